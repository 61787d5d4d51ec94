//! The page that puts a simulated tablet beside scanned ones.

use super::html::{chart, escape, section, table};
use super::number::{percent, significant};
use super::page::document;
use super::{ThicknessMap, map, tablet_charts};
use crate::models::thz::{ThzComparison, ThzMap};
use crate::models::{ModelError, RegionMeans, TabletSurface, sample_sd};

/// Bins of the profiles round the band and across the caps.
const BINS: usize = 24;

/// What the page is made of.
#[derive(Debug, Clone, Copy)]
pub struct ThzSide<'a> {
    /// Title of the run.
    pub title: &'a str,
    /// The average tablet.
    pub map: &'a ThicknessMap,
    /// The scans, laid on its panels.
    pub scans: &'a [ThzMap],
    /// Both compared.
    pub comparison: &'a ThzComparison,
    /// Cap over band of single simulated tablets.
    pub tablets: &'a [f64],
}

impl ThzSide<'_> {
    /// Standard deviation of the mean cap over band of as many simulated tablets as were measured.
    fn spread(&self) -> Option<f64> {
        sample_sd(self.tablets).map(|sd| sd / (self.scans.len() as f64).sqrt())
    }

    /// The figures of the comparison, in words.
    pub fn figures(&self) -> Vec<(String, String)> {
        let c = self.comparison;
        let points: u32 = self.scans.iter().flat_map(|scan| &scan.points).sum();
        let worst = self.scans.iter().map(|scan| scan.pose.residual).fold(0.0, f64::max);
        let ratio =
            |means: Option<RegionMeans>| means.map_or("–".to_owned(), |m| significant(m.ratio(), 3));
        let rows = [
            ("Tablets measured", self.scans.len().to_string()),
            ("Points on them", points.to_string()),
            ("Worst misfit of a pose", format!("{} µm", significant(1e6 * worst, 2))),
            ("Surface covered", percent(c.covered)),
            ("Factor on the simulated thickness", significant(c.scale, 4)),
            ("CoV, measured", significant(c.measured_cov, 3)),
            ("CoV, simulated", significant(c.simulated_cov, 3)),
            ("Cap over band, measured", ratio(c.measured_regions)),
            ("Cap over band, simulated", ratio(c.simulated_regions)),
            (
                "Cap over band, spread of as many",
                self.spread().map_or("–".to_owned(), |s| format!("± {}", significant(s, 2))),
            ),
            ("Correlation of the maps", significant(c.correlation, 3)),
            ("Mean of (difference/uncertainty)²", significant(c.chi_squared, 3)),
        ];
        rows.map(|(name, value)| (name.to_owned(), value)).into()
    }
}

/// The page: both maps on one scale, their difference in uncertainties, and profiles.
///
/// # Errors
/// [`ModelError`] when the comparison is not one of this map.
pub fn thz_page(side: &ThzSide<'_>) -> Result<String, ModelError> {
    let panels = &side.comparison.panels;
    // A panel that no scan covers takes the lowest colour.
    let spread = |value: &dyn Fn(&crate::models::thz::PanelDifference) -> f64| {
        let mut values = vec![f64::NEG_INFINITY; side.map.areas_mm2.len()];
        for panel in panels {
            values[panel.panel] = value(panel);
        }
        let least = values.iter().copied().filter(|v| v.is_finite()).fold(f64::INFINITY, f64::min);
        values.into_iter().map(|v| v.max(least)).collect::<Vec<f64>>()
    };
    let measured = spread(&|p| 1e6 * p.measured);
    let simulated = spread(&|p| 1e6 * p.simulated);
    let apart = spread(&|p| (p.measured - p.simulated) / p.uncertainty);
    let both = map::Scale::over([&measured, &simulated].into_iter());
    let figure = |id: &str, values: &Vec<f64>, unit: &str, scale, caption: &str| {
        let plot = map::panel_map(side.map, values, unit, scale, map::Size::Small);
        format!("<figure>{}<figcaption>{caption}</figcaption></figure>", chart(id, &plot))
    };
    let maps = [
        figure("measured", &measured, "µm", both, "Measured"),
        figure("simulated", &simulated, "µm", both, "Simulated, at the measured mean"),
        figure(
            "apart",
            &apart,
            "σ",
            map::Scale::over(std::iter::once(&apart)),
            "Measured less simulated, in standard uncertainties of a panel",
        ),
    ];
    let content = format!(
        "<div class=\"three\">{}</div>\n{}<div class=\"three\">{}</div>\n",
        maps.concat(),
        table(&side.figures()),
        profiles(side)?
    );
    let body = section(
        &format!("Measured against simulated: {}", escape(side.title)),
        "Panels that no scan covers have the darkest colour. The uncertainty of a panel holds the scatter of its points and how \
         much single tablets differ from the average: few measured tablets never show it. In the profiles the line is simulated, \
         dashes are measured; bars are the most that their uncertainty can be.",
        &content,
    );
    Ok(document(side.title, &body))
}

/// Profiles over the panels that were measured.
fn profiles(side: &ThzSide<'_>) -> Result<String, ModelError> {
    let (centroids, normals, areas) = side.map.geometry();
    let panels = &side.comparison.panels;
    let centroids: Vec<_> = panels.iter().map(|p| centroids[p.panel]).collect();
    let normals: Vec<_> = panels.iter().map(|p| normals[p.panel]).collect();
    let areas: Vec<f64> = panels.iter().map(|p| areas[p.panel]).collect();
    let on_cap: Vec<bool> = panels.iter().map(|p| side.map.on_cap[p.panel]).collect();
    let surface = TabletSurface::new(&centroids, &normals, &areas, &on_cap)?;
    let thickness = [
        panels.iter().map(|p| 1e6 * p.simulated).collect::<Vec<_>>(),
        panels.iter().map(|p| 1e6 * p.measured).collect(),
        // Of a mean over panels at most the mean of theirs: neighbours on a tablet differ from the average together.
        panels.iter().map(|p| 1e6 * p.uncertainty).collect(),
    ];
    let names = ["simulated", "measured"];
    let pair = |bins: &dyn Fn(&[f64]) -> Result<Vec<_>, ModelError>| {
        thickness.iter().map(|h| bins(h)).collect::<Result<Vec<_>, _>>()
    };
    let charts = [
        ("around", pair(&|h| surface.band_by_angle(h, BINS))?, 1f64.to_degrees(), "around the band, °"),
        ("over", pair(&|h| surface.band_by_height(h, BINS / 3))?, 1e3, "height on the band, mm"),
        ("across", pair(&|h| surface.cap_by_radius(h, BINS / 2))?, 1.0, "across the caps, centre 0 to rim 1"),
    ];
    let place = |(id, bins, unit, axis): &(&str, Vec<_>, f64, &str)| {
        format!("<div>{}</div>", chart(id, &tablet_charts::profile(bins, names, *unit, axis)))
    };
    Ok(charts.iter().map(place).collect::<Vec<_>>().concat())
}
