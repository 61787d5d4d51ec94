//! The rows of a coating series.

use super::BatchStatistics;
use serde::{Deserialize, Serialize};

/// One row of `series.csv`: the batch after a coated time. Field names are the columns, units included.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SeriesRow {
    /// Coated time, s.
    pub time_s: f64,
    /// CoV_intra by averaging moments (Eq 8).
    pub cov_intra: f64,
    /// Mean of CoV_intra,i (Eq 12); empty while a tablet has no coating.
    pub cov_intra_each: Option<f64>,
    /// CoV of the average tablet (Eq 19).
    pub cov_intra_average_tablet: f64,
    /// CoV over the total area (Eq 22).
    pub cov_total: f64,
    /// CoV of the mean thickness between tablets.
    pub cov_inter: f64,
    /// Standard deviation of CoV_intra,i over tablets; empty while a tablet has no coating.
    pub sd_cov_intra: Option<f64>,
    /// Mean thickness, µm.
    pub mean_thickness_um: f64,
}

impl SeriesRow {
    /// The row of a batch at `time` (s).
    pub fn new(time: f64, batch: &BatchStatistics) -> Self {
        Self {
            time_s: time,
            cov_intra: batch.moments,
            cov_intra_each: batch.each_tablet,
            cov_intra_average_tablet: batch.average_tablet,
            cov_total: batch.total_area,
            cov_inter: batch.inter,
            sd_cov_intra: batch.sd_cov_intra,
            mean_thickness_um: batch.mean_thickness * 1e6,
        }
    }
}
