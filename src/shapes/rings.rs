//! Triangulation between closed rings of vertices.

use nalgebra::Vector3;

/// Vertices and triangles of a surface that is being built.
#[derive(Debug, Default)]
pub(super) struct Builder {
    /// Vertices, m.
    pub(super) vertices: Vec<Vector3<f64>>,
    /// Vertex indices of each triangle.
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Builder {
    /// Adds a ring of vertices and returns their indices.
    pub(super) fn ring(&mut self, points: impl IntoIterator<Item = Vector3<f64>>) -> Vec<u32> {
        let first = self.vertices.len() as u32;
        self.vertices.extend(points);
        (first..self.vertices.len() as u32).collect()
    }

    /// Fills the strip between two rings, each closed and running the same way round; `inner` may be one vertex.
    /// Seen so that the rings run counter-clockwise with `inner` inside, the triangles wind counter-clockwise.
    /// Each step takes the shorter of the two possible diagonals.
    pub(super) fn stitch(&mut self, outer: &[u32], inner: &[u32]) {
        let distance =
            |a: u32, b: u32| (self.vertices[a as usize] - self.vertices[b as usize]).norm_squared();
        let first = (0..inner.len())
            .min_by(|&a, &b| distance(outer[0], inner[a]).total_cmp(&distance(outer[0], inner[b])))
            .expect("a ring has vertices");
        let out = |i: usize| outer[i % outer.len()];
        let inn = |j: usize| inner[(first + j) % inner.len()];
        let inner_steps = if inner.len() > 1 { inner.len() } else { 0 };
        let mut strip = Vec::with_capacity(outer.len() + inner_steps);
        let (mut i, mut j) = (0, 0);
        while i < outer.len() || j < inner_steps {
            let step_out = j == inner_steps
                || (i < outer.len() && distance(out(i + 1), inn(j)) <= distance(out(i), inn(j + 1)));
            if step_out {
                strip.push([out(i), out(i + 1), inn(j)]);
                i += 1;
            } else {
                strip.push([out(i), inn(j + 1), inn(j)]);
                j += 1;
            }
        }
        self.triangles.extend(strip);
    }

    /// Reverses the winding of all triangles from number `first` on.
    pub(super) fn flip_from(&mut self, first: usize) {
        for t in &mut self.triangles[first..] {
            t.swap(1, 2);
        }
    }
}
