//! What stops a run that has gone wrong, while its last good state is still at hand.

use super::drift::travel;
use super::error::{DeepestContact, SimulationError};
use super::frame::BodyState;
use super::simulation::Simulation;

/// Overlap over radius up to which bodies may begin.
const MOST_START_OVERLAP: f64 = 0.5;
/// Overlap over radius above which a sphere is as good as through.
const MOST_OVERLAP: f64 = 0.75;
/// Farthest that any sphere centre may move in a step, of its body's smallest radius. A centre on one side of a wall and
/// on the other side a step later has then been within a quarter of the radius, so that [`MOST_OVERLAP`] sees it.
pub(super) const MOST_TRAVEL: f64 = 0.5;
/// Farthest position, m: beyond it the near-pair search, in single precision, is too coarse.
const FARTHEST: f64 = 100.0;

impl Simulation {
    /// Refuses bodies that begin deep in each other or in a wall: their springs would shoot them out.
    pub(super) fn guard_start(&self) -> Result<(), SimulationError> {
        let ratio = self.tally.deepest;
        match self.deepest_contact() {
            Some((body, partner)) if ratio > MOST_START_OVERLAP => {
                Err(SimulationError::StartOverlap { body, partner, ratio, most: MOST_START_OVERLAP })
            }
            _ => Ok(()),
        }
    }

    /// Overlap, travel and NaN, at every step of `dt`, s, in which the fastest body went `haste` times as far as it may.
    pub(super) fn guard_step(&self, dt: f64, haste: f64) -> Result<(), SimulationError> {
        let (step, time) = (self.step + u64::from(self.part > 0.0), self.clock());
        if self.tally.deepest > MOST_OVERLAP
            && let Some((body, partner)) = self.deepest_contact()
        {
            return Err(SimulationError::Overlap { body, partner, step, time, ratio: self.tally.deepest });
        }
        if haste > 1.0 {
            let ratios = self.bodies.iter().zip(&self.motions).map(|(body, motion)| {
                let turn = motion.rotation.tr_mul(&motion.spin) * dt;
                travel(&(motion.velocity * dt), &turn, body.reach, &body.arms) * body.inverse_travel
            });
            let astray = ratios.enumerate().find(|(_, ratio)| ratio.is_nan() || *ratio > 1.0);
            if let Some((body, ratio)) = astray {
                let body = self.number(body);
                let contact = DeepestContact(self.deepest_contact());
                let ratio = MOST_TRAVEL * ratio;
                return Err(if ratio.is_finite() {
                    SimulationError::TooFast { body, step, time, ratio, contact }
                } else {
                    SimulationError::NotFinite { body, step, time, contact }
                });
            }
        }
        Ok(())
    }

    /// That every body is where it can be, at every frame.
    pub(super) fn guard_frame(&self) -> Result<(), SimulationError> {
        let (step, time) = (self.step, self.clock());
        for (body, motion) in self.motions.iter().enumerate() {
            let p = motion.position;
            let place = match &self.scene.drum {
                Some(d) if p.xy().norm() > d.radius_at(p.z) || p.z.abs() > 0.5 * d.width => "drum",
                _ if p.norm() > FARTHEST => "100 m about the origin",
                _ => continue,
            };
            let step_key = self.scene.contact.mode.step_key();
            let body = self.number(body);
            return Err(SimulationError::Lost { body, place, step, time, step_key });
        }
        Ok(())
    }

    /// Keeps the present state.
    pub(super) fn note_good(&mut self) {
        self.good = (self.clock(), self.states());
    }

    /// Time since the start, s, and bodies of the last frame that passed all guards.
    pub fn last_good(&self) -> (f64, &[BodyState]) {
        (self.good.0, &self.good.1)
    }
}
