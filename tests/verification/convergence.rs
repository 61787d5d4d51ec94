//! V44: how the error of one Hertz contact falls with the step (root mean square over the phase of touch-down). Derived
//! with separate integrators: velocity Verlet, elastic, 3.1e-4, 3.0e-5, 5.2e-6 at 20, 50 and 100 steps per contact (order
//! 2.5); damped to e = 0.5 by velocities half a step late, dashpots weakened accordingly, 5.8e-3, 1.5e-3, 5.2e-4 (order 1.5: the
//! dashpot's d^(1/4) v is singular at touch-down). Tolerance: a factor of 1.5.

use super::support::{run, set};

fn error(e: f64, steps: f64) -> f64 {
    let phases = 24;
    let dt = 6.104_51 / steps;
    let squares = (0..phases).map(|k| {
        let above = 2.5 + 3.9e-3 * dt * f64::from(k) / f64::from(phases);
        let set = set![
            "pairs[0].restitution={e}",
            "bodies[0].position=Mm(0, {above}, 0)",
            "time.frame_interval=Us({dt})",
            "time.step=PerContact(8)",
            "time.duration=Us(14)",
        ];
        (run("restitution", &set)[0].velocity.y / 3.9 - e).powi(2)
    });
    (squares.sum::<f64>() / f64::from(phases)).sqrt()
}

#[test]
fn errors_fall_as_derived() {
    for (e, steps, expected) in [
        (1.0, 20.0, 3.1e-4),
        (1.0, 50.0, 3.0e-5),
        (1.0, 100.0, 5.2e-6),
        (0.5, 15.0, 4.9e-3),
        (0.5, 20.0, 5.8e-3),
        (0.5, 50.0, 1.5e-3),
        (0.5, 100.0, 5.2e-4),
    ] {
        let found = error(e, steps);
        assert!(
            (expected / 1.5..expected * 1.5).contains(&found),
            "e {e}, {steps} steps: {found:e} for {expected:e}"
        );
    }
}
