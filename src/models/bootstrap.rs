//! Resampling with a seed.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// An interval of confidence, in the unit of the estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// How an estimate is resampled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bootstrap {
    /// How many resampled data sets are evaluated.
    pub replicates: usize,
    /// Seed; the same seed gives the same interval on any number of threads.
    pub seed: u64,
    /// Probability that the interval is meant to hold the truth, 0 to 1.
    pub confidence: f64,
}

impl Default for Bootstrap {
    /// 400 replicates, 95 %.
    fn default() -> Self {
        Self { replicates: 400, seed: 1, confidence: 0.95 }
    }
}

impl Bootstrap {
    /// Evaluates `statistic` on every resampled data set; it is handed the replicate's own random numbers.
    pub(super) fn values(&self, statistic: impl Fn(&mut ChaCha8Rng) -> f64 + Sync) -> Vec<f64> {
        let replicate = |number: usize| {
            let mut rng = ChaCha8Rng::seed_from_u64(self.seed);
            rng.set_stream(number as u64);
            statistic(&mut rng)
        };
        (0..self.replicates).into_par_iter().map(replicate).collect()
    }

    /// The interval that holds the middle share of `values` (percentile interval: Efron and Tibshirani 1993, An Introduction to
    /// the Bootstrap, ch. 13).
    pub(super) fn interval(&self, mut values: Vec<f64>) -> Interval {
        values.sort_by(f64::total_cmp);
        let tail = (1.0 - self.confidence) / 2.0;
        Interval { low: quantile(&values, tail), high: quantile(&values, 1.0 - tail) }
    }
}

/// Quantile of sorted values (not empty) by linear interpolation between order statistics (Hyndman and Fan 1996, Am. Stat.
/// 50, 361, type 7).
pub fn quantile(sorted: &[f64], q: f64) -> f64 {
    let place = q * (sorted.len() - 1) as f64;
    let below = place as usize;
    let above = (below + 1).min(sorted.len() - 1);
    sorted[below] + (place - below as f64) * (sorted[above] - sorted[below])
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt;

    #[test]
    fn quantiles_interpolate() {
        let sorted = [0.0, 1.0, 2.0, 10.0];
        assert_eq!(quantile(&sorted, 0.5), 1.5);
        assert_eq!((quantile(&sorted, 0.0), quantile(&sorted, 1.0)), (0.0, 10.0));
    }

    #[test]
    fn the_spread_of_a_mean_is_its_standard_error() {
        let data: Vec<f64> = (0..400).map(f64::from).collect(); // sd 115.5, error of the mean 5.77
        let bootstrap = Bootstrap { replicates: 2000, seed: 5, confidence: 0.95 };
        let mean =
            |rng: &mut ChaCha8Rng| (0..400).map(|_| data[rng.random_range(0..400)]).sum::<f64>() / 400.0;
        let interval = bootstrap.interval(bootstrap.values(mean));
        assert!((interval.high - interval.low - 2.0 * 1.96 * 5.77).abs() < 1.5, "{interval:?}");
    }
}
