//! Planes, boxes and meshes.

use super::super::fault::FaultKind;
use super::super::model::{Boundary, BoundarySurface};
use super::super::path::KeyPath;
use super::super::spec::{BoundarySpec, SurfaceSpec};
use super::{Allowed, Checker, moving};
use crate::units::{Length, Triple};
use nalgebra::Vector3;

/// Farthest coordinate of a boundary, m.
const FARTHEST: f64 = 100.0;

pub(super) fn boundaries(c: &mut Checker<'_>, specs: Vec<BoundarySpec>) -> Vec<Boundary> {
    let number = |(i, spec)| boundary(c, &Checker::item("boundaries", i), spec);
    specs.into_iter().enumerate().map(number).collect()
}

fn boundary(c: &mut Checker<'_>, at: &KeyPath, spec: BoundarySpec) -> Boundary {
    let (velocity, spin) = moving::motion(c, at, spec.velocity, spec.spin);
    let nowhere = BoundarySurface::Plane { point: Vector3::zeros(), normal: Vector3::y() };
    let surface = c.need(&at.field("surface"), spec.surface, "Plane(..), Box(..) or Mesh(..)");
    Boundary {
        surface: surface.map_or(nowhere, |s| self::surface(c, &at.field("surface"), s)),
        material: c.name(&at.field("material"), spec.material, "material", "materials"),
        velocity,
        spin,
    }
}

fn surface(c: &mut Checker<'_>, at: &KeyPath, spec: SurfaceSpec) -> BoundarySurface {
    match spec {
        SurfaceSpec::Plane { point, normal } => BoundarySurface::Plane {
            point: point.map_or_else(Vector3::zeros, |p| c.triple(&at.field("point"), p, FARTHEST)),
            normal: c.direction(&at.field("normal"), normal),
        },
        SurfaceSpec::Box { min, max } => {
            let (min, max) = (corner(c, &at.field("min"), min), corner(c, &at.field("max"), max));
            if (0..3).any(|axis| min[axis] >= max[axis]) {
                c.fault(at, FaultKind::InsideOutBox);
            }
            BoundarySurface::Box { min, max }
        }
        SurfaceSpec::Mesh { file, unit } => BoundarySurface::Mesh {
            path: c.file(&at.field("file"), file),
            scale: c.number(&at.field("unit"), unit, Allowed::from(1e-6).to(1.0)),
        },
    }
}

/// A corner of a box; NaN, which is above and below nothing, if it is not given.
fn corner(c: &mut Checker<'_>, at: &KeyPath, value: Option<Triple<Length>>) -> Vector3<f64> {
    match c.need(at, value, "a corner such as Mm(x, y, z)") {
        Some(corner) => c.triple(at, corner, FARTHEST),
        None => Vector3::repeat(f64::NAN),
    }
}
