//! What looks at frames: the ID-raster coater, bed statistics, the bed picture, poses on disk. Observers never see the world or each
//! other, and cannot change the motion.

mod aim;
mod coater;
mod picture;
mod poses;
pub mod statistics;
mod zone;

pub use aim::{AimError, BedSurface};
pub use coater::{
    Backend, CoatLedger, Coater, CoaterError, Exposure, PanelIds, SprayLoss, film_thickness,
    film_volume_from_mean, film_volume_per_count,
};
pub use picture::{BedPicture, Image};
pub use poses::{
    Packing, PoseError, PoseReader, RecordedAim, Recorder, Recording, StoredFrame, read_pose_table,
};
pub use zone::SprayZone;

pub use crate::stepping::Observer;
