//! Poses laid out for vector instructions: four numbers where three would do.

use crate::world::Motion;
use nalgebra::Vector3;

/// Three coordinates and a place left over.
pub(super) type Four = [f64; 4];

/// Where a body is.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(32))]
pub(super) struct Frame {
    /// The body's axes in the world.
    axes: [Four; 3],
    /// Centre of mass, m.
    position: Four,
}

impl Frame {
    #[inline]
    pub(super) fn new(motion: &Motion) -> Self {
        let four = |v: &[f64]| [v[0], v[1], v[2], 0.0];
        let [x, y, z] = [0, 1, 2].map(|k| four(&motion.rotation.as_slice()[3 * k..3 * k + 3]));
        Self { axes: [x, y, z], position: four(motion.position.as_slice()) }
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
    pub(super) fn to(&self, other: &Self) -> Four {
        let (from, to) = (&self.position, &other.position);
        [to[0] - from[0], to[1] - from[1], to[2] - from[2], to[3] - from[3]]
    }
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
