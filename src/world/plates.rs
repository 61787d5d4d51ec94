//! Walls as convex plates, for Rapier's own solver.
//!
//! Rapier's triangle meshes have no inside: what a body is pressed into them by may push it on to the other side, and
//! tablets of a slowly turning drum cling to its wall or leave it. A plate has one. A flat part of a wall with nothing
//! behind it, such as a strip or an end of a drum, is a box behind its plane; other facets are plates by themselves.

use super::motion::Relative;
use super::{pose, to_f32};
use crate::shapes::SurfaceMesh;
use nalgebra::{Matrix3, Vector3};
use rapier3d::prelude::*;

/// Most thickness of a plate, m: more than a body can be pressed into it.
const THICKEST: f64 = 50e-3;
/// Distance, m, at which a ray has left its facet.
const CLEAR: f64 = 1e-4;
/// Angle, rad, between facets of one flat part.
const FLAT: f64 = 1e-3;
/// What may stand behind the plane of a part and count as nothing, m: feet of baffles.
const FEET: f64 = 2e-3;

/// A convex piece of wall: its shape and where that is, a point of its face, m, and the face's normal towards the bodies.
pub(super) struct Plate {
    pub(super) shape: SharedShape,
    pub(super) pose: Pose,
    pub(super) point: Vector3<f64>,
    pub(super) normal: Vector3<f64>,
}

/// The plates of a surface.
pub(super) fn plates(mesh: &SurfaceMesh) -> Vec<Plate> {
    let vertices = mesh.vertices.iter().map(to_f32).collect();
    let facets = TriMesh::new(vertices, mesh.triangles.clone()).expect("a mesh has triangles");
    let mut parts: Vec<Vec<usize>> = Vec::new();
    for (t, part) in mesh.patches(FLAT).into_iter().enumerate() {
        parts.resize(parts.len().max(part as usize + 1), Vec::new());
        parts[part as usize].push(t);
    }
    let of_part = |part: Vec<usize>| {
        if nothing_behind(mesh, part[0]) {
            vec![slab(mesh, &part)]
        } else {
            part.iter().filter_map(|t| prism(mesh, *t, thickness(&facets, mesh, *t))).collect()
        }
    };
    parts.into_iter().flat_map(of_part).collect()
}

/// Whether all of a surface is before the plane of one of its facets.
fn nothing_behind(mesh: &SurfaceMesh, facet: usize) -> bool {
    let (point, normal) = (mesh.corners(facet)[0], mesh.normal(facet));
    mesh.vertices.iter().all(|vertex| (vertex - point).dot(&normal) > -FEET)
}

/// The box behind the rectangle around a flat part.
fn slab(mesh: &SurfaceMesh, part: &[usize]) -> Plate {
    let ([point, next, _], normal) = (mesh.corners(part[0]), mesh.normal(part[0]));
    let along = (next - point).normalize();
    let axes = Matrix3::from_columns(&[along, normal, along.cross(&normal)]);
    let placed = part.iter().flat_map(|t| mesh.corners(*t)).map(|corner| axes.tr_mul(&(corner - point)));
    let (mut least, mut most) = (Vector3::zeros(), Vector3::zeros());
    for at in placed {
        (least, most) = (least.inf(&at), most.sup(&at));
    }
    (least.y, most.y) = (-THICKEST, 0.0);
    let half = (most - least) * 0.5;
    Plate {
        shape: SharedShape::cuboid(half.x as f32, half.y as f32, half.z as f32),
        pose: pose(&Relative { position: point + axes * (least + half), rotation: axes }),
        point,
        normal,
    }
}

/// A facet and what is behind it up to `thickness`, m; `None` if it has no area.
fn prism(mesh: &SurfaceMesh, facet: usize, thickness: f64) -> Option<Plate> {
    let (corners, normal) = (mesh.corners(facet), mesh.normal(facet));
    let points: Vec<Vec3> =
        corners.iter().flat_map(|c| [to_f32(c), to_f32(&(c - normal * thickness))]).collect();
    let shape = SharedShape::convex_hull(&points)?;
    Some(Plate { shape, pose: Pose::IDENTITY, point: corners[0], normal })
}

/// How thick the plate behind a facet may be, m: up to the next facet behind it, for a baffle has two sides.
fn thickness(facets: &TriMesh, mesh: &SurfaceMesh, facet: usize) -> f64 {
    let (corners, back) = (mesh.corners(facet), -mesh.normal(facet));
    let center = (corners[0] + corners[1] + corners[2]) / 3.0;
    let places = corners.iter().map(|corner| corner.lerp(&center, 0.1)).chain([center]);
    let behind = places.filter_map(|place| {
        let ray = Ray::new(to_f32(&(place + back * CLEAR)), to_f32(&back));
        facets.cast_local_ray(&ray, THICKEST as f32, false).map(|distance| f64::from(distance) + CLEAR)
    });
    behind.fold(THICKEST, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::shapes::drum_surface;

    /// The paper's drum: a box for each of its 90 strips and for both ends; the baffles' facets, none thicker than a baffle is
    /// high or wide.
    #[test]
    fn a_drum_is_made_of_boxes_and_its_baffles_of_facets() {
        let drum = Scene::embedded("round").expect("the embedded scene").drum.expect("a drum");
        let mesh = drum_surface(&drum).expect("a surface").mesh;
        let (boxes, facets): (Vec<_>, Vec<_>) =
            plates(&mesh).into_iter().partition(|plate| plate.shape.as_cuboid().is_some());
        let ends = boxes.iter().filter(|plate| plate.normal.z.abs() > 0.999).count();
        assert_eq!((ends, boxes.len()), (2, 92));
        let most = drum.baffles.expect("baffles").height + 1e-3;
        for plate in facets {
            let back = to_f32(&-plate.normal);
            let far = plate.shape.as_support_map().expect("is convex").local_support_point(back);
            let depth = f64::from((far - to_f32(&plate.point)).dot(back));
            assert!((CLEAR..most).contains(&depth), "{depth} m");
        }
    }
}
