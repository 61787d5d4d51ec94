//! Statistics of the bed and of its coating, kept while a run goes on.
//!
//! [`BedStatistics`] looks at motion only; [`CoatingSeries`] is handed the coater's counts as plain slices. Both keep
//! block means, so that every figure comes with a standard error that knows of the bed's own memory when a block is longer
//! than that.

mod bed;
mod figure;
mod passes;
mod series;
mod surface;

pub use bed::{BedFigures, BedStatistics, BodyInertia};
pub use figure::Figure;
pub use passes::{PassFigures, SprayPasses};
pub use series::{CoatingSeries, TabletRow};
pub use surface::{Surface, SurfaceSample};
