//! What a report is made of.

use super::{Exponent, TabletRow};
use crate::models::{RegionMeans, SeriesRow, region_means};
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Everything a report shows, as plain values: gathered from a run directory, or put together by hand.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ReportData {
    /// The run's name.
    pub title: String,
    /// Coating uniformity over time; empty without a spray.
    pub series: Vec<SeriesRow>,
    /// One entry per coated shape.
    pub shapes: Vec<ShapeCoating>,
    /// Figures of the bed, in the order shown.
    pub bed: Vec<Quantity>,
    /// The bed picture, a PNG file.
    pub picture: Option<Vec<u8>>,
    /// Step, contacts, overlaps and what else says whether the numbers can be trusted.
    pub numerics: Vec<Quantity>,
    /// Wall time of each phase, s.
    pub phases: Vec<(String, f64)>,
    /// Largest residual of the averaging identities; `None` when not computed.
    pub identity_residual: Option<f64>,
    /// What the run warned of.
    pub warnings: Vec<String>,
    /// Where the numbers come from: version, seed, hashes, machine.
    pub provenance: Vec<(String, String)>,
    /// The scene file.
    pub scene_text: String,
}

/// A number with what it is called.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Quantity {
    /// Name, in words.
    pub name: String,
    /// Value, in `unit`.
    pub value: f64,
    /// Standard error, in `unit`, when known.
    pub error: Option<f64>,
    /// Unit; empty for none.
    pub unit: String,
}

/// The coating of one shape.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ShapeCoating {
    /// Name in the scene.
    pub name: String,
    /// The limit of CoV_intra; `None` when it was not estimated.
    pub limit: Option<Limit>,
    /// Limit of the orientation-only model, when computed.
    pub orientation_only: Option<f64>,
    /// The same by Monte Carlo.
    pub orientation_monte_carlo: Option<f64>,
    /// The same from the order tensor alone.
    pub order_tensor: Option<f64>,
    /// Power of time with which CoV_inter falls, once the batch is mixed.
    pub inter_exponent: Option<Exponent>,
    /// Power of time with which the spread of CoV_intra,i between tablets falls.
    pub spread_exponent: Option<Exponent>,
    /// CoV of the time that tablets spend in the spray.
    pub residence_cov: Option<f64>,
    /// Its tablets.
    pub tablets: Vec<TabletRow>,
    /// The average tablet.
    pub map: Option<ThicknessMap>,
}

/// The limit of CoV_intra as the record keeps it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// CoV_∞.
    pub value: f64,
    /// Lower end of its 95 % interval.
    pub low: f64,
    /// Upper end of its 95 % interval.
    pub high: f64,
    /// K of CoV² = CoV_∞² + K/t, s.
    pub noise_time_s: Option<f64>,
}

/// Thickness on the panels of tablets of one shape.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ThicknessMap {
    /// Vertices in body axes, mm.
    pub vertices_mm: Vec<[f64; 3]>,
    /// Vertex indices of each panel, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Area of each panel, mm².
    pub areas_mm2: Vec<f64>,
    /// Whether each panel is on a cap; the others are on the band.
    pub on_cap: Vec<bool>,
    /// Thickness on each panel of the average tablet, µm.
    pub average_um: Vec<f64>,
    /// Further maps by name, µm per panel: [`ThicknessMap::WITHOUT_SHADOWS`], [`ThicknessMap::SINGLE`], [`ThicknessMap::SD`].
    pub others: BTreeMap<String, Vec<f64>>,
}

impl ThicknessMap {
    /// The orientation-only model, at the mean of the average tablet.
    pub const WITHOUT_SHADOWS: &'static str = "without_shadows";
    /// The tablets with the lowest, the median and the highest CoV_intra,i.
    pub const SINGLE: [&'static str; 3] = ["most_uniform", "median", "least_uniform"];
    /// Standard deviation of each panel over tablets.
    pub const SD: &'static str = "sd";

    /// The surface in SI units: centroids (m), unit normals and areas (m²).
    pub fn geometry(&self) -> (Vec<Vector3<f64>>, Vec<Vector3<f64>>, Vec<f64>) {
        let corners = |t: &[u32; 3]| t.map(|v| Vector3::from(self.vertices_mm[v as usize]) * 1e-3);
        let centroid = |t| corners(t).iter().sum::<Vector3<f64>>() / 3.0;
        let normal = |t| {
            let [a, b, c] = corners(t);
            (b - a).cross(&(c - a)).normalize()
        };
        let areas = self.areas_mm2.iter().map(|a| a * 1e-6).collect();
        (self.triangles.iter().map(centroid).collect(), self.triangles.iter().map(normal).collect(), areas)
    }

    /// A map over its own area-weighted mean; `None` for a bare tablet and for lists that do not match.
    pub fn relative(&self, thickness_um: &[f64]) -> Option<Vec<f64>> {
        let volume: f64 = thickness_um.iter().zip(&self.areas_mm2).map(|(h, a)| h * a).sum();
        let mean = volume / self.areas_mm2.iter().sum::<f64>();
        (mean > 0.0 && thickness_um.len() == self.areas_mm2.len())
            .then(|| thickness_um.iter().map(|h| h / mean).collect())
    }

    /// Mean thickness of caps and band, µm; `None` for a shape that has only one of both, and for lists that do not match.
    pub fn regions(&self) -> Option<RegionMeans> {
        region_means(&self.average_um, &self.areas_mm2, &self.on_cap).ok().flatten()
    }
}
