//! What moves: batches of tablets and bodies placed one by one.

use super::super::fault::FaultKind;
use super::super::model::{Batch, FreeBody};
use super::super::path::KeyPath;
use super::super::pose_table::{FARTHEST, FASTEST, FASTEST_SPIN, PoseTable, PoseTableFault};
use super::super::spec::{BatchSpec, BodySpec, OrientationSpec};
use super::{Allowed, Checker};
use crate::units::{AngularSpeed, Number, Speed, Triple};
use nalgebra::{Quaternion, Unit, UnitQuaternion, Vector3};
use std::path::Path;

/// Masses of one body, kg.
const BODY_MASS: Allowed = Allowed::above(0.0).to(1e3);

/// Tablets of a batch.
const COUNT: Allowed = Allowed::from(1.0).to(1e7);

pub(super) fn batches(c: &mut Checker<'_>, specs: Vec<BatchSpec>) -> Vec<Batch> {
    let number = |(i, spec)| batch(c, &Checker::item("batches", i), spec);
    specs.into_iter().enumerate().map(number).collect()
}

fn batch(c: &mut Checker<'_>, at: &KeyPath, spec: BatchSpec) -> Batch {
    let tablet_mass = c.number(&at.field("tablet_mass"), spec.tablet_mass, BODY_MASS);
    let mass = at.field("mass");
    let refused = c.told(&at.field("count")) || c.told(&mass);
    let count = match (spec.count, spec.mass) {
        (Some(count), None) => c.count(&at.field("count"), Some(count), COUNT),
        (None, Some(total)) => {
            let one_to_many = Allowed::from(tablet_mass).to(1e7 * tablet_mass);
            let allowed = if tablet_mass.is_nan() { BODY_MASS } else { one_to_many };
            (c.number(&mass, Some(total), allowed) / tablet_mass).round() as usize
        }
        _ if refused => 0,
        _ => {
            c.fault(at, FaultKind::EitherOr("count", "mass"));
            0
        }
    };
    Batch {
        shape: c.name(&at.field("shape"), spec.shape, "shape", "shapes"),
        material: c.name(&at.field("material"), spec.material, "material", "materials"),
        tablet_mass,
        count,
    }
}

pub(super) fn bodies(c: &mut Checker<'_>, specs: Vec<BodySpec>) -> Vec<FreeBody> {
    let mut bodies = Vec::new();
    for (i, spec) in specs.into_iter().enumerate() {
        let at = Checker::item("bodies", i);
        if let Some(file) = spec.poses.clone() {
            bodies.extend(in_file(c, &at, file, spec));
        } else {
            c.need(&at.field("position"), spec.position, "a position such as Mm(x, y, z)");
            bodies.push(body(c, &at, spec));
        }
    }
    bodies
}

/// One body for each row of a pose table.
fn in_file(c: &mut Checker<'_>, at: &KeyPath, file: String, spec: BodySpec) -> Vec<FreeBody> {
    let placed = [
        ("position", spec.position.is_some()),
        ("orientation", spec.orientation.is_some()),
        ("velocity", spec.velocity.is_some()),
        ("spin", spec.spin.is_some()),
    ];
    if let Some((key, _)) = placed.into_iter().find(|(_, given)| *given) {
        c.fault(at, FaultKind::EitherOr("poses", key));
    }
    let one = body(c, at, spec);
    let at = at.field("poses");
    let path = c.file(&at, Some(file));
    if c.told(&at) {
        return Vec::new();
    }
    in_table(&path, &one).unwrap_or_else(|fault| {
        c.fault(&at, FaultKind::Poses(fault));
        Vec::new()
    })
}

/// Bodies like `one` in the poses of a table with the columns `x,y,z`, and as far as wanted the others of
/// [`PoseRow`](super::super::PoseRow).
fn in_table(path: &Path, one: &FreeBody) -> Result<Vec<FreeBody>, PoseTableFault> {
    let mut table = PoseTable::open(path, &["x", "y", "z"])?;
    let mut bodies = Vec::new();
    while let Some(row) = table.next_row()? {
        bodies.push(FreeBody {
            position: row.position(),
            orientation: row.orientation(),
            velocity: row.velocity(),
            spin: row.spin(),
            ..*one
        });
    }
    if bodies.is_empty() { Err(table.fault("no row")) } else { Ok(bodies) }
}

fn body(c: &mut Checker<'_>, at: &KeyPath, spec: BodySpec) -> FreeBody {
    let (velocity, spin) = motion(c, at, spec.velocity, spec.spin);
    FreeBody {
        shape: c.name(&at.field("shape"), spec.shape, "shape", "shapes"),
        material: c.name(&at.field("material"), spec.material, "material", "materials"),
        mass: c.number(&at.field("mass"), spec.mass, BODY_MASS),
        position: spec.position.map_or_else(Vector3::zeros, |p| c.triple(&at.field("position"), p, FARTHEST)),
        orientation: spec
            .orientation
            .map_or_else(UnitQuaternion::identity, |o| orientation(c, &at.field("orientation"), o)),
        velocity,
        spin,
    }
}

fn orientation(c: &mut Checker<'_>, at: &KeyPath, spec: OrientationSpec) -> UnitQuaternion<f64> {
    match spec {
        OrientationSpec::AxisAngle { axis, angle } => {
            let axis = c.direction(&at.field("axis"), axis);
            let angle = c.number(&at.field("angle"), angle, Allowed::from(-1e3).to(1e3));
            UnitQuaternion::from_axis_angle(&Unit::new_unchecked(axis), angle)
        }
        OrientationSpec::Quaternion { w, x, y, z } => {
            let one = Allowed::from(-1e6).to(1e6);
            let [w, x, y, z]: [f64; 4] = [("w", w), ("x", x), ("y", y), ("z", z)]
                .map(|(name, part): (&str, Option<Number>)| c.number(&at.field(name), part, one));
            let quaternion = Quaternion::new(w, x, y, z);
            if quaternion.norm() == 0.0 {
                c.fault(at, FaultKind::NoDirection);
            }
            UnitQuaternion::new_normalize(quaternion)
        }
    }
}

/// Velocity, m/s, and spin, rad/s, at rest unless given.
pub(super) fn motion(
    c: &mut Checker<'_>,
    at: &KeyPath,
    velocity: Option<Triple<Speed>>,
    spin: Option<Triple<AngularSpeed>>,
) -> (Vector3<f64>, Vector3<f64>) {
    let rest = Vector3::zeros();
    (
        velocity.map_or(rest, |v| c.triple(&at.field("velocity"), v, FASTEST)),
        spin.map_or(rest, |s| c.triple(&at.field("spin"), s, FASTEST_SPIN)),
    )
}
