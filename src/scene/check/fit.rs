//! Whether the parts of a scene fit together.

use super::super::fault::FaultKind;
use super::super::model::{Aim, Cap, Drum, Recipe, Scene};
use super::super::path::KeyPath;
use super::{Allowed, Checker};
use crate::units::Length;
use std::f64::consts::PI;

/// Largest solid volume over the drum's. Spheres poured and shaken pack to 0.64; these have to move.
const FULLEST: f64 = 0.6;

/// Panel ids are 32-bit numbers, of which the last 1024 are for what is no panel (nothing, wall, baffles).
const MOST_PANELS: u64 = (1 << 32) - 1024;

/// Notes the faults between sections. NaN, which stands for a refused number, trips none of them.
pub(super) fn fit_together(c: &mut Checker<'_>, scene: &Scene) {
    let at = KeyPath::default();
    if scene.drum.is_none() {
        if !scene.batches.is_empty() {
            c.fault(&at.field("batches"), FaultKind::Needs("a drum"));
        }
        if scene.spray.is_some() {
            c.fault(&at.field("spray"), FaultKind::Needs("a drum"));
        }
    }
    if let Some(drum) = &scene.drum {
        bodies_inside(c, scene, drum);
        tablets_inside(c, scene, drum);
        spray_inside(c, scene, drum);
    }
    if scene.spray.is_some() {
        sprayed(c, scene);
    }
}

fn tablets_inside(c: &mut Checker<'_>, scene: &Scene, drum: &Drum) {
    let room = drum.diameter.min(drum.width);
    let mut solid = 0.0;
    for (i, batch) in scene.batches.iter().enumerate() {
        let Some(shape) = scene.shapes.get(batch.shape) else { continue };
        let Some((volume, extent)) = volume_and_extent(&shape.recipe) else { continue };
        if extent > room {
            let (size_mm, room_mm) = (1e3 * extent, 1e3 * room);
            let path = Checker::item("batches", i).field("shape");
            c.fault(&path, FaultKind::LargerThanDrum { shape: shape.name.clone(), size_mm, room_mm });
        }
        solid += batch.count as f64 * volume;
    }
    let fraction = solid / (PI / 4.0 * drum.diameter * drum.diameter * drum.width);
    if fraction > FULLEST {
        let overfull = FaultKind::Overfull { fraction, limit: FULLEST };
        c.fault(&KeyPath::default().field("batches"), overfull);
    }
}

fn bodies_inside(c: &mut Checker<'_>, scene: &Scene, drum: &Drum) {
    for (i, body) in scene.bodies.iter().enumerate() {
        let at = body.position;
        if at.x.hypot(at.y) > drum.diameter / 2.0 || at.z.abs() > drum.width / 2.0 {
            c.fault(&Checker::item("bodies", i).field("position"), FaultKind::OutsideDrum);
        }
    }
}

fn spray_inside(c: &mut Checker<'_>, scene: &Scene, drum: &Drum) {
    let Some(spray) = &scene.spray else { return };
    let at = KeyPath::default().field("spray");
    let mut within = |path: KeyPath, extent: f64, room: f64| {
        if extent > room {
            c.out_of_range::<Length>(&path, Allowed::above(0.0).to(room));
        }
    };
    within(at.field("spanwise"), spray.spanwise, drum.width);
    within(at.field("streamwise"), spray.streamwise, drum.diameter);
    if let Aim::Fixed { target, .. } = spray.aim
        && (target.x.hypot(target.y) > drum.diameter / 2.0 || target.z.abs() > drum.width / 2.0)
    {
        c.fault(&at.field("aim").field("target"), FaultKind::OutsideDrum);
    }
}

/// Panels can be told apart, and every sprayed shape has a surface.
fn sprayed(c: &mut Checker<'_>, scene: &Scene) {
    let at = KeyPath::default();
    let tablets = scene.batches.iter().map(|b| (b.shape, b.count as u64));
    let tablets: Vec<_> = tablets.chain(scene.bodies.iter().map(|b| (b.shape, 1))).collect();
    let panels_of =
        |&(shape, count): &(usize, u64)| scene.shapes.get(shape).map_or(0, |s| s.panels as u64) * count;
    let panels: u64 = tablets.iter().map(panels_of).sum();
    if panels > MOST_PANELS {
        c.fault(&at.field("batches"), FaultKind::TooManyPanels { panels, limit: MOST_PANELS });
    }
    for (index, shape) in scene.shapes.iter().enumerate() {
        let used = tablets.iter().any(|(shape, _)| *shape == index);
        if used && matches!(shape.recipe, Recipe::Clump { .. }) {
            c.fault(&at.field("shapes").field(&shape.name).field("recipe"), FaultKind::NoSurface);
        }
    }
}

/// Volume, m³, and largest extent, m, of the solid; `None` if only its spheres are known.
///
/// A cap of height h over a circle of radius R holds πh(3R² + h²)/6 if it is part of a sphere, and
/// ∫₀¹ h(1 − sᵐ) 2πR² s ds = πR² h m/(m + 2) if it is compound with exponent m (derived here).
fn volume_and_extent(recipe: &Recipe) -> Option<(f64, f64)> {
    match *recipe {
        Recipe::Sphere { diameter } => Some((PI / 6.0 * diameter.powi(3), diameter)),
        Recipe::Round { diameter, band, cap } => {
            let r2 = diameter * diameter / 4.0;
            let (height, cap_volume) = match cap {
                Cap::Spherical { height } => (height, PI * height * (3.0 * r2 + height * height) / 6.0),
                Cap::Compound { height, exponent } => {
                    (height, PI * r2 * height * exponent / (exponent + 2.0))
                }
            };
            Some((PI * r2 * band + 2.0 * cap_volume, diameter.max(band + 2.0 * height)))
        }
        Recipe::Clump { .. } => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// The paper's round tablet has 1042 mm³; a ball is a band of no height with two hemispheres.
    #[test]
    fn volumes_of_tablets() {
        let cap = Cap::Compound { height: 1.6973e-3, exponent: 2.8823 };
        let (volume, extent) = volume_and_extent(&Recipe::Round { diameter: 15.9e-3, band: 3.2452e-3, cap })
            .expect("is a solid");
        assert_relative_eq!(volume, 1042e-9, max_relative = 1e-3);
        assert_eq!(extent, 15.9e-3);
        let halves = Recipe::Round { diameter: 2.0, band: 0.0, cap: Cap::Spherical { height: 1.0 } };
        let ball = volume_and_extent(&Recipe::Sphere { diameter: 2.0 }).expect("is a solid");
        assert_relative_eq!(volume_and_extent(&halves).expect("is a solid").0, ball.0, max_relative = 1e-15);
    }
}
