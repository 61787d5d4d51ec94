//! Beds that look like a bed without a simulation: the same on every machine.

use nalgebra::{UnitQuaternion, Vector3};
use pancoat::stepping::BodyState;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// 770 round tablets (15.9 mm, 6.6 mm thick) in layers below the plane y = 0 over 120 mm of slope (x) and 100 mm of
/// width (z), lying askew. Seen from above they cover and shade each other like those of a pan; they overlap a little.
pub(crate) fn paper_bed(seed: u64) -> Vec<BodyState> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut uniform = move |half: f64| random.random_range(-half..half);
    (0..770)
        .map(|k| {
            let (layer, place) = (k / 56, k % 56);
            let (row, column) = ((place / 7) as f64, (place % 7) as f64);
            let shift = if layer % 2 == 0 { 0.0 } else { 0.0075 };
            let position = Vector3::new(
                0.015 * (row - 3.5) + shift + uniform(0.004),
                -0.005 * (layer as f64 + 0.7) + uniform(0.002),
                0.0145 * (column - 3.0) + shift + uniform(0.004),
            );
            // The tablet's axis z leans up to a right angle from the vertical, mostly less.
            let lean = UnitQuaternion::from_axis_angle(
                &Vector3::x_axis(),
                -std::f64::consts::FRAC_PI_2 + uniform(0.6),
            ) * UnitQuaternion::from_axis_angle(&Vector3::y_axis(), uniform(1.2));
            BodyState { position, orientation: lean, velocity: Vector3::zeros(), spin: Vector3::zeros() }
        })
        .collect()
}
