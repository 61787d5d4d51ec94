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
            return self.take_steps();
        }
        let start = self.start();
        self.take_steps().or_else(|_| {
            self.return_to(start);
            self.repeated += 1;
            self.least_pieces = PIECES;
            let ended = self.take_steps();
            self.least_pieces = 1.0;
            ended
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
        let Start { step, haste, divided, deepest, stiff, tally, audit, .. } = start;
        (self.step, self.part, self.owed) = (step, 0.0, 0.0);
        (self.haste, self.divided) = (haste, divided);
        (self.deepest, self.stiff, self.tally, self.audit) = (deepest, stiff, tally, audit);
        (self.bodies, self.motions) = (start.bodies, start.motions);
        (self.wrenches, self.odometers) = (start.wrenches, start.odometers);
        self.field.restore(start.field);
        let same: Vec<u32> = (0..self.bodies.len() as u32).collect();
        self.world.renumber(&same);
        self.move_surfaces();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use std::path::Path;

    #[test]
    fn from_where_a_frame_began_it_comes_to_the_same() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/round.ron");
        let overrides = ["batches[0].mass=G(100)", "shapes.round.spheres=12", "spray=None"].map(String::from);
        let scene = Scene::load(&path, &overrides).expect("is valid");
        let mut simulation = Simulation::new(&scene).expect("is built");
        simulation.fill(&mut |_| true).expect("is filled");
        simulation.run(0, 20, &mut [], &mut |_| true).expect("runs");
        let mut start = Some(simulation.start());
        let ends = [(); 2].map(|()| {
            simulation.take_steps().expect("runs");
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
