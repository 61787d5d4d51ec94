//! `pancoat predict`: how uniform the tablets of a run can get, when, and how many to measure.

use super::args::PredictArgs;
use super::failure::Failure;
use super::print_line;
use crate::models::{Asymptote, SeriesRow, mean_95, sample_sd, tablets_to_measure};
use crate::report::{Limit, ReportData, ShapeCoating};

pub(super) fn predict(args: &PredictArgs) -> Result<(), Failure> {
    let mut runs: Vec<(ReportData, SeriesRow)> = Vec::new();
    for directory in &args.directories {
        let data = ReportData::read(directory)?;
        let Some(&last) = data.series.last() else {
            return Err(Failure::NothingCoated(directory.clone()));
        };
        if let Some(same) = runs.iter().position(|(other, _)| other.series == data.series) {
            return Err(Failure::SameRun([args.directories[same].clone(), directory.clone()]));
        }
        runs.push((data, last));
    }
    for (data, last) in &runs {
        one_bed(data, last, args)?;
    }
    if runs.len() > 1 { all_beds(&runs, args.target) } else { Ok(()) }
}

fn one_bed(data: &ReportData, last: &SeriesRow, args: &PredictArgs) -> Result<(), Failure> {
    print_line(&format!("{}, after {} of spray", data.title, time(last.time_s)))?;
    for (number, shape) in data.shapes.iter().enumerate() {
        let mut lines = Vec::new();
        if let Some(limit) = &shape.limit {
            lines.extend(approach(limit, args.target));
        } else {
            lines.push((
                "limit of CoV_intra",
                "not known yet: it takes two blocks of at least 2 s".to_owned(),
            ));
        }
        let without = [shape.orientation_only, shape.orientation_monte_carlo, shape.order_tensor];
        if let [Some(exact), Some(played), Some(order)] = without {
            let text = format!("{exact:.3} (Monte Carlo {played:.3}, order tensor {order:.3})");
            lines.push(("without shadows", text));
        }
        // The series is that of the first shape.
        if number == 0 {
            lines.push(("CoV_intra now", format!("{:.3}", last.cov_intra)));
            lines.push(("CoV_inter now", format!("{:.3}", last.cov_inter)));
            lines.extend(inter_in_time(shape, (last.time_s, last.cov_inter), args.target));
        }
        lines.extend(to_measure(shape, args.error));
        print(&shape.name, &lines)?;
    }
    Ok(())
}

/// What several beds of one kind say together.
fn all_beds(runs: &[(ReportData, SeriesRow)], target: f64) -> Result<(), Failure> {
    print_line(&format!("all {} beds", runs.len()))?;
    for shape in &runs[0].0.shapes {
        let of_run =
            |(run, _): &(ReportData, SeriesRow)| run.shapes.iter().find(|s| s.name == shape.name)?.limit;
        let limits: Option<Vec<Limit>> = runs.iter().map(of_run).collect();
        let lines = limits.and_then(|limits| together(&limits, target));
        let unknown = || vec![("limit of CoV_intra", "not known of all beds".to_owned())];
        print(&shape.name, &lines.unwrap_or_else(unknown))?;
    }
    Ok(())
}

/// The limit of several beds: their own scatter tells how sure it is.
fn together(limits: &[Limit], target: f64) -> Option<Vec<Line>> {
    let covs: Vec<f64> = limits.iter().map(|limit| limit.value).collect();
    let ((value, half), sd) = (mean_95(&covs)?, sample_sd(&covs)?);
    let noise: Option<f64> = limits.iter().map(|limit| limit.noise_time_s).sum();
    let noise_time_s = noise.map(|sum| sum / limits.len() as f64);
    let limit = Limit { value, low: (value - half).max(0.0), high: value + half, noise_time_s };
    let mut lines = approach(&limit, target);
    lines.push(("one bed lies off by", format!("{:.1} % (standard deviation)", 100.0 * sd / value)));
    Some(lines)
}

fn print(shape: &str, lines: &[Line]) -> Result<(), Failure> {
    print_line(shape)?;
    lines.iter().try_for_each(|(name, text)| print_line(&format!("  {name:<26}{text}")))
}

type Line = (&'static str, String);

/// The limit, and when CoV_intra comes near it and to the target; intervals are those of the limit.
fn approach(limit: &Limit, target: f64) -> Vec<Line> {
    let mut lines =
        vec![("limit of CoV_intra", format!("{:.4} ({:.4} to {:.4})", limit.value, limit.low, limit.high))];
    let Some(noise_time) = limit.noise_time_s else { return lines };
    let law = |cov: f64| Asymptote { cov_squared: cov * cov, noise_time };
    lines.push(("noise K", format!("{noise_time:.2} s, CoV_intra^2 = limit^2 + K/t")));
    let within = law(limit.value).time_within(0.1);
    lines.push((
        "within 10 % of the limit",
        within.map_or_else(|| "the limit may be 0".to_owned(), |t| format!("after {}", time(t))),
    ));
    let [soonest, expected, latest] =
        [limit.low, limit.value, limit.high].map(|cov| law(cov).time_to(target));
    let text = match (soonest, expected, latest) {
        (Some(soonest), Some(t), Some(latest)) => {
            format!("{target} after {} ({} to {})", time(t), time(soonest), time(latest))
        }
        (Some(soonest), ..) => format!("{target} perhaps never, not before {}", time(soonest)),
        _ => format!("{target} never: the limit is above it"),
    };
    lines.push(("CoV_intra", text));
    lines
}

/// When CoV_inter, which is `cov` after `now` s, comes to the target by its power law.
fn inter_in_time(shape: &ShapeCoating, (now, cov): (f64, f64), target: f64) -> Option<Line> {
    let exponent = shape.inter_exponent?;
    if cov <= target {
        return Some(("CoV_inter", format!("{target} is reached")));
    }
    let when = |power: f64| (power < 0.0).then(|| now * (target / cov).powf(1.0 / power));
    let [expected, soonest, latest] =
        [exponent.value, exponent.low, exponent.high].map(|p| when(p).map_or("never".to_owned(), time));
    Some(("CoV_inter", format!("{target} after {expected} ({soonest} to {latest})")))
}

/// Tablets to measure for a relative error at 95 % confidence: of the mean thickness, and of the mean CoV_intra,i.
fn to_measure(shape: &ShapeCoating, error: f64) -> Vec<Line> {
    let covs: Vec<f64> = shape.tablets.iter().filter_map(|t| t.cov_intra).collect();
    let means: Vec<f64> = shape.tablets.iter().map(|t| t.mean_thickness_um).collect();
    let line = |name, values: &[f64]| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let sd = sample_sd(values).filter(|_| mean > 0.0)?;
        Some((name, format!("{} for +-{:.0} %", tablets_to_measure(sd / mean, error), 100.0 * error)))
    };
    [line("to measure, thickness", &means), line("to measure, CoV_intra,i", &covs)]
        .into_iter()
        .flatten()
        .collect()
}

fn time(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.1} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}
