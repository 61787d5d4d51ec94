//! The scene: what a file asks for, checked, in SI units and immutable.
//!
//! In comes a RON file with units (`diameter: Mm(15.9)`) and the values set on the command line; out goes a [`Scene`]
//! that no later room has to check again, or [`SceneFaults`]: every fault of the file with its line, column and path.
//! `docs/scene.md` describes every key. This room builds nothing: no spheres, no panels, no meshes.

mod check;
mod clump;
mod decode;
mod drum;
mod fault;
mod model;
mod outline;
mod overrides;
mod path;
mod pattern;
mod pose_table;
mod recipe;
mod short_lines;
mod source;
mod spec;
mod text;

pub(crate) use decode::shown;

pub use clump::{Placement, SphereBudget};
pub use drum::{Baffles, Drum, Wall};
pub use fault::{Fault, FaultKind, Place, SceneFaults};
pub use model::*;
pub use outline::Syntax;
pub use pattern::*;
pub use pose_table::{PoseRow, PoseStamp, PoseTable, PoseTableFault};
pub use recipe::{Cap, Outline, Recipe};
pub use short_lines::ShortLines;
pub use text::SceneText;
