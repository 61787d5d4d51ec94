//! What contact knows of each body beside its motion.

use super::sieve::Grains;
use crate::shapes::Clump;
use nalgebra::{Matrix3, Vector3};
use std::ops::AddAssign;

/// One sphere of a body, body axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ball {
    /// m.
    pub center: Vector3<f64>,
    /// m.
    pub radius: f64,
}

/// Centres x, y, z and radii of eight spheres, m: in f32, which is enough to tell what cannot touch.
pub(super) type Eight = [[f32; 8]; 4];

/// Error of a distance or gap measured in f32, as a share of the lengths it comes from.
pub(super) const ROUNDING: f64 = 1e-6;

/// A clump prepared for contact.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Outline {
    pub balls: Vec<Ball>,
    /// How many spheres the outlines before this one have.
    pub first: u32,
    /// Largest distance of a sphere's far side from the centre of mass, m.
    pub bounding_radius: f64,
    /// Largest distance of a sphere's centre from the centre of mass, m.
    pub reach: f64,
    /// See [`softness`], dimensionless.
    pub softness: f64,
    /// The spheres once more, for sieves.
    pub grains: Vec<Grains>,
    /// The spheres once more. Places left over hold a sphere of radius −∞.
    pub eights: Vec<Eight>,
}

impl Outline {
    /// `inertia`: principal moments over mass, m²; `grain` in m.
    pub(super) fn new(clump: &Clump, inertia: &Vector3<f64>, first: u32, grain: f64) -> Self {
        let ball = |s: &crate::shapes::Sphere| Ball { center: s.center, radius: s.radius };
        let balls: Vec<Ball> = clump.spheres.iter().map(ball).collect();
        let eights = balls.chunks(8).map(|balls| {
            let lay = |of: fn(&Ball) -> f64, rest: f32| {
                std::array::from_fn(|k| balls.get(k).map_or(rest, |ball| of(ball) as f32))
            };
            let radii = lay(|b| b.radius, f32::NEG_INFINITY);
            [lay(|b| b.center.x, 0.0), lay(|b| b.center.y, 0.0), lay(|b| b.center.z, 0.0), radii]
        });
        Self {
            bounding_radius: clump.bounding_radius(),
            reach: clump.reach(),
            softness: softness(clump, inertia),
            grains: balls.iter().map(|ball| Grains::of(ball, grain)).collect(),
            eights: eights.collect(),
            balls,
            first,
        }
    }
}

impl Outline {
    /// Centre and radius of a sphere.
    #[inline(always)]
    pub(super) fn sphere(&self, number: u16) -> [f32; 4] {
        let (at, k) = (usize::from(number) / 8, usize::from(number) % 8);
        let [x, y, z, radius] = &self.eights[at];
        [x[k], y[k], z[k], radius[k]]
    }

    /// Middle of some of the spheres, m.
    #[inline(always)]
    pub(super) fn middle(&self, spheres: &[u16]) -> Vector3<f32> {
        let centers = spheres.iter().map(|k| {
            let [x, y, z, _] = self.sphere(*k);
            Vector3::new(x, y, z)
        });
        centers.sum::<Vector3<f32>>() / spheres.len() as f32
    }
}

/// Bound of how much more a body answers a force at any place of its surface than one through its centre of mass, with its
/// principal moments over mass, m²: dimensionless.
///
/// At r from the centre of mass that is the largest eigenvalue of 1 + X I⁻¹ Xᵀ, or 1 + ‖I^-½ X‖², with X v = r × v. On a sphere
/// r = c + ρ n, and ‖I^-½ X‖ is no more than that of c and ρ/√I, I the smallest moment, together.
fn softness(clump: &Clump, inertia: &Vector3<f64>) -> f64 {
    let easiest = 1.0 / inertia.min().sqrt();
    let turned = clump.spheres.iter().map(|sphere| {
        let turn = Matrix3::from_diagonal(&inertia.map(|i| 1.0 / i.sqrt())) * sphere.center.cross_matrix();
        (turn * turn.transpose()).symmetric_eigenvalues().max().sqrt() + sphere.radius * easiest
    });
    let anywhere = clump.bounding_radius() * easiest;
    1.0 + turned.fold(0.0, f64::max).min(anywhere).powi(2)
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
    /// Bound of its response to a force at any place of its surface: see [`softness`], 1/kg.
    pub softness: f64,
}

/// What contacts sum up to.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Load {
    /// Normal dashpots before the bodies' other contacts weaken them, N s/m.
    pub damping: f64,
    /// Normal stiffnesses, N/m.
    pub stiffness: f64,
}

impl AddAssign for Load {
    fn add_assign(&mut self, other: Self) {
        self.damping += other.damping;
        self.stiffness += other.stiffness;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::Sphere;
    use approx::assert_relative_eq;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// No force at the surface of a rod of three spheres is answered more than its softness says, and that is no loose bound; a
    /// sphere's is the answer on its rim.
    #[test]
    fn softness_bounds_the_answer_to_any_force() {
        let rod = |centers: &[f64]| {
            let sphere = |z: &f64| Sphere { center: Vector3::z() * *z, radius: 1.0 };
            Clump { spheres: centers.iter().map(sphere).collect() }
        };
        assert_relative_eq!(softness(&rod(&[0.0]), &Vector3::repeat(0.4)), 3.5, max_relative = 1e-12);
        let inertia = Vector3::new(4.0, 4.0, 0.5);
        let bound = softness(&rod(&[-3.0, 0.0, 3.0]), &inertia);
        let random = &mut ChaCha8Rng::seed_from_u64(1);
        let mut unit = || Vector3::from_fn(|_, _| random.random_range(-1.0..1.0_f64)).normalize();
        let answers = (0..10_000).map(|k| {
            let place = Vector3::z() * f64::from(k % 3 * 3 - 3) + unit();
            let turn = place.cross(&unit());
            1.0 + turn.component_div(&inertia).dot(&turn)
        });
        let most = answers.fold(0.0, f64::max);
        assert!(most < bound && bound < 1.75 * most, "{most} of {bound}");
    }
}
