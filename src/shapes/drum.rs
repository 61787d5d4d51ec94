//! The pan as a triangle mesh: wall, end walls and baffles.

use super::rings::Builder;
use super::{ImportedSurface, MeshFault, Part, Repair, ShapeError, SurfaceMesh, read_surface};
use crate::scene::{Baffles, Drum, Wall};
use nalgebra::{Vector2, Vector3};
use std::f64::consts::TAU;
use std::path::Path;

/// Edge length that triangles of wall and end walls aim at, m. Large ones leave few of them near a body, and the facets of the wall
/// long and thin: 100 mm were slower than 50 (docs/performance.md).
const TRIANGLE: f64 = 0.050;
/// The same of baffles, whose faces are twisted, m.
const TWISTED: f64 = 0.010;

/// How far the feet of baffles reach beyond the wall's vertices, m, so that no sphere finds a gap.
const FOOT: f64 = 0.5e-3;

/// How far the size of a mesh may be from the diameter and width that the scene gives, of these.
const SAME_SIZE: f64 = 0.02;

/// Largest angle between neighbouring triangles of one smooth patch of a drum, rad (30 degrees): above the angle
/// between wall facets, below the corners of end walls and baffles.
pub const PATCH_ANGLE: f64 = std::f64::consts::FRAC_PI_6;

/// The inner surface of a pan in drum axes (axis z, from −width/2 to width/2): its mesh, or what its recipe gives.
///
/// # Errors
/// Those of [`read_surface`], and [`MeshFault::NotTheDrum`] when a mesh has another size than the scene says.
pub fn drum_surface(drum: &Drum) -> Result<ImportedSurface, ShapeError> {
    match &drum.wall {
        Wall::Mesh { path, scale } => imported(drum, path, *scale),
        Wall::Cylinder | Wall::Profile(_) => {
            Ok(ImportedSurface { mesh: drum_mesh(drum), repairs: Vec::new() })
        }
    }
}

/// A mesh in the place of a recipe. It faces the axis, or is turned; facets that look along the axis are end walls.
fn imported(drum: &Drum, path: &Path, scale: f64) -> Result<ImportedSurface, ShapeError> {
    let ImportedSurface { mut mesh, mut repairs } = read_surface(path, scale)?;
    let radius = mesh.vertices.iter().map(|v| v.xy().norm()).fold(0.0, f64::max);
    let half = mesh.vertices.iter().map(|v| v.z.abs()).fold(0.0, f64::max);
    let near = |found: f64, wanted: f64| (found / wanted - 1.0).abs() < SAME_SIZE;
    if !near(2.0 * radius, drum.diameter) || !near(2.0 * half, drum.width) {
        let [across_mm, wide_mm] = [2e3 * radius, 2e3 * half];
        return Err(ShapeError::mesh(path, MeshFault::NotTheDrum { across_mm, wide_mm }));
    }
    let towards = |t: usize| {
        let [a, b, c] = mesh.corners(t);
        (b - a).cross(&(c - a)).dot(&-(a + b + c))
    };
    if (0..mesh.triangles.len()).map(towards).sum::<f64>() < 0.0 {
        mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        repairs.push(Repair::InsideOut);
    }
    for t in 0..mesh.triangles.len() {
        let along = mesh.normal(t).z;
        if along.abs() > PATCH_ANGLE.cos() {
            mesh.parts[t] = Part::End(u8::from(along < 0.0));
        }
    }
    Ok(ImportedSurface { mesh, repairs })
}

/// Room of a drum that nothing sweeps as it turns: a cylinder about z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClearRoom {
    /// Radius, m.
    pub radius: f64,
    /// Both ends along z, m.
    pub ends: [f64; 2],
}

impl ClearRoom {
    /// Of a recipe by its dimensions, of a mesh by its facets.
    pub fn of(drum: &Drum, surface: &SurfaceMesh) -> Self {
        let mut room = Self { radius: drum.diameter / 2.0, ends: [-0.5, 0.5].map(|end| end * drum.width) };
        if let Wall::Mesh { .. } = drum.wall {
            for (triangle, part) in surface.triangles.iter().zip(&surface.parts) {
                let corners = triangle.map(|v| surface.vertices[v as usize]);
                match part {
                    Part::End(0) => room.ends[0] = corners.iter().map(|p| p.z).fold(room.ends[0], f64::max),
                    Part::End(_) => room.ends[1] = corners.iter().map(|p| p.z).fold(room.ends[1], f64::min),
                    _ => {
                        let edges = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| [corners[i].xy(), corners[j].xy()]);
                        room.radius = edges.iter().map(to_axis).fold(room.radius, f64::min);
                    }
                }
            }
        } else {
            let narrowest = drum.profile().iter().map(|point| point[1]).fold(f64::INFINITY, f64::min);
            room.radius = narrowest - drum.baffles.map_or(0.0, |baffles| baffles.height);
        }
        room
    }
}

/// Distance of a segment, seen along the axis, from it, m.
fn to_axis([a, b]: &[Vector2<f64>; 2]) -> f64 {
    let along = b - a;
    let share =
        if along.norm() > 0.0 { (-a.dot(&along) / along.norm_squared()).clamp(0.0, 1.0) } else { 0.0 };
    (a + along * share).norm()
}

/// The inner surface of a recipe, m. Facet vertices lie on the true radius, so the faceted wall is inscribed. Triangles
/// wind counter-clockwise seen from inside.
pub fn drum_mesh(drum: &Drum) -> SurfaceMesh {
    let mut build = Builder::default();
    let mut parts = Vec::new();
    let stations = levels(&drum.profile(), TRIANGLE);
    let rims: Vec<Vec<u32>> = stations
        .iter()
        .map(|&[z, radius]| build.ring(circle(radius, drum.facets).map(|p| p + Vector3::z() * z)))
        .collect();
    for pair in rims.windows(2) {
        for i in 0..drum.facets {
            let next = (i + 1) % drum.facets;
            let quad = [pair[0][i], pair[1][i], pair[1][next], pair[0][next]];
            build.triangles.extend([[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]);
        }
    }
    parts.resize(build.triangles.len(), Part::Wall);

    let last = stations.len() - 1;
    for (number, rim, [z, radius]) in [(0, &rims[0], stations[0]), (1, &rims[last], stations[last])] {
        let first = build.triangles.len();
        end_wall(&mut build, rim, radius, z);
        if number == 1 {
            build.flip_from(first);
        }
        parts.resize(build.triangles.len(), Part::End(number));
    }
    if let Some(baffles) = &drum.baffles {
        let stations = levels(&drum.profile(), TWISTED);
        for number in 0..baffles.count {
            baffle(&mut build, baffles, number, drum.diameter / 2.0, &stations);
            parts.resize(build.triangles.len(), Part::Baffle(number as u8));
        }
    }
    SurfaceMesh { vertices: build.vertices, triangles: build.triangles, parts }
}

/// (z, radius) along a profile, in steps along its line no longer than `most`, m.
fn levels(profile: &[[f64; 2]], most: f64) -> Vec<[f64; 2]> {
    let mut levels = vec![profile[0]];
    for pair in profile.windows(2) {
        let ([z, r], [w, s]) = (pair[0], pair[1]);
        let shares = divide(0.0, (w - z).hypot(s - r), most);
        let length = shares[shares.len() - 1];
        levels.extend(shares[1..].iter().map(|at| at / length).map(|t| [z + (w - z) * t, r + (s - r) * t]));
    }
    levels
}

/// From `a` to `b` in equal steps no longer than `most`, both ends included.
fn divide(a: f64, b: f64, most: f64) -> Vec<f64> {
    let steps = ((b - a).abs() / most - 1e-9).ceil().max(1.0) as usize;
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
    let radii = divide(radius, 0.0, TRIANGLE);
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

/// One baffle: two side faces and the top, as strips over the levels of the wall, on which it stands all along. It turns
/// with z like a helix of `radius`, the largest of the wall.
fn baffle(build: &mut Builder, baffles: &Baffles, number: usize, radius: f64, levels: &[[f64; 2]]) {
    let sign = if number.is_multiple_of(2) { 1.0 } else { -1.0 };
    let turn = sign * baffles.tilt.tan() / radius;
    let half = baffles.thickness / 2.0 / baffles.tilt.cos();
    let steps = divide(FOOT, -baffles.height, TWISTED);
    let side = |offset: f64| steps.iter().map(move |&step| (step, offset));
    let top = divide(-half, half, TWISTED);
    let profile: Vec<(f64, f64)> = side(-half)
        .chain(top[1..top.len() - 1].iter().map(|&offset| (-baffles.height, offset)))
        .chain(side(half).rev())
        .collect();
    let columns: Vec<Vec<u32>> = levels
        .iter()
        .map(|&[z, wall]| {
            let (sin, cos) = (TAU * number as f64 / baffles.count as f64 + turn * z).sin_cos();
            let point = |&(step, t): &(f64, f64)| {
                let r = wall + step;
                Vector3::new(r * cos - t * sin, r * sin + t * cos, z)
            };
            build.ring(profile.iter().map(point))
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
        wall: Wall::Cylinder,
        axis_tilt: 0.0,
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

    /// Volume inside the facets, negative where they face inwards.
    fn volume(mesh: &SurfaceMesh) -> f64 {
        let part = |t| {
            let [a, b, c] = mesh.corners(t);
            a.dot(&b.cross(&c)) / 6.0
        };
        (0..mesh.triangles.len()).map(part).sum()
    }

    #[test]
    fn wall_and_ends_face_inwards_and_enclose_the_prism() {
        let drum = Drum { baffles: None, ..default_pan() };
        let mesh = drum_mesh(&drum);
        let volume = volume(&mesh);
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
    fn triangles_are_no_longer_than_asked_and_no_slivers() {
        let mesh = drum_mesh(&default_pan());
        for (t, part) in mesh.parts.iter().enumerate() {
            // A facet of the wall is 8.7 mm wide.
            let (most, sharpest) = if let Part::Baffle(_) = part { (TWISTED, 20.0) } else { (TRIANGLE, 8.0) };
            let p = mesh.corners(t);
            for k in 0..3 {
                let (u, v) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
                assert!(u.norm() < 1.6 * most, "{part:?}: edge {}", u.norm());
                let degrees = u.angle(&v).to_degrees();
                assert!(degrees > sharpest, "{part:?}: {degrees}");
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
        let lowest = members.iter().flat_map(|&t| mesh.corners(t)).map(|p| radial(&p)).fold(0.0, f64::max);
        assert!(lowest > radius && lowest < radius + 2.0 * FOOT);
        let half = baffles.thickness / 2.0 / baffles.tilt.cos();
        let nearest = members.iter().flat_map(|&t| mesh.corners(t)).map(|p| radial(&p)).fold(1.0, f64::min);
        assert_relative_eq!(nearest, (radius - baffles.height).hypot(half), max_relative = 1e-12);
        // A ray from the middle of the plate leaves through every face: the normals point away from the plate's middle.
        for &t in &members {
            let p = mesh.corners(t);
            let centroid = (p[0] + p[1] + p[2]) / 3.0;
            let angle = baffles.tilt.tan() / radius * centroid.z;
            let middle = Vector3::new(angle.cos(), angle.sin(), 0.0) * (radius - baffles.height / 2.0);
            assert!(mesh.normal(t).dot(&(centroid - Vector3::new(0., 0., centroid.z) - middle)) > 0.0);
        }
        // The plate runs at the tilt to the axis: measured along the wall over the full width.
        let angle = |z: f64| {
            let at: Vec<_> = members
                .iter()
                .flat_map(|&t| mesh.corners(t))
                .filter(|p| (p.z - z).abs() < 1e-12)
                .map(|p| p.y.atan2(p.x))
                .collect();
            at.iter().sum::<f64>() / at.len() as f64
        };
        let run = radius * (angle(drum.width / 2.0) - angle(-drum.width / 2.0));
        assert_relative_eq!((run / drum.width).atan(), baffles.tilt, epsilon = 0.01);
    }

    /// A barrel: both ends narrow to 200 mm over 20 mm.
    fn barrel() -> Drum {
        let points = [[-0.05, 0.2], [-0.03, 0.25], [0.03, 0.25], [0.05, 0.2]];
        Drum { wall: Wall::Profile(points.to_vec()), ..default_pan() }
    }

    /// Inscribed facets have the sine of their angle for it: the volume is n sin(2π/n)/2π of the true one.
    #[test]
    fn a_profile_encloses_its_cones() {
        let drum = Drum { baffles: None, ..barrel() };
        let mesh = drum_mesh(&drum);
        let volume = volume(&mesh);
        let n = drum.facets as f64;
        assert_relative_eq!(-volume, drum.volume() * n * (TAU / n).sin() / TAU, max_relative = 1e-12);
        assert_relative_eq!(drum.radius_at(0.0), 0.125);
        assert_relative_eq!(drum.radius_at(-0.04), 0.1125, max_relative = 1e-12);
        let steps = levels(&drum.profile(), TRIANGLE);
        assert!(steps.windows(2).all(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1]) < 1.001 * TRIANGLE));
    }

    #[test]
    fn baffles_follow_the_profile() {
        let (drum, mesh) = (barrel(), drum_mesh(&barrel()));
        for t in of_part(&mesh, |p| matches!(p, Part::Baffle(_))) {
            for p in mesh.corners(t) {
                let above = drum.radius_at(p.z) - p.xy().norm();
                assert!((-2.0 * FOOT..0.012 + 1e-9).contains(&above), "{above}");
            }
        }
        let room = ClearRoom::of(&drum, &mesh);
        assert_relative_eq!(room.radius, 0.088, max_relative = 1e-12);
        assert_eq!(room.ends, [-0.05, 0.05]);
    }

    fn stored(mesh: &SurfaceMesh) -> (tempfile::TempDir, std::path::PathBuf) {
        let folder = tempfile::tempdir().expect("a folder for the test");
        let path = folder.path().join("pan.stl");
        crate::shapes::write_stl(mesh, &path, 1e-3).expect("written");
        (folder, path)
    }

    #[test]
    fn a_mesh_serves_as_a_drum_and_is_turned_to_face_its_axis() {
        let mut mesh = drum_mesh(&default_pan());
        let (_kept, path) = stored(&mesh);
        mesh.triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
        let (_kept_too, turned) = stored(&mesh);
        for (path, inside_out) in [(path, false), (turned, true)] {
            let drum = Drum { wall: Wall::Mesh { path, scale: 1e-3 }, baffles: None, ..default_pan() };
            let surface = drum_surface(&drum).expect("fits");
            assert_eq!(surface.repairs.contains(&Repair::InsideOut), inside_out);
            let face = |part, z: f64| {
                let members = of_part(&surface.mesh, |p| p == part);
                members.len() > 100 && members.iter().all(|&t| surface.mesh.normal(t).z * z > 0.9)
            };
            assert!(face(Part::End(0), 1.0) && face(Part::End(1), -1.0));
            // Edges of the baffles' tops run straight between points a little farther out than their middle.
            let room = ClearRoom::of(&drum, &surface.mesh);
            assert!((room.radius - 0.113).abs() < 1e-4, "{}", room.radius);
            assert!(room.ends.iter().zip([-0.05, 0.05]).all(|(end, wanted)| (end - wanted).abs() < 1e-7));
        }
    }

    #[test]
    fn a_mesh_of_another_size_is_refused() {
        let (_kept, path) = stored(&drum_mesh(&default_pan()));
        let drum = |scale| Drum { wall: Wall::Mesh { path: path.clone(), scale }, ..default_pan() };
        for scale in [1e-2, 0.9e-3] {
            let fault = drum_surface(&drum(scale)).expect_err("has another size").to_string();
            assert!(fault.contains("mm across its axis z"), "{fault}");
        }
        let fault = drum_surface(&drum(1.0)).expect_err("is 250 m across").to_string();
        assert!(fault.contains("is the unit right?"), "{fault}");
    }
}
