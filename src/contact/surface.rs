//! Surfaces that bodies touch: triangle meshes cut into smooth patches, and unbounded planes.

use crate::shapes::{PATCH_ANGLE, SurfaceMesh};
use nalgebra::Vector3;

/// One triangle, in the surface's own axes.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Facet {
    corners: [Vector3<f64>; 3],
    normal: Vector3<f64>,
    planes: Planes,
    patch: u32,
    /// Patches that meet each edge k → k+1 and each corner, this facet's own left out.
    edge_patches: [Vec<u32>; 3],
    corner_patches: [Vec<u32>; 3],
}

/// Four planes about a facet: its own and, upright on it, one along each edge k → k+1, which faces away from it. Rows:
/// x, y and z of the planes' unit normals, and what a point of each plane gives with its normal, m.
pub(super) type Planes = [[f64; 4]; 4];

/// What two squares of distances may differ by in rounding: 1e-9 is far above it. Of facets as near as that, the nearest
/// places decide.
const SURELY: f64 = 1.0 + 1e-9;

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
            // Of a facet without area zero, with which nothing is told of any point.
            let unit = |v: Vector3<f64>| v.try_normalize(0.0).unwrap_or_default();
            let normal = unit((corners[1] - corners[0]).cross(&(corners[2] - corners[0])));
            let away = |k: usize| unit((corners[(k + 1) % 3] - corners[k]).cross(&normal));
            let sides = [(normal, 0), (away(0), 0), (away(1), 1), (away(2), 2)];
            Facet {
                normal,
                planes: [
                    sides.map(|(n, _)| n.x),
                    sides.map(|(n, _)| n.y),
                    sides.map(|(n, _)| n.z),
                    sides.map(|(n, k): (_, usize)| n.dot(&corners[k])),
                ],
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

    /// Planes that tell how far a facet is at least: √(h² + e²) with the height h over the first and the farthest way
    /// e ≥ 0 past the others. Of an unbounded plane no point is over the first, and all in front are past the others.
    #[inline(always)]
    pub(super) fn planes(&self, facet: u32) -> Planes {
        match self {
            Self::Plane(point, n) => {
                let from = n.dot(point);
                [[0.0, n.x, n.x, n.x], [0.0, n.y, n.y, n.y], [0.0, n.z, n.z, n.z], [0.0, from, from, from]]
            }
            Self::Mesh(all) => all[facet as usize].planes,
        }
    }

    /// Whether a facet is surely farther than `distance` from `p` (surface axes).
    #[inline(always)]
    pub(super) fn beyond(&self, facet: u32, p: &Vector3<f64>, distance: f64) -> bool {
        match self {
            Self::Plane(point, normal) => (p - point).dot(normal) > distance,
            Self::Mesh(all) => all[facet as usize].least(p) > distance * distance,
        }
    }

    /// Nearest place to `p` (surface axes) among the listed facets; a plane ignores the list.
    #[inline(always)]
    pub(super) fn nearest(&self, p: &Vector3<f64>, facets: &[u32]) -> Nearest<'_> {
        let all = match self {
            Self::Plane(point, normal) => {
                return Nearest { distance: (p - point).dot(normal), normal: -normal, shared: &[] };
            }
            Self::Mesh(all) => all,
        };
        // Points above the inside of a facet are the most frequent, and then no other facet is likely to be nearer.
        let (mut least, mut above, mut others) = (f64::INFINITY, None, f64::INFINITY);
        for &f in facets {
            let (height, past) = all[f as usize].over(p);
            if past < 0.0 && height * height < least {
                others = others.min(least);
                (least, above) = (height * height, Some((f, height)));
            } else {
                others = others.min(square(height, past));
            }
        }
        let mut best = None;
        if let Some((f, height)) = above {
            let normal = &all[f as usize].normal;
            if others >= SURELY * least {
                let normal = if height < 0.0 { *normal } else { -normal };
                return Nearest { distance: height.abs(), normal, shared: &[] };
            }
            best = Some((f, normal * -height, &[][..]));
        }
        for &f in facets {
            if above.is_none_or(|(above, _)| f != above) && all[f as usize].least(p) < SURELY * least {
                let (to, shared) = all[f as usize].closest(p);
                if to.norm_squared() < least {
                    (least, best) = (to.norm_squared(), Some((f, to, shared)));
                }
            }
        }
        let Some((f, to, shared)) = best else {
            return Nearest { distance: f64::INFINITY, normal: Vector3::y(), shared: &[] };
        };
        let distance = to.norm();
        let normal = if distance > 0.0 { to / distance } else { -all[f as usize].normal };
        Nearest { distance, normal, shared }
    }
}

/// Square of the least distance of a point so high above a facet's plane and so far past its edges, m².
#[inline(always)]
fn square(height: f64, past: f64) -> f64 {
    height * height + past.max(0.0).powi(2)
}

impl Facet {
    /// How far `p` is above the facet's plane, and how far at most past an edge, m: negative above its inside.
    #[inline(always)]
    fn over(&self, p: &Vector3<f64>) -> (f64, f64) {
        let [x, y, z, from] = &self.planes;
        let mut ahead = [0.0; 4];
        for k in 0..4 {
            ahead[k] = x[k] * p.x + y[k] * p.y + z[k] * p.z - from[k];
        }
        (ahead[0], ahead[1].max(ahead[2]).max(ahead[3]))
    }

    /// Square of the distance that `p` has at least, m².
    #[inline(always)]
    fn least(&self, p: &Vector3<f64>) -> f64 {
        let (height, past) = self.over(p);
        square(height, past)
    }

    /// Vector from `p` to the closest point of the triangle, and the other patches there.
    ///
    /// Source: Ericson 2005, Real-Time Collision Detection, section 5.1.5.
    fn closest(&self, p: &Vector3<f64>) -> (Vector3<f64>, &[u32]) {
        let [a, b, c] = &self.corners;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::Part;
    use approx::assert_relative_eq;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn the_nearest_place_is_that_of_the_nearest_facet() {
        let vertices = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.], [1., 0., 1.], [0., 0., 1.]];
        let mesh = SurfaceMesh {
            vertices: vertices.map(Vector3::from).to_vec(),
            // The last has no area.
            triangles: vec![[0, 1, 2], [0, 2, 3], [0, 4, 1], [0, 5, 4], [3, 2, 2]],
            parts: vec![Part::Wall; 5],
        };
        let surface = Surface::mesh(&mesh);
        let Surface::Mesh(facets) = &surface else { unreachable!() };
        let mut random = ChaCha8Rng::seed_from_u64(1);
        for _ in 0..10_000 {
            let p = Vector3::from_fn(|_, _| random.random_range(-1.0..2.0));
            let each: Vec<f64> = facets.iter().map(|f| f.closest(&p).0.norm()).collect();
            for (facet, distance) in facets.iter().zip(&each) {
                assert!(facet.least(&p).sqrt() <= distance * (1.0 + 1e-12));
            }
            let nearest = surface.nearest(&p, &[0, 1, 2, 3, 4]);
            let least = each.into_iter().fold(f64::INFINITY, f64::min);
            assert_relative_eq!(nearest.distance, least, max_relative = 1e-12);
        }
    }
}
