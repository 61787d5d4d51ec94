//! The limit of intra-tablet uniformity, estimated from a run too short to reach it.

use super::student::student_95;
use super::{Amount, Asymptote, CoatMap, Interval, ModelError};
use rayon::prelude::*;

/// An [`Asymptote`] with its interval.
///
/// # Estimate
/// Let d_ib be the thickness that tablet i = 1..N gains in time block b = 1..B, less its own mean, and
/// ⟨f, g⟩ = 1/A Σ_j f_j g_j A_j. In a stationary bed d_ib = η + noise with the same η for all tablets and blocks; η is what is
/// left after infinite time, so the limit is CoV_∞ = √⟨η, η⟩ / μ, μ the mean gain of a tablet in a block. The variance of any
/// finite average holds ⟨η, η⟩ *and* noise. But for two different tablets in two different blocks the noise is independent,
/// hence E⟨d_ib, d_kc⟩ = ⟨η, η⟩ exactly, and so is the mean over all pairs with i ≠ k, b ≠ c:
///
/// ```text
/// ⟨η, η⟩ ≈ ( ‖Σ_ib d_ib‖² − Σ_i ‖Σ_b d_ib‖² − Σ_b ‖Σ_i d_ib‖² + Σ_ib ‖d_ib‖² ) / (N (N−1) B (B−1))
/// ```
///
/// With one block the pairs differ in the tablet only, and in the paper's σ_t (Eq 18) and σ_m (Eq 14) this is
/// σ_∞² = (N σ_t² − σ_m²)/(N − 1): the average tablet less its finite-sample bias. What single tablets have above it gives
/// K = T (σ_m² − σ_∞²)/μ² after the time T. CoV_∞² comes out negative when the limit is too small to be told from zero; the
/// sign is kept in [`Asymptote::cov_squared`], and [`Asymptote::cov`] is then 0.
///
/// # Interval
/// The estimate is a function of weights on all gains. Its derivative g_ib by each weight gives the variance that tablets and
/// blocks put into it, V = Σ_i (Σ_b g_ib)² + Σ_b (Σ_i g_ib)² − Σ_ib g_ib² (two-way clustering: Cameron, Gelbach and Miller
/// 2011, J. Bus. Econ. Stat. 29, 238), and CoV_∞² ± t √V with Student's t of Satterthwaite's degrees of freedom. Resampling
/// tablets and blocks together instead counts the noise of single gains three times (Owen 2007, Ann. Appl. Stat. 1, 386) and
/// costs two passes for every resampled set. Blocks make the interval know of fluctuations that all tablets
/// share, when a block is longer than these last; with fewer than four blocks it knows of none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AsymptoteEstimate {
    /// The limit.
    pub asymptote: Asymptote,
    /// 95 % interval of CoV_∞; its lower end is 0 when the limit cannot be told from zero.
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

    /// Estimates from what each tablet gained in successive `blocks` of time of equal length, which add up to `duration` (s).
    /// Takes two passes over the gains; the same bits on any number of threads.
    ///
    /// # Errors
    /// [`ModelError::TooFew`] below two tablets or without blocks, [`ModelError::Length`] when blocks differ in tablets,
    /// [`ModelError::Uncoated`] when nothing is coated.
    pub fn from_blocks<T: Amount>(blocks: &[CoatMap<'_, T>], duration: f64) -> Result<Self, ModelError> {
        let sums = Sums::new(blocks)?;
        let (n, b) = (sums.tablets as f64, blocks.len() as f64);
        let cells: Vec<Cell> =
            (0..sums.tablets).into_par_iter().flat_map_iter(|tablet| sums.cells(tablet)).collect();

        let mean = cells.iter().map(|cell| cell.mean).sum::<f64>() / (n * b);
        if mean <= 0.0 {
            return Err(ModelError::Uncoated);
        }
        // Half the derivative of the sum over pairs by the weight of each cell: the sum itself is theirs over all cells.
        let pairs = |cell: &Cell| match blocks.len() {
            1 => cell.with_all - cell.with_tablet,
            _ => cell.with_all - cell.with_tablet - cell.with_block + cell.with_itself,
        };
        let others = if blocks.len() > 1 { (n - 1.0) * (b - 1.0) } else { n - 1.0 };
        let limit = cells.iter().map(pairs).sum::<f64>() / (n * b * others);
        let single = cells.iter().map(|cell| cell.with_tablet).sum::<f64>() / (n * b * b);
        let cov_squared = limit / (mean * mean);

        // Derivative of limit/mean² by the weight of each cell, at equal weights.
        let derivative = |cell: &Cell| {
            2.0 / (n * b)
                * ((pairs(cell) / others - limit) / (mean * mean) - cov_squared * (cell.mean / mean - 1.0))
        };
        let half = half_width(&cells.iter().map(derivative).collect::<Vec<_>>(), blocks.len());
        Ok(Self {
            asymptote: Asymptote { cov_squared, noise_time: duration * (single - limit) / (mean * mean) },
            interval: Interval {
                low: (cov_squared - half).max(0.0).sqrt(),
                high: (cov_squared + half).max(0.0).sqrt(),
            },
            duration,
            tablets: sums.tablets,
            blocks: blocks.len(),
        })
    }
}

/// Fewer blocks cannot tell what tablets share from chance.
const ENOUGH_BLOCKS: usize = 4;

/// Half the 95 % interval of a quantity with these derivatives by the weights of its cells, `tablets × blocks`.
fn half_width(derivatives: &[f64], blocks: usize) -> f64 {
    let tablets = derivatives.len() / blocks;
    let square = |sum: f64| sum * sum;
    let by_tablet: f64 = derivatives.chunks_exact(blocks).map(|row| square(row.iter().sum())).sum();
    let by_block: f64 = (0..blocks).map(|b| square(derivatives.iter().skip(b).step_by(blocks).sum())).sum();
    let by_cell: f64 = derivatives.iter().map(|g| g * g).sum();
    let freedom = |units: usize| (units as f64 - 1.0).max(1.0);
    let by_block = if blocks >= ENOUGH_BLOCKS { by_block * blocks as f64 / freedom(blocks) } else { 0.0 };
    // What all tablets of a block share comes to what blocks have beyond their single gains. It may come out too small by
    // chance, which is why the freedom is that of all that blocks have.
    let variance = by_tablet + (by_block - by_cell).max(0.0);
    let degrees =
        variance * variance / (by_tablet.powi(2) / freedom(tablets) + by_block.powi(2) / freedom(blocks));
    student_95(degrees) * variance.sqrt()
}

/// What one tablet gained in one block: its mean, and the products ⟨d_ib, ·⟩ that the estimate is made of.
#[derive(Debug, Clone, Copy)]
struct Cell {
    mean: f64,
    /// With Σ d over all tablets and blocks.
    with_all: f64,
    /// With Σ d over the blocks of its tablet.
    with_tablet: f64,
    /// With Σ d over the tablets of its block.
    with_block: f64,
    /// With itself.
    with_itself: f64,
}

/// Sums over tablets, in counts per area.
struct Sums<'a, T> {
    blocks: &'a [CoatMap<'a, T>],
    areas: &'a [f64],
    area: f64,
    tablets: usize,
    /// Σ_i d_ib of each block.
    of_block: Vec<Vec<f64>>,
    /// Σ_ib d_ib.
    of_all: Vec<f64>,
}

impl<'a, T: Amount> Sums<'a, T> {
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
        let sum = |block: &CoatMap<'_, T>| {
            let mut counts = vec![0.0; areas.len()];
            for row in block.amounts().chunks_exact(areas.len()) {
                counts.iter_mut().zip(row).for_each(|(sum, c)| *sum += c.value());
            }
            deviation(&counts, areas).0
        };
        let of_block: Vec<Vec<f64>> = blocks.par_iter().map(sum).collect();
        let of_all = (0..areas.len()).map(|j| of_block.iter().map(|d| d[j]).sum()).collect();
        Ok(Self { blocks, areas, area: areas.iter().sum(), tablets, of_block, of_all })
    }

    /// The cells of a tablet, block after block.
    fn cells(&self, tablet: usize) -> Vec<Cell> {
        let gain = |block: &CoatMap<'_, T>| {
            deviation(&block.row(tablet).iter().map(|c| c.value()).collect::<Vec<_>>(), self.areas)
        };
        let gains: Vec<(Vec<f64>, f64)> = self.blocks.iter().map(gain).collect();
        let of_tablet: Vec<f64> =
            (0..self.areas.len()).map(|j| gains.iter().map(|(d, _)| d[j]).sum()).collect();
        let cell = |((d, mean), of_block): (&(Vec<f64>, f64), &Vec<f64>)| Cell {
            mean: *mean,
            with_all: self.product(d, &self.of_all),
            with_tablet: self.product(d, &of_tablet),
            with_block: self.product(d, of_block),
            with_itself: self.product(d, d),
        };
        gains.iter().zip(&self.of_block).map(cell).collect()
    }

    /// ⟨f, g⟩
    fn product(&self, f: &[f64], g: &[f64]) -> f64 {
        f.iter().zip(g).zip(self.areas).map(|((f, g), a)| f * g * a).sum::<f64>() / self.area
    }
}

/// Counts per area less their mean over the surface, and that mean.
fn deviation(counts: &[f64], areas: &[f64]) -> (Vec<f64>, f64) {
    let mean = counts.iter().sum::<f64>() / areas.iter().sum::<f64>();
    (counts.iter().zip(areas).map(|(c, a)| c / a - mean).collect(), mean)
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
        let found = AsymptoteEstimate::from_blocks(&[map], 10.0).unwrap().asymptote;
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
        let found = AsymptoteEstimate::from_blocks(&maps, 1.0).unwrap().asymptote.cov_squared;
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
        let estimate = AsymptoteEstimate::from_blocks(&[map], 1.0).unwrap();
        assert!(!estimate.is_above_zero() && estimate.interval.high > 0.0, "{estimate:?}");
    }
}
