//! The scene: what a file asks for, checked, in SI units and immutable.

mod model;
mod recipe;

pub use model::*;
pub use recipe::{Cap, Outline, Recipe};
