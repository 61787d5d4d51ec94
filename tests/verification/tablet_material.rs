//! V19: one sphere of the paper's material on steel (r 4 mm, 1500 kg/m³, G 1 and 3 MPa, ν 0.25 and 0.3, e 0.5, μ 0.5,
//! 0.3 m/s). Expected: separate integrations with 4e5 steps a contact, of the law as it is (cap on |F_n| with its dashpot,
//! tangential dashpot while sticking), without the tangential dashpot, and with no tension and no tangential dashpot.
//! Tolerance 0.2 %, 2e-3 of the spin and 0.05 rad/s.

use super::support::{Single, law, near, run, set};
use nalgebra::Vector3;
use pancoat::scene::ContactSettings;
use pancoat::stepping::BodyState;

/// Angle, then e_t and spin of each.
const TABLE: [(f64, [[f64; 2]; 3]); 6] = [
    (10.0, [[0.72458, -8.968], [0.78380, -7.039], [0.81043, -6.172]]),
    (30.0, [[0.72347, -25.925], [0.64756, -33.042], [0.62199, -35.438]]),
    (45.0, [[0.71755, -37.448], [0.62887, -49.205], [0.60501, -52.369]]),
    (60.0, [[0.70383, -48.092], [0.63934, -58.565], [0.62519, -60.862]]),
    (70.0, [[0.70671, -51.676], [0.71885, -49.536], [0.72060, -49.227]]),
    (80.0, [[0.84541, -28.546], [0.85950, -25.943], [0.86392, -25.127]]),
];

/// Speeds along the plane and onto it, m/s, of an impact at an angle, and how the scene ends with `more` set.
fn impact(degrees: f64, more: &[String]) -> (f64, f64, BodyState) {
    let (s, c) = degrees.to_radians().sin_cos();
    let (vx, vy) = (0.3 * s, 0.3 * c);
    let set = set![
        "bodies[0].velocity=MPerS({vx}, -{vy}, 0)",
        "time.impact_speed=MPerS({vy})",
        "time.duration=Ms(20)",
    ];
    (vx, vy, run("tablet_impact", &[&set[..], more].concat())[0])
}

#[test]
fn rebound_and_spin() {
    for (degrees, [as_is, no_dashpot, no_tension]) in TABLE {
        let (vx, vy, state) = impact(degrees, &[]);
        near(state.velocity.x / vx, as_is[0], 2e-3, "e_t of the scene");
        near(state.spin.z, as_is[1], 5e-3, "spin of the scene");
        for (cut, dashpot, expected) in
            [(false, 1.0, as_is), (false, 0.0, no_dashpot), (true, 0.0, no_tension)]
        {
            let settings = ContactSettings { no_tension: cut, ..ContactSettings::default() };
            let single = Single {
                radius: 4e-3,
                mass: 4.021_239e-4,
                law: law((1e6, 0.25), (3e6, 0.3), 0.5, 0.5, settings),
                tangential_dashpot: dashpot,
                velocity: Vector3::new(vx, -vy, 0.0),
                spin: 0.0,
                steps: 20_000.0,
            };
            let (v, w, _) = single.collide();
            near(v.x / vx, expected[0], 2e-3, "e_t of the law");
            near(w, expected[1], 5e-3, "spin of the law");
        }
    }
}

/// A sphere alone feels its own mass at the contact: damped by the contact it rebounds as damped by the body, along the
/// plane too.
#[test]
fn damping_by_the_contact_is_the_same_for_one_sphere() {
    for (degrees, [as_is, ..]) in TABLE {
        let (vx, _, state) = impact(degrees, &set!["contact=(damping_mass: Contact)"]);
        near(state.velocity.x / vx, as_is[0], 2e-3, "e_t");
    }
}
