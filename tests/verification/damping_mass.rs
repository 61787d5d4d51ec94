//! V35: an off-centre hit. A dumbbell lands on one of its spheres, frictionless: 1/m_eff = 1/m + (r × n)·I⁻¹(r × n) is
//! 1.849057/m, so that damping by the body's mass delivers β' = β √1.849 at the contact (e = 0.5: 0.3815, with the body
//! turning under finite overlap 0.38153), damping by the contact e. v' and ω' follow from the impulse. Tolerance 0.5 %.

use super::support::{close, near, scene, set, watch};
use nalgebra::{UnitQuaternion, Vector3};

/// Speed at the contact after over before; v_y; spin about z.
fn landing(e: f64, mode: &str) -> (f64, f64, f64) {
    let set = set![
        "pairs[0].restitution={e}",
        "contact=(damping_mass: {mode})",
        "bodies[0].orientation=AxisAngle(axis: (0, 0, 1), angle: Deg(-4))",
    ];
    let lean: UnitQuaternion<f64> = scene("off_centre_landing", &set).bodies[0].orientation;
    let arm = lean * Vector3::new(3e-3, 0.0, 0.0);
    let history = watch("off_centre_landing", &set);
    let height = |s: &pancoat::stepping::BodyState| {
        (s.position + s.orientation * Vector3::new(3e-3, 0.0, 0.0)).y - 2e-3
    };
    let begun = history.iter().position(|(_, b)| height(&b[0]) < 0.0).expect("lands");
    let end = history[begun..].iter().find(|(_, b)| height(&b[0]) > 0.0).expect("leaves").1[0];
    let at = end.velocity + end.spin.cross(&(end.orientation * Vector3::new(3e-3, 0.0, 0.0)));
    assert!(arm.y < 0.0, "its right end is the lower one");
    (at.y / 0.3, end.velocity.y, end.spin.z)
}

#[test]
fn elastic_and_damped_by_the_body() {
    // 4 degrees of lean: lever 3 mm cos 4.
    let lever = 3.0 * 4.0_f64.to_radians().cos();
    let felt = 1.0 + lever * lever / 10.6;
    let (contact, v, w) = landing(1.0, "Body");
    near(contact, 1.0, 5e-3, "elastic");
    let impulse = 2.0 * 0.3 / felt;
    close(v, -0.3 + impulse, 2e-3, "v");
    near(w, impulse * lever * 1e-3 / 10.6e-6, 5e-3, "spin");
    let beta = pancoat::contact::damping_ratio(0.5) * felt.sqrt();
    let expected = (-beta * std::f64::consts::PI / (1.0 - beta * beta).sqrt()).exp();
    close(expected, 0.38188, 2e-3, "as tabulated");
    let (contact, v, _) = landing(0.5, "Body");
    close(contact, expected, 3e-3, "damped");
    close(v, -0.3 + (1.0 + expected) * 0.3 / felt, 2e-3, "v");
}

#[test]
fn damped_by_the_contact() {
    for e in [0.2, 0.5, 0.8] {
        close(landing(e, "Contact").0, e, 5e-3, "at the contact");
    }
}
