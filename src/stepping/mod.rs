//! The simulation: time step, integrator, guards and the loop that hands frames to observers.

mod frame;

pub use frame::{BodyState, Frame};
