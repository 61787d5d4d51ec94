//! How far each sphere of a body reaches along a direction.

use super::body::Outline;
use nalgebra::Vector3;
use wide::f32x8;

/// The reach of every sphere from the centre of mass along a direction, m.
#[derive(Debug, Clone, Default)]
pub(super) struct Extents {
    each: Vec<f32x8>,
    /// The farthest, m.
    pub most: f32,
}

impl Extents {
    /// Measures along the unit vector `direction`, body axes.
    #[inline(always)]
    pub(super) fn measure(&mut self, outline: &Outline, direction: &Vector3<f32>) {
        let [dx, dy, dz] = [direction.x, direction.y, direction.z].map(f32x8::splat);
        let mut most = f32x8::splat(f32::NEG_INFINITY);
        self.each.clear();
        self.each.extend(outline.eights.iter().map(|&[x, y, z, radius]| {
            let extent = dx * f32x8::new(x) + dy * f32x8::new(y) + dz * f32x8::new(z) + f32x8::new(radius);
            most = most.fast_max(extent);
            extent
        }));
        self.most = most.to_array().into_iter().fold(f32::NEG_INFINITY, f32::max);
    }

    /// Fills `spheres` with those that come within `depth`, m, of the farthest, in order.
    #[inline(always)]
    pub(super) fn foremost(&self, depth: f32, spheres: &mut Vec<u16>) {
        spheres.resize(8 * self.each.len(), 0);
        let (from, mut count) = (self.most - depth, 0);
        for (k, each) in self.each.iter().enumerate() {
            for (lane, extent) in each.to_array().into_iter().enumerate() {
                spheres[count] = (8 * k + lane) as u16;
                count += usize::from(extent > from);
            }
        }
        spheres.truncate(count);
    }
}
