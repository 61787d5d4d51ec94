//! Coating uniformity over time.

use crate::models::{Amount, BatchStatistics, CoatMap, ModelError, SeriesRow};

/// Collects a row at each output time from the coating of one shape.
#[derive(Debug, Clone, PartialEq)]
pub struct CoatingSeries {
    interval: f64,
    rows: Vec<SeriesRow>,
    /// Largest residual of the averaging identities so far.
    worst_identity: f64,
}

impl CoatingSeries {
    /// A series with a row every `interval` (s) of coated time.
    pub fn new(interval: f64) -> Self {
        Self { interval, rows: Vec::new(), worst_identity: 0.0 }
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
        Ok(Some(batch))
    }

    /// The rows so far.
    pub fn rows(&self) -> &[SeriesRow] {
        &self.rows
    }

    /// Largest residual of the identities of the appendix (Eqs 25, 30, 34) over all rows; round-off when all is well.
    pub fn worst_identity(&self) -> f64 {
        self.worst_identity
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
