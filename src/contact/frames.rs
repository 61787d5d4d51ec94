//! Poses laid out for vector instructions: four numbers where three would do.

use crate::world::Motion;
use nalgebra::{ArrayStorage, Matrix3, Vector3};

/// Three coordinates and a place left over.
pub(super) type Four = [f64; 4];

/// Where a body or a surface is and how it moves.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub(super) struct Frame {
    /// The body's axes in the world.
    axes: [Four; 3],
    /// Centre of mass, m.
    position: Four,
    /// m/s; the place left over holds 1/mass, 1/kg.
    pub velocity: Four,
    /// rad/s.
    pub spin: Four,
    pub mean_velocity: Four,
    pub mean_spin: Four,
}

impl Frame {
    #[inline]
    pub(super) fn new(motion: &Motion, inverse_mass: f64) -> Self {
        let four = |v: &Vector3<f64>| [v.x, v.y, v.z, 0.0];
        let Matrix3 { data: ArrayStorage([x, y, z]), .. } = motion.rotation;
        let [vx, vy, vz] = motion.velocity.data.0[0];
        Self {
            axes: [x, y, z].map(|[x, y, z]| [x, y, z, 0.0]),
            position: four(&motion.position),
            velocity: [vx, vy, vz, inverse_mass],
            spin: four(&motion.spin),
            mean_velocity: four(&motion.mean_velocity),
            mean_spin: four(&motion.mean_spin),
        }
    }

    /// 1/kg.
    #[inline(always)]
    pub(super) fn inverse_mass(&self) -> f64 {
        self.velocity[3]
    }

    /// Mean of the mean spins of this body and another, rad/s.
    #[inline(always)]
    pub(super) fn mean_spin_with(&self, other: &Self) -> Four {
        let (a, b) = (&self.mean_spin, &other.mean_spin);
        [0, 1, 2, 3].map(|k| (a[k] + b[k]) * 0.5)
    }

    /// A vector of the body in world axes.
    #[inline(always)]
    pub(super) fn turn(&self, v: &Vector3<f64>) -> Four {
        let [x, y, z] = &self.axes;
        let mut turned = [0.0; 4];
        for k in 0..4 {
            turned[k] = x[k] * v.x + y[k] * v.y + z[k] * v.z;
        }
        turned
    }

    /// From this body's centre of mass to another's, m.
    #[inline(always)]
    pub(super) fn offset(&self, other: &Self) -> Vector3<f64> {
        let [x, y, z, _] = self.to(other);
        Vector3::new(x, y, z)
    }

    /// The same, four numbers wide.
    #[inline(always)]
    pub(super) fn to(&self, other: &Self) -> Four {
        less(&other.position, &self.position)
    }
}

/// a − b.
#[inline(always)]
pub(super) fn less(a: &Four, b: &Four) -> Four {
    let mut difference = [0.0; 4];
    for k in 0..4 {
        difference[k] = a[k] - b[k];
    }
    difference
}

/// a + b − c.
#[inline(always)]
pub(super) fn add_less(a: &Four, b: &Four, c: &Four) -> Four {
    let mut sum = [0.0; 4];
    for k in 0..4 {
        sum[k] = a[k] + b[k] - c[k];
    }
    sum
}
