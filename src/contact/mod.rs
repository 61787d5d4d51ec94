//! Hertz-Mindlin contact on cached sphere lists.
//!
//! In: motions at one time level, near pairs. Out: forces and torques. It moves nothing. Forces, overlaps and spring
//! increments are taken at one time level; each contact has one common point for both bodies, so that angular momentum is
//! conserved to round-off.

mod batch;
mod block;
mod body;
mod energy;
mod extents;
mod field;
mod frames;
mod groups;
#[cfg(test)]
mod harvest;
mod law;
mod lease;
mod links;
mod pairs;
mod side;
mod surface;
mod tasks;
mod walls;

pub use energy::{ContactState, Press};
pub use field::{ContactField, Partner, Tally, Wrench};
pub use law::{ContactForce, Dashpots, PairLaw, Spring, Touch, damping_ratio};
