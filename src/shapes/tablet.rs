//! A tablet shape: recipe in, clump, panels and mass properties out.

use super::{Clump, Panels};
use nalgebra::Vector3;

/// A shape ready for a run.
#[derive(Debug, Clone, PartialEq)]
pub struct TabletShape {
    /// Name in the scene.
    pub name: String,
    /// Volume of the true solid, m³.
    pub volume: f64,
    /// Surface area of the true solid, m².
    pub area: f64,
    /// Principal moments of inertia of the homogeneous true solid, per unit mass, m².
    pub inertia_per_mass: Vector3<f64>,
    /// The spheres that contact sees.
    pub clump: Clump,
    /// The panels that the coater sees; `None` when the scene has no spray.
    pub panels: Option<Panels>,
}

/// Why a shape cannot be built.
#[derive(Debug, thiserror::Error)]
pub enum ShapeError {
    /// A file could not be read.
    #[error("cannot read {path}: {source}")]
    Read {
        /// The file.
        path: std::path::PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file's content is not what it should be.
    #[error("{path}:{line}: {fault}")]
    Content {
        /// The file.
        path: std::path::PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong and what is expected.
        fault: String,
    },
}
