//! The scene: what a file asks for, checked, in SI units and immutable.

mod model;
mod pattern;

pub use model::*;
pub use pattern::*;
