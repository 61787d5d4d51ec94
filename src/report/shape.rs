//! The page of a tablet shape: its panels, how far its clump is from them, and its measures.

use super::charts::ink;
use super::html::{chart, escape, section, table};
use super::page::document;
use super::tablet_charts::{axis, layout};
use super::{ThicknessMap, map};
use plotly::common::{Line, Mode};
use plotly::layout::AxisType;
use plotly::{Plot, Scatter};

/// The page of the shape `name`: `gaps` are the distances from each panel to the clump, µm; `rows` are measures in words;
/// `errors` are sphere counts with mean and largest distance, µm, and may be empty.
pub fn shape_page(
    name: &str,
    surface: &ThicknessMap,
    gaps: &[f64],
    rows: &[(String, String)],
    errors: &[[f64; 3]],
) -> String {
    let gaps = gaps.to_vec();
    let scale = map::Scale::over(std::iter::once(&gaps));
    let picture = chart("shape", &map::panel_map(surface, &gaps, "µm", scale, map::Size::Large));
    let rows: Vec<(String, String)> = rows.iter().map(|(n, v)| (escape(n), escape(v))).collect();
    let mut content = format!("{picture}<div class=\"sheet\">{}</div>\n", table(&rows));
    if !errors.is_empty() {
        content += &chart("errors", &error_plot(errors));
    }
    let body = section(
        &format!("Shape: {}", escape(name)),
        "The panels that are coated, in the colour of their distance from the clump of spheres that collides. Turn it with \
         the mouse.",
        &content,
    );
    document(name, &body)
}

fn error_plot(errors: &[[f64; 3]]) -> Plot {
    let column = |k: usize| errors.iter().map(|row| row[k]).collect::<Vec<f64>>();
    let mut plot = Plot::new();
    for (k, name, ink) in [(1, "mean", ink::INTRA), (2, "largest", ink::INTER)] {
        let line = Line::new().color(ink).width(2.0);
        plot.add_trace(Scatter::new(column(0), column(k)).mode(Mode::LinesMarkers).name(name).line(line));
    }
    let (x, y) = ("spheres", "distance of surface and clump, µm");
    let log = |title| axis(title).type_(AxisType::Log);
    plot.set_layout(layout(x, y).x_axis(log(x)).y_axis(log(y)));
    plot
}
