//! V07, V08: bodies at rest. One sphere: overlap (3 m g/(4 E* √R))^(2/3), swinging at √(1.5 g/d)/2π (from Hertz; the
//! load is shared by n equal spheres). Stack: overlap under the weight of all above, (3F/(4E*√R*))^(2/3). Tolerance 1e-6 of
//! the overlaps, 0.2 % of the frequency at an amplitude of a tenth of the overlap. A dashpot that would take 1.4 times the
//! velocity in a step brings a body to rest all the same (derived: met by the velocity of half a step before it is stable
//! below 2, by one predicted for the end of the step below 1), and so does a step too long for the swing.

use super::support::{clump_file, near, run, scene, set, watch};
use pancoat::stepping::Simulation;
use std::f64::consts::TAU;

/// E* of tablet on steel, Pa.
const MODULUS: f64 = 2.033_898_305e6;

fn three() -> (tempfile::NamedTempFile, Vec<String>) {
    let third = |k: f64| (0.006 * (k * TAU / 3.0).cos(), 0.006 * (k * TAU / 3.0).sin());
    let rows: String = [0.0, 1.0, 2.0].map(|k| format!("{} 0 {} 0.002\n", third(k).0, third(k).1)).concat();
    let (file, path) = clump_file(&rows);
    (file, set!["shapes.ball.recipe=Clump(file: {path:?}, inertia_per_mass: Mm2(19.6, 37.6, 19.6))"].into())
}

fn overlap(n: f64) -> f64 {
    (3.0 * 1.3e-3 / n * 9.81 / (4.0 * MODULUS * 2e-3_f64.sqrt())).powf(2.0 / 3.0)
}

#[test]
fn static_overlap_on_one_and_three_spheres() {
    near(2e-3 - run("static_overlap", &[])[0].position.y, overlap(1.0), 1e-6, "one");
    near(overlap(1.0), 22.28e-6, 1e-3, "as tabulated");
    let (_file, set) = three();
    near(2e-3 - run("static_overlap", &set)[0].position.y, overlap(3.0), 1e-6, "three");
    near(overlap(3.0), 10.71e-6, 1e-3, "as tabulated");
}

#[test]
fn strong_dashpots_bring_to_rest() {
    // 2 √(5/6) β √(S_n/m) of e = 0.05 at the overlap of rest is 1024/s.
    let step = "time.step=Fixed(Ms(1.4))";
    let set = set!["{step}", "pairs[0].restitution=0.05", "time.frame_interval=Ms(1.4)"];
    near(2e-3 - run("static_overlap", &set)[0].position.y, overlap(1.0), 1e-6, "overlap");
}

#[test]
fn a_body_stiffer_than_the_step_bears_comes_to_rest() {
    // It swings at 812.7 rad/s; velocity Verlet by itself bears no step above 2 rad, 2.46 ms.
    let set = set!["time.step=Fixed(Ms(3))", "time.frame_interval=Ms(3)", "time.duration=Ms(900)"];
    let mut simulation = Simulation::new(&scene("static_overlap", &set)).expect("the scene is built");
    simulation.run(0, 300, &mut [], &mut |_| true).expect("it runs");
    near(2e-3 - simulation.states()[0].position.y, overlap(1.0), 1e-6, "overlap");
    assert!(simulation.stiff_share() > 0.9);
}

#[test]
fn natural_frequency_on_one_and_three_spheres() {
    let (_file, clump) = three();
    for (n, expected, more) in [(1.0, 129.347, vec![]), (3.0, 186.55, clump)] {
        let rest = 2e-3 - overlap(n);
        let start = 1e3 * (rest + 0.1 * overlap(n));
        let set = set![
            "pairs[0].restitution=1",
            "bodies[0].position=Mm(0, {start}, 0)",
            "time.frame_interval=Us(100)",
            "time.duration=Ms(200)",
        ];
        let history = watch("static_overlap", &[more, set.to_vec()].concat());
        let up: Vec<f64> = history
            .windows(2)
            .filter(|w| w[0].1[0].position.y < rest && w[1].1[0].position.y >= rest)
            .map(|w| {
                let (a, b) = (w[0].1[0].position.y - rest, w[1].1[0].position.y - rest);
                w[0].0 + (w[1].0 - w[0].0) * a / (a - b)
            })
            .collect();
        let frequency = (up.len() - 1) as f64 / (up[up.len() - 1] - up[0]);
        near(frequency, expected, 2e-3, "frequency");
    }
}

#[test]
fn stack_of_ten() {
    let bodies = run("stack", &[]);
    let y: Vec<f64> = bodies.iter().map(|b| b.position.y).collect();
    near(5e-3 - y[0], 24.8590e-6, 1e-5, "lowest");
    near(0.01 - (y[1] - y[0]), 46.3456e-6, 1e-5, "next");
    near(0.01 - (y[9] - y[8]), 10.7114e-6, 1e-5, "topmost");
    near(y[9], 94.703_078e-3, 1e-8, "top");
    assert!(bodies.iter().all(|b| b.position.xz().norm() < 1e-6 && b.spin.norm() < 1e-6));
}
