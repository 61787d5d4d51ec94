//! The triangular panels that carry the coating.

use nalgebra::Vector3;

/// Which part of a tablet a panel belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Region {
    /// On one of the two caps.
    Cap,
    /// On the band.
    Band,
}

/// A closed triangle mesh in body axes, the same for every tablet of a shape. Triangles wind counter-clockwise seen
/// from outside. All per-panel lists have `triangles.len()` entries.
#[derive(Debug, Clone, PartialEq)]
pub struct Panels {
    /// Vertices, m.
    pub vertices: Vec<Vector3<f64>>,
    /// Vertex indices of each panel.
    pub triangles: Vec<[u32; 3]>,
    /// Region of each panel.
    pub regions: Vec<Region>,
    /// Area of each panel, m².
    pub areas: Vec<f64>,
    /// Outward unit normal of each panel.
    pub normals: Vec<Vector3<f64>>,
    /// Centroid of each panel, m.
    pub centroids: Vec<Vector3<f64>>,
}

impl Panels {
    /// Number of panels.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Whether there is no panel.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }
}
