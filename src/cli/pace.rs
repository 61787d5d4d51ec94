//! How long a run will take on this machine.

use crate::contact::{PairLaw, Spring, Touch};
use crate::scene::Scene;
use crate::shapes::TabletShape;
use nalgebra::Vector3;
use std::hint::black_box;
use std::time::Instant;

/// Cost of one body in one time step, in evaluations of the contact law: lists, motion and search, and what each sphere
/// of its clump adds. Measured with `cargo run --release --example throughput` on the cases `peers20`, `peers50`,
/// `peers100` and `round`, one thread; a flat pan is a quarter cheaper, a busy machine up to twice as slow.
const BODY: f64 = 12.0;
const SPHERE: f64 = 0.12;
/// Evaluations timed to learn the machine's pace.
const TRIALS: u32 = 100_000;

/// Wall time of one simulated second of dynamics on one core, s, with steps of `step` s.
pub(super) fn seconds_per_second(scene: &Scene, shapes: &[TabletShape], step: f64) -> f64 {
    let batches = scene.batches.iter().map(|batch| (batch.shape, batch.count));
    let bodies = batches.chain(scene.bodies.iter().map(|body| (body.shape, 1)));
    let evaluations: f64 = bodies
        .map(|(shape, count)| count as f64 * (BODY + SPHERE * shapes[shape].clump.spheres.len() as f64))
        .sum();
    evaluations * law_seconds(scene) / step
}

/// Time of one evaluation of the contact law here and now, s.
fn law_seconds(scene: &Scene) -> f64 {
    let material = &scene.materials[0];
    let law = PairLaw::new(material, material, scene.pairs.get(0, 0), scene.contact);
    let mut spring = Spring::default();
    let velocity = Vector3::new(-0.1, 0.1, 0.0);
    let touch = Touch { normal: Vector3::x(), overlap: 1e-5, velocity, twirl: 1.0 };
    let start = Instant::now();
    for _ in 0..TRIALS {
        let dashpots = law.dashpots(1e-4, 1e-3);
        black_box(law.force(black_box(&touch), 1e-4, dashpots, 1e-5, &mut spring));
    }
    start.elapsed().as_secs_f64() / f64::from(TRIALS)
}
