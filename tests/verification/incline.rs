//! A sphere on an incline rolls without slipping while tan(theta) <= 7/2 mu, at 5/7 g sin(theta); steeper, it slides at
//! g (sin(theta) - mu cos(theta)). Elementary mechanics of a homogeneous sphere. Tolerance 0.2 % after 0.5 s, less what
//! the first bounce takes.

use super::support::run;

fn speed_after_half_a_second(degrees: f64, friction: f64) -> f64 {
    let (s, c) = degrees.to_radians().sin_cos();
    // The plane stays level and gravity leans; the sphere starts at its static overlap.
    let text = format!(
        r#"(format: 1, title: "incline", gravity: MPerS2({}, {}, 0),
        materials: {{ "m": (shear_modulus: MPa(10), poisson: 0.3) }},
        pairs: [(between: ("m", "m"), friction: {friction}, restitution: 0.5)],
        shapes: {{ "ball": (recipe: Sphere(diameter: Mm(10))) }},
        bodies: [(shape: "ball", material: "m", mass: Mg(1047.1975512), position: Mm(0, 4.997, 0))],
        boundaries: [(surface: Plane(point: Mm(0, 0, 0), normal: (0, 1, 0)), material: "m")],
        time: (step: PerContact(60), impact_speed: MPerS(0.5), duration: Ms(500), frame_interval: Ms(10)))"#,
        9.81 * s,
        -9.81 * c
    );
    run(&text)[0].velocity.x
}

#[test]
fn a_gentle_incline_is_rolled_down() {
    let expected = 5.0 / 7.0 * 9.81 * 15.0_f64.to_radians().sin() * 0.5;
    let found = speed_after_half_a_second(15.0, 0.5);
    assert!((found / expected - 1.0).abs() < 2e-3, "{found} for {expected}");
}

#[test]
fn a_steep_incline_is_slid_down() {
    let angle = 50.0_f64.to_radians();
    let expected = 9.81 * (angle.sin() - 0.2 * angle.cos()) * 0.5;
    let found = speed_after_half_a_second(50.0, 0.2);
    assert!((found / expected - 1.0).abs() < 2e-3, "{found} for {expected}");
}
