//! The profile of a cap over the gauge radius s: 0 at the axis, 1 at the band.

use super::quadrature::unit_rule;
use crate::scene::Cap;

/// A cap on an outline of a given mean radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CapProfile {
    /// The recipe.
    pub(super) cap: Cap,
    /// Mean radius of the outline, m.
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
    /// Height above the band and its derivative by s, m.
    fn at(&self, s: f64) -> (f64, f64) {
        let a = self.radius;
        match self.cap {
            Cap::Spherical { height: 0.0 } => (0.0, 0.0),
            // A sphere of radius R = (a² + c²)/2c through the rim of radius a, c above it in the middle. The height
            // is written as the difference of squares over the sum: a nearly flat cap keeps its digits.
            Cap::Spherical { height } => {
                let sphere = (a * a + height * height) / (2.0 * height);
                let root = (sphere * sphere - (a * s).powi(2)).max(0.0).sqrt();
                let sum = root + sphere - height;
                (if sum > 0.0 { a * a * (1.0 - s * s) / sum } else { 0.0 }, -a * a * s / root)
            }
            Cap::Compound { height, exponent } => {
                (height * (1.0 - s.powf(exponent)), -height * exponent * s.powf(exponent - 1.0))
            }
            Cap::Bevelled { height, width } => {
                let from_rim = (1.0 - s) * a / width;
                if from_rim < 1.0 { (height * from_rim, -height * a / width) } else { (height, 0.0) }
            }
        }
    }

    /// Height above the band, m.
    pub(super) fn height(&self, s: f64) -> f64 {
        self.at(s).0
    }

    /// Values of s between which the profile is smooth, from 0 to 1.
    fn pieces(&self) -> Vec<[f64; 2]> {
        match self.cap {
            Cap::Bevelled { width, .. } => {
                let edge = 1.0 - width / self.radius;
                vec![[0.0, edge], [edge, 1.0]]
            }
            Cap::Spherical { .. } | Cap::Compound { .. } => vec![[0.0, 1.0]],
        }
    }

    /// Nodes for integrals over s from 0 to 1. On each piece the substitution s = u² (3 − 2u) takes the endpoint
    /// singularities of fractional exponents (s = 0) and of half spheres (s = 1) out of the integrand.
    pub(super) fn nodes(&self) -> Vec<CapNode> {
        let node = |[from, to]: [f64; 2], (u, weight): (f64, f64)| {
            let s = from + (to - from) * u * u * (3.0 - 2.0 * u);
            let (height, slope) = self.at(s);
            CapNode { s, height, slope, weight: (to - from) * weight * 6.0 * u * (1.0 - u) }
        };
        self.pieces().iter().flat_map(|&p| unit_rule(16).into_iter().map(move |rule| node(p, rule))).collect()
    }

    /// Values of s from 1 to 0, on each smooth piece evenly spaced along the mean meridian by about `step` (m).
    pub(super) fn divide(&self, step: f64) -> Vec<f64> {
        let mut values = vec![1.0];
        for [from, to] in self.pieces().into_iter().rev() {
            let table = self.meridian(from, to);
            let length = table[table.len() - 1].1;
            let least = if from == 0.0 { 2 } else { 1 };
            let count = ((length / step).round() as usize).max(least);
            values.extend((1..count).map(|k| at_length(&table, length * (1.0 - k as f64 / count as f64))));
            values.push(from);
        }
        values
    }

    /// (s, length from the start) along the mean meridian, finely divided.
    fn meridian(&self, from: f64, to: f64) -> Vec<(f64, f64)> {
        const STEPS: usize = 4000;
        let mut table = vec![(from, 0.0)];
        let mut last = self.height(from);
        for k in 1..=STEPS {
            let s = from + (to - from) * k as f64 / STEPS as f64;
            let ((before, length), height) = (table[k - 1], self.height(s));
            table.push((s, length + (self.radius * (s - before)).hypot(height - last)));
            last = height;
        }
        table
    }
}

/// The s at a length from the start of a finely divided meridian.
fn at_length(table: &[(f64, f64)], length: f64) -> f64 {
    let k = table.partition_point(|&(_, l)| l < length).clamp(1, table.len() - 1);
    let ((s0, l0), (s1, l1)) = (table[k - 1], table[k]);
    s0 + (s1 - s0) * (length - l0) / (l1 - l0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn caps() -> [Cap; 3] {
        [
            Cap::Spherical { height: 1.0 },
            Cap::Compound { height: 1.0, exponent: 2.5 },
            Cap::Bevelled { height: 1.0, width: 0.5 },
        ]
    }

    #[test]
    fn heights_fall_from_the_middle_to_the_band_and_slopes_match() {
        for cap in caps() {
            let profile = CapProfile { cap, radius: 5.0 };
            assert_relative_eq!(profile.height(0.0), 1.0, epsilon = 1e-14);
            assert_relative_eq!(profile.height(1.0), 0.0, epsilon = 1e-14);
            for s in [0.3, 0.7, 0.95] {
                let slope = (profile.height(s + 1e-6) - profile.height(s - 1e-6)) / 2e-6;
                assert_relative_eq!(profile.at(s).1, slope, epsilon = 1e-8);
            }
        }
    }

    #[test]
    fn volumes_have_their_closed_forms() {
        // On a circle of radius a, 2 π a² ∫ s h ds: spherical π c (3a² + c²)/6, compound π a² c m/(m + 2), bevelled a cone
        // frustum of radii a and a − w.
        let expected = [76.0 / 6.0, 25.0 * 2.5 / 4.5, (25.0 + 5.0 * 4.5 + 4.5 * 4.5) / 3.0];
        for (cap, expected) in caps().into_iter().zip(expected) {
            let profile = CapProfile { cap, radius: 5.0 };
            let volume: f64 = profile.nodes().iter().map(|n| 50.0 * n.weight * n.s * n.height).sum();
            assert_relative_eq!(volume, expected, max_relative = 1e-10);
        }
    }

    #[test]
    fn a_bevel_keeps_its_inner_edge() {
        let profile = CapProfile { cap: Cap::Bevelled { height: 1.0, width: 0.5 }, radius: 5.0 };
        assert!(profile.divide(0.7).contains(&0.9));
    }
}
