//! The sections of a coated shape: where its coating lies, and how its tablets differ.

use super::html::{chart, escape, section, table};
use super::number::{signed, significant};
use super::{Exponent, ShapeCoating, ThicknessMap, map, tablet_charts};
use crate::models::{AndersonDarling, TabletSurface, tablets_to_measure};
use plotly::Plot;
use std::fmt::Write;

/// Bins of the profiles.
const BINS: usize = 24;

/// All sections of the shape with this number.
pub(super) fn sections(number: usize, shape: &ShapeCoating) -> String {
    let Some(thickness) = &shape.map else { return String::new() };
    where_it_lies(number, shape, thickness) + &from_tablet_to_tablet(number, shape, thickness)
}

fn where_it_lies(number: usize, shape: &ShapeCoating, thickness: &ThicknessMap) -> String {
    let without = thickness.others.get(ThicknessMap::WITHOUT_SHADOWS);
    let scale = map::Scale::over([Some(&thickness.average_um), without].into_iter().flatten());
    let average = map::panel_map(thickness, &thickness.average_um, "µm", scale, map::Size::Large);
    let mut content = format!(
        "<div class=\"pair\"><div>{}</div><div>{}</div></div>\n",
        chart(&format!("map-{number}"), &average),
        table(&facts(shape, thickness))
    );
    content += &profiles(number, thickness, without).unwrap_or_default();
    if let Some(without) = without {
        let plot = map::panel_map(thickness, without, "µm", scale, map::Size::Small);
        let _ = writeln!(
            content,
            "<div class=\"pair\"><div>{}</div><p>What the same tablets would carry if neighbours cast no shadow, on the same scale: \
             each panel by how it was turned to the spray. Shadows even the coating out.</p></div>",
            chart(&format!("without-{number}"), &plot)
        );
    }
    section(
        &format!("Where the coating lies: {}", escape(&shape.name)),
        "The average tablet of the batch. Turn it with the mouse; point at a panel for its thickness.",
        &content,
    )
}

fn facts(shape: &ShapeCoating, thickness: &ThicknessMap) -> Vec<(String, String)> {
    let mut rows = Vec::new();
    let mut row = |name: &str, value: String| rows.push((name.to_string(), value));
    let um = |value: f64| format!("{} µm", significant(value, 3));
    if let Some(means) = thickness.regions() {
        row("Mean on the caps", um(means.cap));
        row("Mean on the band", um(means.band));
        row("Cap over band", significant(means.ratio(), 3));
    }
    let without = [
        ("Limit of CoV<sub>intra</sub> without shadows", shape.orientation_only),
        ("The same by Monte Carlo, 400 trials", shape.orientation_monte_carlo),
        ("The same from the order tensor", shape.order_tensor),
    ];
    for (name, cov) in without {
        if let Some(cov) = cov {
            row(name, significant(cov, 3));
        }
    }
    let mut sorted = thickness.average_um.clone();
    sorted.sort_by(f64::total_cmp);
    if let (Some(least), Some(most)) = (sorted.first(), sorted.last()) {
        row("Thinnest panel", um(*least));
        row("Thickest panel", um(*most));
        row("Panels", sorted.len().to_string());
    }
    rows
}

/// Thickness around the band, over its height, and across the caps; none for a shape without both.
fn profiles(number: usize, thickness: &ThicknessMap, without: Option<&Vec<f64>>) -> Option<String> {
    thickness.regions()?;
    let (centroids, normals, areas) = thickness.geometry();
    let surface = TabletSurface::new(&centroids, &normals, &areas, &thickness.on_cap).ok()?;
    let maps = || std::iter::once(&thickness.average_um).chain(without);
    let around = maps().map(|h| surface.band_by_angle(h, BINS)).collect::<Result<Vec<_>, _>>().ok()?;
    let over = maps().map(|h| surface.band_by_height(h, BINS / 3)).collect::<Result<Vec<_>, _>>().ok()?;
    let across = maps().map(|h| surface.cap_by_radius(h, BINS / 2)).collect::<Result<Vec<_>, _>>().ok()?;
    let place = |name: &str, plot: &Plot| format!("<div>{}</div>", chart(&format!("{name}-{number}"), plot));
    let names = ["average tablet", "without shadows"];
    let charts = [
        place("around", &tablet_charts::profile(&around, names, 1f64.to_degrees(), "around the band, °")),
        place("over", &tablet_charts::profile(&over, names, 1e3, "height on the band, mm")),
        place("across", &tablet_charts::profile(&across, names, 1.0, "across the caps, centre 0 to rim 1")),
    ];
    Some(format!("<div class=\"three\">{}</div>\n", charts.concat()))
}

fn from_tablet_to_tablet(number: usize, shape: &ShapeCoating, thickness: &ThicknessMap) -> String {
    let covs: Vec<f64> = shape.tablets.iter().filter_map(|t| t.cov_intra).collect();
    if covs.len() < 8 {
        return String::new();
    }
    let mut content = format!(
        "<div class=\"pair\"><div>{}</div><div>{}</div></div>\n",
        chart(&format!("spread-{number}"), &tablet_charts::distribution(&covs)),
        table(&spread(shape, &covs))
    );
    let singles: Vec<Vec<f64>> = ThicknessMap::SINGLE
        .iter()
        .filter_map(|name| thickness.relative(thickness.others.get(*name)?))
        .collect();
    if singles.len() == ThicknessMap::SINGLE.len() {
        let scale = map::Scale::over(singles.iter());
        let captions = ["The most uniform tablet", "The median tablet", "The least uniform tablet"];
        let tablet = |(k, (caption, h)): (usize, (&str, &Vec<f64>))| {
            let plot = map::panel_map(thickness, h, "× mean", scale, map::Size::Small);
            format!(
                "<figure>{}<figcaption>{caption}</figcaption></figure>",
                chart(&format!("single-{number}-{k}"), &plot)
            )
        };
        let figures: Vec<String> = captions.into_iter().zip(&singles).enumerate().map(tablet).collect();
        let _ = writeln!(content, "<div class=\"three\">{}</div>", figures.concat());
    }
    section(
        &format!("From tablet to tablet: {}", escape(&shape.name)),
        "Single tablets differ from the average one: CoV of the thickness over each tablet’s own surface, and \
         three of them, each relative to its own mean thickness.",
        &content,
    )
}

fn spread(shape: &ShapeCoating, covs: &[f64]) -> Vec<(String, String)> {
    let (mean, sd) = tablet_charts::mean_and_sd(covs);
    let mut rows = vec![
        ("Tablets".to_string(), shape.tablets.len().to_string()),
        ("Mean CoV<sub>intra,i</sub>".to_string(), significant(mean, 3)),
        ("Standard deviation".to_string(), significant(sd, 3)),
    ];
    let exponent =
        |e: &Exponent| format!("{} <i>({} to {})</i>", signed(e.value), signed(e.low), signed(e.high));
    if let Some(fit) = &shape.spread_exponent {
        rows.push(("It falls as time to the power".to_string(), exponent(fit)));
    }
    if let Some(fit) = &shape.inter_exponent {
        rows.push(("CoV<sub>inter</sub> falls as time to the power".to_string(), exponent(fit)));
    }
    if let Some(cov) = shape.residence_cov {
        rows.push(("CoV of the time in the spray".to_string(), significant(cov, 3)));
    }
    if let Ok(test) = AndersonDarling::test(covs) {
        let verdict = if test.p_value < 0.05 { "not normal" } else { "normal" };
        rows.push((
            "Distribution (Anderson–Darling)".to_string(),
            format!("{verdict}, p = {}", significant(test.p_value, 2)),
        ));
    }
    let measure = |error: f64| tablets_to_measure(sd / mean, error).min(shape.tablets.len() as u64);
    for (error, name) in [(0.1, "± 10 %"), (0.05, "± 5 %")] {
        rows.push((format!("Tablets to measure for {name}"), measure(error).to_string()));
    }
    rows
}
