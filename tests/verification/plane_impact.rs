//! A sphere hits a plane: delivered restitution, and oblique impact with friction.
//!
//! Normal: with the attractive tail of the dashpot allowed, e_out = e_in for any material and speed (Antypov & Elliott
//! 2011, EPL 94, 50004: the dashpot used here is theirs with alpha = sqrt(5) beta). Tolerance 1e-3 at 400 steps per
//! contact; the case is Chung & Ooi 2011, Granular Matter 13, 643, test 3.
//!
//! Oblique: Chung & Ooi, test 4 (aluminium oxide, 3.9 m/s, mu 0.092, e 0.98). In gross sliding, from 30 degrees
//! up, e_t = 1 - mu (1 + e)/tan(theta) and the spin is -5 mu (1 + e) v cos(theta)/(2 r), exact for a rigid sphere;
//! tolerance 0.2 %. Below, the value of the total tangential law without dashpot in a separate integration of the same
//! law with 4e5 steps per contact; with the dashpot while sticking it is 0.70236 at 10 degrees; tolerance 1 %.

use super::support::run;

fn impact(restitution: f64, friction: f64, speed: f64, degrees: f64) -> (f64, f64, f64) {
    let (vx, vy) = (speed * degrees.to_radians().sin(), speed * degrees.to_radians().cos());
    // A thousandth of E = 380 GPa at nu = 0.23 gives G = 154.47 MPa (what is tested does not depend on E); the mass is that
    // of 4000 kg/m3; a plane 6000 times as stiff is rigid.
    let text = format!(
        r#"(format: 1, title: "impact", gravity: MPerS2(0, 0, 0),
        materials: {{ "oxide": (shear_modulus: MPa(154.4715447), poisson: 0.23), "rigid": (shear_modulus: GPa(1000), poisson: 0.23) }},
        pairs: [(between: ("oxide", "rigid"), friction: {friction}, restitution: {restitution})],
        shapes: {{ "ball": (recipe: Sphere(diameter: Mm(5))) }},
        bodies: [(shape: "ball", material: "oxide", mass: Mg(261.7993878), position: Mm(0, 2.5, 0), velocity: MPerS({vx}, -{vy}, 0))],
        boundaries: [(surface: Plane(point: Mm(0, 0, 0), normal: (0, 1, 0)), material: "rigid")],
        time: (step: PerContact(400), impact_speed: MPerS({speed}), duration: Us(400), frame_interval: Us(100)))"#
    );
    let state = run(&text)[0];
    (state.velocity.y / vy, state.velocity.x / vx.max(1e-300), state.spin.z)
}

#[test]
fn restitution_is_delivered() {
    for e in [0.2, 0.4, 0.6, 0.8, 1.0] {
        let (out, ..) = impact(e, 0.0, 3.9, 0.0);
        assert!((out - e).abs() < 1e-3, "asked {e}, delivered {out}");
    }
}

#[test]
fn gross_sliding_follows_coulomb() {
    for degrees in [40.0_f64, 60.0, 80.0] {
        let (_, tangential, spin) = impact(0.98, 0.092, 3.9, degrees);
        let expected = 1.0 - 0.092 * 1.98 / degrees.to_radians().tan();
        assert!((tangential / expected - 1.0).abs() < 2e-3, "{degrees}: {tangential} for {expected}");
        let expected = -5.0 * 0.092 * 1.98 * 3.9 * degrees.to_radians().cos() / (2.0 * 2.5e-3);
        assert!((spin / expected - 1.0).abs() < 2e-3, "{degrees}: {spin} for {expected}");
    }
}

#[test]
fn steep_impact_tells_the_tangential_law() {
    let (_, tangential, _) = impact(0.98, 0.092, 3.9, 10.0);
    assert!((tangential / 0.70236 - 1.0).abs() < 1e-2, "{tangential}");
}
