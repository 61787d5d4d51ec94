//! The scene: what a file asks for, checked, in SI units and immutable.

mod model;

pub use model::*;
