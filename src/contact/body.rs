//! What contact knows of each body beside its motion.

use crate::shapes::{Clump, Sphere};
use nalgebra::Vector3;

/// A clump prepared for list building.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Outline {
    pub spheres: Vec<Sphere>,
    /// Largest distance of a sphere's far side from the centre of mass, m.
    pub bounding_radius: f64,
    /// Largest distance of a sphere's centre from the centre of mass, m.
    pub reach: f64,
    /// Centres x, y, z and radii by turns, m. Places left over hold a sphere of radius −∞.
    turns: Vec<f32>,
}

/// Spheres are stored in multiples of this number.
const EIGHT: usize = 8;

impl Outline {
    pub(super) fn new(clump: &Clump) -> Self {
        let padded = clump.spheres.len().next_multiple_of(EIGHT);
        let lay = |of: fn(&Sphere) -> f64, rest: f32| {
            (0..padded).map(move |k| clump.spheres.get(k).map_or(rest, |sphere| of(sphere) as f32))
        };
        let centers =
            lay(|s| s.center.x, 0.0).chain(lay(|s| s.center.y, 0.0)).chain(lay(|s| s.center.z, 0.0));
        Self {
            bounding_radius: clump.bounding_radius(),
            reach: clump.reach(),
            turns: centers.chain(lay(|s| s.radius, f32::NEG_INFINITY)).collect(),
            spheres: clump.spheres.clone(),
        }
    }

    /// Number of spheres with the places left over.
    #[inline(always)]
    pub(super) fn padded(&self) -> usize {
        self.turns.len() / 4
    }

    /// Centres along x, y and z, body axes, m.
    #[inline(always)]
    pub(super) fn centers(&self) -> [&[f32]; 3] {
        let padded = self.padded();
        std::array::from_fn(|axis| &self.turns[axis * padded..(axis + 1) * padded])
    }

    /// Radii, m.
    #[inline(always)]
    pub(super) fn radii(&self) -> &[f32] {
        &self.turns[3 * self.padded()..]
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
