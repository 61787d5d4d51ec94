//! Error against CPU time, both in powers of ten, as an SVG picture.

use super::study::Row;
use std::fmt::Write;

const SIZE: [f64; 2] = [640.0, 420.0];
const MARGIN: [f64; 4] = [70.0, 20.0, 20.0, 55.0];
/// Powers of ten at the ends of the axes: CPU ms a frame, errors.
const TIME: [f64; 2] = [-1.0, 3.0];
const ERROR: [f64; 2] = [-5.0, 1.0];

/// One curve.
struct Curve<'a> {
    study: &'a str,
    name: &'a str,
    color: &'a str,
    error: fn(&Row) -> Option<f64>,
}

/// The picture; the `default` raster is ringed.
pub(crate) fn page(rows: &[Row], default: [u32; 2]) -> String {
    let curves = [
        Curve {
            study: "resolution",
            name: "panel areas of one frame",
            color: "#1f77b4",
            error: |r| r.frame_error,
        },
        Curve {
            study: "ratio",
            name: "the same by the ratio estimator",
            color: "#d62728",
            error: |r| r.frame_error,
        },
        Curve {
            study: "resolution",
            name: "panel thickness of the run",
            color: "#2ca02c",
            error: |r| r.run_error,
        },
        Curve {
            study: "resolution",
            name: "CoV of the average tablet",
            color: "#9467bd",
            error: |r| r.bias_average_tablet.map(f64::abs),
        },
        Curve {
            study: "resolution",
            name: "CoV_intra",
            color: "#8c564b",
            error: |r| r.bias_intra.map(f64::abs),
        },
    ];
    let [width, height] = SIZE;
    let [left, top, right, bottom] = MARGIN;
    let place = |value: f64, [low, high]: [f64; 2]| (value.log10() - low) / (high - low);
    let x = |ms: f64| left + place(ms, TIME) * (width - left - right);
    let y = |error: f64| height - bottom - place(error, ERROR) * (height - top - bottom);
    let mut svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {width} {height}' font-family='sans-serif' font-size='12'>\n\
         <rect width='{width}' height='{height}' fill='white'/>\n"
    );
    let mut line = |text: std::fmt::Arguments<'_>| writeln!(svg, "{text}").expect("a string takes all");
    for power in TIME[0] as i32..=TIME[1] as i32 {
        let (at, end) = (x(10_f64.powi(power)), height - bottom);
        line(format_args!("<path d='M{at:.1} {top}V{end}' stroke='#ddd'/>"));
        line(format_args!(
            "<text x='{at:.1}' y='{}' text-anchor='middle'>{}</text>",
            end + 18.0,
            10_f64.powi(power)
        ));
    }
    for power in ERROR[0] as i32..=ERROR[1] as i32 {
        let (at, end) = (y(10_f64.powi(power)), width - right);
        line(format_args!("<path d='M{left} {at:.1}H{end}' stroke='#ddd'/>"));
        let percent = 100.0 * 10_f64.powi(power);
        line(format_args!(
            "<text x='{}' y='{:.1}' text-anchor='end'>{percent} %</text>",
            left - 6.0,
            at + 4.0
        ));
    }
    let (middle, foot) = (f64::midpoint(left, width - right), height - 12.0);
    line(format_args!("<text x='{middle}' y='{foot}' text-anchor='middle'>CPU time of a frame, ms</text>"));
    for (k, curve) in curves.iter().enumerate() {
        let color = curve.color;
        let points: Vec<_> = rows
            .iter()
            .filter(|row| row.study == curve.study)
            .filter_map(|row| {
                let error = (curve.error)(row).filter(|error| error.log10() > ERROR[0])?;
                Some((x(row.cpu_ms_per_frame), y(error), [row.columns, row.rows] == default))
            })
            .collect();
        let path: Vec<_> = points.iter().map(|(x, y, _)| format!("{x:.1},{y:.1}")).collect();
        line(format_args!("<polyline points='{}' fill='none' stroke='{color}'/>", path.join(" ")));
        for (x, y, ringed) in points {
            let (radius, fill) = if ringed { (6, "none") } else { (3, color) };
            line(format_args!(
                "<circle cx='{x:.1}' cy='{y:.1}' r='{radius}' fill='{fill}' stroke='{color}'/>"
            ));
        }
        let at = top + 16.0 + 16.0 * k as f64;
        let from = width - right - 220.0;
        line(format_args!("<path d='M{from} {}h20' stroke='{color}'/>", at - 4.0));
        line(format_args!("<text x='{}' y='{at}'>{}</text>", from + 26.0, curve.name));
    }
    svg.push_str("</svg>\n");
    svg
}
