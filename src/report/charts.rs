//! Line charts of a report.

use super::ReportData;
use super::number::significant;
use super::verdict::inter_law;
use crate::models::{Asymptote, SeriesRow};
use plotly::common::{DashType, Fill, Font, Line, Mode, Title};
use plotly::layout::{Axis, AxisType, HoverMode, Legend, Margin};
use plotly::{Layout, Plot, Scatter};

/// Colours of the page, one meaning each.
pub(super) mod ink {
    pub(crate) const TEXT: &str = "#1f2a3a";
    pub(crate) const GRID: &str = "#e6e9ee";
    pub(crate) const INTRA: &str = "#2b5fa8";
    pub(crate) const INTER: &str = "#c4622d";
    pub(crate) const AVERAGE: &str = "#3a8f85";
    pub(crate) const TOTAL: &str = "#8a6fb0";
    pub(crate) const GUIDE: &str = "#98a2b3";
    pub(crate) const BAR: &str = "#c3d3ea";
    pub(crate) const BAND: &str = "rgba(43,95,168,0.13)";
}

/// CoV_intra and CoV_inter over time with their limits, on log-log paper.
pub(super) fn uniformity(data: &ReportData) -> Plot {
    let mut plot = Plot::new();
    let times = axis_times(data);
    let several = data.shapes.len() > 1;
    for shape in &data.shapes {
        let name = |what: &str| if several { format!("{what}, {}", shape.name) } else { what.to_string() };
        if let Some(limit) = &shape.limit {
            let ends = vec![times[0], times[times.len() - 1]];
            // An end of the interval at zero has no place on log paper: the band then runs off the chart.
            let low = Scatter::new(ends.clone(), vec![limit.low.max(1e-6); 2]).mode(Mode::Lines);
            plot.add_trace(low.line(Line::new().width(0.0)).show_legend(false).hover_info(skip()));
            let high = Scatter::new(ends.clone(), vec![limit.high; 2])
                .mode(Mode::Lines)
                .line(Line::new().width(0.0));
            plot.add_trace(
                high.fill(Fill::ToNextY)
                    .fill_color(ink::BAND)
                    .name(name("95 % interval of the limit"))
                    .hover_info(skip()),
            );
            plot.add_trace(rule(ends, limit.value, &name("limit of CoV_intra"), ink::INTRA, DashType::Dash));
            if let Some(noise_time) = limit.noise_time_s {
                let law = Asymptote { cov_squared: limit.value.powi(2), noise_time };
                let values = times.iter().map(|&t| law.after(t)).collect();
                let line = Line::new().color(ink::INTRA).width(1.2).dash(DashType::Dot);
                plot.add_trace(curve(times.clone(), values, &name("expected CoV_intra"), line));
            }
        }
        if let Some(value) = shape.orientation_only {
            let ends = vec![times[0], times[times.len() - 1]];
            plot.add_trace(rule(
                ends,
                value,
                &name("limit without shadowing"),
                ink::GUIDE,
                DashType::DashDot,
            ));
        }
    }
    plot.add_trace(measured(data, "CoV_intra", ink::INTRA, |r| Some(r.cov_intra)));
    plot.add_trace(measured(data, "CoV_intra of the average tablet", ink::AVERAGE, |r| {
        Some(r.cov_intra_average_tablet)
    }));
    plot.add_trace(measured(data, "CoV_inter", ink::INTER, |r| Some(r.cov_inter)));
    if let Some(last) = data.series.last() {
        // Half a decade of t^-1/2 through the last point of CoV_inter, or the fitted law where there is one.
        let at_last = inter_law(data).map_or(last.cov_inter, |law| law.at(last.time_s));
        let guide = times.iter().map(|t| at_last * (last.time_s / t).sqrt()).collect();
        let line = Line::new().color(ink::GUIDE).width(1.0).dash(DashType::Dot);
        plot.add_trace(curve(times, guide, "time to the power −1/2", line));
    }
    let axis = log_axis("coefficient of variation");
    plot.set_layout(over_time(match range(data) {
        Some(range) => axis.range(range),
        None => axis,
    }));
    plot
}

/// Powers of ten between which all that was measured and the limits lie. An interval of a limit that reaches far down, as in short
/// runs, runs off the chart.
fn range(data: &ReportData) -> Option<Vec<f64>> {
    let measured = data.series.iter().flat_map(|r| [r.cov_intra, r.cov_intra_average_tablet, r.cov_inter]);
    let limits = data.shapes.iter().filter_map(|shape| Some(shape.limit.as_ref()?.value));
    let shown = measured.chain(limits).filter(|value| *value > 0.0).map(f64::log10);
    let ends = shown.map(|value| (value - 0.2, value + 0.2));
    ends.reduce(|(low, high), (l, h)| (low.min(l), high.max(h))).map(|(low, high)| vec![low, high])
}

/// The four averages of the appendix over time.
pub(super) fn schemes(data: &ReportData) -> Plot {
    let mut plot = Plot::new();
    plot.add_trace(measured(data, "total area", ink::TOTAL, |r| Some(r.cov_total)));
    plot.add_trace(measured(data, "averaging moments (CoV_intra)", ink::INTRA, |r| Some(r.cov_intra)));
    plot.add_trace(measured(data, "each tablet", ink::INTER, |r| r.cov_intra_each));
    plot.add_trace(measured(data, "average tablet", ink::AVERAGE, |r| Some(r.cov_intra_average_tablet)));
    plot.add_trace(measured(data, "spread of CoV_intra,i between tablets", ink::GUIDE, |r| r.sd_cov_intra));
    plot.set_layout(over_time(log_axis("coefficient of variation")));
    plot
}

/// Times from the first row to three times the last, evenly on log paper.
fn axis_times(data: &ReportData) -> Vec<f64> {
    let ends = data.series.first().zip(data.series.last());
    let (first, last) = ends.map_or((1.0, 10.0), |(a, b)| (a.time_s.max(1e-3), 3.0 * b.time_s));
    (0..=60).map(|k| first * (last / first).powf(f64::from(k) / 60.0)).collect()
}

fn measured(
    data: &ReportData,
    name: &str,
    color: &'static str,
    value: impl Fn(&SeriesRow) -> Option<f64>,
) -> Box<Scatter<f64, f64>> {
    let points = data.series.iter().filter_map(|r| Some((r.time_s, value(r)?))).filter(|p| p.1 > 0.0);
    let (x, y) = points.unzip();
    curve(x, y, name, Line::new().color(color).width(2.4))
}

fn curve(x: Vec<f64>, y: Vec<f64>, name: &str, line: Line) -> Box<Scatter<f64, f64>> {
    Scatter::new(x, y).mode(Mode::Lines).name(html_name(name)).line(line)
}

fn rule(
    ends: Vec<f64>,
    value: f64,
    name: &str,
    color: &'static str,
    dash: DashType,
) -> Box<Scatter<f64, f64>> {
    curve(ends, vec![value; 2], name, Line::new().color(color).width(1.4).dash(dash))
}

/// `CoV_intra` with a real subscript.
fn html_name(name: &str) -> String {
    let subscript = |name: String, s: &str| name.replace(&format!("CoV_{s}"), &format!("CoV<sub>{s}</sub>"));
    ["intra,i", "intra", "inter"].into_iter().fold(name.to_string(), subscript)
}

fn skip() -> plotly::common::HoverInfo {
    plotly::common::HoverInfo::Skip
}

fn over_time(y: Axis) -> Layout {
    Layout::new()
        .x_axis(log_axis("coated time, s"))
        .y_axis(y)
        .height(460)
        .hover_mode(HoverMode::X)
        .font(Font::new().family("system-ui, sans-serif").size(13).color(ink::TEXT))
        .paper_background_color("#ffffff")
        .plot_background_color("#ffffff")
        .legend(Legend::new().x(0.01).y(-0.18).orientation(plotly::common::Orientation::Horizontal))
        .margin(Margin::new().left(64).right(16).top(12).bottom(48))
}

fn log_axis(title: &str) -> Axis {
    // 1, 2 and 5 of every decade that a run may show.
    let ticks: Vec<f64> =
        (-4..6).flat_map(|decade| [1.0, 2.0, 5.0].map(|m| m * 10f64.powi(decade))).collect();
    let labels = ticks.iter().map(|&tick| significant(tick, 1)).collect();
    Axis::new()
        .title(Title::with_text(title))
        .type_(AxisType::Log)
        .grid_color(ink::GRID)
        .line_color(ink::GUIDE)
        .tick_values(ticks)
        .tick_text(labels)
        .zero_line(false)
}
