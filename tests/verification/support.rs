//! Small scenes and what came of them.

use pancoat::scene::Scene;
use pancoat::stepping::{BodyState, Simulation};
use std::path::Path;

/// Runs a scene's whole duration and gives the states at its end.
pub(crate) fn run(text: &str) -> Vec<BodyState> {
    let scene = Scene::parse(text, "test.ron", Path::new("."), &[]).expect("the scene of the test runs");
    let mut simulation = Simulation::new(&scene).expect("the scene of the test runs");
    let frames = (scene.time.duration / scene.time.frame_interval).round() as u64;
    simulation.run(0, frames, &mut [], &mut |_| true).expect("the scene of the test runs");
    simulation.states()
}
