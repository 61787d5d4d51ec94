//! The pan as a triangle mesh: wall, end walls and baffles.

use super::rings::Builder;
use super::{Part, SurfaceMesh};
use crate::scene::{Baffles, Drum};
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Edge length that triangles aim at, m. Near pairs and sphere-triangle lists are short when triangles are about as
/// large as a tablet; a much larger value makes every list longer, a much smaller one makes more lists.
const TRIANGLE: f64 = 0.010;

/// How far the feet of baffles reach beyond the wall's vertices, m, so that no sphere finds a gap.
const FOOT: f64 = 0.5e-3;

/// Largest angle between neighbouring triangles of one smooth patch of a drum, rad (30 degrees): above the angle
/// between wall facets, below the corners of end walls and baffles.
pub const PATCH_ANGLE: f64 = std::f64::consts::FRAC_PI_6;

/// The inner surface of a pan in drum axes (axis z, from −width/2 to width/2), m. Facet vertices lie on the true
/// radius, so the faceted wall is inscribed. Triangles wind counter-clockwise seen from inside.
pub fn drum_mesh(drum: &Drum) -> SurfaceMesh {
    let mut build = Builder::default();
    let mut parts = Vec::new();
    let radius = drum.diameter / 2.0;
    let heights = divide(-drum.width / 2.0, drum.width / 2.0);

    let rims: Vec<Vec<u32>> = heights
        .iter()
        .map(|&z| build.ring(circle(radius, drum.facets).map(|p| p + Vector3::z() * z)))
        .collect();
    for pair in rims.windows(2) {
        for i in 0..drum.facets {
            let next = (i + 1) % drum.facets;
            let quad = [pair[0][i], pair[1][i], pair[1][next], pair[0][next]];
            build.triangles.extend([[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]);
        }
    }
    parts.resize(build.triangles.len(), Part::Wall);

    for (number, rim, z) in [(0, &rims[0], heights[0]), (1, &rims[rims.len() - 1], drum.width / 2.0)] {
        let first = build.triangles.len();
        end_wall(&mut build, rim, radius, z);
        if number == 1 {
            build.flip_from(first);
        }
        parts.resize(build.triangles.len(), Part::End(number));
    }
    if let Some(baffles) = &drum.baffles {
        for number in 0..baffles.count {
            baffle(&mut build, baffles, number, radius, &heights);
            parts.resize(build.triangles.len(), Part::Baffle(number as u8));
        }
    }
    SurfaceMesh { vertices: build.vertices, triangles: build.triangles, parts }
}

/// From `a` to `b` in equal steps no longer than a triangle, both ends included.
fn divide(a: f64, b: f64) -> Vec<f64> {
    let steps = ((b - a).abs() / TRIANGLE - 1e-9).ceil().max(1.0) as usize;
    (0..=steps).map(|i| a + (b - a) * i as f64 / steps as f64).collect()
}

/// `count` points on a circle about z.
fn circle(radius: f64, count: usize) -> impl Iterator<Item = Vector3<f64>> {
    (0..count).map(move |i| {
        let (sin, cos) = (TAU * i as f64 / count as f64).sin_cos();
        Vector3::new(radius * cos, radius * sin, 0.0)
    })
}

/// Rings from the rim to the centre, facing +z.
fn end_wall(build: &mut Builder, rim: &[u32], radius: f64, z: f64) {
    let radii = divide(radius, 0.0);
    let mut outer = rim.to_vec();
    for &r in &radii[1..radii.len() - 1] {
        let count = ((TAU * r / TRIANGLE).round() as usize).clamp(3, rim.len());
        let inner = build.ring(circle(r, count).map(|p| p + Vector3::z() * z));
        build.stitch(&outer, &inner);
        outer = inner;
    }
    let centre = build.ring([Vector3::z() * z]);
    build.stitch(&outer, &centre);
}

/// One baffle: two side faces and the top, as strips over the heights. It turns with z like a helix of the wall's
/// radius, so it stands on the wall all along.
fn baffle(build: &mut Builder, baffles: &Baffles, number: usize, radius: f64, heights: &[f64]) {
    let sign = if number.is_multiple_of(2) { 1.0 } else { -1.0 };
    let turn = sign * baffles.tilt.tan() / radius;
    let half = baffles.thickness / 2.0 / baffles.tilt.cos();
    let levels = divide(radius + FOOT, radius - baffles.height);
    let side = |offset: f64| levels.iter().map(move |&r| (r, offset));
    let top = divide(-half, half);
    let profile: Vec<(f64, f64)> = side(-half)
        .chain(top[1..top.len() - 1].iter().map(|&offset| (radius - baffles.height, offset)))
        .chain(side(half).rev())
        .collect();
    let columns: Vec<Vec<u32>> = heights
        .iter()
        .map(|&z| {
            let (sin, cos) = (TAU * number as f64 / baffles.count as f64 + turn * z).sin_cos();
            build.ring(profile.iter().map(|&(r, t)| Vector3::new(r * cos - t * sin, r * sin + t * cos, z)))
        })
        .collect();
    for pair in columns.windows(2) {
        for i in 0..profile.len() - 1 {
            let quad = [pair[0][i], pair[1][i], pair[1][i + 1], pair[0][i + 1]];
            build.triangles.extend([[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]);
        }
    }
}

/// The default pan: 250 mm inside, 100 mm wide, four baffles 12 mm high and 6 mm thick, tilted ±20 degrees in turn,
/// 90 facets. Declared, not published: no source gives the dimensions of the coater in use.
pub fn default_pan() -> Drum {
    Drum {
        diameter: 0.250,
        width: 0.100,
        speed: 22.0 * TAU / 60.0,
        material: 0,
        facets: 90,
        baffles: Some(Baffles { count: 4, height: 0.012, thickness: 0.006, tilt: 20f64.to_radians() }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use std::collections::BTreeMap;

    fn of_part(mesh: &SurfaceMesh, wanted: impl Fn(Part) -> bool) -> Vec<usize> {
        (0..mesh.triangles.len()).filter(|&t| wanted(mesh.parts[t])).collect()
    }

    fn corners(mesh: &SurfaceMesh, t: usize) -> [Vector3<f64>; 3] {
        mesh.triangles[t].map(|v| mesh.vertices[v as usize])
    }

    #[test]
    fn wall_and_ends_face_inwards_and_enclose_the_prism() {
        let drum = Drum { baffles: None, ..default_pan() };
        let mesh = drum_mesh(&drum);
        let volume: f64 = (0..mesh.triangles.len())
            .map(|t| {
                let [a, b, c] = corners(&mesh, t);
                a.dot(&b.cross(&c)) / 6.0
            })
            .sum();
        let (n, r) = (drum.facets as f64, drum.diameter / 2.0);
        let prism = 0.5 * n * r * r * (TAU / n).sin() * drum.width;
        assert_relative_eq!(volume, -prism, max_relative = 1e-12);
    }

    #[test]
    fn wall_with_ends_is_closed() {
        let mesh = drum_mesh(&Drum { baffles: None, ..default_pan() });
        let mut edges: BTreeMap<(u32, u32), i32> = BTreeMap::new();
        for [a, b, c] in &mesh.triangles {
            for (u, v) in [(a, b), (b, c), (c, a)] {
                *edges.entry((*u.min(v), *u.max(v))).or_default() += if u < v { 1 } else { -1 };
            }
        }
        assert!(edges.values().all(|&balance| balance == 0));
    }

    #[test]
    fn triangles_are_about_ten_millimetres_and_not_thin() {
        let mesh = drum_mesh(&default_pan());
        for t in 0..mesh.triangles.len() {
            let p = corners(&mesh, t);
            for k in 0..3 {
                let (u, v) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
                assert!(u.norm() < 1.6 * TRIANGLE, "edge {}", u.norm());
                assert!(
                    u.angle(&v) > 20f64.to_radians(),
                    "{:?} {:?}",
                    mesh.parts[t],
                    u.angle(&v).to_degrees()
                );
            }
        }
    }

    #[test]
    fn patches_are_wall_ends_and_three_faces_per_baffle() {
        let mesh = drum_mesh(&default_pan());
        let patches = mesh.patches(PATCH_ANGLE);
        assert_eq!(patches.iter().max(), Some(&(3 + 4 * 3 - 1)));
        for part in [Part::Wall, Part::End(0), Part::End(1)] {
            let members = of_part(&mesh, |p| p == part);
            assert!(members.iter().all(|&t| patches[t] == patches[members[0]]));
        }
    }

    #[test]
    fn baffles_stand_on_the_wall_and_face_the_tablets() {
        let drum = default_pan();
        let baffles = drum.baffles.expect("the default pan has baffles");
        let radius = drum.diameter / 2.0;
        let mesh = drum_mesh(&drum);
        let members = of_part(&mesh, |p| p == Part::Baffle(0));
        let radial = |p: &Vector3<f64>| p.xy().norm();
        let lowest = members.iter().flat_map(|&t| corners(&mesh, t)).map(|p| radial(&p)).fold(0.0, f64::max);
        assert!(lowest > radius && lowest < radius + 2.0 * FOOT);
        let half = baffles.thickness / 2.0 / baffles.tilt.cos();
        let nearest = members.iter().flat_map(|&t| corners(&mesh, t)).map(|p| radial(&p)).fold(1.0, f64::min);
        assert_relative_eq!(nearest, (radius - baffles.height).hypot(half), max_relative = 1e-12);
        // A ray from the middle of the plate leaves through every face: the normals point away from the plate's middle.
        for &t in &members {
            let p = corners(&mesh, t);
            let centroid = (p[0] + p[1] + p[2]) / 3.0;
            let angle = baffles.tilt.tan() / radius * centroid.z;
            let middle = Vector3::new(angle.cos(), angle.sin(), 0.0) * (radius - baffles.height / 2.0);
            assert!(mesh.normal(t).dot(&(centroid - Vector3::new(0., 0., centroid.z) - middle)) > 0.0);
        }
        // The plate runs at the tilt to the axis: measured along the wall over the full width.
        let angle = |z: f64| {
            let at: Vec<_> = members
                .iter()
                .flat_map(|&t| corners(&mesh, t))
                .filter(|p| (p.z - z).abs() < 1e-12)
                .map(|p| p.y.atan2(p.x))
                .collect();
            at.iter().sum::<f64>() / at.len() as f64
        };
        let run = radius * (angle(drum.width / 2.0) - angle(-drum.width / 2.0));
        assert_relative_eq!((run / drum.width).atan(), baffles.tilt, epsilon = 0.01);
    }
}
