//! The profile of a cap over the gauge radius s: 0 at the axis, 1 at the band.

use super::quadrature::unit_rule;
use crate::scene::Cap;

/// A cap on an outline of a given mean radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CapProfile {
    /// The recipe.
    pub(super) cap: Cap,
    /// Mean radius of the outline, m: a spherical cap is spherical on a circle of this radius, and scaled with the
    /// outline elsewhere.
    pub(super) radius: f64,
}

/// A value of the gauge radius with the profile there.
#[derive(Debug, Clone, Copy)]
pub(super) struct CapNode {
    /// Gauge radius, dimensionless.
    pub(super) s: f64,
    /// Height above the band, m.
    pub(super) height: f64,
    /// Derivative of the height by s, m.
    pub(super) slope: f64,
    /// Weight of the node in an integral over s.
    pub(super) weight: f64,
}

impl CapProfile {
    /// Height above the band, m.
    pub(super) fn height(&self, s: f64) -> f64 {
        match self.cap {
            // A sphere of radius R = (a² + c²)/2c through the rim of radius a, c above it in the middle; written as
            // the difference of squares over the sum so that a nearly flat cap keeps its digits.
            Cap::Spherical { height } if height > 0.0 => {
                let (a, r) = (self.radius, self.sphere_radius(height));
                let rim = r - height;
                let at = (r * r - (a * s).powi(2)).max(0.0).sqrt();
                if rim + at > 0.0 { a * a * (1.0 - s * s) / (at + rim) } else { 0.0 }
            }
            Cap::Compound { height, exponent } => height * (1.0 - s.powf(exponent)),
            Cap::Spherical { .. } => 0.0,
        }
    }

    /// Derivative of the height by s, m.
    pub(super) fn slope(&self, s: f64) -> f64 {
        match self.cap {
            Cap::Spherical { height } if height > 0.0 => {
                let (a, r) = (self.radius, self.sphere_radius(height));
                -a * a * s / (r * r - (a * s).powi(2)).max(0.0).sqrt()
            }
            Cap::Compound { height, exponent } => -height * exponent * s.powf(exponent - 1.0),
            Cap::Spherical { .. } => 0.0,
        }
    }

    /// Radius of the sphere whose cap this is, m.
    fn sphere_radius(&self, height: f64) -> f64 {
        (self.radius.powi(2) + height * height) / (2.0 * height)
    }

    /// Nodes for integrals over s from 0 to 1. The substitution s = u² (3 − 2u) takes the endpoint singularities of
    /// fractional exponents (s = 0) and of half spheres (s = 1) out of the integrand.
    pub(super) fn nodes(&self) -> Vec<CapNode> {
        unit_rule(16)
            .into_iter()
            .map(|(u, weight)| {
                let s = u * u * (3.0 - 2.0 * u);
                let weight = weight * 6.0 * u * (1.0 - u);
                CapNode { s, height: self.height(s), slope: self.slope(s), weight }
            })
            .collect()
    }

    /// `count` + 1 values of s from 1 to 0, evenly spaced along the mean meridian.
    pub(super) fn divide(&self, count: usize) -> Vec<f64> {
        let length = self.meridian();
        (0..=count).map(|k| interpolate(&length, 1.0 - k as f64 / count as f64)).collect()
    }

    /// Length of the mean meridian from the axis to the band, m.
    pub(super) fn meridian_length(&self) -> f64 {
        self.meridian().last().map_or(0.0, |&(_, length)| length)
    }

    /// (s, length from the axis along the mean meridian), finely divided.
    fn meridian(&self) -> Vec<(f64, f64)> {
        const STEPS: usize = 4000;
        let at = |k: usize| k as f64 / STEPS as f64;
        let mut length = 0.0;
        std::iter::once((0.0, 0.0))
            .chain((1..=STEPS).map(|k| {
                length += (self.radius / STEPS as f64).hypot(self.height(at(k)) - self.height(at(k - 1)));
                (at(k), length)
            }))
            .collect()
    }
}

/// The s at a fraction of the whole length.
fn interpolate(table: &[(f64, f64)], fraction: f64) -> f64 {
    let wanted = fraction * table[table.len() - 1].1;
    let k = table.partition_point(|&(_, length)| length < wanted).clamp(1, table.len() - 1);
    let ((s0, l0), (s1, l1)) = (table[k - 1], table[k]);
    s0 + (s1 - s0) * (wanted - l0) / (l1 - l0)
}
