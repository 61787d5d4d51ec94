//! How deep a bed is and how far it presses its lowest tablets together: the static overlap that `check` tells.

use std::f64::consts::{PI, TAU};

/// Solid fraction of a bed of tablets at rest, dimensionless.
pub(super) const PACKING: f64 = 0.6;

/// Depth, m, of the middle of a bed that fills the share `fill` (0 to 1) of a lying cylinder of `diameter` m.
///
/// Derived here: the segment under a chord that subtends the angle φ holds (φ − sin φ)/2π of the circle and is
/// R(1 − cos φ/2) deep; φ is found by bisection.
pub(super) fn bed_depth(fill: f64, diameter: f64) -> f64 {
    let (mut low, mut high) = (0.0, TAU);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (middle - middle.sin()) / TAU < fill { low = middle } else { high = middle }
    }
    0.5 * diameter * (1.0 - (0.5 * low).cos())
}

/// Overlap, m, of two equal spheres of `radius` m and effective modulus `modulus` Pa under a column of `mass` kg.
///
/// Hertz: F = 4/3 E* √R* δ^(3/2) with R* = R/2 and F = mass × `gravity` m/s². Source: Johnson 1985, Contact Mechanics,
/// Eq 4.23.
pub(super) fn static_overlap(mass: f64, gravity: f64, radius: f64, modulus: f64) -> f64 {
    (0.75 * mass * gravity / (modulus * (0.5 * radius).sqrt())).powf(2.0 / 3.0)
}

/// Mass, kg, of a column of tablets of `mass` kg and `volume` m³ each, one tablet wide and `depth` m deep.
pub(super) fn column_mass(depth: f64, mass: f64, volume: f64) -> f64 {
    // One tablet wide: the cross-section of the sphere of its volume.
    let radius = (0.75 * volume / PI).cbrt();
    depth * PI * radius * radius * PACKING * mass / volume
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_a_drum_is_a_radius_deep() {
        assert!((bed_depth(0.5, 0.25) - 0.125).abs() < 1e-12);
        assert!(bed_depth(0.0, 0.25) < 1e-12);
        assert!((bed_depth(1.0, 0.25) - 0.25).abs() < 1e-9);
    }

    #[test]
    fn a_pressed_contact_carries_its_load() {
        let (radius, modulus) = (4e-3, 1.33e6);
        let overlap = static_overlap(0.01, 9.81, radius, modulus);
        let force = 4.0 / 3.0 * modulus * (0.5 * radius).sqrt() * overlap.powf(1.5);
        assert!((force - 0.0981).abs() < 1e-12);
    }
}
