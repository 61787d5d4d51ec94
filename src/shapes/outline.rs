//! The outline of a tablet seen along its axis.

use super::quadrature::unit_rule;
use nalgebra::Vector2;
use std::f64::consts::TAU;

/// A circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Outline {
    /// Radius, m.
    pub(super) radius: f64,
}

/// A point of an outline with its derivative by the parameter.
#[derive(Debug, Clone, Copy)]
pub(super) struct OutlineNode {
    /// The point, m.
    pub(super) point: Vector2<f64>,
    /// Its derivative by the parameter, m.
    pub(super) derivative: Vector2<f64>,
    /// Weight of the node in an integral over the parameter.
    pub(super) weight: f64,
}

impl Outline {
    /// A circle.
    pub(super) fn circle(diameter: f64) -> Self {
        Self { radius: diameter / 2.0 }
    }

    /// The point at parameter u, 0 to 1 once round counter-clockwise, m.
    fn point(self, u: f64) -> Vector2<f64> {
        let (sin, cos) = (TAU * u).sin_cos();
        Vector2::new(self.radius * cos, self.radius * sin)
    }

    /// The derivative of the point by u, m.
    fn derivative(self, u: f64) -> Vector2<f64> {
        let (sin, cos) = (TAU * u).sin_cos();
        Vector2::new(-sin, cos) * (TAU * self.radius)
    }

    /// Nodes for integrals once round.
    pub(super) fn nodes(self) -> Vec<OutlineNode> {
        unit_rule(24)
            .into_iter()
            .map(|(u, weight)| OutlineNode { point: self.point(u), derivative: self.derivative(u), weight })
            .collect()
    }

    /// Length once round, m.
    pub(super) fn perimeter(self) -> f64 {
        self.nodes().iter().map(|n| n.derivative.norm() * n.weight).sum()
    }

    /// `count` points evenly spaced along the outline, the first `phase` spacings behind parameter 0.
    pub(super) fn divide(self, count: usize, phase: f64) -> Vec<Vector2<f64>> {
        (0..count).map(|i| self.point((i as f64 + phase) / count as f64)).collect()
    }
}
