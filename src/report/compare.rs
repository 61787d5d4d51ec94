//! The page that puts the shapes of several runs side by side: limits against shape measures.

use super::charts::ink;
use super::html::{chart, escape, section};
use super::number::significant;
use super::page::document;
use super::tablet_charts::{axis, layout};
use super::{Limit, ReportData, ThicknessMap};
use crate::models::Spearman;
use nalgebra::Vector3;
use plotly::common::{ErrorData, ErrorType, Marker, Mode};
use plotly::layout::RangeMode;
use plotly::{Plot, Scatter};
use std::f64::consts::PI;

/// One shape of one run.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedShape {
    /// Title of the run.
    pub run: String,
    /// Name of the shape in its scene.
    pub shape: String,
    /// Coated time, s.
    pub time_s: f64,
    /// CoV_intra (Eq 8) and CoV_inter at the end; known of a run's first shape.
    pub covs: Option<(f64, f64)>,
    /// The limit of CoV_intra.
    pub limit: Option<Limit>,
    /// Limit of the orientation-only model.
    pub orientation_only: Option<f64>,
    /// Mean thickness of the caps over that of the band.
    pub cap_to_band: Option<f64>,
    /// Sphericity, aspect ratio and band over face area (Freireich et al. 2015, Table 4), of the panels; `None` where
    /// the shape has no band.
    pub measures: [Option<f64>; 3],
}

/// Shape measures in words.
pub const MEASURES: [&str; 3] = ["sphericity", "aspect ratio", "band over face area"];

impl ComparedShape {
    /// The shapes of a run; none without coating.
    pub fn of(data: &ReportData) -> Vec<Self> {
        let Some(last) = data.series.last() else { return Vec::new() };
        let shape = |(number, shape): (usize, &super::ShapeCoating)| Self {
            run: data.title.clone(),
            shape: shape.name.clone(),
            time_s: last.time_s,
            covs: (number == 0).then_some((last.cov_intra, last.cov_inter)),
            limit: shape.limit,
            orientation_only: shape.orientation_only,
            cap_to_band: shape.map.as_ref().and_then(ThicknessMap::regions).map(|means| means.ratio()),
            measures: shape.map.as_ref().map_or([None; 3], measures),
        };
        data.shapes.iter().enumerate().map(shape).collect()
    }

    /// Rank correlation of the limit with each of [`MEASURES`]; `None` below three shapes that have both.
    pub fn correlations(shapes: &[Self]) -> [Option<Spearman>; 3] {
        [0, 1, 2].map(|k| {
            let pairs = shapes.iter().filter_map(|s| s.measures[k].zip(s.limit.map(|limit| limit.value)));
            let (x, y): (Vec<f64>, Vec<f64>) = pairs.unzip();
            Spearman::test(&x, &y).ok()
        })
    }
}

/// Table 4 measures of the panels.
fn measures(map: &ThicknessMap) -> [Option<f64>; 3] {
    let corner = |v: u32| Vector3::from(map.vertices_mm[v as usize]);
    let (mut low, mut high) = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
    for vertex in &map.vertices_mm {
        (low, high) = (low.inf(&Vector3::from(*vertex)), high.sup(&Vector3::from(*vertex)));
    }
    let extents = high - low;
    let six_volumes: f64 =
        map.triangles.iter().map(|&[a, b, c]| corner(a).dot(&corner(b).cross(&corner(c)))).sum();
    let area: f64 = map.areas_mm2.iter().sum();
    let cap: f64 = map.areas_mm2.iter().zip(&map.on_cap).filter(|(_, cap)| **cap).map(|(a, _)| a).sum();
    [
        Some((PI * six_volumes * six_volumes).cbrt() / area),
        Some((extents.x + extents.y) / (2.0 * extents.z)),
        (cap > 0.0 && cap < area).then(|| (area - cap) / cap),
    ]
}

/// The page: limits of all shapes, and against each measure with the rank correlation and its p-value.
pub fn comparison_page(shapes: &[ComparedShape]) -> String {
    let head = "<tr><td>Run</td><td>Shape</td><td>Spray</td><td>CoV<sub>intra</sub></td><td>CoV<sub>inter</sub></td>\
                <td>Limit (95 %)</td><td>Without shadows</td><td>Cap over band</td></tr>";
    let number = |value: Option<f64>| value.map_or("–".to_owned(), |v| significant(v, 3));
    let row = |s: &ComparedShape| {
        let limit = s.limit.map_or("–".to_owned(), |l| {
            let [value, low, high] = [l.value, l.low, l.high].map(|v| significant(v, 3));
            format!("{value} <i>({low} to {high})</i>")
        });
        let cells = [
            escape(&s.run),
            escape(&s.shape),
            format!("{} s", significant(s.time_s, 3)),
            number(s.covs.map(|c| c.0)),
            number(s.covs.map(|c| c.1)),
            limit,
            number(s.orientation_only),
            number(s.cap_to_band),
        ];
        format!("<tr>{}</tr>", cells.map(|cell| format!("<td>{cell}</td>")).concat())
    };
    let rows: Vec<String> = shapes.iter().map(row).collect();
    let mut body = section(
        "Runs side by side",
        "CoV at the end of each run, and the limit that CoV of a tablet’s surface tends to.",
        &format!("<table>{head}{}</table>\n", rows.concat()),
    );
    let correlations = ComparedShape::correlations(shapes);
    let figure = |k: usize| {
        let told = correlations[k].map_or_else(
            || "fewer than three shapes: no rank correlation".to_owned(),
            |s| format!("rank correlation ρ = {}, p = {}", significant(s.rho, 2), significant(s.p_value, 2)),
        );
        let plot = chart(&format!("measure-{k}"), &against(shapes, k));
        format!("<figure>{plot}<figcaption>{}: {told}</figcaption></figure>", MEASURES[k])
    };
    let charts = [0, 1, 2].map(figure).concat();
    body += &section(
        "Limit against shape",
        "What of a shape sets its limit? Bars are 95 % intervals. With few shapes no correlation can be told from chance: \
         look at p.",
        &format!("<div class=\"three\">{charts}</div>\n"),
    );
    document("Runs compared", &body)
}

fn against(shapes: &[ComparedShape], k: usize) -> Plot {
    let points = shapes.iter().filter_map(|s| Some((s.measures[k]?, s.limit?, s.shape.clone())));
    let (mut x, mut y, mut up, mut down, mut names) = (vec![], vec![], vec![], vec![], vec![]);
    for (measure, limit, name) in points {
        x.push(measure);
        y.push(limit.value);
        up.push(limit.high - limit.value);
        down.push(limit.value - limit.low);
        names.push(name);
    }
    let bars = ErrorData::new(ErrorType::Data).array(up).array_minus(down).symmetric(false).color(ink::GUIDE);
    let mut plot = Plot::new();
    plot.add_trace(
        Scatter::new(x, y)
            .mode(Mode::MarkersText)
            .text_array(names)
            .text_position(plotly::common::Position::TopCenter)
            .marker(Marker::new().color(ink::INTRA).size(9))
            .error_y(bars)
            .show_legend(false),
    );
    let limit = "limit of CoV<sub>intra</sub>";
    plot.set_layout(layout(MEASURES[k], limit).y_axis(axis(limit).range_mode(RangeMode::ToZero)));
    plot
}
