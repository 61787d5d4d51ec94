//! Hertz-Mindlin contact on cached sphere lists.
//!
//! In: poses with the mean velocities of the step that led there, near pairs. Out: forces and torques. It moves nothing.
//! Overlaps and springs are those of the poses, dashpots meet the mean velocities; each contact has one common point for
//! both bodies, so that angular momentum is conserved to round-off.

mod batch;
mod block;
mod body;
mod energy;
mod extents;
mod field;
mod groups;
#[cfg(test)]
mod harvest;
mod law;
mod lease;
mod links;
mod pairs;
mod side;
mod sieve;
mod surface;
mod tasks;
mod walls;

pub use energy::{ContactState, Press};
pub use field::{ContactField, Kept, Partner, Tally, Wrench};
pub use law::{ContactForce, Dashpots, PairLaw, Spring, Touch, damping_ratio};
