//! Which facets of a surface are near a place.

use super::to_f32;
use nalgebra::Vector3;
use rapier3d::parry::bounding_volume::Aabb;
use rapier3d::parry::shape::TriMesh;
use std::sync::Arc;

/// The facets of a surface in the tree of its Rapier shape.
#[derive(Clone)]
pub struct FacetTree(pub(super) Arc<TriMesh>);

impl FacetTree {
    /// Adds the facets whose boxes meet the box from `min` to `max` (surface axes, m) to `facets`, in no particular order.
    pub fn near(&self, min: &Vector3<f64>, max: &Vector3<f64>, facets: &mut Vec<u32>) {
        facets.extend(self.0.bvh().intersect_aabb(&Aabb::new(to_f32(min), to_f32(max))));
    }
}
