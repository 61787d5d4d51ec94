//! V06 and the drop of V09: a ball bounces. Instant bounces reach the heights h e^(2n), the last is over at
//! √(2h/g)(1 + e)/(1 − e); a contact lasts 0.2 % of the first fall, and gravity in it, the more the slower the ball,
//! takes another 0.16, 0.52 and 1.36 % of the heights (separate integrator, 6400 steps per contact). Tolerance for these
//! 0.5 %, 100 steps per contact; for the end 1 %. At e = 1 it keeps its height: 1e-4 after 16 bounces, no trend (MFiX reports
//! +0.094 % with Adams-Bashforth).

use super::support::{near, scene, set, watch};
use pancoat::stepping::BodyState;

/// Heights of the lowest point at the summits, m.
fn summits(set: &[String]) -> Vec<f64> {
    let heights: Vec<f64> = watch("bouncing_ball", set).iter().map(|(_, b)| b[0].position.y - 5e-3).collect();
    let tops = heights.windows(3).filter(|h| h[1] > h[0] && h[1] >= h[2]);
    tops.map(|h| h[1] + (h[0] - h[2]).powi(2) / (8.0 * (2.0 * h[1] - h[0] - h[2]))).collect()
}

#[test]
fn heights_fall_by_the_square_of_e() {
    for (expected, height) in [24.960e-3, 6.2173e-3, 1.5412e-3].into_iter().zip(summits(&[])) {
        near(height, expected, 5e-3, "height");
    }
}

#[test]
fn bounces_end_in_time() {
    let history = watch("bouncing_ball", &[]);
    let last = history.iter().rev().find(|(_, b)| b[0].position.y > 5e-3 + 1e-6).expect("bounced").0;
    near(last, (0.2_f64 / 9.81).sqrt() * 3.0, 1e-2, "end");
}

#[test]
fn elastic_bounces_keep_their_height() {
    let set = set!["pairs[0].restitution=1", "time.duration=S(4.8)"];
    let tops = summits(&set);
    assert!(tops.len() >= 16, "{}", tops.len());
    for height in tops {
        near(height, 0.1, 1e-4, "height");
    }
}

/// Set-up of MFiX DEM03 with Hertz contacts, 800 steps in a contact at 10 m/s (velocity Verlet lets the energy waver within a
/// contact by the square of the step, so that 100 steps cannot do): kinetic plus 8/15 E* √R* δ^(5/2) of the three contacts stays to 1e-6.
#[test]
fn two_compressed_spheres_keep_their_energy() {
    let masses = scene("two_compressed", &[]).bodies.iter().map(|b| b.mass).collect::<Vec<_>>();
    let modulus = 1e8 / 0.7;
    let elastic =
        |radius: f64, overlap: f64| 8.0 / 15.0 * modulus * radius.sqrt() * overlap.max(0.0).powf(2.5);
    let energy = |bodies: &[BodyState]| {
        let [a, b] = [bodies[0].position.y, bodies[1].position.y];
        let kinetic: f64 = bodies.iter().zip(&masses).map(|(s, m)| 0.5 * m * s.velocity.norm_squared()).sum();
        kinetic + elastic(5e-4, 5e-4 - a) + elastic(2.5e-4, 1e-3 - (b - a)) + elastic(5e-4, b - 1.3e-3)
    };
    let history = watch("two_compressed", &[]);
    for (time, bodies) in &history {
        near(energy(bodies), energy(&history[0].1), 1e-6, &format!("energy at {time} s"));
    }
    assert!(history.iter().any(|(_, b)| b[0].velocity.norm() > 1.0), "they swing");
}
