//! Whether the parts of a scene fit together.

use super::super::drum::Drum;
use super::super::fault::FaultKind;
use super::super::model::{Aim, Record, Scene, Spray};
use super::super::path::KeyPath;
use super::super::recipe::Recipe;
use super::pattern::LONGEST_PHASE;
use super::size::volume_and_extent;
use super::{Allowed, Checker};
use crate::units::{Length, TimeSpan};

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
        if scene.outputs.record == Some(Record::Compact) {
            c.fault(&at.field("outputs").field("record"), FaultKind::Needs("a drum"));
        }
    }
    if let Some(drum) = &scene.drum {
        bodies_inside(c, scene, drum);
        tablets_inside(c, scene, drum);
        if let Some(spray) = &scene.spray {
            spray_inside(c, spray, drum);
        }
    }
    if let Some(spray) = &scene.spray {
        sprayed(c, scene);
        no_burst_between_frames(c, spray, scene.time.frame_interval);
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
    let fraction = solid / drum.volume();
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

fn spray_inside(c: &mut Checker<'_>, spray: &Spray, drum: &Drum) {
    let at = KeyPath::default().field("spray");
    let mut within = |path: KeyPath, extent: f64, room: f64| {
        if extent > room {
            c.out_of_range::<Length>(&path, Allowed::above(0.0).to(room));
        }
    };
    within(at.field("spanwise"), spray.spanwise, drum.width);
    within(at.field("streamwise"), spray.streamwise, drum.diameter);
    let room = (drum.width - spray.spanwise) / 2.0;
    for (i, offset) in spray.pattern.nozzles.iter().enumerate() {
        // Rounding of the subtraction is no fault.
        if room >= 0.0 && offset.abs() > room + 1e-9 {
            c.out_of_range::<Length>(&at.field("nozzles").index(i), Allowed::from(-room).to(room));
        }
    }
    if let Aim::Fixed { target, .. } = spray.aim
        && (target.x.hypot(target.y) > drum.diameter / 2.0 || target.z.abs() > drum.width / 2.0)
    {
        c.fault(&at.field("aim").field("target"), FaultKind::OutsideDrum);
    }
}

/// The coater looks at the bed once a frame: a spray shorter than that could be missed.
fn no_burst_between_frames(c: &mut Checker<'_>, spray: &Spray, frame_interval: f64) {
    if spray.pattern.cycle.is_some_and(|cycle| cycle.on < frame_interval) {
        let path = KeyPath::default().field("spray").field("cycle").field("on");
        c.out_of_range::<TimeSpan>(&path, Allowed::from(frame_interval).to(LONGEST_PHASE));
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
