//! The pan.

use super::super::model::{Baffles, Drum};
use super::super::path::KeyPath;
use super::super::spec::{BafflesSpec, DrumSpec};
use super::{Allowed, Checker};
use std::f64::consts::PI;

/// Inner diameter and width, m.
const SIZE: Allowed = Allowed::from(1e-3).to(10.0);

/// Flat facets around the wall unless the scene says otherwise: at 250 mm across, 90 facets stay within 0.08 mm of the
/// circle.
const FACETS: f64 = 90.0;

/// Steepest tilt of a baffle, rad (80 degrees).
const STEEPEST: f64 = 80.0 * PI / 180.0;

pub(super) fn drum(c: &mut Checker<'_>, spec: DrumSpec) -> Drum {
    let at = KeyPath::default().field("drum");
    let diameter = c.number(&at.field("diameter"), spec.diameter, SIZE);
    Drum {
        diameter,
        width: c.number(&at.field("width"), spec.width, SIZE),
        speed: c.number(&at.field("speed"), spec.speed, Allowed::from(-1e3).to(1e3)),
        material: c.name(&at.field("material"), spec.material, "material", "materials"),
        facets: c.number_or(&at.field("facets"), spec.facets, FACETS, Allowed::from(8.0).to(10_000.0))
            as usize,
        baffles: spec.baffles.map(|baffles| self::baffles(c, &at.field("baffles"), baffles, diameter)),
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
