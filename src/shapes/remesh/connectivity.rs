//! Who is next to whom in a closed mesh.

use super::Patchwork;

/// An edge and the two triangles it is between.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edge {
    /// Its vertices, the smaller number first.
    pub(super) ends: [u32; 2],
    /// Its triangles; the first has the ends in this order.
    pub(super) sides: [usize; 2],
}

/// What a vertex is to the patches around it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// Inside a patch.
    Inner(u32),
    /// On a sharp edge between two patches.
    Rim([u32; 2]),
    /// Where sharp edges meet or end; never moves.
    Corner,
}

/// Edges, triangles around vertices, and roles of vertices.
#[derive(Debug)]
pub(super) struct Connectivity {
    /// All edges, sorted by their ends.
    pub(super) edges: Vec<Edge>,
    /// Role of each vertex.
    pub(super) roles: Vec<Role>,
    fans: Vec<u32>,
    starts: Vec<usize>,
}

impl Connectivity {
    pub(super) fn new(mesh: &Patchwork) -> Self {
        let edges = edges(&mesh.triangles);
        let mut starts = vec![0; mesh.vertices.len() + 1];
        for v in mesh.triangles.iter().flatten() {
            starts[*v as usize + 1] += 1;
        }
        for v in 1..starts.len() {
            starts[v] += starts[v - 1];
        }
        let mut fans = vec![0; 3 * mesh.triangles.len()];
        let mut next = starts.clone();
        for (t, triangle) in mesh.triangles.iter().enumerate() {
            for v in triangle.map(|v| v as usize) {
                fans[next[v]] = t as u32;
                next[v] += 1;
            }
        }
        let mut sharp: Vec<Vec<[u32; 2]>> = vec![Vec::new(); mesh.vertices.len()];
        for edge in &edges {
            if let Some(pair) = edge.pair(mesh) {
                edge.ends.iter().for_each(|&v| sharp[v as usize].push(pair));
            }
        }
        let roles = (0..mesh.vertices.len())
            .map(|v| match sharp[v][..] {
                [] => Role::Inner(fans.get(starts[v]).map_or(0, |&t| mesh.patches[t as usize])),
                [a, b] if a == b => Role::Rim(a),
                _ => Role::Corner,
            })
            .collect();
        Self { edges, roles, fans, starts }
    }

    /// Triangles around a vertex.
    pub(super) fn fan(&self, v: u32) -> &[u32] {
        &self.fans[self.starts[v as usize]..self.starts[v as usize + 1]]
    }

    /// Vertices next to a vertex, sorted.
    pub(super) fn ring(&self, mesh: &Patchwork, v: u32) -> Vec<u32> {
        let mut ring: Vec<u32> =
            self.fan(v).iter().flat_map(|&t| mesh.triangles[t as usize]).filter(|&w| w != v).collect();
        ring.sort_unstable();
        ring.dedup();
        ring
    }
}

impl Edge {
    /// The two patches it is between, in order; `None` inside a patch.
    pub(super) fn pair(&self, mesh: &Patchwork) -> Option<[u32; 2]> {
        let [a, b] = self.sides.map(|t| mesh.patches[t]);
        (a != b).then(|| [a.min(b), a.max(b)])
    }

    /// Its length, m.
    pub(super) fn length(&self, mesh: &Patchwork) -> f64 {
        let [a, b] = self.ends.map(|v| mesh.vertices[v as usize]);
        (b - a).norm()
    }

    /// The vertices opposite to it, one in each side.
    pub(super) fn opposites(&self, mesh: &Patchwork) -> [u32; 2] {
        self.sides.map(|t| {
            let [a, b, c] = mesh.triangles[t];
            // The three corners are the two ends and the one asked for.
            a ^ b ^ c ^ self.ends[0] ^ self.ends[1]
        })
    }
}

/// Edges of a closed, consistently wound mesh.
fn edges(triangles: &[[u32; 3]]) -> Vec<Edge> {
    let mut halves: Vec<([u32; 2], bool, usize)> = triangles
        .iter()
        .enumerate()
        .flat_map(|(t, &[a, b, c])| [(a, b), (b, c), (c, a)].map(|(u, v)| ([u.min(v), u.max(v)], u > v, t)))
        .collect();
    halves.sort_unstable();
    halves.chunks_exact(2).map(|pair| Edge { ends: pair[0].0, sides: [pair[0].2, pair[1].2] }).collect()
}
