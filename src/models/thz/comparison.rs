//! Measured and simulated maps, panel by panel.

use super::super::averaging::area_moments;
use super::super::{ModelError, RegionMeans, TabletSurface, region_means};
use super::pose::{Pose, nearest};
use super::scan::ThzScan;
use rayon::prelude::*;

/// A scan averaged on the panels of a tablet.
#[derive(Debug, Clone, PartialEq)]
pub struct ThzMap {
    /// How the tablet lay.
    pub pose: Pose,
    /// Points on each panel.
    pub points: Vec<u32>,
    /// Mean thickness on each panel, m; 0 where there is no point.
    pub thickness: Vec<f64>,
    /// Standard deviation of single points about their panel's mean, over the whole tablet, m.
    pub scatter: f64,
}

impl ThzMap {
    /// Fits the pose of a scan and gives every point to the panel with the nearest centroid.
    pub fn new(scan: &ThzScan, surface: &TabletSurface<'_>) -> Self {
        let positions: Vec<_> = scan.points.iter().map(|p| p.position).collect();
        let pose = Pose::fit(&positions, surface);
        let panels: Vec<usize> = positions.par_iter().map(|p| nearest(&pose.apply(p), surface)).collect();
        let (mut points, mut thickness) = (vec![0_u32; surface.panels()], vec![0.0; surface.panels()]);
        for (point, &panel) in scan.points.iter().zip(&panels) {
            points[panel] += 1;
            thickness[panel] += point.thickness;
        }
        thickness.iter_mut().zip(&points).for_each(|(h, n)| *h /= f64::from((*n).max(1)));
        let squares: f64 = scan
            .points
            .iter()
            .zip(&panels)
            .map(|(point, &panel)| (point.thickness - thickness[panel]).powi(2))
            .sum();
        let covered = points.iter().filter(|n| **n > 0).count();
        let freedom = scan.points.len().saturating_sub(covered).max(1);
        Self { pose, points, thickness, scatter: (squares / freedom as f64).sqrt() }
    }
}

/// The average tablet of a run, in any unit of thickness.
#[derive(Debug, Clone, Copy)]
pub struct SimulatedMap<'a> {
    /// Thickness of each panel of the average tablet.
    pub average: &'a [f64],
    /// Standard deviation over tablets of the thickness of each panel.
    pub panel_sd: &'a [f64],
    /// Tablets averaged over.
    pub tablets: usize,
}

/// Measured less simulated on one panel, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PanelDifference {
    /// Number of the panel.
    pub panel: usize,
    /// Measured thickness, mean over the scans that cover the panel, m.
    pub measured: f64,
    /// Simulated thickness after scaling, m.
    pub simulated: f64,
    /// Standard uncertainty of their difference, m.
    pub uncertainty: f64,
}

/// Measured maps against a simulated one, on the panels that were measured.
///
/// The simulated map is scaled to the measured mean (the paper's choice of k_V, section 8.3), so that a common factor, as a
/// wrong refractive index of 2 % is, drops out. The uncertainty of a panel's difference has three parts: the scatter of single
/// points over the root of their number, the spread of that panel between tablets over the root of the number of *measured*
/// tablets (few tablets never show the average), and the same for the simulated ones.
#[derive(Debug, Clone, PartialEq)]
pub struct ThzComparison {
    /// Factor on the simulated thickness; on k_V, if that was in m³ per count.
    pub scale: f64,
    /// Panels with points.
    pub panels: Vec<PanelDifference>,
    /// Share of the surface that these are.
    pub covered: f64,
    /// CoV over these panels, measured.
    pub measured_cov: f64,
    /// CoV over these panels, simulated.
    pub simulated_cov: f64,
    /// Caps and band as measured, m.
    pub measured_regions: Option<RegionMeans>,
    /// Caps and band as simulated, m.
    pub simulated_regions: Option<RegionMeans>,
    /// Area-weighted correlation of both maps, −1 to 1.
    pub correlation: f64,
    /// Mean of (difference/uncertainty)²; about 1 when the maps agree within their uncertainties.
    pub chi_squared: f64,
}

impl ThzComparison {
    /// Compares scans, already laid on the panels of `surface`, with a simulated map.
    ///
    /// # Errors
    /// [`ModelError::Length`] when a map has another number of panels, [`ModelError::TooFew`] without scans,
    /// [`ModelError::Uncoated`] when a mean is zero.
    pub fn new(
        scans: &[ThzMap],
        simulated: &SimulatedMap<'_>,
        surface: &TabletSurface<'_>,
    ) -> Result<Self, ModelError> {
        surface.expect("simulated thickness values", simulated.average.len())?;
        surface.expect("simulated spreads", simulated.panel_sd.len())?;
        for scan in scans {
            surface.expect("measured thickness values", scan.thickness.len())?;
        }
        let on = |panel: usize| scans.iter().filter(move |s| s.points[panel] > 0);
        let covered: Vec<usize> = (0..surface.panels()).filter(|&j| on(j).count() > 0).collect();
        if covered.is_empty() {
            return Err(ModelError::TooFew {
                what: "a comparison",
                unit: "measured panels",
                found: 0,
                needed: 1,
            });
        }
        let areas: Vec<f64> = covered.iter().map(|&j| surface.areas[j]).collect();
        let measured: Vec<f64> = covered
            .iter()
            .map(|&j| on(j).map(|s| s.thickness[j]).sum::<f64>() / on(j).count() as f64)
            .collect();
        let raw: Vec<f64> = covered.iter().map(|&j| simulated.average[j]).collect();
        let ((measured_mean, measured_variance), (raw_mean, _)) =
            (area_moments(&measured, &areas), area_moments(&raw, &areas));
        if measured_mean <= 0.0 || raw_mean <= 0.0 {
            return Err(ModelError::Uncoated);
        }
        let scale = measured_mean / raw_mean;
        let scaled: Vec<f64> = raw.iter().map(|h| h * scale).collect();
        let (_, simulated_variance) = area_moments(&scaled, &areas);

        let uncertainty = |j: usize| {
            let tablets = on(j).count() as f64;
            let points: f64 =
                on(j).map(|s| s.scatter.powi(2) / f64::from(s.points[j])).sum::<f64>() / tablets.powi(2);
            let spread = (scale * simulated.panel_sd[j]).powi(2);
            (points + spread / tablets + spread / simulated.tablets as f64).sqrt()
        };
        let panels: Vec<PanelDifference> = covered
            .iter()
            .zip(measured.iter().zip(&scaled))
            .map(|(&panel, (&measured, &simulated))| PanelDifference {
                panel,
                measured,
                simulated,
                uncertainty: uncertainty(panel),
            })
            .collect();
        let product: Vec<f64> =
            panels.iter().map(|p| (p.measured - measured_mean) * (p.simulated - measured_mean)).collect();
        let on_cap: Vec<bool> = covered.iter().map(|&j| surface.on_cap[j]).collect();
        let square = |p: &PanelDifference| ((p.measured - p.simulated) / p.uncertainty).powi(2);
        Ok(Self {
            scale,
            covered: areas.iter().sum::<f64>() / surface.areas.iter().sum::<f64>(),
            measured_cov: measured_variance.sqrt() / measured_mean,
            simulated_cov: simulated_variance.sqrt() / measured_mean,
            measured_regions: region_means(&measured, &areas, &on_cap)?,
            simulated_regions: region_means(&scaled, &areas, &on_cap)?,
            correlation: area_moments(&product, &areas).0 / (measured_variance * simulated_variance).sqrt(),
            chi_squared: panels.iter().map(square).sum::<f64>() / panels.len() as f64,
            panels,
        })
    }
}
