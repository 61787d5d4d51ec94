//! Coats the same poses with one choice varied at a time.

use pancoat::models::{BatchStatistics, CoatMap};
use pancoat::observers::{Coater, Observer, Recording, SprayZone, StoredFrame};
use pancoat::scene::{Scene, Shape, Spray};
use pancoat::shapes::{SurfaceMesh, TabletShape, drum_mesh};
use serde::Serialize;
use std::error::Error;
use std::fmt;

/// The default raster.
pub(crate) const PIXELS: [u32; 2] = [512, 256];
/// The raster that others are measured against in a run, and in a single frame; the latter is shifted so many times.
const FINE: [u32; 2] = [2048, 1024];
const FINEST: [u32; 2] = [4096, 2048];
const SHIFTS: u64 = 4;
/// Frames in which single frames are compared, spread over the recording.
const SINGLE: usize = 8;
/// Panels of the finest map.
const MOST_PANELS: usize = 6800;

pub(crate) type Outcome<T> = Result<T, Box<dyn Error>>;

/// What one choice costs and how far off it is.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Row {
    /// What is varied.
    pub(crate) study: &'static str,
    pub(crate) columns: u32,
    pub(crate) rows: u32,
    pub(crate) interval_ms: f64,
    pub(crate) panels: usize,
    /// Error of a panel's area in one frame, summed without sign over panels, over the area seen.
    pub(crate) frame_error: Option<f64>,
    /// The same of what a whole run puts on each panel, against the best choice of the study.
    pub(crate) run_error: Option<f64>,
    pub(crate) cov_intra: Option<f64>,
    pub(crate) cov_average_tablet: Option<f64>,
    pub(crate) cov_inter: Option<f64>,
    /// Relative differences from the best choice of the study.
    pub(crate) bias_intra: Option<f64>,
    pub(crate) bias_average_tablet: Option<f64>,
    pub(crate) cpu_ms_per_frame: f64,
    pub(crate) cpu_ms_per_coated_s: f64,
}

impl Row {
    pub(crate) const HEAD: &'static str = "study                raster       ms  panels  frame err  run err  CoV intra (bias)     average (bias)     ms/frame";
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |x: Option<f64>| x.map_or("-".into(), |x| format!("{:.2} %", 100.0 * x));
        let plain = |x: Option<f64>| x.map_or("-".into(), |x| format!("{x:.4}"));
        write!(
            f,
            "{:<20} {:>4} x {:<4} {:>4} {:>6} {:>9} {:>9} {:>8} ({:>8}) {:>8} ({:>8}) {:>8.3}",
            self.study,
            self.columns,
            self.rows,
            self.interval_ms,
            self.panels,
            percent(self.frame_error),
            percent(self.run_error),
            plain(self.cov_intra),
            percent(self.bias_intra),
            plain(self.cov_average_tablet),
            percent(self.bias_average_tablet),
            self.cpu_ms_per_frame
        )
    }
}

/// The poses and what is coated.
pub(crate) struct Bed {
    shape: Shape,
    bodies: usize,
    spray: Spray,
    pub(crate) zone: SprayZone,
    drum: Option<SurfaceMesh>,
    pub(crate) frames: Vec<StoredFrame>,
    /// Between the recorded frames, s.
    interval: f64,
}

/// Counts of a run and their cost.
struct Coated {
    counts: Vec<u64>,
    cpu: f64,
    frames: usize,
}

impl Bed {
    pub(crate) fn new(scene: &Scene, recording: &Recording, frames: Vec<StoredFrame>) -> Outcome<Self> {
        let spray = scene.spray.clone().ok_or("the scene has a spray")?;
        let aim = recording.aim.ok_or("the recorded run has a spray")?;
        Ok(Self {
            shape: scene.shapes.first().ok_or("the scene has a shape")?.clone(),
            bodies: recording.body_shapes.len(),
            zone: SprayZone::facing(aim.target, aim.normal, &spray),
            spray,
            drum: scene.drum.as_ref().map(drum_mesh),
            frames,
            interval: scene.time.frame_interval,
        })
    }

    /// The tablet, cut into about so many panels.
    pub(crate) fn tablet(&self, panels: usize) -> Outcome<TabletShape> {
        Ok(TabletShape::build(&Shape { panels, ..self.shape.clone() }, true)?)
    }

    pub(crate) fn coater(&self, tablet: &TabletShape, pixels: [u32; 2], bodies: usize) -> Outcome<Coater> {
        let spray = Spray { pixels, ..self.spray.clone() };
        let drum = self.drum.as_ref().filter(|_| bodies > 1);
        Ok(Coater::new(&[tablet], &vec![0; bodies], &spray, self.zone, drum)?)
    }

    /// Every how many of the recorded frames make the interval of the paper, 20 ms.
    fn every(&self) -> usize {
        ((0.02 / self.interval).round() as usize).max(1)
    }

    /// Some frames, spread over the recording.
    pub(crate) fn single_frames(&self) -> impl Iterator<Item = &StoredFrame> {
        self.frames.iter().step_by((self.frames.len() / SINGLE).max(1)).take(SINGLE)
    }

    /// Share of the zone that each panel is seen on in one frame, averaged over shifts of the grid.
    fn shares(
        &self,
        tablet: &TabletShape,
        pixels: [u32; 2],
        frame: &StoredFrame,
        shifts: u64,
    ) -> Outcome<Vec<f64>> {
        let mut coater = self.coater(tablet, pixels, self.bodies)?;
        for shift in 0..shifts {
            let frame = StoredFrame { index: frame.index + shift, ..frame.clone() };
            coater.observe(&frame.as_frame());
        }
        let all = (shifts * coater.counts_per_frame()) as f64;
        Ok((0..self.bodies).flat_map(|body| coater.counts(body)).map(|&count| count as f64 / all).collect())
    }

    /// The best known shares of a frame.
    pub(crate) fn reference(&self, tablet: &TabletShape, frame: &StoredFrame) -> Outcome<Vec<f64>> {
        self.shares(tablet, FINEST, frame, SHIFTS)
    }

    fn frame_error(&self, tablet: &TabletShape, pixels: [u32; 2], references: &[Vec<f64>]) -> Outcome<f64> {
        let mut sum = 0.0;
        for (frame, reference) in self.single_frames().zip(references) {
            sum += difference(&self.shares(tablet, pixels, frame, 1)?, reference);
        }
        Ok(sum / references.len() as f64)
    }

    fn references(&self, tablet: &TabletShape) -> Outcome<Vec<Vec<f64>>> {
        self.single_frames().map(|frame| self.reference(tablet, frame)).collect()
    }

    /// Coats every so many of the frames.
    fn coat(&self, tablet: &TabletShape, pixels: [u32; 2], every: usize) -> Outcome<Coated> {
        let mut coater = self.coater(tablet, pixels, self.bodies)?;
        let start = cpu_seconds()?;
        let mut frames = 0;
        for (index, frame) in (0..).zip(self.frames.iter().step_by(every)) {
            coater.observe(&StoredFrame { index, ..frame.clone() }.as_frame());
            frames += 1;
        }
        let cpu = cpu_seconds()? - start;
        let counts = (0..self.bodies).flat_map(|body| coater.counts(body)).copied().collect();
        Ok(Coated { counts, cpu, frames })
    }

    fn row(
        &self,
        study: &'static str,
        tablet: &TabletShape,
        pixels: [u32; 2],
        every: usize,
        coated: &Coated,
    ) -> Outcome<Row> {
        let panels = tablet.panels.as_ref().ok_or("the tablet has panels")?;
        let batch = BatchStatistics::of(&CoatMap::new(&panels.areas, &coated.counts, 1.0)?)?;
        let interval = every as f64 * self.interval;
        let per_frame = coated.cpu / coated.frames as f64;
        Ok(Row {
            study,
            columns: pixels[0],
            rows: pixels[1],
            interval_ms: 1e3 * interval,
            panels: panels.len(),
            frame_error: None,
            run_error: None,
            cov_intra: Some(batch.moments),
            cov_average_tablet: Some(batch.average_tablet),
            cov_inter: Some(batch.inter),
            bias_intra: None,
            bias_average_tablet: None,
            cpu_ms_per_frame: 1e3 * per_frame,
            cpu_ms_per_coated_s: 1e3 * per_frame / interval,
        })
    }

    /// Pixels at the default interval and panel count.
    pub(crate) fn resolutions(&self) -> Outcome<Vec<Row>> {
        let tablet = self.tablet(self.shape.panels)?;
        let references = self.references(&tablet)?;
        let best = self.coat(&tablet, FINE, self.every())?;
        let best_row = self.row("resolution", &tablet, FINE, self.every(), &best)?;
        let mut rows = Vec::new();
        for pixels in [[64, 32], [128, 64], [256, 128], PIXELS, [1024, 512]] {
            let coated = self.coat(&tablet, pixels, self.every())?;
            let mut row = self.row("resolution", &tablet, pixels, self.every(), &coated)?;
            row.frame_error = Some(self.frame_error(&tablet, pixels, &references)?);
            row.run_error = Some(run_error(&coated, &best));
            rows.push(row.against(&best_row));
        }
        let frame_error = Some(self.frame_error(&tablet, FINE, &references)?);
        rows.push(Row { frame_error, ..best_row });
        Ok(rows)
    }

    /// Frames further apart at the default raster and panel count.
    pub(crate) fn intervals(&self) -> Outcome<Vec<Row>> {
        let tablet = self.tablet(self.shape.panels)?;
        let best = self.coat(&tablet, PIXELS, 1)?;
        let best_row = self.row("interval", &tablet, PIXELS, 1, &best)?;
        let mut rows = vec![best_row.clone()];
        for every in [2, 4, 8, 16] {
            let coated = self.coat(&tablet, PIXELS, every)?;
            let mut row = self.row("interval", &tablet, PIXELS, every, &coated)?;
            row.run_error = Some(run_error(&coated, &best));
            rows.push(row.against(&best_row));
        }
        Ok(rows)
    }

    /// Coarser and finer maps at the default raster and interval.
    pub(crate) fn panel_counts(&self) -> Outcome<Vec<Row>> {
        let finest = self.tablet(MOST_PANELS)?;
        let best = self.coat(&finest, FINE, self.every())?;
        let best_row = self.row("panels", &finest, FINE, self.every(), &best)?;
        let mut rows = Vec::new();
        for panels in [200, 425, 850, 1700, 3400, MOST_PANELS] {
            let tablet = self.tablet(panels)?;
            let coated = self.coat(&tablet, PIXELS, self.every())?;
            let mut row = self.row("panels", &tablet, PIXELS, self.every(), &coated)?;
            row.frame_error = Some(self.frame_error(&tablet, PIXELS, &self.references(&tablet)?)?);
            rows.push(row.against(&best_row));
        }
        rows.push(best_row);
        Ok(rows)
    }
}

impl Row {
    fn against(self, best: &Self) -> Self {
        let relative = |value: Option<f64>, best: Option<f64>| Some(value? / best? - 1.0);
        Self {
            bias_intra: relative(self.cov_intra, best.cov_intra),
            bias_average_tablet: relative(self.cov_average_tablet, best.cov_average_tablet),
            ..self
        }
    }
}

/// Sum of the differences without sign, over the sum of the reference.
pub(crate) fn difference(found: &[f64], reference: &[f64]) -> f64 {
    let off: f64 = found.iter().zip(reference).map(|(a, b)| (a - b).abs()).sum();
    off / reference.iter().sum::<f64>()
}

fn run_error(coated: &Coated, best: &Coated) -> f64 {
    let share = |coated: &Coated| -> Vec<f64> {
        let all = coated.counts.iter().sum::<u64>() as f64;
        coated.counts.iter().map(|&count| count as f64 / all).collect()
    };
    difference(&share(coated), &share(best))
}

/// CPU time of this thread so far, s.
pub(crate) fn cpu_seconds() -> Outcome<f64> {
    let stat = std::fs::read_to_string("/proc/thread-self/schedstat")?;
    let nanoseconds = stat.split(' ').next().ok_or("an empty schedstat")?;
    Ok(1e-9 * nanoseconds.parse::<f64>()?)
}
