//! The rows of `tablets.csv` and `panels.csv`. Field names are the columns, units included.

use serde::{Deserialize, Serialize};

/// One tablet.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TabletRow {
    /// Number of the tablet, that of its body.
    pub tablet: usize,
    /// Name of its shape.
    pub shape: String,
    /// Mass without coating, mg.
    pub mass_mg: f64,
    /// Dry film it carries, mg.
    pub coat_mass_mg: f64,
    /// Mean thickness, µm.
    pub mean_thickness_um: f64,
    /// CoV_intra,i over its surface (Eq 11); empty without coating.
    pub cov_intra: Option<f64>,
    /// Mean thickness of its caps over that of its band; empty without coating on the band, or without a band.
    pub cap_to_band: Option<f64>,
}

/// One panel of a shape.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PanelRow {
    /// Number of the panel in its shape.
    pub panel: usize,
    /// Name of the shape.
    pub shape: String,
    /// `cap` or `band`.
    pub region: String,
    /// Centroid in body axes, mm.
    pub x_mm: f64,
    /// Centroid, y.
    pub y_mm: f64,
    /// Centroid, z.
    pub z_mm: f64,
    /// Outward unit normal in body axes.
    pub nx: f64,
    /// Normal, y.
    pub ny: f64,
    /// Normal, z.
    pub nz: f64,
    /// Area, mm².
    pub area_mm2: f64,
    /// Thickness on the average tablet, µm.
    pub average_um: f64,
    /// Thickness on the representative tablet, µm; empty when not computed.
    pub representative_um: Option<f64>,
}
