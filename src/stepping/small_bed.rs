//! A bed of a few of the paper's tablets, for tests of what must not change it.

use super::simulation::Simulation;
use crate::scene::Scene;
use std::path::Path;

/// Tablets of 12 spheres, so many grams of them, filled in and turned for some frames.
pub(super) fn small_bed(grams: u32, frames: u64) -> Simulation {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/round.ron");
    let overrides = [&format!("batches[0].mass=G({grams})"), "shapes.round.spheres=12", "spray=None"];
    let scene = Scene::load(&path, &overrides.map(String::from)).expect("is valid");
    let mut simulation = Simulation::new(&scene).expect("is built");
    simulation.fill(&mut |_| true).expect("is filled");
    simulation.run(0, frames, &mut [], &mut |_| true).expect("runs");
    simulation
}
