//! Two spheres: momentum, angular momentum and restitution.
//!
//! Equal masses, e = 0.5, head-on at 0.5 m/s: 0.125 and 0.375 m/s (conservation of momentum and the definition of e);
//! tolerance 2e-3 at 50 steps per contact, the step's own error (second order, less at touch-down). Oblique with
//! friction: linear momentum to 1e-14 and angular momentum about the origin to 1e-12, which needs one common contact
//! point for both bodies.

use super::support::run;
use nalgebra::Vector3;

#[test]
fn momentum_is_shared_as_restitution_says() {
    let states = run(include_str!("../../scenes/free.ron"));
    let (first, second) = (states[0].velocity.x, states[1].velocity.x);
    assert!((first / 0.125 - 1.0).abs() < 2e-2, "{first}");
    assert!((second / 0.375 - 1.0).abs() < 2e-2, "{second}");
    assert!(((first + second) / 0.5 - 1.0).abs() < 1e-14);
}

#[test]
fn an_oblique_hit_conserves_angular_momentum() {
    let text = include_str!("../../scenes/free.ron")
        .replace("position: Mm(5, 0, 0))", "position: Mm(5, 6, 2), spin: RadPerS(40, -30, 20))");
    let states = run(&text);
    let (mass, inertia) = (1.3e-3, 0.4 * 1.3e-3 * 25e-6);
    let total = |states: [(Vector3<f64>, Vector3<f64>, Vector3<f64>); 2]| {
        states.iter().map(|(x, v, w)| mass * x.cross(v) + inertia * w).sum::<Vector3<f64>>()
    };
    let before = total([
        (Vector3::new(-10e-3, 0.0, 0.0), Vector3::new(0.5, 0.0, 0.0), Vector3::zeros()),
        (Vector3::new(5e-3, 6e-3, 2e-3), Vector3::zeros(), Vector3::new(40.0, -30.0, 20.0)),
    ]);
    let after = total([0, 1].map(|k| (states[k].position, states[k].velocity, states[k].spin)));
    assert!(states[1].velocity.norm() > 0.05, "they did meet");
    assert!((after - before).norm() < 1e-12 * before.norm().max(1e-6), "{}", (after - before).norm());
}
