//! Poses on disk: recorded while a bed turns, read back to be coated again with another spray, or taken from another
//! program's table.
//!
//! A recording is a header and one block per frame, each with its checksum, so that a recording cut short by a crash
//! is good up to its last whole frame and can be gone on with. Poses are kept exactly (56 bytes) or, for most uses well
//! enough, in 9 bytes ([`Packing`]). Velocities are not kept.

mod block;
mod packing;
mod reader;
mod recorder;
mod table;

pub use packing::Packing;
pub use reader::PoseReader;
pub use recorder::Recorder;
pub use table::read_pose_table;

use crate::scene::PoseTableFault;
use crate::stepping::{BodyState, Frame};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::io;
use std::path::PathBuf;

/// What a recording holds beside its frames.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Recording {
    /// How poses are stored.
    pub packing: Packing,
    /// Place of each body's shape among the scene's, in the order of the frames.
    pub body_shapes: Vec<usize>,
    /// Where the spray of the run pointed.
    pub aim: Option<RecordedAim>,
}

/// Where a spray pointed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct RecordedAim {
    /// Middle of the zone, m.
    pub target: Vector3<f64>,
    /// Unit vector from the zone to the nozzle.
    pub normal: Vector3<f64>,
}

/// A frame that was stored. Its bodies are at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredFrame {
    /// Number of the frame.
    pub index: u64,
    /// Time, s.
    pub time: f64,
    /// Angle of the drum, rad.
    pub drum_angle: f64,
    /// The bodies.
    pub bodies: Vec<BodyState>,
}

impl StoredFrame {
    /// The frame as observers take it.
    pub fn as_frame(&self) -> Frame<'_> {
        Frame {
            index: self.index,
            time: self.time,
            bodies: &self.bodies,
            drum_angle: self.drum_angle,
            drum_torque: 0.0,
        }
    }
}

impl From<&Frame<'_>> for StoredFrame {
    fn from(frame: &Frame<'_>) -> Self {
        Self {
            index: frame.index,
            time: frame.time,
            drum_angle: frame.drum_angle,
            bodies: frame.bodies.to_vec(),
        }
    }
}

/// Why poses cannot be stored or read.
#[derive(Debug, thiserror::Error)]
pub enum PoseError {
    /// The file system refuses.
    #[error("{path}: {source}")]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The file is something else.
    #[error("{path} is not a recording of poses")]
    NotPoses {
        /// The file.
        path: PathBuf,
    },
    /// A recording that is to be gone on with is of another kind or of other bodies.
    #[error("{path} is a recording of other bodies, in another packing or with another aim")]
    Other {
        /// The file.
        path: PathBuf,
    },
    /// A table is not one of poses.
    #[error(transparent)]
    Table(#[from] PoseTableFault),
}
