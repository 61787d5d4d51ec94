//! What contact knows of each body beside its motion.

use crate::shapes::{Clump, Sphere};
use crate::world::Relative;
use nalgebra::Vector3;

/// A clump prepared for list building.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Outline {
    pub spheres: Vec<Sphere>,
    /// Largest distance of a sphere's far side from the centre of mass, m.
    pub bounding_radius: f64,
    /// Largest distance of a sphere's centre from the centre of mass, m.
    pub reach: f64,
    /// Box about the spheres, body axes, m.
    pub min: Vector3<f64>,
    /// Its other corner, m.
    pub max: Vector3<f64>,
}

impl Outline {
    pub(super) fn new(clump: &Clump) -> Self {
        let corner = |sign: f64| {
            clump.spheres.iter().map(|s| s.center + Vector3::repeat(sign * s.radius)).collect::<Vec<_>>()
        };
        let min = corner(-1.0).into_iter().reduce(|a, b| a.inf(&b)).unwrap_or_default();
        let max = corner(1.0).into_iter().reduce(|a, b| a.sup(&b)).unwrap_or_default();
        Self {
            bounding_radius: clump.bounding_radius(),
            reach: clump.reach(),
            spheres: clump.spheres.clone(),
            min,
            max,
        }
    }

    /// At most the gap between this body and another one seen from it, m: what its bounding spheres leave, or the best
    /// of six separating planes along the axes of the two bodies' boxes.
    pub(super) fn apart(&self, other: &Self, at: &Relative) -> f64 {
        let half = |o: &Self| (o.max - o.min) * 0.5;
        let middle = |o: &Self| (o.max + o.min) * 0.5;
        let between = at.position + at.rotation * middle(other) - middle(self);
        let turned = at.rotation.abs();
        let mine = between.abs() - half(self) - turned * half(other);
        let theirs = at.rotation.tr_mul(&between).abs() - half(other) - turned.tr_mul(&half(self));
        let balls = at.position.norm() - self.bounding_radius - other.bounding_radius;
        balls.max(mine.max()).max(theirs.max())
    }

    /// Whether a sphere of the given centre (body axes) and radius comes closer than `margin` to the box.
    #[inline]
    pub(super) fn near(&self, center: &Vector3<f64>, margin: f64) -> bool {
        (0..3).all(|k| center[k] > self.min[k] - margin && center[k] < self.max[k] + margin)
    }
}

/// Constants of one body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BodyConstants {
    /// Index of its outline.
    pub shape: usize,
    /// Index of its material.
    pub material: usize,
    /// 1/kg.
    pub inverse_mass: f64,
    /// Inverse principal moments, 1/(kg m²).
    pub inverse_inertia: Vector3<f64>,
    /// 1/m + R²/I with the bounding radius R and the smallest moment I, 1/kg.
    pub softness: f64,
}
