//! Writing a recording.

use super::reader::{Header, VERSION};
use super::{Packing, PoseError, PoseReader, Recording, block};
use crate::stepping::{Frame, Observer};
use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Stores the poses of every frame it is shown.
#[derive(Debug)]
pub struct Recorder {
    path: PathBuf,
    file: BufWriter<File>,
    packing: Packing,
    content: Vec<u8>,
    failure: Option<io::Error>,
}

impl Recorder {
    /// Begins a recording, in place of what is at `path`.
    ///
    /// # Errors
    /// [`PoseError::Io`].
    pub fn create(path: &Path, recording: Recording) -> Result<Self, PoseError> {
        let io = |source| PoseError::Io { path: path.into(), source };
        let mut recorder = Self::to_file(path, File::create(path).map_err(io)?, recording.packing);
        let header = Header { pancoat_poses: VERSION, recording };
        let header = serde_json::to_vec(&header).map_err(|error| io(error.into()))?;
        block::write(&mut recorder.file, &header).and_then(|()| recorder.file.flush()).map_err(io)?;
        Ok(recorder)
    }

    /// Goes on with the recording at `path` from frame `next` on; later frames and a torn end are cut off.
    ///
    /// # Errors
    /// [`PoseError::Io`], [`PoseError::NotPoses`], [`PoseError::Other`] when it holds other bodies or another packing.
    pub fn resume(path: &Path, recording: &Recording, next: u64) -> Result<Self, PoseError> {
        let io = |source| PoseError::Io { path: path.into(), source };
        let mut reader = PoseReader::open(path)?;
        if reader.recording() != recording {
            return Err(PoseError::Other { path: path.into() });
        }
        let mut kept = reader.sound();
        while let Some(frame) = reader.next() {
            if frame?.index >= next {
                break;
            }
            kept = reader.sound();
        }
        let mut file = OpenOptions::new().write(true).open(path).map_err(io)?;
        file.set_len(kept).and_then(|()| file.seek(SeekFrom::End(0))).map_err(io)?;
        Ok(Self::to_file(path, file, recording.packing))
    }

    fn to_file(path: &Path, file: File, packing: Packing) -> Self {
        Self { path: path.into(), file: BufWriter::new(file), packing, content: Vec::new(), failure: None }
    }

    /// Writes out what is still in memory, and tells whether anything since the last call could not be written. A run
    /// asks at each checkpoint and at its end: a recording with a hole is no recording.
    ///
    /// # Errors
    /// [`PoseError::Io`] with the first failure.
    pub fn flush(&mut self) -> Result<(), PoseError> {
        let outcome = self.failure.take().map_or_else(|| self.file.flush(), Err);
        outcome.map_err(|source| PoseError::Io { path: self.path.clone(), source })
    }
}

impl Observer for Recorder {
    fn observe(&mut self, frame: &Frame<'_>) {
        if self.failure.is_some() {
            return;
        }
        self.content.clear();
        self.content.extend(frame.index.to_le_bytes());
        self.content.extend(frame.time.to_le_bytes());
        self.content.extend(frame.drum_angle.to_le_bytes());
        for body in frame.bodies {
            self.packing.write(&body.position, &body.orientation, &mut self.content);
        }
        self.failure = block::write(&mut self.file, &self.content).err();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observers::coater::tests::tumbled;
    use nalgebra::Vector3;

    fn record(recorder: &mut Recorder, frames: std::ops::Range<u64>) {
        for index in frames {
            let bodies = tumbled(5, [0.1; 3], index);
            let time = 0.02 * index as f64;
            recorder.observe(&Frame {
                index,
                time,
                bodies: &bodies,
                drum_angle: 2.3 * time,
                drum_torque: 0.0,
            });
        }
        recorder.flush().unwrap();
    }

    fn bed(bodies: usize, packing: Packing) -> Recording {
        Recording { packing, body_shapes: vec![0; bodies], aim: None }
    }

    fn indices(path: &Path) -> Vec<u64> {
        PoseReader::open(path).unwrap().map(|frame| frame.unwrap().index).collect()
    }

    #[test]
    fn frames_come_back_as_they_were() {
        let file = tempfile::NamedTempFile::new().unwrap();
        record(&mut Recorder::create(file.path(), bed(5, Packing::Exact)).unwrap(), 0..4);
        let frames: Vec<_> = PoseReader::open(file.path()).unwrap().map(Result::unwrap).collect();
        assert_eq!(frames.len(), 4);
        let bodies = tumbled(5, [0.1; 3], 3);
        assert_eq!((frames[3].time, frames[3].drum_angle), (0.06, 2.3 * 0.06));
        for (stored, body) in frames[3].as_frame().bodies.iter().zip(&bodies) {
            assert_eq!((stored.position, stored.orientation), (body.position, body.orientation));
        }
    }

    #[test]
    fn a_torn_recording_is_gone_on_with_where_it_was_sound() {
        let compact = Packing::Compact { min: Vector3::repeat(-0.2), max: Vector3::repeat(0.2) };
        let file = tempfile::NamedTempFile::new().unwrap();
        record(&mut Recorder::create(file.path(), bed(5, compact)).unwrap(), 0..6);
        let whole = std::fs::read(file.path()).unwrap();
        std::fs::write(file.path(), &whole[..whole.len() - 3]).unwrap();
        assert_eq!(indices(file.path()), [0, 1, 2, 3, 4]);
        record(&mut Recorder::resume(file.path(), &bed(5, compact), 4).unwrap(), 4..6);
        assert_eq!(std::fs::read(file.path()).unwrap(), whole);
        assert_eq!(PoseReader::open(file.path()).unwrap().frames_left().unwrap(), 6);
        for other in [bed(6, compact), bed(5, Packing::Exact)] {
            assert!(matches!(Recorder::resume(file.path(), &other, 0), Err(PoseError::Other { .. })));
        }
        std::fs::write(file.path(), "time_s,id\n").unwrap();
        assert!(matches!(PoseReader::open(file.path()), Err(PoseError::NotPoses { .. })));
    }
}
