//! Vertices shared between the triangles that meet in them.

use super::{Facets, Repair};
use crate::shapes::tree::Bounds;
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// Vertices nearer than this part of the largest extent are one: single precision files round to about 1e-7 of it.
const WELD: f64 = 1e-6;

/// Triangles with shared vertices.
#[derive(Debug, Clone)]
pub(super) struct Welded {
    /// Vertices, m.
    pub(super) vertices: Vec<Vector3<f64>>,
    /// Vertex indices of each triangle.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Number in the file of the facet each triangle comes from.
    pub(super) numbers: Vec<usize>,
    /// Numbers of facets that were dropped because two corners fell together.
    pub(super) dropped: Vec<usize>,
    /// Distance below which vertices were joined, m.
    pub(super) tolerance: f64,
    /// How many corners were moved to a vertex beside them, and the largest distance, m.
    moved: (usize, f64),
}

impl Welded {
    /// Welds finite facets and scales them to m.
    pub(super) fn new(facets: &Facets, scale: f64) -> Self {
        let tolerance = WELD * scale * Bounds::of(facets.corners.iter().flatten()).extents().max();
        let mut mesh = Self {
            vertices: Vec::new(),
            triangles: Vec::new(),
            numbers: Vec::new(),
            dropped: Vec::new(),
            tolerance,
            moved: (0, 0.0),
        };
        let mut cells: BTreeMap<[i64; 3], Vec<u32>> = BTreeMap::new();
        for (corners, &number) in facets.corners.iter().zip(&facets.numbers) {
            let triangle = corners.map(|p| mesh.vertex(&mut cells, p * scale));
            let [a, b, c] = triangle;
            if a == b || b == c || c == a {
                mesh.dropped.push(number);
            } else {
                mesh.triangles.push(triangle);
                mesh.numbers.push(number);
            }
        }
        mesh
    }

    /// What welding has put right.
    pub(super) fn repairs(&self) -> Vec<Repair> {
        let (count, most) = self.moved;
        let welded = (count > 0).then_some(Repair::Welded { count, most_um: 1e6 * most });
        let first = self.dropped.first();
        let dropped = first.map(|&first| Repair::Dropped { count: self.dropped.len(), first });
        welded.into_iter().chain(dropped).collect()
    }

    /// The vertex at `p`: a known one nearby, or a new one. Looked up in cells four tolerances wide, and in the next
    /// cell where `p` is within a tolerance of it.
    fn vertex(&mut self, cells: &mut BTreeMap<[i64; 3], Vec<u32>>, p: Vector3<f64>) -> u32 {
        let cell =
            |p: Vector3<f64>| -> [i64; 3] { (p / (4.0 * self.tolerance)).map(|x| x.floor() as i64).into() };
        let reach = Vector3::repeat(self.tolerance);
        let (low, home, high) = (cell(p - reach), cell(p), cell(p + reach));
        for x in low[0]..=high[0] {
            for y in low[1]..=high[1] {
                for z in low[2]..=high[2] {
                    let known = cells.get(&[x, y, z]).into_iter().flatten().copied();
                    let distance = |v: u32| (self.vertices[v as usize] - p).norm();
                    if let Some(v) = known.into_iter().find(|&v| distance(v) <= self.tolerance) {
                        let by = distance(v);
                        if by > 0.0 {
                            self.moved = (self.moved.0 + 1, self.moved.1.max(by));
                        }
                        return v;
                    }
                }
            }
        }
        let number = self.vertices.len() as u32;
        self.vertices.push(p);
        cells.entry(home).or_default().push(number);
        number
    }
}
