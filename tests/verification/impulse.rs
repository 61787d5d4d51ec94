//! The contact mode `Impulse`: Rapier's solver with the friction and restitution of each pair of materials.
//!
//! - A ball dropped from 100 mm rebounds with e of its own pair: 0.8 on one floor, 0.2 on another (heights e^2 h; the solver
//!   meets the floor within a step of 1 ms, in which the ball falls 1.4 mm, so tolerance 0.03 in e).
//! - A block of friction 0.3 sent along a floor at 0.5 m/s stops after v^2/(2 mu g) = 42.5 mm; tolerance 5 %.
//! - A bed of tablets keeps all of them in the drum, through more than half a turn.

use pancoat::scene::Scene;
use pancoat::stepping::{BodyState, Simulation};
use std::path::Path;

fn scene(text: &str) -> Scene {
    Scene::parse(text, "test.ron", Path::new("."), &[]).expect("the scene of the test")
}

/// Highest point of the ball after its first touch of the floor.
fn drop(restitution: f64) -> f64 {
    let text = format!(
        r#"(format: 1,
        materials: {{"ball": (shear_modulus: MPa(1), poisson: 0.25), "floor": (shear_modulus: MPa(1), poisson: 0.25)}},
        pairs: [(between: ("ball", "floor"), friction: 0.5, restitution: {restitution})],
        shapes: {{"ball": (recipe: Sphere(diameter: Mm(20)))}},
        bodies: [(shape: "ball", material: "ball", mass: G(5), position: Mm(0, 110, 0))],
        boundaries: [(surface: Plane(point: Mm(0, 0, 0), normal: (0, 1, 0)), material: "floor")],
        contact: (mode: Impulse(step: Ms(1))),
        time: (duration: Ms(400), frame_interval: Ms(1)))"#
    );
    let mut simulation = Simulation::new(&scene(&text)).expect("is built");
    let (mut touched, mut highest) = (false, 0.0_f64);
    for frame in 0..400 {
        simulation.run(frame, 1, &mut [], &mut |_| true).expect("runs");
        let BodyState { position, velocity, .. } = simulation.states()[0];
        touched |= velocity.y > 0.0;
        highest = highest.max(if touched { position.y - 0.01 } else { 0.0 });
    }
    highest
}

#[test]
fn each_pair_has_its_own_restitution() {
    for e in [0.2, 0.8] {
        let delivered = (drop(e) / 0.1).sqrt();
        assert!((delivered - e).abs() < 0.03, "{delivered} for {e}");
    }
}

#[test]
fn friction_stops_a_sliding_tablet() {
    let text = r#"(format: 1,
        materials: {"m": (shear_modulus: MPa(1), poisson: 0.25)},
        pairs: [(between: ("m", "m"), friction: 0.3, restitution: 0.1)],
        shapes: {"flat": (recipe: Round(diameter: Mm(16), band: Mm(4), cap: Spherical(height: Mm(0))), spheres: 60)},
        bodies: [(shape: "flat", material: "m", mass: G(1), position: Mm(0, 2, 0), velocity: MPerS(0.5, 0, 0),
            orientation: AxisAngle(axis: (1, 0, 0), angle: Deg(90)))],
        boundaries: [(surface: Plane(point: Mm(0, 0, 0), normal: (0, 1, 0)), material: "m")],
        contact: (mode: Impulse(step: Ms(1))),
        time: (duration: Ms(500), frame_interval: Ms(10)))"#;
    let mut simulation = Simulation::new(&scene(text)).expect("is built");
    simulation.run(0, 50, &mut [], &mut |_| true).expect("runs");
    let BodyState { position, velocity, .. } = simulation.states()[0];
    assert!(velocity.norm() < 1e-3, "{velocity}");
    let expected = 0.25 / (2.0 * 0.3 * 9.81);
    assert!((position.x / expected - 1.0).abs() < 0.05, "{} for {expected}", position.x);
}

#[test]
fn a_stop_names_the_step_of_this_mode() {
    let text = r#"(format: 1,
        materials: {"m": (shear_modulus: MPa(1), poisson: 0.25)},
        pairs: [(between: ("m", "m"), friction: 0.3, restitution: 0.1)],
        shapes: {"ball": (recipe: Sphere(diameter: Mm(10)))},
        bodies: [(shape: "ball", material: "m", mass: G(1), position: Mm(99990, 0, 0), velocity: MPerS(2, 0, 0))],
        contact: (mode: Impulse(step: Ms(1))),
        time: (duration: Ms(10), frame_interval: Ms(10)))"#;
    let mut simulation = Simulation::new(&scene(text)).expect("is built");
    let error = simulation.run(0, 1, &mut [], &mut |_| true).expect_err("ends beyond 100 m");
    assert!(error.to_string().ends_with("lower the step of contact.mode: Impulse"), "{error}");
}

/// The states of 20 tablets after two seconds in a small drum.
fn bed(more: &[&str]) -> Vec<BodyState> {
    let overrides = [
        "batches[0].mass=G(26)",
        "shapes.round.spheres=20",
        "drum.diameter=Mm(120)",
        "drum.width=Mm(60)",
        "drum.baffles.height=Mm(8)",
        "time.settle=For(S(2))",
        "contact.mode=Impulse(step: Ms(1))",
        "spray=None",
    ];
    let overrides: Vec<String> = overrides.iter().chain(more).map(|set| (*set).to_owned()).collect();
    let text = include_str!("../../scenes/round.ron");
    let scene = Scene::parse(text, "round.ron", Path::new("."), &overrides).expect("the scene of the test");
    let mut simulation = Simulation::new(&scene).expect("is built");
    simulation.fill(&mut |_| true).expect("is filled");
    simulation.settle(&mut |_| true).expect("settles");
    assert_eq!(simulation.states().len(), 20);
    simulation.states()
}

#[test]
fn a_bed_turns_and_stays_in_its_drum() {
    let speed = bed(&[]).iter().map(|state| state.velocity.norm()).sum::<f64>() / 20.0;
    // The wall moves at 0.14 m/s and a fall through the drum ends at 1.5 m/s.
    assert!((0.02..0.6).contains(&speed), "{speed} m/s");
}

/// Where friction is low a bed slips: contact forces carry it up by 9 degrees. Walls of facets with edges to bump into
/// carried it up by 45.
#[test]
fn facets_do_not_hold_a_bed_that_slips() {
    let friction = ["drum.baffles=None", "pairs[0].friction=0.1", "pairs[1].friction=0.1"];
    let states = bed(&friction);
    let sum = states.iter().map(|state| state.position).sum::<nalgebra::Vector3<f64>>();
    let angle = sum.x.atan2(-sum.y).to_degrees();
    assert!((2.0..25.0).contains(&angle), "{angle} degrees");
}
