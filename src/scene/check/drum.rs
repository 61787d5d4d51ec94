//! The pan.

use super::super::drum::{Baffles, Drum, Wall};
use super::super::fault::FaultKind;
use super::super::path::KeyPath;
use super::super::spec::{BafflesSpec, DrumSpec, WallSpec};
use super::{Allowed, Checker};
use crate::units::Quantity;
use std::f64::consts::PI;

/// Inner diameter and width, m.
const SIZE: Allowed = Allowed::from(1e-3).to(10.0);

/// Flat facets around the wall unless the scene says otherwise: at 250 mm across, 90 facets stay within 0.08 mm of the
/// circle.
const FACETS: f64 = 90.0;

/// Steepest tilt of a baffle, rad (80 degrees).
const STEEPEST: f64 = 80.0 * PI / 180.0;

/// Most that the drum's axis may lean, rad (45 degrees).
const MOST_AXIS_TILT: f64 = PI / 4.0;

pub(super) fn drum(c: &mut Checker<'_>, spec: DrumSpec) -> Drum {
    let at = KeyPath::default().field("drum");
    let diameter = c.number(&at.field("diameter"), spec.diameter, SIZE);
    let width = c.number(&at.field("width"), spec.width, SIZE);
    let wall = spec.wall.map_or(Wall::Cylinder, |w| wall(c, &at.field("wall"), w, [diameter, width]));
    if spec.baffles.is_some() && matches!(wall, Wall::Mesh { .. }) {
        let own = "a mesh brings its own baffles; leave these out".to_owned();
        c.fault(&at.field("baffles"), FaultKind::Impossible(own));
    }
    // Baffles are as high everywhere, so they have to fit where the drum is narrowest.
    let narrowest = match &wall {
        Wall::Profile(points) => points.iter().map(|point| point[1]).fold(diameter, f64::min),
        Wall::Cylinder | Wall::Mesh { .. } => diameter,
    };
    Drum {
        diameter,
        width,
        speed: c.number(&at.field("speed"), spec.speed, Allowed::from(-1e3).to(1e3)),
        material: c.name(&at.field("material"), spec.material, "material", "materials"),
        wall,
        facets: c.number_or(&at.field("facets"), spec.facets, FACETS, Allowed::from(8.0).to(10_000.0))
            as usize,
        baffles: spec.baffles.map(|baffles| self::baffles(c, &at.field("baffles"), baffles, narrowest)),
        axis_tilt: c.number_or(
            &at.field("axis_tilt"),
            spec.axis_tilt,
            0.0,
            Allowed::from(-MOST_AXIS_TILT).to(MOST_AXIS_TILT),
        ),
    }
}

fn wall(c: &mut Checker<'_>, at: &KeyPath, spec: WallSpec, [diameter, width]: [f64; 2]) -> Wall {
    match spec {
        WallSpec::Cylinder => Wall::Cylinder,
        WallSpec::Mesh { file, unit } => Wall::Mesh {
            path: c.file(&at.field("file"), file),
            scale: c.number(&at.field("unit"), unit, Allowed::from(1e-6).to(1.0)),
        },
        WallSpec::Profile(points) => {
            let points: Vec<[f64; 2]> = points.iter().map(|(z, d)| [z.si(), d.si()]).collect();
            let ends = points.first().zip(points.last()).filter(|_| points.len() > 1);
            let spans = ends.is_some_and(|(first, last)| {
                let half = width / 2.0;
                width.is_nan() || ((first[0] + half).abs() < 1e-9 && (last[0] - half).abs() < 1e-9)
            });
            let largest = if diameter.is_nan() { 10.0 } else { diameter };
            let rises = points.windows(2).all(|pair| pair[0][0] < pair[1][0]);
            let fits = points.iter().all(|point| (1e-3..=largest).contains(&point[1]));
            if !spans || !rises || !fits {
                let rule = "places rise from minus half to plus half the drum's width, and diameters are from 1 mm to \
                            that of the drum";
                c.fault(at, FaultKind::Impossible(rule.to_owned()));
            }
            Wall::Profile(points)
        }
    }
}

fn baffles(c: &mut Checker<'_>, at: &KeyPath, spec: BafflesSpec, diameter: f64) -> Baffles {
    let diameter = if diameter.is_nan() { 10.0 } else { diameter };
    let count = c.count(&at.field("count"), spec.count, Allowed::from(1.0).to(64.0));
    // Half of the wall stays free between the baffles' feet, and a way along the axis past their edges.
    let widest = PI * diameter / (2 * count.max(1)) as f64;
    Baffles {
        count,
        height: c.number(&at.field("height"), spec.height, Allowed::above(0.0).below(diameter / 2.0)),
        thickness: c.number(&at.field("thickness"), spec.thickness, Allowed::above(0.0).to(widest)),
        tilt: c.number_or(&at.field("tilt"), spec.tilt, 0.0, Allowed::from(-STEEPEST).to(STEEPEST)),
    }
}
