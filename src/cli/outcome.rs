//! What came out of coating, and the files it goes to.

use super::bed::CoatedBed;
use super::failure::Failure;
use crate::observers::{BedPicture, SprayZone};
use crate::report::{self, PanelRow, RunDir, RunRecord, TabletRow};
use crate::shapes::SurfaceMesh;
use crate::stepping::Frame;
use std::collections::BTreeMap;

/// Width and height of the bed picture, pixels.
const PICTURE: u32 = 640;

/// What is known of the coating.
pub(super) struct Outcome {
    /// What drew the frames.
    pub(super) backend: String,
    /// k_V, m³.
    pub(super) volume_per_count: f64,
    /// Of the shape with the most tablets.
    pub(super) main: report::Coating,
    /// Of each shape, when there are several.
    pub(super) shapes: BTreeMap<String, report::Coating>,
    pub(super) efficiency: f64,
    pub(super) identity_residual: f64,
    pub(super) tablets: Vec<TabletRow>,
    pub(super) panels: Vec<PanelRow>,
    pub(super) surfaces: String,
    /// Mean thickness on each body, m.
    pub(super) film: Vec<f64>,
}

impl Outcome {
    /// Puts it into the record and into the tables beside it.
    pub(super) fn write(&self, directory: &RunDir, record: &mut RunRecord) -> Result<(), Failure> {
        record.backend.clone_from(&self.backend);
        record.derived.film_volume_per_count_m3 = Some(self.volume_per_count);
        let results = &mut record.results;
        results.coating = self.main;
        results.shapes.clone_from(&self.shapes);
        results.spray_efficiency = Some(self.efficiency);
        results.cov_identity_residual = Some(self.identity_residual);
        directory.write_table("tablets.csv", &self.tablets)?;
        directory.write_table("panels.csv", &self.panels)?;
        directory.write("coating.vtp", self.surfaces.as_bytes())?;
        Ok(())
    }

    /// Draws the bed of a frame with the film on it.
    pub(super) fn picture(
        &self,
        directory: &RunDir,
        bed: &CoatedBed<'_>,
        drum: &SurfaceMesh,
        zone: &SprayZone,
        frame: &Frame<'_>,
    ) -> Result<(), Failure> {
        let mut picture = BedPicture::new(bed.shapes, bed.body_shapes, drum, PICTURE)?;
        let image = picture.draw(frame, &self.film, Some(zone));
        image.write_png(&directory.path().join("bed.png")).map_err(Failure::Output)
    }
}
