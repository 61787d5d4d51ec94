//! Reading a recording.

use super::{PoseError, Recording, StoredFrame, block};
use crate::stepping::BodyState;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// What a recording begins with, as JSON.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Header {
    /// Version of the format.
    pub(super) pancoat_poses: u32,
    pub(super) recording: Recording,
}

/// The version this program writes and reads.
pub(super) const VERSION: u32 = 1;
/// Bytes of a frame before its poses: its number, its time and the drum's angle.
const FRAME_HEAD: usize = 24;

/// The frames of a recording, one after the other.
#[derive(Debug)]
pub struct PoseReader {
    path: PathBuf,
    file: BufReader<File>,
    header: Header,
    /// Bytes of the header and the frames read so far.
    sound: u64,
}

impl PoseReader {
    /// Opens a recording.
    ///
    /// # Errors
    /// [`PoseError::Io`], [`PoseError::NotPoses`].
    pub fn open(path: &Path) -> Result<Self, PoseError> {
        let io = |source| PoseError::Io { path: path.into(), source };
        let mut file = BufReader::new(File::open(path).map_err(io)?);
        let content = block::read(&mut file).map_err(io)?;
        let header = content.as_deref().and_then(|content| serde_json::from_slice::<Header>(content).ok());
        match header {
            Some(header) if header.pancoat_poses == VERSION => {
                let sound = content.map_or(0, |content| block::size(content.len()));
                Ok(Self { path: path.into(), file, header, sound })
            }
            _ => Err(PoseError::NotPoses { path: path.into() }),
        }
    }

    /// What is recorded.
    pub fn recording(&self) -> &Recording {
        &self.header.recording
    }

    /// How many frames follow, by the size of the file.
    ///
    /// # Errors
    /// [`PoseError::Io`].
    pub fn frames_left(&self) -> Result<u64, PoseError> {
        let file = self.file.get_ref().metadata();
        let size = file.map_err(|source| PoseError::Io { path: self.path.clone(), source })?.len();
        let Recording { packing, body_shapes, .. } = self.recording();
        Ok(size.saturating_sub(self.sound) / block::size(FRAME_HEAD + packing.bytes() * body_shapes.len()))
    }

    /// Bytes of the header and the frames read so far.
    pub(super) fn sound(&self) -> u64 {
        self.sound
    }

    fn decode(&self, content: &[u8]) -> Option<StoredFrame> {
        let (head, poses) = content.split_at_checked(FRAME_HEAD)?;
        let (head, _) = head.as_chunks::<8>();
        let Recording { packing, body_shapes, .. } = self.recording();
        let size = packing.bytes();
        (poses.len() == size * body_shapes.len()).then(|| StoredFrame {
            index: u64::from_le_bytes(head[0]),
            time: f64::from_le_bytes(head[1]),
            drum_angle: f64::from_le_bytes(head[2]),
            bodies: poses
                .chunks_exact(size)
                .map(|pose| {
                    let (position, orientation) = packing.read(pose);
                    BodyState { position, orientation, velocity: Vector3::zeros(), spin: Vector3::zeros() }
                })
                .collect(),
        })
    }
}

impl Iterator for PoseReader {
    type Item = Result<StoredFrame, PoseError>;

    /// The next frame; `None` after the last whole and sound one.
    fn next(&mut self) -> Option<Self::Item> {
        match block::read(&mut self.file) {
            Ok(content) => {
                let content = content?;
                let frame = self.decode(&content)?;
                self.sound += block::size(content.len());
                Some(Ok(frame))
            }
            Err(source) => Some(Err(PoseError::Io { path: self.path.clone(), source })),
        }
    }
}
