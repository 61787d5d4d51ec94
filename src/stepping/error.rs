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
    /// Bodies begin deep in each other.
    #[error(
        "body {body} and {partner} overlap by {ratio:.2} of a sphere's radius at the start, at most {most} is allowed: \
         move them apart"
    )]
    StartOverlap {
        /// Index of the body.
        body: usize,
        /// What it overlaps.
        partner: Partner,
        /// Overlap over radius, dimensionless.
        ratio: f64,
        /// Largest allowed.
        most: f64,
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
    /// A body is too fast for its contacts to be met.
    #[error(
        "body {body} moves by {ratio:.2} of a sphere's radius in step {step}, {time:.6} s{contact}: lower time.step"
    )]
    TooFast {
        /// Index of the body.
        body: usize,
        /// Number of the step.
        step: u64,
        /// Simulated time, s.
        time: f64,
        /// Distance in a step over radius, dimensionless.
        ratio: f64,
        /// The deepest contact of the step.
        contact: DeepestContact,
    },
    /// A body's state is not a number.
    #[error(
        "body {body} has no finite position or velocity any more at step {step}, {time:.6} s{contact}: lower time.step"
    )]
    NotFinite {
        /// Index of the body.
        body: usize,
        /// Number of the step.
        step: u64,
        /// Simulated time, s.
        time: f64,
        /// The deepest contact of the step.
        contact: DeepestContact,
    },
    /// A body has left the drum, or everything.
    #[error("body {body} has left the {place} at step {step}, {time:.6} s: lower {step_key}")]
    Lost {
        /// Index of the body.
        body: usize,
        /// What it has left.
        place: &'static str,
        /// Number of the step.
        step: u64,
        /// Simulated time, s.
        time: f64,
        /// What sets the step in the scene.
        step_key: &'static str,
    },
    /// The caller asked to stop.
    #[error("stopped on request at {time:.3} s")]
    Stopped {
        /// Simulated time, s.
        time: f64,
    },
}

/// The deepest contact of a step, if anything touches: a body and what it touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DeepestContact(pub Option<(usize, Partner)>);

impl std::fmt::Display for DeepestContact {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.0 {
            Some((body, partner)) => write!(f, ", deepest contact body {body} with {partner}"),
            None => f.write_str(", without any contact"),
        }
    }
}
