//! V27, V28, V41: single bodies in a turning drum. A sphere without rolling friction rests at the bottom and spins at Ω R/r
//! (nothing damps its swinging about there, so it is started so); a
//! body that cannot roll sticks all the way round iff Fr = Ω² r_cm/g ≥ √(1 + 1/μ²) (the friction angle at its worst place).
//! Tolerance 0.5 % of the spin, 1 mm of the place; thresholds bracketed by 5 %. Deviation known: the drum is a polygon of
//! 3000 and 1000 facets.

use super::support::{near, run, scene, set, watch};

#[test]
fn a_sphere_stays_at_the_bottom() {
    let end = run("sphere_in_drum", &[])[0];
    near(end.spin.z, 20.0 / 60.0 * std::f64::consts::TAU * 0.1 / 5e-3, 5e-3, "spin");
    assert!(end.position.x.abs() < 1e-3, "{}", end.position.x);
}

#[test]
fn negative_and_no_rotation_mirror_and_rest() {
    let place = |rpm: f64| {
        run(
            "sphere_in_drum",
            &set!["drum.speed=Rpm({rpm})", "bodies[0].spin=RadPerS(0, 0, 0)", "time.duration=Ms(100)"],
        )[0]
    };
    let (forth, back) = (place(20.0), place(-20.0));
    assert!((forth.position.x + back.position.x).abs() < 1e-9 && (forth.spin.z + back.spin.z).abs() < 1e-6);
    assert!(forth.position.x > 1e-4, "carried to the right");
    assert!(place(0.0).spin.norm() < 1e-3, "{}", place(0.0).spin);
}

/// Farthest that the sled gets along the wall after its landing, as an angle, rad.
fn slips(froude: f64) -> f64 {
    let radius = scene("sled_in_drum", &[]).bodies[0].position.norm();
    let speed = (froude * 9.81 / radius).sqrt();
    let tangential = speed * radius;
    let set = set![
        "drum.speed=RadPerS({speed})",
        "bodies[0].spin=RadPerS(0, 0, {speed})",
        "bodies[0].velocity=MPerS({tangential}, 0, 0)",
    ];
    let angle = |(time, bodies): &(f64, Vec<pancoat::stepping::BodyState>)| {
        let p = bodies[0].position;
        let behind = p.x.atan2(-p.y) - speed * time;
        behind.sin().atan2(behind.cos())
    };
    // Landing on its springs takes the first fifth of a second.
    let history = watch("sled_in_drum", &set);
    let late: Vec<f64> = history.iter().filter(|(t, _)| *t > 0.2).map(angle).collect();
    late.iter().map(|a| (a - late[0]).abs()).fold(0.0, f64::max)
}

#[test]
fn a_sled_sticks_above_the_critical_froude_number() {
    assert!(slips(2.26) < 1e-4, "{}", slips(2.26));
    assert!(slips(2.05) > 2e-3, "{}", slips(2.05));
}
