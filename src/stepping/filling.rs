//! Where tablets can be put into the drum without touching anything.

use crate::shapes::ClearRoom;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use rand::{Rng, RngExt};

/// Free room kept around each bounding sphere, as a share of its radius.
const CLEARANCE: f64 = 0.01;

/// Lattice sites of a drum for bounding spheres of `radius` m, lowest first: a cubic lattice inside the cylinder that
/// the baffles leave free, every second column shifted along the axis, so that layers mix.
pub(super) fn sites(room: &ClearRoom, radius: f64) -> Vec<Vector3<f64>> {
    let cell = 2.0 * radius * (1.0 + CLEARANCE);
    let inner = room.radius - 0.5 * cell;
    let [first, last] = room.ends;
    let layers = ((last - first) / cell).floor() as i64;
    if inner <= 0.0 || layers < 1 {
        return Vec::new();
    }
    // What the layers leave free along the axis goes to shifting every second column.
    let slack = last - first - layers as f64 * cell;
    let rows = (inner / cell).floor() as i64;
    let mut sites = Vec::new();
    for row in -rows..=rows {
        let y = row as f64 * cell;
        let columns = ((inner * inner - y * y).sqrt() / cell).floor() as i64;
        for column in -columns..=columns {
            let shift = if (row + column).rem_euclid(2) == 0 { 0.0 } else { slack };
            for layer in 0..layers {
                let z = (layer as f64 + 0.5) * cell + first + shift;
                sites.push(Vector3::new(column as f64 * cell, y, z));
            }
        }
    }
    sites
}

/// An orientation drawn evenly from all orientations.
///
/// Source: Shoemake 1992, Graphics Gems III, "Uniform random rotations".
pub(super) fn any_orientation(rng: &mut impl Rng) -> UnitQuaternion<f64> {
    let (u, a, b): (f64, f64, f64) = (rng.random(), rng.random(), rng.random());
    let (a, b) = (a * std::f64::consts::TAU, b * std::f64::consts::TAU);
    let (low, high) = ((1.0 - u).sqrt(), u.sqrt());
    UnitQuaternion::from_quaternion(Quaternion::new(
        low * a.sin(),
        low * a.cos(),
        high * b.sin(),
        high * b.cos(),
    ))
}
