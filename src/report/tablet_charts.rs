//! Charts of a shape's tablets: profiles over their surface, and how they differ.

use super::charts::ink;
use crate::models::ProfileBin;
use plotly::common::{DashType, ErrorData, ErrorType, Font, Line, Marker, Mode, Title};
use plotly::layout::{Axis, Margin, RangeMode};
use plotly::{Bar, Layout, Plot, Scatter};

/// One or two profiles with their names; places are multiplied by `unit`. A third one is the uncertainty of the second.
pub(super) fn profile(profiles: &[Vec<ProfileBin>], names: [&str; 2], unit: f64, place: &str) -> Plot {
    let errors = profiles.get(2).map(|bins| bins.iter().map(|bin| bin.mean).collect::<Vec<_>>());
    let mut plot = Plot::new();
    let lines = [
        Line::new().color(ink::INTRA).width(2.4),
        Line::new().color(ink::GUIDE).width(1.6).dash(DashType::Dash),
    ];
    for (k, ((bins, name), line)) in profiles.iter().zip(names).zip(lines).enumerate() {
        let (x, y) = bins.iter().map(|bin| (bin.at * unit, bin.mean)).unzip::<f64, f64, Vec<_>, Vec<_>>();
        let mut curve = Scatter::new(x, y).mode(Mode::Lines).name(name).line(line).show_legend(false);
        if let (1, Some(errors)) = (k, &errors) {
            curve = curve.error_y(ErrorData::new(ErrorType::Data).array(errors.clone()).color(ink::GUIDE));
        }
        plot.add_trace(curve);
    }
    plot.set_layout(
        layout(place, "thickness, µm").y_axis(axis("thickness, µm").range_mode(RangeMode::ToZero)),
    );
    plot
}

/// How CoV_intra,i is distributed over tablets, with the normal distribution of the same mean and spread.
pub(super) fn distribution(covs: &[f64]) -> Plot {
    let (mean, sd) = mean_and_sd(covs);
    let n = covs.len() as f64;
    // Bins of about Scott's width (Scott 1979, Biometrika 66, 605), 3.49 sd n^(-1/3), over four deviations either way.
    let width = 3.49 * sd / n.cbrt();
    let half = (4.0 * sd / width).ceil();
    let place = |k: f64| mean + (k - half) * width;
    let bins = 2 * half as usize + 1;
    let mut counts = vec![0.0; bins];
    for cov in covs {
        counts[(((cov - mean) / width + half).round().max(0.0) as usize).min(bins - 1)] += 1.0;
    }
    let centers: Vec<f64> = (0..bins).map(|k| place(k as f64)).collect();
    let curve: Vec<f64> = (0..=100).map(|k| mean + (f64::from(k) / 50.0 - 1.0) * 4.0 * sd).collect();
    let density =
        |x: &f64| n * width / (sd * std::f64::consts::TAU.sqrt()) * (-0.5 * ((x - mean) / sd).powi(2)).exp();
    let normal = curve.iter().map(density).collect();
    let mut plot = Plot::new();
    plot.add_trace(
        Bar::new(centers, counts).name("tablets").marker(Marker::new().color(ink::BAR)).show_legend(false),
    );
    let line = Line::new().color(ink::INTRA).width(1.8);
    plot.add_trace(
        Scatter::new(curve, normal).mode(Mode::Lines).name("normal").line(line).show_legend(false),
    );
    plot.set_layout(layout("CoV<sub>intra,i</sub>", "tablets").y_axis(axis("tablets")).bar_gap(0.08));
    plot
}

/// Mean and sample standard deviation of at least two values.
pub(super) fn mean_and_sd(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt())
}

/// An axis as all small charts have it.
pub(super) fn axis(title: &str) -> Axis {
    Axis::new().title(Title::with_text(title)).grid_color(ink::GRID).line_color(ink::GUIDE).zero_line(false)
}

/// The layout of a small chart, by what its axes say.
pub(super) fn layout(x: &str, y: &str) -> Layout {
    Layout::new()
        .x_axis(axis(x))
        .y_axis(axis(y))
        .height(300)
        .font(Font::new().family("system-ui, sans-serif").size(12).color(ink::TEXT))
        .paper_background_color("#ffffff")
        .plot_background_color("#ffffff")
        .margin(Margin::new().left(56).right(12).top(28).bottom(48))
}
