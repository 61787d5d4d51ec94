//! How far each sphere of a body reaches along a direction.

use super::body::Outline;
use nalgebra::Vector3;
use wide::f32x8;

/// The reach of every sphere from the centre of mass along a direction, m.
#[derive(Debug, Clone, Default)]
pub(super) struct Extents {
    each: Vec<[f32; 8]>,
    /// The farthest, m.
    pub most: f32,
}

impl Extents {
    /// Measures along the unit vector `direction`, body axes.
    #[inline(always)]
    pub(super) fn measure(&mut self, outline: &Outline, direction: &Vector3<f32>) {
        self.each.resize(outline.eights.len(), [0.0; 8]);
        let mut most = [f32::NEG_INFINITY; 8];
        for (each, [x, y, z, radius]) in self.each.iter_mut().zip(&outline.eights) {
            for k in 0..8 {
                each[k] = direction.x * x[k] + direction.y * y[k] + direction.z * z[k] + radius[k];
                most[k] = if each[k] > most[k] { each[k] } else { most[k] };
            }
        }
        self.most = most.into_iter().fold(f32::NEG_INFINITY, f32::max);
    }

    /// Fills `spheres` with those that come within `depth`, m, of the farthest, in order.
    #[inline(always)]
    pub(super) fn foremost(&self, depth: f32, spheres: &mut Vec<u16>) {
        spheres.clear();
        let from = f32x8::splat(self.most - depth);
        for (k, each) in self.each.iter().enumerate() {
            let mut lanes = f32x8::new(*each).simd_gt(from).to_bitmask();
            while lanes != 0 {
                spheres.push(8 * k as u16 + lanes.trailing_zeros() as u16);
                lanes &= lanes - 1;
            }
        }
    }
}
