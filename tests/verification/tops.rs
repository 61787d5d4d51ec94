//! V30, V31: torque-free tops (Landau & Lifshitz, Mechanics, section 37; Jacobi elliptic functions). Angular momentum in
//! space to 1e-12, energy 1e-6, times of turning over 1e-4 at |ω| dt = 0.01; the spin at t = 50 s to 5e-5 at a quarter of that
//! step, the error falling by 8 when the step is halved (third order).

use super::support::{kinetic, near, run, set, watch};
use nalgebra::{Quaternion, Vector3};

#[test]
fn asymmetric_top_turns_over() {
    let history = watch("free_top", &[]);
    let inertia = Vector3::new(1e-6, 2e-6, 3e-6);
    let momentum = |s: &pancoat::stepping::BodyState| {
        s.orientation * (s.orientation.inverse() * s.spin).component_mul(&inertia)
    };
    let first = history[0].1[0];
    for (_, bodies) in &history {
        let s = &bodies[0];
        assert!((momentum(s) - momentum(&first)).norm() < 1e-12 * momentum(&first).norm(), "momentum");
        near(kinetic(s, 1.0, &inertia), kinetic(&first, 1.0, &inertia), 1e-6, "energy");
    }
    let middle = |s: &pancoat::stepping::BodyState| (s.orientation.inverse() * s.spin).y;
    let zeros: Vec<f64> = history
        .windows(2)
        .filter(|w| middle(&w[0].1[0]) * middle(&w[1].1[0]) <= 0.0)
        .map(|w| {
            let (a, b) = (middle(&w[0].1[0]), middle(&w[1].1[0]));
            w[0].0 + (w[1].0 - w[0].0) * a / (a - b)
        })
        .collect();
    near(zeros[0], 10.377_304_88, 1e-4, "first turn");
    near(zeros[1], 31.131_914_65, 1e-4, "second turn");
    let after = |dt: f64| {
        let end =
            run("free_top", &set!["time=(step: Fixed(Ms({dt})), duration: S(50), frame_interval: S(1))"])[0];
        let spin = end.orientation.inverse() * end.spin;
        (end, (spin - Vector3::new(0.604_575_658_8, 0.796_610_49, -0.349_004_167_7)).norm())
    };
    let ((_, coarse), (_, middle), (end, fine)) = (after(10.0), after(5.0), after(2.5));
    assert!(fine < 5e-5 && middle < coarse / 6.0 && fine < middle / 6.0, "{coarse} {middle} {fine}");
    let q = Quaternion::new(-0.362_407_609_4, 0.044_225_379_3, 0.875_981_421_4, -0.315_216_417_3);
    assert!((end.orientation.coords.dot(&q.coords)).abs() > 1.0 - 1e-6, "{}", end.orientation);
}

#[test]
fn a_top_of_a_tablets_size() {
    let set = [
        "shapes.top.recipe=Clump(file: \"unit_ball.txt\", inertia_per_mass: Mm2(10, 30, 36))",
        "bodies[0].mass=G(1)",
        "bodies[0].spin=RadPerS(0.5, 20, 0.2)",
        "time=(step: Fixed(Us(500)), duration: S(2), frame_interval: Ms(1))",
    ]
    .map(String::from);
    let end = run("free_top", &set)[0];
    let spin = end.orientation.inverse() * end.spin;
    assert!((spin - Vector3::new(3.403_007_668_6, 19.586_571_376_3, -3.245_176_077)).norm() < 2e-2, "{spin}");
}

#[test]
fn symmetric_top_precesses() {
    let history = watch("symmetric_top", &[]);
    let momentum = Vector3::new(20.0 * 3.0, 0.0, 35.0 * 30.0).normalize();
    let axis = |k: usize| history[k].1[0].orientation * Vector3::z();
    let mut angle = 0.0;
    for k in 1..history.len() {
        near(axis(k).dot(&momentum), 3.270_49_f64.to_radians().cos(), 1e-8, "cone");
        let flat = |k: usize| axis(k) - momentum * axis(k).dot(&momentum);
        angle += flat(k - 1).cross(&flat(k)).dot(&momentum).atan2(flat(k - 1).dot(&flat(k)));
    }
    near(angle / history.last().expect("has an end").0, 52.585_64, 1e-5, "precession");
}
