//! Coating uniformity over time.

use crate::models::{
    Amount, BatchStatistics, Bootstrap, CoatMap, ModelError, SeriesRow, SpreadLaw, TabletMoments,
};

/// The tablets of a batch at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct TabletRow {
    /// Coated time, s.
    pub time: f64,
    /// Moments of every tablet.
    pub tablets: Vec<TabletMoments>,
}

/// Rows of tablets are kept at times at least so far apart, as a factor: some 24 a decade, evenly on log paper.
const SPREAD_STEP: f64 = 1.1;

/// Collects a row at each output time from the coating of one shape.
#[derive(Debug, Clone, PartialEq)]
pub struct CoatingSeries {
    interval: f64,
    rows: Vec<SeriesRow>,
    spread: Vec<TabletRow>,
    /// Largest residual of the averaging identities so far.
    worst_identity: f64,
}

impl CoatingSeries {
    /// A series with a row every `interval` (s) of coated time.
    pub fn new(interval: f64) -> Self {
        Self { interval, rows: Vec::new(), spread: Vec::new(), worst_identity: 0.0 }
    }

    /// Whether a row is due at a coated `time` (s): asked before the counts are gathered, as that is what costs.
    pub fn is_due(&self, time: f64) -> bool {
        let last = self.rows.last().map_or(0.0, |row| row.time_s);
        time >= last + 0.999 * self.interval
    }

    /// Adds the row of a map at `time` (s) and returns the batch it was made of; `None` while nothing is coated.
    ///
    /// # Errors
    /// Those of [`BatchStatistics::of`] but for [`ModelError::Uncoated`].
    pub fn record<T: Amount>(
        &mut self,
        time: f64,
        map: &CoatMap<'_, T>,
    ) -> Result<Option<BatchStatistics>, ModelError> {
        let batch = match BatchStatistics::of(map) {
            Err(ModelError::Uncoated) => return Ok(None),
            other => other?,
        };
        self.worst_identity = self.worst_identity.max(batch.identities.worst());
        self.rows.push(SeriesRow::new(time, &batch));
        if self.spread.last().is_none_or(|row| time >= SPREAD_STEP * row.time) {
            self.spread.push(TabletRow { time, tablets: batch.tablets.clone() });
        }
        Ok(Some(batch))
    }

    /// The rows so far.
    pub fn rows(&self) -> &[SeriesRow] {
        &self.rows
    }

    /// The tablets at times evenly spaced on log paper, for how their spread falls ([`Self::spread_of_cov`]).
    pub fn tablets(&self) -> &[TabletRow] {
        &self.spread
    }

    /// Power law of the standard deviation over tablets of CoV_intra,i, once all are coated (Fig 9 of the paper: −0.57).
    ///
    /// # Errors
    /// Those of [`SpreadLaw::fit`].
    pub fn spread_of_cov(&self, bootstrap: &Bootstrap) -> Result<SpreadLaw, ModelError> {
        let covs = |row: &TabletRow| {
            Some((row.time, row.tablets.iter().map(TabletMoments::cov).collect::<Option<_>>()?))
        };
        SpreadLaw::fit(&self.spread.iter().filter_map(covs).collect::<Vec<_>>(), bootstrap)
    }

    /// Power law of CoV_inter after `from` (s) of coating (Fig 6b: −1/2 after 10 s).
    ///
    /// # Errors
    /// Those of [`SpreadLaw::fit`].
    pub fn law_of_inter(&self, from: f64, bootstrap: &Bootstrap) -> Result<SpreadLaw, ModelError> {
        let relative = |row: &TabletRow| {
            let mean = row.tablets.iter().map(|t| t.mean).sum::<f64>() / row.tablets.len() as f64;
            (row.time, row.tablets.iter().map(|t| t.mean / mean).collect())
        };
        let rows: Vec<_> = self.spread.iter().filter(|row| row.time >= from).map(relative).collect();
        SpreadLaw::fit(&rows, bootstrap)
    }

    /// Largest residual of the identities of the appendix (Eqs 25, 30, 34) over all rows; round-off when all is well.
    pub fn worst_identity(&self) -> f64 {
        self.worst_identity
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn rows_come_at_the_interval_and_only_when_something_is_coated() {
        let mut series = CoatingSeries::new(0.5);
        assert!(!series.is_due(0.4) && series.is_due(0.5));
        let bare = CoatMap::new(&[1.0, 1.0], &[0_u32; 4], 1.0).unwrap();
        assert_eq!(series.record(0.5, &bare), Ok(None));
        assert!(series.is_due(0.52));
        let coated = CoatMap::new(&[1.0, 1.0], &[1_u32, 3, 2, 2], 1.0e-6).unwrap();
        series.record(0.52, &coated).unwrap();
        assert!(!series.is_due(1.0) && series.is_due(1.02));
        assert_eq!(series.rows()[0].mean_thickness_um, 2.0);
        assert!(series.worst_identity() < 1e-14);
    }

    #[test]
    fn tablets_are_kept_evenly_on_log_paper_and_give_both_laws() {
        let mut series = CoatingSeries::new(1.0);
        let areas = vec![1.0; 20];
        let mut amounts = vec![0_u32; 200 * 20];
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        for time in 1..=1500_u32 {
            for tablet in amounts.chunks_exact_mut(20) {
                if rng.random_bool(0.1) {
                    for (j, amount) in tablet.iter_mut().enumerate() {
                        *amount += u32::from(rng.random_bool(0.005 * (j + 1) as f64));
                    }
                }
            }
            if time % 5 == 0 {
                series.record(f64::from(time), &CoatMap::new(&areas, &amounts, 1.0).unwrap()).unwrap();
            }
        }
        assert!((30..60).contains(&series.tablets().len()), "{}", series.tablets().len());
        let few = Bootstrap { replicates: 100, ..Bootstrap::default() };
        let inter = series.law_of_inter(10.0, &few).unwrap();
        assert!((inter.law.exponent + 0.5).abs() < 0.05, "{inter:?}");
        let spread = series.spread_of_cov(&few).unwrap();
        assert!((-0.75..-0.4).contains(&spread.law.exponent), "{spread:?}");
    }
}
