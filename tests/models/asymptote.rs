//! The estimate of the limit: unbiased from a short run, with an interval that covers the truth as often as it says.

use pancoat::models::{Asymptote, AsymptoteEstimate, BatchStatistics, CoatMap, RepresentativeTablet};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A made-up run: `tablets` tablets of panels with the true pattern `eta` (mean 1), coated in passes. In each block of time a
/// tablet makes a random number of passes; a pass lays eta × random exposure on a random half of the panels, so that panels
/// of a pass hang together. A fluctuation that all tablets of a block share may be added.
struct MadeUpRun {
    areas: Vec<f64>,
    eta: Vec<f64>,
    tablets: usize,
    shared: f64,
}

impl MadeUpRun {
    fn new(spread: f64, shared: f64) -> Self {
        let panels = 36;
        let areas: Vec<f64> = (0..panels).map(|j| 0.8 + 0.4 * f64::from(j % 3)).collect();
        let mut eta: Vec<f64> = (0..panels).map(|j| 1.0 + spread * (f64::from(j) * 0.7).sin()).collect();
        let mean = eta.iter().zip(&areas).map(|(e, a)| e * a).sum::<f64>() / areas.iter().sum::<f64>();
        for e in &mut eta {
            *e /= mean;
        }
        Self { areas, eta, tablets: 60, shared }
    }

    fn limit(&self) -> f64 {
        let area: f64 = self.areas.iter().sum();
        (self.eta.iter().zip(&self.areas).map(|(e, a)| (e - 1.0).powi(2) * a).sum::<f64>() / area).sqrt()
    }

    /// What each tablet gains in each block.
    fn play(&self, blocks: usize, passes: u32, seed: u64) -> Vec<Vec<f64>> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let panels = self.eta.len();
        let block = |rng: &mut ChaCha8Rng| {
            let wave: f64 = rng.random_range(0.0..std::f64::consts::TAU);
            let mut gain = vec![0.0; self.tablets * panels];
            for tablet in gain.chunks_exact_mut(panels) {
                for _ in 0..rng.random_range(0..=2 * passes) {
                    let (from, amount) = (rng.random_range(0..panels), rng.random_range(0.0..2.0));
                    for k in 0..panels / 2 {
                        let j = (from + k) % panels;
                        let common = 1.0 + self.shared * (j as f64 * 0.35 + wave).cos();
                        tablet[j] += amount * self.eta[j] * common * self.areas[j];
                    }
                }
            }
            gain
        };
        (0..blocks).map(|_| block(&mut rng)).collect()
    }

    fn estimate(&self, gains: &[Vec<f64>]) -> AsymptoteEstimate {
        let maps: Vec<_> =
            gains.iter().map(|g| CoatMap::new(&self.areas, g, 1.0).expect("whole tablets")).collect();
        AsymptoteEstimate::from_blocks(&maps, gains.len() as f64).expect("coated tablets")
    }
}

/// Share of 200 made-up runs whose interval holds the truth, and the mean of the estimates over the truth.
fn coverage(run: &MadeUpRun, blocks: usize, passes: u32) -> (f64, f64) {
    let truth = run.limit();
    let (mut covered, mut squares) = (0, 0.0);
    for seed in 0..200 {
        let estimate = run.estimate(&run.play(blocks, passes, seed));
        covered += u32::from((estimate.interval.low..=estimate.interval.high).contains(&truth));
        squares += estimate.asymptote.cov_squared / 200.0;
    }
    let found = (f64::from(covered) / 200.0, squares.sqrt() / truth);
    eprintln!(
        "{blocks} blocks, limit {truth:.3}: covered {:.3}, mean estimate over truth {:.4}",
        found.0, found.1
    );
    found
}

#[test]
fn the_interval_covers_the_truth_and_the_estimate_has_no_bias() {
    for (spread, blocks) in [(0.3, 1), (0.3, 6), (0.15, 6)] {
        let (covered, ratio) = coverage(&MadeUpRun::new(spread, 0.0), blocks, 12 / blocks as u32);
        assert!(covered >= 0.9, "{spread} {blocks}: covered {covered}");
        assert!((ratio - 1.0).abs() < 0.02, "{spread} {blocks}: bias {ratio}");
    }
}

/// What all tablets of a block share looks like a limit to a single block; several blocks tell it from one.
#[test]
fn blocks_tell_a_shared_fluctuation_from_a_limit() {
    let run = MadeUpRun::new(0.2, 0.35);
    // A small share can come out as none by chance.
    for (run, blocks) in [(&run, 8), (&MadeUpRun::new(0.2, 0.15), 5), (&MadeUpRun::new(0.2, 0.1), 5)] {
        let (covered, ratio) = coverage(run, blocks, 4);
        assert!(covered >= 0.93, "{blocks} blocks: covered {covered}");
        assert!((ratio - 1.0).abs() < 0.02, "{blocks} blocks: bias {ratio}");
    }
    let (mut one_block, mut average) = (0.0, 0.0);
    for seed in 0..40 {
        let gains = run.play(8, 4, seed);
        let total: Vec<f64> = (0..gains[0].len()).map(|k| gains.iter().map(|g| g[k]).sum()).collect();
        one_block += run.estimate(std::slice::from_ref(&total)).asymptote.cov_squared / 40.0;
        average += BatchStatistics::of(&CoatMap::new(&run.areas, &total, 1.0).unwrap())
            .unwrap()
            .average_tablet
            .powi(2)
            / 40.0;
    }
    assert!(
        one_block.sqrt() > 1.05 * run.limit() && average > one_block,
        "{} {}",
        one_block.sqrt(),
        run.limit()
    );
}

/// From a tenth of the data the estimate is within 2 % on average, and the law it gives foretells CoV_intra of the whole run,
/// where the average tablet is still far off.
#[test]
fn a_tenth_of_the_run_foretells_the_rest() {
    let run = MadeUpRun::new(0.3, 0.0);
    let (mut squares, mut average, mut foretold) = (0.0, 0.0, 0.0);
    for seed in 0..200 {
        let gains = run.play(20, 4, 1000 + seed);
        let Asymptote { cov_squared, noise_time } = run.estimate(&gains[..2]).asymptote;
        squares += cov_squared / 200.0;
        let sum = |n: usize| {
            (0..gains[0].len()).map(|k| gains[..n].iter().map(|g| g[k]).sum::<f64>()).collect::<Vec<_>>()
        };
        let batch = |n: usize| BatchStatistics::of(&CoatMap::new(&run.areas, &sum(n), 1.0).unwrap()).unwrap();
        average += batch(2).average_tablet / 200.0;
        foretold += (cov_squared + noise_time / 20.0).sqrt() / batch(20).moments / 200.0;
    }
    assert!((squares.sqrt() / run.limit() - 1.0).abs() < 0.02, "{} {}", squares.sqrt(), run.limit());
    assert!((foretold - 1.0).abs() < 0.02, "{foretold}");
    assert!(average / run.limit() > 1.025, "{}", average / run.limit());
}

#[test]
fn a_uniform_truth_gives_an_interval_from_zero() {
    let run = MadeUpRun::new(0.0, 0.0);
    let mut from_zero = 0;
    for seed in 0..100 {
        from_zero += usize::from(!run.estimate(&run.play(3, 4, seed)).is_above_zero());
    }
    assert!(from_zero >= 90, "{from_zero}");
}

#[test]
fn the_same_data_give_the_same_bits_on_any_number_of_threads() {
    let run = MadeUpRun::new(0.3, 0.2);
    let gains = run.play(4, 3, 1);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run.estimate(&gains))
    };
    assert_eq!(on(1), on(3));
}

/// Fig 5: coating one tablet with the trials of all gives the average tablet, whatever their order.
#[test]
fn the_representative_tablet_is_the_sum_over_tablets_and_times() {
    let run = MadeUpRun::new(0.3, 0.1);
    let gains = run.play(5, 3, 9);
    let panels = run.eta.len();
    let mut representative = RepresentativeTablet::new(panels);
    for tablet in (0..run.tablets).rev() {
        for gain in &gains {
            representative.add_trial(&gain[tablet * panels..][..panels]).unwrap();
        }
    }
    assert_eq!(representative.trials(), 300);
    let total: Vec<f64> = (0..gains[0].len()).map(|k| gains.iter().map(|g| g[k]).sum()).collect();
    let batch = BatchStatistics::of(&CoatMap::new(&run.areas, &total, 1.0).unwrap()).unwrap();
    assert!((representative.cov(&run.areas).unwrap() / batch.average_tablet - 1.0).abs() < 1e-12);
    let thickness = representative.thickness(&run.areas, batch.mean_thickness).unwrap();
    assert!(thickness.iter().zip(&batch.average).all(|(a, b)| (a / b - 1.0).abs() < 1e-12));
}
