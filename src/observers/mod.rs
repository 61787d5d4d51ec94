//! What looks at frames: the ID-raster coater, bed statistics, the bed picture. Observers never see the world or each
//! other, and cannot change the motion.

pub use crate::stepping::Observer;
