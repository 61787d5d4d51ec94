//! Figures of a bed in a drum about z, gravity along -y, as the runs of other codes in `scenes/peers/reference.csv` were
//! measured: means over frames and bodies, and standard errors over blocks of 1 s.

use super::peers_scene::{MASS, MOMENTS, RADIUS, WIDTH};
use nalgebra::Vector3;
use pancoat::stepping::{BodyState, Frame, Observer};
use std::path::Path;

/// Names and order of the figures, units in the names.
///
/// - `speed`: mean |v|; `ke_trans`, `ke_rot`: mean over frames of the energies of all bodies;
/// - `com`: mean position, z from the end plate; `angle_com`: atan2(com_x, -com_y);
/// - `angle_surf`: in axes s along and n across the surface, turned by `angle_com`, bins of 10 mm in |s| < 50 mm; the line
///   through the bins' 95 % quantiles of n leans by the difference of both angles;
/// - `n95`: in axes turned by `angle_surf`, 95 % quantile of n for |s| < 20 mm;
/// - `v_surf`: mean speed down the slope (-v_s) of bodies with |s| < 20 mm and n > n95 - 10 mm;
/// - `cos_axis_surf`: mean |axis . n| of the same bodies; NaN for spheres.
pub(crate) const NAMES: [&str; 11] = [
    "speed_mm_s",
    "ke_trans_mJ",
    "ke_rot_mJ",
    "com_x_mm",
    "com_y_mm",
    "com_z_mm",
    "angle_com_deg",
    "angle_surf_deg",
    "n95_mm",
    "v_surf_mm_s",
    "cos_axis_surf",
];

/// Frames of the window from `from` to `to`, s.
pub(crate) struct Watch {
    window: [f64; 2],
    tablets: bool,
    frames: Vec<(f64, Vec<BodyState>)>,
}

impl Observer for Watch {
    fn observe(&mut self, frame: &Frame<'_>) {
        if within(self.window, frame.time) {
            self.frames.push((frame.time, frame.bodies.to_vec()));
        }
    }
}

fn within(window: [f64; 2], time: f64) -> bool {
    window[0] - 1e-9 <= time && time < window[1] - 1e-9
}

impl Watch {
    /// A window, s; `tablets` says that bodies have an axis.
    pub(crate) fn new(window: [f64; 2], tablets: bool) -> Self {
        Self { window, tablets, frames: Vec::new() }
    }

    /// The figures in the order of [`NAMES`], and their standard errors.
    pub(crate) fn figures(&self) -> [(f64, f64); 11] {
        let [from, to] = self.window;
        let blocks = (to - from).round().max(1.0);
        let length = (to - from) / blocks;
        let block = |k: usize| self.over([from + k as f64 * length, from + (k + 1) as f64 * length]);
        let blocks: Vec<[f64; 11]> = (0..blocks as usize).map(block).collect();
        let mut figures = self.over(self.window).map(|value| (value, f64::NAN));
        for (k, (_, error)) in figures.iter_mut().enumerate() {
            let n = blocks.len() as f64;
            let mean = blocks.iter().map(|b| b[k]).sum::<f64>() / n;
            let variance = blocks.iter().map(|b| (b[k] - mean).powi(2)).sum::<f64>() / (n - 1.0);
            *error = (variance / n).sqrt();
        }
        figures
    }

    fn over(&self, window: [f64; 2]) -> [f64; 11] {
        let frames = self.frames.iter().filter(|f| within(window, f.0)).count() as f64;
        let bodies = || self.frames.iter().filter(move |f| within(window, f.0)).flat_map(|f| &f.1);
        let n = bodies().count() as f64;
        let mean = |value: &dyn Fn(&BodyState) -> f64| bodies().map(value).sum::<f64>() / n;
        let moments =
            if self.tablets { Vector3::from(MOMENTS) } else { Vector3::repeat(0.4 * MASS * RADIUS * RADIUS) };
        let spin = |b: &BodyState| {
            let spin = b.orientation.inverse() * b.spin;
            0.5 * spin.component_mul(&spin).dot(&moments)
        };
        let com = bodies().map(|b| b.position).sum::<Vector3<f64>>() / n;
        let angle_com = com.x.atan2(-com.y);
        // Along and across the surface.
        let axes = |angle: f64| {
            let (sin, cos) = angle.sin_cos();
            (Vector3::new(cos, sin, 0.0), Vector3::new(-sin, cos, 0.0))
        };
        let (s, across) = axes(angle_com);
        let tops = (0..10).map(|k| {
            let middle = -45e-3 + 10e-3 * f64::from(k);
            let bin = bodies().filter(|b| (b.position.dot(&s) - middle).abs() < 5e-3);
            (middle, quantile_95(bin.map(|b| b.position.dot(&across)).collect()))
        });
        let angle_surf = angle_com + slope(&tops.collect::<Vec<_>>()).atan();
        let (s, across) = axes(angle_surf);
        let middle = || bodies().filter(|b| b.position.dot(&s).abs() < 20e-3);
        let n95 = quantile_95(middle().map(|b| b.position.dot(&across)).collect());
        let top: Vec<&BodyState> = middle().filter(|b| b.position.dot(&across) > n95 - 10e-3).collect();
        let of_top =
            |value: &dyn Fn(&BodyState) -> f64| top.iter().map(|b| value(b)).sum::<f64>() / top.len() as f64;
        let axis = |b: &BodyState| (b.orientation * Vector3::z()).dot(&across).abs();
        [
            1e3 * mean(&|b| b.velocity.norm()),
            1e3 * 0.5 * MASS * mean(&|b| b.velocity.norm_squared()) * n / frames,
            1e3 * mean(&spin) * n / frames,
            1e3 * com.x,
            1e3 * com.y,
            1e3 * (com.z + 0.5 * WIDTH),
            angle_com.to_degrees(),
            angle_surf.to_degrees(),
            1e3 * n95,
            1e3 * of_top(&|b| -b.velocity.dot(&s)),
            if self.tablets { of_top(&axis) } else { f64::NAN },
        ]
    }
}

/// The 95 % quantile, linear between the sorted values.
fn quantile_95(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let place = 0.95 * (values.len() - 1) as f64;
    let k = place as usize;
    let next = values[(k + 1).min(values.len() - 1)];
    values[k] + (next - values[k]) * (place - k as f64)
}

/// Slope of the least-squares line.
fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |m, p| (m.0 + p.0 / n, m.1 + p.1 / n));
    let along = |f: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>();
    along(&|p| (p.0 - x) * (p.1 - y)) / along(&|p| (p.0 - x).powi(2))
}

/// What each other code found in a case: its name, and its figures with their standard errors.
pub(crate) fn reference(case: &str) -> Vec<(String, Vec<(f64, f64)>)> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/peers/reference.csv");
    let text = std::fs::read_to_string(path).expect("the reference");
    let lines = text.lines().skip(1).map(|line| line.split(',').collect::<Vec<_>>());
    let same = lines.filter_map(|fields| {
        let (code, what) = fields[0].split_once('_')?;
        let number = |text: &str| text.parse().unwrap_or(f64::NAN);
        let values = fields[5..].chunks(2).map(|pair| (number(pair[0]), number(pair[1])));
        (what == case).then(|| (code.to_owned(), values.collect()))
    });
    same.collect()
}
