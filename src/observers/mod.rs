//! What looks at frames: the ID-raster coater, bed statistics, the bed picture. Observers never see the world or each
//! other, and cannot change the motion.

pub mod statistics;

use crate::stepping::Frame;

/// Something that looks at every frame of a run.
pub trait Observer {
    /// Takes note of a frame.
    fn observe(&mut self, frame: &Frame<'_>);
}
