//! The limit of intra-tablet uniformity, estimated from a run too short to reach it.

use super::averaging::area_moments;
use super::bootstrap::draw_counts;
use super::{Amount, Bootstrap, CoatMap, Interval, ModelError};
use rayon::prelude::*;

/// The limit of CoV_intra and how fast it is approached.
///
/// # Derivation
/// Let d_ib be the map that tablet i = 1..N gains in time block b = 1..B, less its own mean, and
/// ⟨f, g⟩ = 1/A Σ_j f_j g_j A_j. In a stationary bed d_ib = η + noise with the same η for all tablets and blocks; η is
/// what is left after infinite time, so the limit is CoV_∞ = √⟨η, η⟩ / μ, μ the mean gain of a tablet in a block. The
/// variance of any finite average holds ⟨η, η⟩ *and* noise. But for two different tablets (and two different blocks) the
/// noise is independent, hence E⟨d_ib, d_kc⟩ = ⟨η, η⟩ exactly, and so is the mean over all pairs with i ≠ k, b ≠ c:
///
/// ```text
/// ⟨η, η⟩ ≈ ( ‖Σ_ib d_ib‖² − Σ_i ‖Σ_b d_ib‖² − Σ_b ‖Σ_i d_ib‖² + Σ_ib ‖d_ib‖² ) / (N (N−1) B (B−1))
/// ```
///
/// With one block the pairs differ in the tablet only, and in the paper's σ_t (Eq 18) and σ_m (Eq 14) this is
/// σ_∞² = (N σ_t² − σ_m²)/(N − 1): the average tablet less its finite-sample bias.
///
/// What one tablet has above the limit is noise that falls as 1/time: CoV_intra²(t) = CoV_∞² + K/t (Freireich and
/// Wassgren 2010, Chem. Eng. Sci. 65, 1117), with K = T (σ_m² − σ_∞²)/μ² after the time T.
///
/// CoV_∞² may come out negative when the limit is too small to be told from zero; the sign is kept in
/// [`Asymptote::cov_squared`], and [`Asymptote::cov`] is then 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asymptote {
    /// CoV_∞², dimensionless; negative when noise wins.
    pub cov_squared: f64,
    /// K, s.
    pub noise_time: f64,
}

impl Asymptote {
    /// CoV_∞; 0 when the estimate of its square is negative.
    pub fn cov(&self) -> f64 {
        self.cov_squared.max(0.0).sqrt()
    }

    /// CoV_intra expected after a coated time, s.
    ///
    /// ```
    /// use pancoat::models::Asymptote;
    /// let limit = Asymptote { cov_squared: 0.09, noise_time: 7.0 };
    /// assert!((limit.after(100.0) - 0.4).abs() < 1e-12); // sqrt(0.09 + 0.07)
    /// assert!((limit.time_to(0.4).unwrap() - 100.0).abs() < 1e-9);
    /// assert_eq!(limit.time_to(0.3), None);
    /// ```
    pub fn after(&self, time: f64) -> f64 {
        (self.cov_squared + self.noise_time / time).max(0.0).sqrt()
    }

    /// Coated time until CoV_intra is `target`, s; `None` when the limit is not below the target.
    pub fn time_to(&self, target: f64) -> Option<f64> {
        let above = target * target - self.cov_squared.max(0.0);
        (above > 0.0).then(|| self.noise_time / above)
    }

    /// Coated time until CoV_intra is within a `share` of its limit (0.1: at 1.1 CoV_∞), s; `None` when the limit is 0,
    /// which is never approached in proportion.
    pub fn time_within(&self, share: f64) -> Option<f64> {
        (self.cov_squared > 0.0).then(|| self.time_to((1.0 + share) * self.cov())).flatten()
    }
}

/// An [`Asymptote`] with its interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AsymptoteEstimate {
    /// The limit.
    pub asymptote: Asymptote,
    /// Interval of CoV_∞; its lower end is 0 when the limit cannot be told from zero.
    pub interval: Interval,
    /// Coated time of the data, s.
    pub duration: f64,
    /// Tablets the estimate rests on.
    pub tablets: usize,
    /// Time blocks the estimate rests on.
    pub blocks: usize,
}

impl AsymptoteEstimate {
    /// Whether the interval excludes a limit of zero, as for any shape but a sphere it should in the end.
    pub fn is_above_zero(&self) -> bool {
        self.interval.low > 0.0
    }

    /// Estimates from what each tablet gained in successive `blocks` of time of equal length, which add up to `duration`
    /// (s). One block works; several remove fluctuations that all tablets share, and let the interval know of them, when
    /// a block is longer than these last. The interval resamples tablets and blocks.
    ///
    /// # Errors
    /// [`ModelError::TooFew`] below two tablets or without blocks, [`ModelError::Length`] when blocks differ in tablets,
    /// [`ModelError::Uncoated`] when nothing is coated.
    pub fn from_blocks<T: Amount>(
        blocks: &[CoatMap<'_, T>],
        duration: f64,
        bootstrap: &Bootstrap,
    ) -> Result<Self, ModelError> {
        let gains = Gains::new(blocks)?;
        let ones = (vec![1.0; gains.tablets], vec![1.0; blocks.len()]);
        let (cov_squared, noise) = gains.estimate(&ones.0, &ones.1).ok_or(ModelError::Uncoated)?;
        let replicate = |rng: &mut _| {
            let tablets = draw_counts(gains.tablets, rng);
            let drawn = draw_counts(blocks.len(), rng);
            gains.estimate(&tablets, &drawn).map_or(cov_squared, |e| e.0)
        };
        let square = bootstrap.centred_interval(cov_squared, bootstrap.values(replicate));
        Ok(Self {
            asymptote: Asymptote { cov_squared, noise_time: duration * noise },
            interval: Interval { low: square.low.max(0.0).sqrt(), high: square.high.max(0.0).sqrt() },
            duration,
            tablets: gains.tablets,
            blocks: blocks.len(),
        })
    }
}

/// The gains of all tablets in all blocks, with what does not change from one resampled set to the next.
struct Gains<'a, T> {
    blocks: &'a [CoatMap<'a, T>],
    areas: &'a [f64],
    tablets: usize,
    /// ‖d_ib‖² and the mean gain, `tablets × blocks`.
    each: Vec<(f64, f64)>,
}

impl<'a, T: Amount> Gains<'a, T> {
    fn new(blocks: &'a [CoatMap<'a, T>]) -> Result<Self, ModelError> {
        let Some(first) = blocks.first() else {
            return Err(ModelError::TooFew {
                what: "an asymptote",
                unit: "time blocks",
                found: 0,
                needed: 1,
            });
        };
        let tablets = first.tablets();
        if tablets < 2 {
            return Err(ModelError::TooFew {
                what: "an asymptote",
                unit: "tablets",
                found: tablets,
                needed: 2,
            });
        }
        for block in blocks {
            let (found, expected) = (block.amounts().len(), first.amounts().len());
            if found != expected {
                return Err(ModelError::Length { what: "amounts of a time block", found, expected });
            }
        }
        let areas = first.areas();
        let moments = |index: usize| {
            let row = blocks[index % blocks.len()].row(index / blocks.len());
            let thickness: Vec<f64> = row.iter().zip(areas).map(|(&c, a)| c.value() / a).collect();
            let (mean, variance) = area_moments(&thickness, areas);
            (variance, mean)
        };
        let each = (0..tablets * blocks.len()).into_par_iter().map(moments).collect();
        Ok(Self { blocks, areas, tablets, each })
    }

    /// CoV_∞² and (σ_m² − σ_∞²)/μ² with tablet i taken `w[i]` times and block b taken `v[b]` times, every taking being a
    /// unit of its own; `None` when they carry no coating.
    fn estimate(&self, w: &[f64], v: &[f64]) -> Option<(f64, f64)> {
        let (n, b) = (w.iter().sum::<f64>(), v.iter().sum::<f64>());
        let panels = self.areas.len();
        let mut by_block = vec![vec![0.0; panels]; v.len()];
        let mut row_sum = vec![0.0; panels];
        let (mut same_tablet, mut same_both, mut total) = (0.0, 0.0, 0.0);
        for (tablet, &times) in w.iter().enumerate().filter(|(_, times)| **times > 0.0) {
            row_sum.fill(0.0);
            for (block, &taken) in v.iter().enumerate().filter(|(_, taken)| **taken > 0.0) {
                let sums = row_sum.iter_mut().zip(&mut by_block[block]);
                for (&c, (row, column)) in self.blocks[block].row(tablet).iter().zip(sums) {
                    let c = c.value();
                    *row += taken * c;
                    *column += times * c;
                }
                let (square, mean) = self.each[tablet * v.len() + block];
                same_both += times * taken * square;
                total += times * taken * mean;
            }
            same_tablet += times * self.norm_squared(&row_sum);
        }
        let mut all = vec![0.0; panels];
        let mut same_block = 0.0;
        for (column, &taken) in by_block.iter().zip(v).filter(|(_, taken)| **taken > 0.0) {
            all.iter_mut().zip(column).for_each(|(sum, c)| *sum += taken * c);
            same_block += taken * self.norm_squared(column);
        }
        let limit = if v.len() > 1 {
            (self.norm_squared(&all) - same_tablet - same_block + same_both) / (n * (n - 1.0) * b * (b - 1.0))
        } else {
            (self.norm_squared(&all) - same_tablet) / (n * (n - 1.0))
        };
        let mean = total / (n * b);
        (mean > 0.0).then(|| (limit / (mean * mean), (same_tablet / (n * b * b) - limit) / (mean * mean)))
    }

    /// ‖·‖² of the thickness of summed counts, less its mean.
    fn norm_squared(&self, counts: &[f64]) -> f64 {
        let (mut sum, mut square, mut area) = (0.0, 0.0, 0.0);
        for (c, a) in counts.iter().zip(self.areas) {
            sum += c;
            square += c * c / a;
            area += a;
        }
        (square - sum * sum / area) / area
    }
}

#[cfg(test)]
mod tests {
    use super::super::{BatchStatistics, TrialProcess};
    use super::*;

    #[test]
    fn one_block_is_the_corrected_average_tablet() {
        let areas = [1.0, 2.0, 0.5];
        let amounts = [3_u32, 4, 1, 0, 5, 2, 2, 2, 2, 6, 1, 0];
        let map = CoatMap::new(&areas, &amounts, 1.0).unwrap();
        let batch = BatchStatistics::of(&map).unwrap();
        let few = Bootstrap { replicates: 20, ..Bootstrap::default() };
        let found = AsymptoteEstimate::from_blocks(&[map], 10.0, &few).unwrap().asymptote;
        let limit = (4.0 * batch.variance_average_tablet - batch.variance_moments) / 3.0;
        assert!((found.cov_squared - limit / batch.mean_thickness.powi(2)).abs() < 1e-12);
        assert!((found.after(10.0) - batch.moments).abs() < 1e-12);
    }

    #[test]
    fn blocks_are_the_mean_over_pairs_that_differ_in_both() {
        let areas = [1.0, 3.0];
        let blocks = [[1_u32, 2, 3, 0, 1, 1], [0, 4, 1, 1, 5, 2]];
        let maps: Vec<_> = blocks.iter().map(|a| CoatMap::new(&areas, a, 1.0).unwrap()).collect();
        let deviation = |t: usize, b: usize| {
            let h = [maps[b].thickness(t, 0), maps[b].thickness(t, 1)];
            let mean = (h[0] + 3.0 * h[1]) / 4.0;
            ([h[0] - mean, h[1] - mean], mean)
        };
        let (mut sum, mut mean) = (0.0, 0.0);
        for (t, b) in (0..3).flat_map(|t| [(t, 0), (t, 1)]) {
            mean += deviation(t, b).1 / 6.0;
            for other in (0..3).filter(|&o| o != t) {
                let (x, y) = (deviation(t, b).0, deviation(other, 1 - b).0);
                sum += (x[0] * y[0] + 3.0 * x[1] * y[1]) / 4.0 / 12.0;
            }
        }
        let few = Bootstrap { replicates: 20, ..Bootstrap::default() };
        let found = AsymptoteEstimate::from_blocks(&maps, 1.0, &few).unwrap().asymptote.cov_squared;
        assert!((found - sum / (mean * mean)).abs() < 1e-12, "{found}");
    }

    #[test]
    fn finds_the_limit_of_the_trial_process_where_the_average_tablet_is_still_biased() {
        let process = TrialProcess { tablets: 120, panels: 50, ..TrialProcess::PAPER };
        let (mut limit, mut average) = (0.0, 0.0);
        for seed in 0..20 {
            process
                .play(seed, &[300], |_, batch| {
                    let square = (120.0 * batch.variance_average_tablet - batch.variance_moments) / 119.0;
                    limit += square / batch.mean_thickness.powi(2) / 20.0;
                    average += batch.average_tablet.powi(2) / 20.0;
                })
                .unwrap();
        }
        let truth = process.asymptote().powi(2);
        assert!((limit / truth - 1.0).abs() < 0.008, "{}", limit / truth);
        assert!(average / truth > 1.012, "{}", average / truth);
    }

    #[test]
    fn a_uniform_coat_with_noise_has_a_limit_not_told_from_zero() {
        use rand::{RngExt, SeedableRng};
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(2);
        let amounts: Vec<u32> = (0..60 * 30).map(|_| rng.random_range(0..9)).collect();
        let areas = vec![1.0; 30];
        let map = CoatMap::new(&areas, &amounts, 1.0).unwrap();
        let estimate = AsymptoteEstimate::from_blocks(&[map], 1.0, &Bootstrap::default()).unwrap();
        assert!(!estimate.is_above_zero() && estimate.interval.high > 0.0, "{estimate:?}");
    }
}
