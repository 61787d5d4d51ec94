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
        for &[x, y, z, radius] in &outline.eights {
            let extent = dx * f32x8::new(x) + dy * f32x8::new(y) + dz * f32x8::new(z) + f32x8::new(radius);
            most = most.fast_max(extent);
            self.each.push(extent);
        }
        self.most = most.to_array().into_iter().fold(f32::NEG_INFINITY, f32::max);
    }

    /// Fills `spheres` with those that come within `depth`, m, of the farthest, in order.
    #[inline(always)]
    pub(super) fn foremost(&self, depth: f32, spheres: &mut Vec<u16>) {
        let from = f32x8::splat(self.most - depth);
        spheres.clear();
        for (k, extents) in self.each.chunks(8).enumerate() {
            let ahead =
                extents.iter().enumerate().map(|(k, e)| u64::from(e.simd_gt(from).to_bitmask()) << (8 * k));
            let mut ahead = ahead.fold(0, |all, some| all | some);
            while ahead != 0 {
                spheres.push(64 * k as u16 + ahead.trailing_zeros() as u16);
                ahead &= ahead - 1;
            }
        }
    }

    /// The lever about the point `about` with which the way of a body tells that all spheres keep their gaps, m.
    ///
    /// A sphere at the distance d from the point goes no farther than u + θd when the point goes u and the body turns by θ.
    /// As long as u + θL is within the allowance s, with L ≥ s d/g, that is no more than its gap g ≥ s. Spheres within
    /// `depth` of the foremost count with g = s, the others have what they stay behind in addition.
    #[inline(always)]
    pub(super) fn lever(&self, outline: &Outline, about: &Vector3<f32>, depth: f32, allowance: f32) -> f32 {
        let [px, py, pz] = [about.x, about.y, about.z].map(f32x8::splat);
        let (from, allowance) = (f32x8::splat(self.most - depth), f32x8::splat(allowance));
        let mut most = f32x8::ZERO;
        for (extent, &[x, y, z, _]) in self.each.iter().zip(&outline.eights) {
            let (dx, dy, dz) = (f32x8::new(x) - px, f32x8::new(y) - py, f32x8::new(z) - pz);
            let gap = allowance + (from - *extent).fast_max(f32x8::ZERO);
            most = most.fast_max((dx * dx + dy * dy + dz * dz) / (gap * gap));
        }
        let most = most.to_array().into_iter().fold(0.0, f32::max);
        1.0001 * most.sqrt() * allowance.to_array()[0]
    }
}
