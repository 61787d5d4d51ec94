//! The given surface, to which the vertices of a new mesh are held.

use super::Patchwork;
use super::connectivity::{Connectivity, Role};
use crate::shapes::tree::TriangleTree;
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// Nearest points on the patches and sharp edges of a surface.
#[derive(Debug)]
pub(super) struct Guide {
    patches: BTreeMap<u32, TriangleTree>,
    rims: BTreeMap<[u32; 2], Vec<[Vector3<f64>; 2]>>,
}

impl Guide {
    pub(super) fn new(surface: &Patchwork) -> Self {
        let mut members: BTreeMap<u32, Vec<[Vector3<f64>; 3]>> = BTreeMap::new();
        for (t, &patch) in surface.patches.iter().enumerate() {
            members.entry(patch).or_default().push(surface.corners(t));
        }
        let mut rims: BTreeMap<[u32; 2], Vec<[Vector3<f64>; 2]>> = BTreeMap::new();
        for edge in &Connectivity::new(surface).edges {
            if let Some(pair) = edge.pair(surface) {
                rims.entry(pair).or_default().push(edge.ends.map(|v| surface.vertices[v as usize]));
            }
        }
        Self { patches: members.into_iter().map(|(p, t)| (p, TriangleTree::new(t))).collect(), rims }
    }

    /// The point nearest to `p` where a vertex of that role may be; `p` itself for a corner.
    pub(super) fn hold(&self, role: Role, p: Vector3<f64>) -> Vector3<f64> {
        match role {
            Role::Inner(patch) => self.patches[&patch].nearest(&p).point,
            Role::Rim(pair) => self.rims[&pair]
                .iter()
                .map(|segment| closest_point(segment, &p))
                .min_by(|a, b| (a - p).norm_squared().total_cmp(&(b - p).norm_squared()))
                .unwrap_or(p),
            Role::Corner => p,
        }
    }
}

/// The point of a line segment nearest to `p`.
fn closest_point([a, b]: &[Vector3<f64>; 2], p: &Vector3<f64>) -> Vector3<f64> {
    let along = b - a;
    a + along * ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0)
}
