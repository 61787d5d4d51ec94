//! V24, V25, V26: inclines. A homogeneous sphere rolls at 5/7 g sin θ while tan θ ≤ 7/2 μ, else slides at g(sin θ − μ cos θ)
//! with angular acceleration 5μ g cos θ/2r. A flat block stays while tan θ ≤ μ, else slides; thrown, it stops after
//! v²/2μg. Elementary mechanics. Tolerance 1e-4 (sphere), creep below 1e-6 m/s after 5 s, 0.5 % (Project Chrono's for the
//! block's way).

use super::support::{near, run, set, watch};

fn gravity(g: f64, degrees: f64) -> String {
    let (s, c) = degrees.to_radians().sin_cos();
    format!("gravity=MPerS2({}, {}, 0)", g * s, -g * c)
}

#[test]
fn a_gentle_incline_is_rolled_down() {
    let speed = run("incline", &[])[0].velocity.x;
    near(speed, 5.0 / 7.0 * 9.8 * 15.0_f64.to_radians().sin(), 1e-4, "speed");
    near(speed, 1.811_73, 1e-4, "as MercuryDPM has it");
}

#[test]
fn a_steep_incline_is_slid_down() {
    // The static overlap at 50 degrees is lower; the first oscillation is damped out.
    let set = [gravity(9.8, 50.0), "pairs[0].friction=0.2".into(), "pairs[0].restitution=0.3".into()];
    let end = run("incline", &set)[0];
    let (s, c) = 50.0_f64.to_radians().sin_cos();
    near(end.velocity.x, 9.8 * (s - 0.2 * c), 1e-3, "speed");
    near(-end.spin.z, 5.0 * 0.2 * 9.8 * c / (2.0 * 5e-3), 1e-3, "spin");
}

#[test]
fn a_block_stays_below_the_angle_of_friction() {
    let history = watch("block_stays", &[]);
    let at = |time: f64| history.iter().find(|(t, _)| *t >= time).expect("lasts so long").1[0];
    let end = history.last().expect("has an end").1[0];
    assert!(end.velocity.norm() < 1e-6 && end.spin.norm() < 1e-4, "{end:?}");
    assert!((end.position - at(2.5).position).norm() < 1e-7, "it creeps");
    assert!(end.position.x < 1e-4, "held by its springs");
}

#[test]
fn a_block_slides_above_the_angle_of_friction() {
    let history = watch("block_stays", &[gravity(9.81, 27.0), "time.duration=S(3)".into()]);
    let speed = |time: f64| history.iter().find(|(t, _)| *t >= time - 1e-9).expect("lasts").1[0].velocity.x;
    let (s, c) = 27.0_f64.to_radians().sin_cos();
    near((speed(3.0) - speed(1.0)) / 2.0, 9.81 * (s - 0.5 * c), 5e-3, "acceleration");
}

#[test]
fn a_thrown_block_stops() {
    let end = run("block_slides", &set!["time.duration=S(1.2)"])[0];
    near(end.position.x, 2.548_420, 5e-3, "way");
    assert!(end.velocity.norm() < 1e-3);
}
