//! `bodies.csv`: where the bodies of a run are, and how they move, at its end.

use crate::scene::{PoseRow, PoseStamp};
use crate::stepping::{BodyState, Simulation};

/// The last state that passed all guards, as rows that a scene's `poses` can read.
pub(super) fn rows(simulation: &Simulation) -> impl Iterator<Item = (PoseStamp, PoseRow)> + '_ {
    let (time_s, bodies) = simulation.last_good();
    bodies.iter().zip(0..).map(move |(state, id)| {
        let BodyState { position, orientation: q, velocity, spin } = state;
        let ([x, y, z], [vx, vy, vz], [wx, wy, wz]) =
            ((*position).into(), (*velocity).into(), (*spin).into());
        let row = PoseRow { x, y, z, qw: q.w, qx: q.i, qy: q.j, qz: q.k, vx, vy, vz, wx, wy, wz };
        (PoseStamp { time_s, id }, row)
    })
}
