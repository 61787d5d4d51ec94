//! Where the spheres of the bodies are: their centres as seen from the body's centre of mass, along world axes.
//!
//! In f32, which is enough to tell what cannot touch: what may touch is measured again in f64.

use super::body::Outline;
use crate::world::Motion;
use nalgebra::Vector3;
use wide::f32x8;

/// The sphere centres of one body, x, y and z by turns of [`Outline::padded`] numbers, m.
pub(super) type Arms = Vec<f32>;

/// Turns the spheres of a body to world axes.
#[inline(always)]
pub(super) fn turn(outline: &Outline, motion: &Motion, arms: &mut Arms) {
    let padded = outline.padded();
    arms.resize(3 * padded, 0.0);
    let [cx, cy, cz] = outline.centers();
    let r = motion.rotation.map(|x| x as f32);
    for (row, arms) in arms.chunks_exact_mut(padded).enumerate() {
        let (rx, ry, rz) = (r[(row, 0)], r[(row, 1)], r[(row, 2)]);
        for (k, arm) in arms.iter_mut().enumerate() {
            *arm = rx * cx[k] + ry * cy[k] + rz * cz[k];
        }
    }
}

/// One sphere's centre.
#[inline(always)]
pub(super) fn arm(arms: &Arms, sphere: usize) -> Vector3<f32> {
    let padded = arms.len() / 3;
    Vector3::new(arms[sphere], arms[padded + sphere], arms[2 * padded + sphere])
}

/// How far each sphere of a body reaches along a direction.
#[derive(Debug, Clone, Default)]
pub(super) struct Extents {
    each: Vec<f32>,
    /// The farthest, m.
    pub most: f32,
}

impl Extents {
    /// Fills in the reach of every sphere from the centre of mass along the unit vector `direction`.
    #[inline(always)]
    pub(super) fn along(&mut self, direction: &Vector3<f32>, outline: &Outline, arms: &Arms) {
        let padded = outline.padded();
        let (x, yz) = arms.split_at(padded);
        let (y, z) = yz.split_at(padded);
        let radii = outline.radii();
        self.each.resize(padded, 0.0);
        let mut most = [f32::NEG_INFINITY; 8];
        for (k, each) in self.each.as_chunks_mut::<8>().0.iter_mut().enumerate() {
            let eight = 8 * k..8 * k + 8;
            let (x, y, z, r) = (&x[eight.clone()], &y[eight.clone()], &z[eight.clone()], &radii[eight]);
            for lane in 0..8 {
                let extent = direction.x * x[lane] + direction.y * y[lane] + direction.z * z[lane] + r[lane];
                each[lane] = extent;
                most[lane] = if extent > most[lane] { extent } else { most[lane] };
            }
        }
        self.most = most.into_iter().fold(f32::NEG_INFINITY, f32::max);
    }

    /// Calls `f` with the spheres that reach farther than `from`, m, in order.
    #[inline(always)]
    pub(super) fn beyond(&self, from: f32, mut f: impl FnMut(usize)) {
        let from = f32x8::splat(from);
        for (k, eight) in self.each.as_chunks::<8>().0.iter().enumerate() {
            let mut lanes = f32x8::new(*eight).simd_gt(from).to_bitmask();
            while lanes != 0 {
                f(8 * k + lanes.trailing_zeros() as usize);
                lanes &= lanes - 1;
            }
        }
    }
}
