//! Triangle surfaces of drums and boundaries.

use nalgebra::Vector3;
use std::collections::BTreeMap;

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
    /// Corners of a triangle, m.
    pub fn corners(&self, triangle: usize) -> [Vector3<f64>; 3] {
        self.triangles[triangle].map(|v| self.vertices[v as usize])
    }

    /// Unit normal of a triangle, pointing to the side the tablets are on.
    pub fn normal(&self, triangle: usize) -> Vector3<f64> {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(&(c - a)).normalize()
    }

    /// Number of the smooth patch each triangle belongs to, counted from 0 in the order of the first triangle. Two
    /// triangles of the same part that share an edge are in one patch when their normals differ by less than
    /// `max_angle` (rad). A sphere feels one contact per patch.
    pub fn patches(&self, max_angle: f64) -> Vec<u32> {
        let smooth = |s: usize, t: usize| {
            self.parts[s] == self.parts[t] && self.normal(s).dot(&self.normal(t)) > max_angle.cos()
        };
        patches(&self.triangles, smooth)
    }
}

/// Numbers sets of triangles that hang together across edges which have two triangles and are smooth between them.
pub(super) fn patches(triangles: &[[u32; 3]], smooth: impl Fn(usize, usize) -> bool) -> Vec<u32> {
    let mut edges: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
    for (t, [a, b, c]) in triangles.iter().enumerate() {
        for (u, v) in [(a, b), (b, c), (c, a)] {
            edges.entry((*u.min(v), *u.max(v))).or_default().push(t);
        }
    }
    let mut root: Vec<usize> = (0..triangles.len()).collect();
    for sharers in edges.values() {
        if let [s, t] = sharers[..]
            && smooth(s, t)
        {
            let (s, t) = (find(&mut root, s), find(&mut root, t));
            root[s.max(t)] = s.min(t);
        }
    }
    let mut numbers = BTreeMap::new();
    (0..root.len())
        .map(|t| {
            let next = numbers.len() as u32;
            *numbers.entry(find(&mut root, t)).or_insert(next)
        })
        .collect()
}

/// The smallest member of the set `t` is in; shortens the way there.
fn find(root: &mut [usize], mut t: usize) -> usize {
    while root[t] != t {
        root[t] = root[root[t]];
        t = root[t];
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two squares meeting at a right angle along x, in one part.
    fn angle_iron() -> SurfaceMesh {
        let vertices = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [1., 0., 1.], [0., 0., 1.]];
        SurfaceMesh {
            vertices: vertices.map(Vector3::from).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3], [0, 4, 1], [0, 5, 4]],
            parts: vec![Part::Wall; 4],
        }
    }

    #[test]
    fn patches_split_at_sharp_edges_only() {
        let mesh = angle_iron();
        assert_eq!(mesh.patches(89f64.to_radians()), [0, 0, 1, 1]);
        assert_eq!(mesh.patches(91f64.to_radians()), [0, 0, 0, 0]);
    }

    #[test]
    fn patches_split_at_parts() {
        let mut mesh = angle_iron();
        mesh.parts[1] = Part::Baffle(0);
        assert_eq!(mesh.patches(1.0), [0, 1, 2, 2]);
    }
}
