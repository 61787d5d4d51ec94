//! Cuts a closed surface into about equal, about equilateral triangles without moving its sharp edges.
//!
//! Rounds of four steps: split edges that are too long, collapse those that are too short, flip edges where that widens
//! the smallest angle, and slide every vertex towards the middle of its triangles, along the given surface. Source:
//! Botsch and Kobbelt 2004, "A remeshing approach to multiresolution modeling", SGP, section 4; flips follow the
//! smallest angle instead of the valence, because that is what a panel is judged by.

mod connectivity;
mod edit;
mod guide;
mod relax;

use super::mesh::patches;
use edit::Size;
use guide::Guide;
use nalgebra::Vector3;

/// A closed surface whose triangles belong to smooth patches; where two patches meet is a sharp edge to keep.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Patchwork {
    /// Vertices, m.
    pub(super) vertices: Vec<Vector3<f64>>,
    /// Vertex indices of each triangle, counter-clockwise seen from outside.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Patch of each triangle.
    pub(super) patches: Vec<u32>,
}

/// Rounds of all four steps. The mesh hardly changes after ten.
const ROUNDS: usize = 10;

/// Rounds at the end that even out the areas (first half) and bring the number of triangles to the one asked for.
const POLISH: usize = 12;

/// Flips and slides in each of them.
const SLIDES: usize = 3;

/// An edge whose two triangles are larger or smaller than the mean by this factor is split or collapsed. With 1.5 the
/// largest area is below three times the smallest on all shapes tried, with 1.35 angles suffer.
const UNEVEN: f64 = 1.5;

/// Angle between triangles above which the edge between them is kept, rad (25 degrees): above the steps of a usual export
/// of a round band, below the angle between a band and its caps.
const SHARP: f64 = 0.436;

impl Patchwork {
    /// Cuts a closed surface into patches along its sharp edges, and wherever two neighbours are not `alike`.
    pub(super) fn new(
        vertices: Vec<Vector3<f64>>,
        triangles: Vec<[u32; 3]>,
        alike: impl Fn(usize, usize) -> bool,
    ) -> Self {
        let mut mesh = Self { vertices, triangles, patches: Vec::new() };
        let normals: Vec<Vector3<f64>> =
            (0..mesh.triangles.len()).map(|t| normal(&mesh.corners(t))).collect();
        mesh.patches = patches(&mesh.triangles, |s, t| alike(s, t) && normals[s].angle(&normals[t]) < SHARP);
        mesh
    }

    fn corners(&self, t: usize) -> [Vector3<f64>; 3] {
        self.triangles[t].map(|v| self.vertices[v as usize])
    }

    /// Area of all triangles, m².
    pub(super) fn area(&self) -> f64 {
        (0..self.triangles.len()).map(|t| normal(&self.corners(t)).norm() / 2.0).sum()
    }

    /// The same surface cut into about `count` triangles (within 1 %, more where sharp edges leave no choice).
    pub(super) fn remesh(&self, count: usize) -> Self {
        let guide = Guide::new(self);
        let mut mesh = self.clone();
        let area = self.area() / count as f64;
        let edge = (4.0 * area / 3f64.sqrt()).sqrt();
        let (short, long) = (edge * 4.0 / 5.0, edge * 4.0 / 3.0);
        for _ in 0..ROUNDS {
            mesh.split_larger(Size::Length, long, usize::MAX, &guide);
            mesh.collapse_smaller(Size::Length, short, long, usize::MAX, &guide);
            mesh.flip();
            mesh.relax(&guide);
        }
        // Lengths alone leave the areas uneven and the number off. Each split or collapse changes the number by two.
        for round in 0..POLISH {
            if round < POLISH / 2 {
                mesh.split_larger(Size::Area, area * UNEVEN, usize::MAX, &guide);
                mesh.collapse_smaller(Size::Area, area / UNEVEN, 2.0 * edge, usize::MAX, &guide);
            }
            let (lack, excess) =
                (count.saturating_sub(mesh.triangles.len()), mesh.triangles.len().saturating_sub(count));
            mesh.split_larger(Size::Area, 0.0, lack / 2, &guide);
            mesh.collapse_smaller(Size::Area, f64::INFINITY, 2.0 * edge, excess / 2, &guide);
            for _ in 0..SLIDES {
                mesh.flip();
                mesh.relax(&guide);
            }
        }
        mesh
    }
}

/// Normal of a triangle, twice its area long.
fn normal([a, b, c]: &[Vector3<f64>; 3]) -> Vector3<f64> {
    (b - a).cross(&(c - a))
}

/// Smallest angle of a triangle, rad.
fn smallest_angle([a, b, c]: &[Vector3<f64>; 3]) -> f64 {
    let angle = |p: &Vector3<f64>, q: &Vector3<f64>, r: &Vector3<f64>| (q - p).angle(&(r - p));
    angle(a, b, c).min(angle(b, c, a)).min(angle(c, a, b))
}

#[cfg(test)]
mod tests;
