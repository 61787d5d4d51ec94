//! The simulation: time step, integrator, guards and the loop that hands frames to observers.

mod body;
mod drift;
mod energy;
mod error;
mod filling;
mod fingerprint;
mod frame;
mod guard;
mod impulse;
mod numbering;
mod readings;
mod repeat;
mod settling;
mod simulation;
#[cfg(test)]
mod small_bed;
mod stages;
mod stopwatch;
mod time_step;

pub use energy::Energy;
pub use error::SimulationError;
pub use frame::{BodyState, Frame, Observer};
pub use simulation::Simulation;
pub use stages::{Progress, Stage};
pub use stopwatch::{Phase, Stopwatch};
pub use time_step::{TimeStep, hertz_overlap, hertz_time};
