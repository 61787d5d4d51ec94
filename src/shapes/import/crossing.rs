//! Finds triangles of a surface that cross each other.

use crate::shapes::tree::TriangleTree;
use nalgebra::Vector3;

/// Share of an edge or triangle at its border where a crossing does not count: facets that only touch do not cross.
const MARGIN: f64 = 1e-6;

/// The first pair of triangles, in their order, of which an edge of one passes through the other. Neighbours that are
/// folded flat onto each other have no such edge and are not found.
pub(super) fn first_crossing(vertices: &[Vector3<f64>], triangles: &[[u32; 3]]) -> Option<(usize, usize)> {
    let corners = |t: usize| triangles[t].map(|v| vertices[v as usize]);
    let tree = TriangleTree::new((0..triangles.len()).map(corners).collect());
    (0..triangles.len()).find_map(|t| {
        let pierces = |edges_of: usize, other: usize| {
            let [a, b, c] = triangles[edges_of];
            [(a, b), (b, c), (c, a)].into_iter().any(|(u, v)| {
                // An edge that starts on the other triangle touches it there.
                let touches = triangles[other].contains(&u) || triangles[other].contains(&v);
                !touches && passes_through(vertices[u as usize], vertices[v as usize], &corners(other))
            })
        };
        let mut later: Vec<usize> = tree.near(t).into_iter().filter(|&other| other > t).collect();
        later.sort_unstable();
        later.into_iter().find(|&other| pierces(t, other) || pierces(other, t)).map(|other| (t, other))
    })
}

/// Whether the segment from `p` to `q` passes through the inside of a triangle (Möller and Trumbore 1997, J. Graphics
/// Tools 2(1), 21).
fn passes_through(p: Vector3<f64>, q: Vector3<f64>, [a, b, c]: &[Vector3<f64>; 3]) -> bool {
    let (along, ab, ac) = (q - p, b - a, c - a);
    let normal = along.cross(&ac);
    let volume = ab.dot(&normal);
    if volume == 0.0 {
        return false;
    }
    let from_a = p - a;
    let u = from_a.dot(&normal) / volume;
    let across = from_a.cross(&ab);
    let v = along.dot(&across) / volume;
    let t = ac.dot(&across) / volume;
    u > MARGIN && v > MARGIN && u + v < 1.0 - MARGIN && t > MARGIN && t < 1.0 - MARGIN
}
