//! Surfaces that bodies touch: triangle meshes cut into smooth patches, and unbounded planes.

use crate::shapes::{PATCH_ANGLE, SurfaceMesh};
use nalgebra::Vector3;

/// One triangle, in the surface's own axes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Facet {
    corners: [Vector3<f64>; 3],
    normal: Vector3<f64>,
    /// Of each edge k → k+1: vector in the facet's plane at right angles to it, away from the facet; and what a point of
    /// the edge gives with it.
    edges: [(Vector3<f64>, f64); 3],
    /// Ball about the facet: centre, m, and radius, m.
    ball: (Vector3<f64>, f64),
    patch: u32,
    /// Patches that meet each edge k → k+1 and each corner, this facet's own left out.
    edge_patches: [Vec<u32>; 3],
    corner_patches: [Vec<u32>; 3],
}

/// The place of a surface that is nearest to a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Nearest<'a> {
    /// Distance, m.
    pub distance: f64,
    /// Unit vector from the point to the surface.
    pub normal: Vector3<f64>,
    /// Other patches that share this place when it lies on a border.
    pub shared: &'a [u32],
}

/// Shape of a surface.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Surface {
    Mesh(Vec<Facet>),
    /// Point and unit normal towards the bodies.
    Plane(Vector3<f64>, Vector3<f64>),
}

impl Surface {
    pub(super) fn mesh(mesh: &SurfaceMesh) -> Self {
        let patches = mesh.patches(PATCH_ANGLE);
        let mut at_vertex = vec![Vec::new(); mesh.vertices.len()];
        for (triangle, patch) in mesh.triangles.iter().zip(&patches) {
            for &v in triangle {
                at_vertex[v as usize].push(*patch);
            }
        }
        for list in &mut at_vertex {
            list.sort_unstable();
            list.dedup();
        }
        let facets = mesh.triangles.iter().zip(&patches).map(|(t, &patch)| {
            let others = |v: u32| -> Vec<u32> {
                at_vertex[v as usize].iter().copied().filter(|p| *p != patch).collect()
            };
            let corner_patches = [others(t[0]), others(t[1]), others(t[2])];
            let edge = |k: usize| -> Vec<u32> {
                let next = &corner_patches[(k + 1) % 3];
                corner_patches[k].iter().copied().filter(|p| next.contains(p)).collect()
            };
            let corners = t.map(|v| mesh.vertices[v as usize]);
            let center = (corners[0] + corners[1] + corners[2]) / 3.0;
            let radius = corners.iter().map(|c| (c - center).norm()).fold(0.0, f64::max);
            let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).normalize();
            Facet {
                ball: (center, radius),
                normal,
                edges: [0, 1, 2].map(|k: usize| {
                    let away = (corners[(k + 1) % 3] - corners[k]).cross(&normal);
                    (away, away.dot(&corners[k]))
                }),
                corners,
                patch,
                edge_patches: [edge(0), edge(1), edge(2)],
                corner_patches,
            }
        });
        Self::Mesh(facets.collect())
    }

    /// Smooth patch that a facet belongs to: a sphere feels one contact per patch.
    #[inline]
    pub(super) fn patch(&self, facet: u32) -> u32 {
        match self {
            Self::Plane(..) => 0,
            Self::Mesh(all) => all[facet as usize].patch,
        }
    }

    /// Whether a facet is surely farther than `distance` from `p` (surface axes).
    #[inline]
    pub(super) fn beyond(&self, facet: u32, p: &Vector3<f64>, distance: f64) -> bool {
        match self {
            Self::Plane(point, normal) => (p - point).dot(normal) > distance,
            Self::Mesh(all) => all[facet as usize].beyond(p, distance),
        }
    }

    /// Nearest place to `p` (surface axes) among the listed facets; a plane ignores the list.
    #[inline]
    pub(super) fn nearest(&self, p: &Vector3<f64>, facets: &[u32]) -> Nearest<'_> {
        match self {
            Self::Plane(point, normal) => {
                Nearest { distance: (p - point).dot(normal), normal: -normal, shared: &[] }
            }
            Self::Mesh(all) => {
                let mut best: Option<(f64, Vector3<f64>, &[u32], u32)> = None;
                for &f in facets {
                    let (to, shared) = all[f as usize].closest(p);
                    let d2 = to.norm_squared();
                    if best.as_ref().is_none_or(|b| d2 < b.0) {
                        best = Some((d2, to, shared, f));
                    }
                }
                let Some((d2, to, shared, f)) = best else {
                    return Nearest { distance: f64::INFINITY, normal: Vector3::y(), shared: &[] };
                };
                let distance = d2.sqrt();
                let normal = if distance > 0.0 { to / distance } else { -all[f as usize].normal };
                Nearest { distance, normal, shared }
            }
        }
    }
}

impl Facet {
    /// Whether the facet is surely farther from `p` than `distance`.
    #[inline]
    pub(super) fn beyond(&self, p: &Vector3<f64>, distance: f64) -> bool {
        let from = p - self.ball.0;
        let reach = self.ball.1 + distance;
        self.normal.dot(&from).abs() > distance || from.norm_squared() > reach * reach
    }

    /// Vector from `p` to the closest point of the triangle, and the other patches there.
    ///
    /// Source: Ericson 2005, Real-Time Collision Detection, section 5.1.5; points above the inside of the facet, the most
    /// frequent ones, first.
    #[inline]
    fn closest(&self, p: &Vector3<f64>) -> (Vector3<f64>, &[u32]) {
        let [a, b, c] = &self.corners;
        if self.edges.iter().all(|(away, edge)| away.dot(p) < *edge) {
            return (self.normal * self.normal.dot(&(a - p)), &[]);
        }
        let (ab, ac, ap) = (b - a, c - a, p - a);
        let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
        if d1 <= 0.0 && d2 <= 0.0 {
            return (-ap, &self.corner_patches[0]);
        }
        let bp = p - b;
        let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
        if d3 >= 0.0 && d4 <= d3 {
            return (-bp, &self.corner_patches[1]);
        }
        let vc = d1 * d4 - d3 * d2;
        if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
            return (ab * (d1 / (d1 - d3)) - ap, &self.edge_patches[0]);
        }
        let cp = p - c;
        let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
        if d6 >= 0.0 && d5 <= d6 {
            return (-cp, &self.corner_patches[2]);
        }
        let vb = d5 * d2 - d1 * d6;
        if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
            return (ac * (d2 / (d2 - d6)) - ap, &self.edge_patches[2]);
        }
        let va = d3 * d6 - d5 * d4;
        if va <= 0.0 && d4 >= d3 && d5 >= d6 {
            let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
            return ((c - b) * w - bp, &self.edge_patches[1]);
        }
        // Inside: along the normal, exactly.
        (self.normal * -self.normal.dot(&ap), &[])
    }
}
