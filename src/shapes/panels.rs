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
    /// Panels from a closed surface wound counter-clockwise seen from outside, with areas, normals and centroids.
    pub fn new(vertices: Vec<Vector3<f64>>, triangles: Vec<[u32; 3]>, regions: Vec<Region>) -> Self {
        let corners = || triangles.iter().map(|t| t.map(|v| vertices[v as usize]));
        let crosses: Vec<Vector3<f64>> = corners().map(|[a, b, c]| (b - a).cross(&(c - a))).collect();
        Self {
            areas: crosses.iter().map(|n| n.norm() / 2.0).collect(),
            normals: crosses.iter().map(Vector3::normalize).collect(),
            centroids: corners().map(|[a, b, c]| (a + b + c) / 3.0).collect(),
            regions,
            vertices,
            triangles,
        }
    }

    /// Number of panels.
    pub fn len(&self) -> usize {
        self.triangles.len()
    }

    /// Whether there is no panel.
    pub fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// Corners of each panel, m.
    pub fn corners(&self) -> impl Iterator<Item = [Vector3<f64>; 3]> {
        self.triangles.iter().map(|t| t.map(|v| self.vertices[v as usize]))
    }
}
