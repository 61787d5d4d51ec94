//! The imaginary coating process by which the appendix of the paper compares averaging schemes (A.6, Fig A1).

use super::{BatchStatistics, CoatMap, ModelError};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// In every trial each of `tablets` tablets is coated with probability `coated_fraction`, independently; a tablet that is
/// coated receives one unit on panel j with probability p_j = `peak` · j / N_p, j = 1..N_p, independently. All panels
/// have the same area.
///
/// The paper has 1000 tablets of 100 panels, a fraction of 0.1 and a peak of 0.1. (It says that 10 % of the surface is
/// coated per trial; with these p_j it is their mean, 5.05 %.)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrialProcess {
    /// Number of tablets N.
    pub tablets: usize,
    /// Panels per tablet N_p.
    pub panels: usize,
    /// Probability α that a tablet takes part in a trial.
    pub coated_fraction: f64,
    /// Probability of the most exposed panel.
    pub peak: f64,
}

/// Exact expectations of the batch averages: roots of ratios of expected moments.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrialExpectation {
    /// "Averaging moments" (Eq 15).
    pub moments: f64,
    /// "Average tablet" (Eq 19).
    pub average_tablet: f64,
    /// "Total area" (Eq 22).
    pub total_area: f64,
    /// CoV_inter.
    pub inter: f64,
}

impl TrialProcess {
    /// The process of Fig A1.
    pub const PAPER: Self = Self { tablets: 1000, panels: 100, coated_fraction: 0.1, peak: 0.1 };

    fn probability(&self, panel: usize) -> f64 {
        self.peak * (panel + 1) as f64 / self.panels as f64
    }

    /// Mean of p_j, mean of p_j (1 − p_j), variance of p_j over panels.
    fn panel_moments(&self) -> (f64, f64, f64) {
        let n = self.panels as f64;
        let mean = (0..self.panels).map(|j| self.probability(j)).sum::<f64>() / n;
        let square = (0..self.panels).map(|j| self.probability(j).powi(2)).sum::<f64>() / n;
        (mean, mean - square, square - mean * mean)
    }

    /// CoV_intra after infinitely many trials, sd(p)/mean(p).
    ///
    /// ```
    /// # use pancoat::models::TrialProcess;
    /// assert!((TrialProcess::PAPER.asymptote() - 0.571_605_3).abs() < 1e-7);
    /// ```
    pub fn asymptote(&self) -> f64 {
        let (mean, _, variance) = self.panel_moments();
        variance.sqrt() / mean
    }

    /// Exact expectations after `trials` trials. Derived here: tablet i is coated K_i ~ Bin(C, α) times, and
    /// h_ij | K_i ~ Bin(K_i, p_j). With Var K = Cα(1−α), p̄, m = mean p(1−p), v = var p over panels,
    ///
    /// - E σ_m² = Cα m (1 − 1/N_p) + (Var K + C²α²) v,
    /// - Var μ_i = Cα m / N_p + Var K p̄², of which the batch variance holds the share 1 − 1/N,
    /// - E σ_t² = C²α² v + (Cα m (1 − 1/N_p) + Var K v) / N,
    /// - σ_T² = σ_m² + σ_inter² (Eq 30), mean thickness Cα p̄.
    ///
    /// ```
    /// # use pancoat::models::TrialProcess;
    /// let e = TrialProcess::PAPER.expectation(1000.0);
    /// assert!((e.moments - 0.715946).abs() < 1e-6 && (e.average_tablet - 0.571768).abs() < 1e-6);
    /// assert!((e.total_area - 0.723474).abs() < 1e-6 && (e.inter - 0.104099).abs() < 1e-6);
    /// ```
    pub fn expectation(&self, trials: f64) -> TrialExpectation {
        let (mean_p, m, v) = self.panel_moments();
        let (n, np) = (self.tablets as f64, self.panels as f64);
        let coatings = trials * self.coated_fraction;
        let var_k = coatings * (1.0 - self.coated_fraction);
        let noise = coatings * m * (1.0 - 1.0 / np) + var_k * v;
        let variance_moments = noise + coatings * coatings * v;
        let variance_average = noise / n + coatings * coatings * v;
        let variance_inter = (coatings * m / np + var_k * mean_p * mean_p) * (1.0 - 1.0 / n);
        let cov = |variance: f64| variance.sqrt() / (coatings * mean_p);
        TrialExpectation {
            moments: cov(variance_moments),
            average_tablet: cov(variance_average),
            total_area: cov(variance_moments + variance_inter),
            inter: cov(variance_inter),
        }
    }

    /// Probability that every tablet carries some coating after `trials` trials, so that "each tablet" (Eq 12) exists.
    pub fn probability_all_coated(&self, trials: f64) -> f64 {
        let bare = (0..self.panels).map(|j| 1.0 - self.probability(j)).product::<f64>();
        let missed = 1.0 - self.coated_fraction * (1.0 - bare);
        (1.0 - missed.powf(trials)).powf(self.tablets as f64)
    }

    /// Plays the process and hands `at` the batch after each of the trials listed in `when` (ascending).
    ///
    /// # Errors
    /// Those of [`BatchStatistics::of`], [`ModelError::Uncoated`] excepted: such a batch is passed over.
    pub fn play(
        &self,
        seed: u64,
        when: &[u64],
        mut at: impl FnMut(u64, &BatchStatistics),
    ) -> Result<(), ModelError> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let areas = vec![1.0; self.panels];
        let probabilities: Vec<f64> = (0..self.panels).map(|j| self.probability(j)).collect();
        let mut amounts = vec![0_u32; self.tablets * self.panels];
        let mut done = 0;
        for &trials in when {
            for _ in done..trials {
                for tablet in amounts.chunks_exact_mut(self.panels) {
                    if rng.random_bool(self.coated_fraction) {
                        for (amount, &p) in tablet.iter_mut().zip(&probabilities) {
                            *amount += u32::from(rng.random_bool(p));
                        }
                    }
                }
            }
            done = trials;
            match BatchStatistics::of(&CoatMap::new(&areas, &amounts, 1.0)?) {
                Ok(batch) => at(trials, &batch),
                Err(ModelError::Uncoated) => {}
                Err(other) => return Err(other),
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Trials, moments, average tablet, total area, inter: covariance algebra done apart from this file.
    #[expect(clippy::unreadable_literal, reason = "digits as tabulated")]
    const TABLE: [[f64; 5]; 4] = [
        [10.0, 4.34871, 0.587637, 4.47157, 1.04099],
        [100.0, 1.47824, 0.573229, 1.51445, 0.329191],
        [1000.0, 0.715946, 0.571768, 0.723474, 0.104099],
        [10000.0, 0.587637, 0.571622, 0.588558, 0.032919],
    ];

    #[test]
    fn expectations_are_the_tabulated_ones() {
        for [trials, moments, average, total, inter] in TABLE {
            let e = TrialProcess::PAPER.expectation(trials);
            for (found, wanted) in
                [(e.moments, moments), (e.average_tablet, average), (e.total_area, total), (e.inter, inter)]
            {
                assert!((found - wanted).abs() < 5e-6, "{trials}: {found} {wanted}");
            }
        }
    }

    #[test]
    fn each_tablet_first_exists_between_60_and_80_trials() {
        let process = TrialProcess::PAPER;
        let first = (1..200).find(|&c| process.probability_all_coated(f64::from(c)) > 0.5);
        assert!((60..80).contains(&first.unwrap()), "{first:?}");
    }

    #[test]
    fn played_batches_scatter_about_the_expectation() {
        let process = TrialProcess { tablets: 500, panels: 40, ..TrialProcess::PAPER };
        process
            .play(3, &[100, 400], |trials, batch| {
                let e = process.expectation(trials as f64);
                assert!((batch.moments / e.moments - 1.0).abs() < 0.02, "{trials}");
                assert!((batch.average_tablet / e.average_tablet - 1.0).abs() < 0.02);
                assert!((batch.inter / e.inter - 1.0).abs() < 0.1);
                assert!(batch.identities.worst() < 1e-12);
            })
            .unwrap();
    }
}
