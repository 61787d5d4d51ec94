//! How tablets differ from each other, over time and in a sample.

use super::averaging::sample_sd;
use super::{Bootstrap, Interval, ModelError, PowerLaw};
use rand::RngExt;

/// A power law in time of a statistic over tablets, with an interval that knows that all times are of the same tablets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpreadLaw {
    /// The fit to all tablets.
    pub law: PowerLaw,
    /// Interval of the exponent, from resampled tablets.
    pub exponent: Interval,
}

impl SpreadLaw {
    /// Law of the sample standard deviation of a value per tablet: `rows` are times (s) with the values of all tablets, as
    /// CoV_intra,i or the mean thickness over its mean. Freireich et al. 2015 find an exponent of −0.57 for CoV_intra,i of
    /// round tablets (Fig 9), and −1/2 is expected of CoV_inter (Fig 6b).
    ///
    /// # Errors
    /// [`ModelError::TooFew`] below three times or two tablets, [`ModelError::Length`] when rows differ in tablets.
    pub fn fit(rows: &[(f64, Vec<f64>)], bootstrap: &Bootstrap) -> Result<Self, ModelError> {
        let tablets = rows.first().map_or(0, |row| row.1.len());
        if let Some(row) = rows.iter().find(|row| row.1.len() != tablets) {
            return Err(ModelError::Length {
                what: "tablets in a row",
                found: row.1.len(),
                expected: tablets,
            });
        }
        if tablets < 2 {
            return Err(ModelError::TooFew { what: "a spread", unit: "tablets", found: tablets, needed: 2 });
        }
        let spread = |chosen: &dyn Fn(&[f64]) -> Vec<f64>| {
            PowerLaw::fit(rows.iter().filter_map(|(time, values)| Some((*time, sample_sd(&chosen(values))?))))
        };
        let law = spread(&<[f64]>::to_vec)?;
        let exponents = bootstrap.values(|rng| {
            let drawn: Vec<usize> = (0..tablets).map(|_| rng.random_range(0..tablets)).collect();
            spread(&|values| drawn.iter().map(|&i| values[i]).collect()).map_or(law.exponent, |l| l.exponent)
        });
        let exponent = bootstrap.interval(exponents);
        Ok(Self { law, exponent })
    }
}

/// How many tablets to measure so that their mean is within `relative_error` of the batch's mean with 95 % confidence, when
/// single tablets have a coefficient of variation `cov` about it.
///
/// n = (1.96 cov/error)² + 1.92: the normal sample size, plus z²/2 for having to estimate the spread from the same sample
/// (Guenther 1981, Am. Stat. 35, 243).
///
/// ```
/// // Tablets that scatter by 20 %: 18 of them give the mean within 10 %, with 95 % confidence.
/// assert_eq!(pancoat::models::tablets_to_measure(0.2, 0.1), 18);
/// ```
pub fn tablets_to_measure(cov: f64, relative_error: f64) -> u64 {
    const Z: f64 = 1.959_963_984_540_054;
    ((Z * cov / relative_error).powi(2) + Z * Z / 2.0).ceil() as u64
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn running_means_of_random_numbers_spread_as_one_over_the_root_of_time() {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let mut sums = vec![0.0; 200];
        let mut rows = Vec::new();
        for time in 1..=300_u32 {
            for sum in &mut sums {
                *sum += rng.random_range(0.0..1.0);
            }
            if time % 20 == 0 {
                rows.push((f64::from(time), sums.iter().map(|s| s / f64::from(time)).collect()));
            }
        }
        let spread = SpreadLaw::fit(&rows, &Bootstrap { replicates: 200, ..Bootstrap::default() }).unwrap();
        assert!((spread.law.exponent + 0.5).abs() < 0.06, "{spread:?}");
        assert!(spread.exponent.low < -0.5 && -0.5 < spread.exponent.high, "{spread:?}");
        // Tablets keep their sums: the honest interval is wider than what independent points would give.
        assert!(spread.exponent.high - spread.exponent.low > 2.0 * spread.law.exponent_error);
    }

    #[test]
    fn the_sample_size_keeps_its_promise() {
        let mut rng = ChaCha8Rng::seed_from_u64(2);
        let n = tablets_to_measure(0.2, 0.1);
        let mut kept = 0;
        for _ in 0..2000 {
            // Sums of twelve uniforms: normal enough, sd 1.
            let normal =
                |rng: &mut ChaCha8Rng| (0..12).map(|_| rng.random_range(0.0..1.0_f64)).sum::<f64>() - 6.0;
            let mean = (0..n).map(|_| 1.0 + 0.2 * normal(&mut rng)).sum::<f64>() / n as f64;
            kept += usize::from((mean - 1.0).abs() < 0.1);
        }
        assert!((1900..=1980).contains(&kept), "{kept}");
    }
}
