//! From what is written to what is meant: defaults, ranges, names to indices, and whether the parts fit together.
//!
//! Every check notes its fault and goes on with a number that trips no later check, so that one reading tells all.

mod allowed;
mod boundaries;
mod checker;
mod drum;
mod fit;
mod materials;
mod moving;
mod pattern;
mod recipe;
mod shapes;
mod size;
mod spray;
mod time;

use super::decode::Located;
use super::fault::FaultKind;
use super::model::{ContactMode, Scene};
use super::outline::Node;
use super::path::KeyPath;
use super::spec::SceneSpec;
use allowed::Allowed;
use checker::Checker;
use nalgebra::{Rotation3, Vector3};
use std::path::Path;

/// The format that this version of the program reads.
const FORMAT: f64 = 1.0;

/// Standard acceleration of gravity, m/s², rounded as discrete-element papers do.
const GRAVITY: f64 = 9.81;

/// Checks a spec read from `text`, adds to `faults`, and returns the scene, which is of use only without any fault.
pub(super) fn check(
    spec: SceneSpec,
    text: &str,
    root: &Node,
    base_dir: &Path,
    faults: &mut Vec<Located>,
) -> Scene {
    let mut checker = Checker { text, root, base_dir, faults };
    let c = &mut checker;
    let at = KeyPath::default();

    let format = c.number(&at.field("format"), spec.format, Allowed::from(FORMAT).to(FORMAT));
    debug_assert!(format.is_nan() || format == FORMAT, "another format has been refused");
    let seed = c.number_or(&at.field("seed"), spec.seed, 1.0, Allowed::from(0.0).to(9_007_199_254_740_992.0));
    let gravity = match spec.gravity {
        Some(gravity) => c.triple(&at.field("gravity"), gravity, 1e4),
        None => Vector3::new(0.0, -GRAVITY, 0.0),
    };
    let materials = materials::materials(c, spec.materials);
    let pairs = materials::pairs(c, spec.pairs.unwrap_or_default(), &materials);
    let shapes = shapes::shapes(c, spec.shapes);
    let drum = spec.drum.map(|drum| drum::drum(c, drum));
    // The drum's axes are those of the scene: its tilt turns gravity.
    let tilt = drum.as_ref().map_or(0.0, |drum| drum.axis_tilt);
    let gravity =
        if tilt == 0.0 { gravity } else { Rotation3::from_axis_angle(&Vector3::x_axis(), tilt) * gravity };
    let batches = moving::batches(c, spec.batches.unwrap_or_default());
    let bodies = moving::bodies(c, spec.bodies.unwrap_or_default());
    let boundaries = boundaries::boundaries(c, spec.boundaries.unwrap_or_default());
    let time = time::time(c, spec.time.unwrap_or_default(), drum.is_some());
    let contact = time::contact(c, spec.contact, time.frame_interval);
    let energy_audit = spec.outputs.as_ref().is_some_and(|outputs| outputs.energy == Some(true));
    if energy_audit && contact.mode != ContactMode::HertzMindlin {
        c.fault(&at.field("outputs").field("energy"), FaultKind::Needs("contact.mode: HertzMindlin"));
    }
    let spray = spec.spray.map(|spray| spray::spray(c, spray));
    let outputs = time::outputs(c, spec.outputs.unwrap_or_default(), time.frame_interval);

    let scene = Scene {
        title: spec.title.unwrap_or_else(|| "untitled scene".to_owned()),
        seed: seed as u64,
        gravity,
        materials,
        pairs: pairs.table,
        shapes,
        batches,
        drum,
        bodies,
        boundaries,
        contact,
        time,
        spray,
        outputs,
    };
    materials::all_pairs_given(c, &scene, &pairs.given);
    fit::fit_together(c, &scene);
    if scene.batches.is_empty()
        && scene.bodies.is_empty()
        && !c.told(&at.field("batches"))
        && !c.told(&at.field("bodies"))
    {
        c.fault(&at, FaultKind::Nothing);
    }
    scene
}
