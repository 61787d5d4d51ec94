//! Why a run cannot go on.

use crate::contact::Partner;
use crate::shapes::ShapeError;

/// Why a run cannot be built or go on. Times are simulated seconds since the start.
#[derive(Debug, thiserror::Error)]
pub enum SimulationError {
    /// A shape cannot be built.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// The drum is full.
    #[error("only {placed} of {wanted} tablets fit into the drum: make the drum larger or the batch smaller")]
    Full {
        /// Tablets in the drum.
        placed: usize,
        /// Tablets asked for.
        wanted: usize,
    },
    /// A sphere is as good as through another.
    #[error(
        "body {body} and {partner} overlap by {ratio:.2} of a sphere's radius at step {step}, {time:.6} s: \
         lower time.step, raise the shear modulus or lower the speeds"
    )]
    Overlap {
        /// Index of the body.
        body: usize,
        /// What it overlaps.
        partner: Partner,
        /// Number of the step.
        step: u64,
        /// Simulated time, s.
        time: f64,
        /// Overlap over radius, dimensionless.
        ratio: f64,
    },
    /// A body's state is not a number.
    #[error("body {body} has no finite position or velocity any more at {time:.6} s: lower time.step")]
    NotFinite {
        /// Index of the body.
        body: usize,
        /// Simulated time, s.
        time: f64,
    },
    /// A body has left the drum.
    #[error(
        "body {body} has left the drum at {time:.6} s: lower time.step or raise the wall's shear modulus"
    )]
    Lost {
        /// Index of the body.
        body: usize,
        /// Simulated time, s.
        time: f64,
    },
    /// The caller asked to stop.
    #[error("stopped on request at {time:.3} s")]
    Stopped {
        /// Simulated time, s.
        time: f64,
    },
}
