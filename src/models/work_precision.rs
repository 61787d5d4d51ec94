//! Error against work: what a choice of step, stiffness or law costs, and how far its results lie from the most exact one.
//!
//! A bed is chaotic, so that only statistics can be compared: each case runs with several seeds, and its figures are known
//! to a confidence interval. A difference within the intervals is no error that anyone could see.

use super::student::mean_95;

/// One run of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Figures of the bed, the same for all runs, in any units.
    pub figures: Vec<f64>,
    /// CPU seconds for each simulated second.
    pub cost: f64,
}

/// A case against the reference of its axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Precision {
    /// Mean of each figure and half the width of its 95 % interval; the width is NaN with one seed.
    pub figures: Vec<(f64, f64)>,
    /// Root mean square over figures of the relative difference from the reference.
    pub error: f64,
    /// The same of the half-widths of these differences: what chance alone makes of it.
    pub noise: f64,
    /// Mean cost, CPU seconds for each simulated second.
    pub cost: f64,
    /// Whether no other case is both cheaper and nearer to the reference.
    pub on_front: bool,
}

impl Precision {
    /// Whether the error is one that the seeds cannot explain.
    pub fn is_seen(&self) -> bool {
        self.error > self.noise
    }
}

/// Compares the cases of an axis with the one at `reference`. Cases without runs have failed and give `None`, as do all if
/// the reference has failed.
pub fn work_precision(cases: &[Vec<Run>], reference: usize) -> Vec<Option<Precision>> {
    let figures: Vec<_> = cases.iter().map(|runs| intervals(runs)).collect();
    let Some(exact) = figures[reference].clone() else { return vec![None; cases.len()] };
    let compared = figures.into_iter().zip(cases).map(|(figures, runs)| {
        let figures = figures?;
        let (mut error, mut noise) = (0.0, 0.0);
        for ((mean, half_width), (exact, exact_half_width)) in figures.iter().zip(&exact) {
            error += ((mean - exact) / exact).powi(2);
            noise += (half_width.hypot(*exact_half_width) / exact).powi(2);
        }
        let root_mean = |sum: f64| (sum / exact.len() as f64).sqrt();
        Some(Precision {
            error: root_mean(error),
            noise: root_mean(noise),
            cost: runs.iter().map(|run| run.cost).sum::<f64>() / runs.len() as f64,
            on_front: false,
            figures,
        })
    });
    let mut compared: Vec<Option<Precision>> = compared.collect();
    let points: Vec<(f64, f64)> = compared.iter().flatten().map(|p| (p.cost, p.error)).collect();
    for case in compared.iter_mut().flatten() {
        let better =
            |p: &&(f64, f64)| p.0 <= case.cost && p.1 <= case.error && (p.0 < case.cost || p.1 < case.error);
        case.on_front = points.iter().find(better).is_none();
    }
    compared
}

/// Mean of each figure and half the width of its 95 % interval.
fn intervals(runs: &[Run]) -> Option<Vec<(f64, f64)>> {
    let figures = 0..runs.first()?.figures.len();
    let interval = |k: usize| {
        let values: Vec<f64> = runs.iter().map(|run| run.figures[k]).collect();
        mean_95(&values).unwrap_or((values[0], f64::NAN))
    };
    Some(figures.map(interval).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn runs(values: &[f64], cost: f64) -> Vec<Run> {
        values.iter().map(|v| Run { figures: vec![*v, 1.0], cost }).collect()
    }

    #[test]
    fn differences_are_judged_by_their_intervals() {
        // 1, 2, 3: mean 2, sd 1, t(2) 4.303, half-width 2.484.
        let cases = [runs(&[1.0, 2.0, 3.0], 4.0), runs(&[2.2, 2.2, 2.2], 1.0), vec![], runs(&[9.0; 3], 2.0)];
        let found = work_precision(&cases, 0);
        let [exact, near, failed, far] = &found[..] else { panic!("four cases") };
        let (exact, near, far) = (exact.as_ref().unwrap(), near.as_ref().unwrap(), far.as_ref().unwrap());
        assert!((exact.figures[0].1 - 2.4843).abs() < 1e-3 && exact.error == 0.0);
        // Two figures, one of which does not differ.
        assert!((near.error - 0.1 / 2.0_f64.sqrt()).abs() < 1e-12 && !near.is_seen());
        assert!(far.is_seen() && failed.is_none());
        assert_eq!([exact, near, far].map(|case| case.on_front), [true, true, false]);
        assert_eq!(work_precision(&cases, 2), vec![None; 4]);
    }
}
