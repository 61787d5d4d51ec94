//! A frame that goes wrong is repeated in finer steps from where it began: what explodes in one step bears a quarter of it.

use super::body::Body;
use super::energy::EnergyAudit;
use super::error::SimulationError;
use super::simulation::Simulation;
use crate::contact::{Kept, Tally, Wrench};
use crate::world::Motion;

/// Pieces of each step, at least, when a frame is repeated.
const PIECES: f64 = 4.0;

/// What a frame begins with. Lists are made anew from it.
struct Start {
    step: u64,
    haste: f64,
    divided: u64,
    deepest: f64,
    stiff: f64,
    tally: Tally,
    audit: Option<EnergyAudit>,
    bodies: Vec<Body>,
    motions: Vec<Motion>,
    wrenches: Vec<Wrench>,
    odometers: Vec<f64>,
    field: Kept,
}

impl Simulation {
    /// Takes all steps of a frame, and if that fails once more in pieces.
    ///
    /// # Errors
    /// Those of the second attempt.
    pub(super) fn try_frame(&mut self) -> Result<(), SimulationError> {
        if self.impulses.is_some() {
            return self.take_steps(1.0);
        }
        let start = self.start();
        self.take_steps(1.0).or_else(|_| {
            self.return_to(start);
            self.repeated += 1;
            self.take_steps(PIECES)
        })
    }

    fn start(&self) -> Start {
        Start {
            step: self.step,
            haste: self.haste,
            divided: self.divided,
            deepest: self.deepest,
            stiff: self.stiff,
            tally: self.tally,
            audit: self.audit.clone(),
            bodies: self.bodies.clone(),
            motions: self.motions.clone(),
            wrenches: self.wrenches.clone(),
            odometers: self.odometers.clone(),
            field: self.field.keep(),
        }
    }

    fn return_to(&mut self, start: Start) {
        (self.step, self.part, self.owed) = (start.step, 0.0, 0.0);
        (self.haste, self.divided) = (start.haste, start.divided);
        (self.deepest, self.stiff) = (start.deepest, start.stiff);
        (self.tally, self.audit) = (start.tally, start.audit);
        (self.bodies, self.motions) = (start.bodies, start.motions);
        (self.wrenches, self.odometers) = (start.wrenches, start.odometers);
        self.field.restore(start.field);
        self.world.forget();
        self.move_surfaces();
    }
}

#[cfg(test)]
mod tests {
    use super::super::small_bed::small_bed;
    use super::*;

    #[test]
    fn from_where_a_frame_began_it_comes_to_the_same() {
        let mut simulation = small_bed(100, 20);
        let mut start = Some(simulation.start());
        let ends = [(); 2].map(|()| {
            simulation.take_steps(1.0).expect("runs");
            let Tally { sphere_contacts, wall_contacts, deepest, .. } = simulation.tally();
            assert!(sphere_contacts > 20 && wall_contacts > 20);
            let end = (simulation.clock(), simulation.states(), simulation.drum_torque(), deepest);
            if let Some(start) = start.take() {
                simulation.return_to(start);
            }
            end
        });
        assert!(ends[0] == ends[1], "to the last bit");
    }
}
