//! `bodies.csv`: where the bodies of a run are, and how they move, at its end.

use crate::stepping::{BodyState, Simulation};
use serde::Serialize;

/// A row of the table, SI units; a scene's `poses` can read it.
#[derive(Debug, Serialize)]
pub(super) struct BodyRow {
    time_s: f64,
    id: usize,
    x: f64,
    y: f64,
    z: f64,
    qw: f64,
    qx: f64,
    qy: f64,
    qz: f64,
    vx: f64,
    vy: f64,
    vz: f64,
    wx: f64,
    wy: f64,
    wz: f64,
}

/// The last state that passed all guards.
pub(super) fn rows(simulation: &Simulation) -> impl Iterator<Item = BodyRow> + '_ {
    let (time_s, bodies) = simulation.last_good();
    bodies.iter().enumerate().map(move |(id, state)| {
        let BodyState { position, orientation: q, velocity, spin } = state;
        let ([x, y, z], [vx, vy, vz], [wx, wy, wz]) =
            ((*position).into(), (*velocity).into(), (*spin).into());
        BodyRow { time_s, id, x, y, z, qw: q.w, qx: q.i, qy: q.j, qz: q.k, vx, vy, vz, wx, wy, wz }
    })
}
