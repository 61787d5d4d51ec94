//! Triangle surfaces of drums and boundaries.

use nalgebra::Vector3;

/// What a triangle of a drum belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// The cylindrical wall.
    Wall,
    /// An end wall: 0 at z = −width/2, 1 at z = +width/2.
    End(u8),
    /// The baffle of that number.
    Baffle(u8),
}

/// A triangle surface. Triangles wind counter-clockwise seen from the side the tablets are on.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceMesh {
    /// Vertices, m.
    pub vertices: Vec<Vector3<f64>>,
    /// Vertex indices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Part of each triangle.
    pub parts: Vec<Part>,
}

impl SurfaceMesh {
    /// tmp
    pub fn patches(&self, _a: f64) -> Vec<u32> { self.parts.iter().map(|p| match p { Part::Wall => 0, Part::End(k) => 1 + u32::from(*k), Part::Baffle(k) => 3 + u32::from(*k) }).collect() }
}
