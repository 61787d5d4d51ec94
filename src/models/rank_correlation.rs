//! Do two quantities rank a few shapes in the same order?

use super::ModelError;
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

/// Spearman's rank correlation with the probability of one at least as strong by chance.
///
/// Source: Spearman 1904, Am. J. Psychol. 15, 72; ties take their mean rank. Up to nine pairs the p-value is exact, over all
/// permutations; with more it is that of 100 000 random permutations (seeded). Two-sided.
///
/// ```
/// use pancoat::models::Spearman;
/// // Sphericity of four tablet shapes against the order of their limits of CoV_intra (almond, oval, round, triangular):
/// let s = Spearman::test(&[0.8383, 0.8816, 0.8502, 0.8835], &[4.0, 1.0, 3.0, 2.0])?;
/// assert!((s.rho + 0.8).abs() < 1e-12);
/// assert!((s.p_value - 8.0 / 24.0).abs() < 1e-12); // four shapes cannot show a correlation
/// # Ok::<(), pancoat::models::ModelError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spearman {
    /// Correlation of ranks, −1 to 1.
    pub rho: f64,
    /// Probability of |ρ| at least as large if the order were random.
    pub p_value: f64,
}

const EXACT_UP_TO: usize = 9;
const RANDOM_PERMUTATIONS: usize = 100_000;

impl Spearman {
    /// Correlates `x` with `y`, pair by pair.
    ///
    /// # Errors
    /// [`ModelError::Length`] when the lists differ, [`ModelError::TooFew`] below three pairs and when all values of a list
    /// are equal.
    pub fn test(x: &[f64], y: &[f64]) -> Result<Self, ModelError> {
        if x.len() != y.len() {
            return Err(ModelError::Length { what: "second values", found: y.len(), expected: x.len() });
        }
        let (x, mut y) = (centred_ranks(x), centred_ranks(y));
        let norm = (dot(&x, &x) * dot(&y, &y)).sqrt();
        if x.len() < 3 || norm == 0.0 {
            return Err(ModelError::TooFew {
                what: "a rank correlation",
                unit: "pairs",
                found: x.len(),
                needed: 3,
            });
        }
        let product = dot(&x, &y);
        // Ranks are multiples of a half: products of equal strength differ by round-off only.
        let as_strong = |y: &[f64]| dot(&x, y).abs() > product.abs() - 1e-9;
        let (mut hits, mut all) = (0_usize, 0_usize);
        if x.len() <= EXACT_UP_TO {
            permutations(&mut y, 0, &mut |y| {
                all += 1;
                hits += usize::from(as_strong(y));
            });
        } else {
            let mut rng = ChaCha8Rng::seed_from_u64(1);
            // The order found is one of them, so that the p-value is never zero.
            (hits, all) = (1, RANDOM_PERMUTATIONS + 1);
            for _ in 0..RANDOM_PERMUTATIONS {
                y.shuffle(&mut rng);
                hits += usize::from(as_strong(&y));
            }
        }
        Ok(Self { rho: product / norm, p_value: hits as f64 / all as f64 })
    }
}

/// Ranks less their mean; equal values share the mean of their ranks.
fn centred_ranks(values: &[f64]) -> Vec<f64> {
    let rank = |v: &f64| {
        let below = values.iter().filter(|o| *o < v).count() as f64;
        let equal = values.iter().filter(|o| *o == v).count() as f64;
        below + (equal - values.len() as f64) / 2.0
    };
    values.iter().map(rank).collect()
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(a, b)| a * b).sum()
}

/// Visits all orders of the values from `fixed` on.
fn permutations(values: &mut [f64], fixed: usize, visit: &mut impl FnMut(&[f64])) {
    if fixed + 1 >= values.len() {
        return visit(values);
    }
    for k in fixed..values.len() {
        values.swap(fixed, k);
        permutations(values, fixed + 1, visit);
        values.swap(fixed, k);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn perfect_orders_and_ties() {
        let rising = Spearman::test(&[1.0, 2.0, 3.0, 4.0, 5.0], &[2.0, 4.0, 8.0, 16.0, 32.0]).unwrap();
        assert!((rising.rho - 1.0).abs() < 1e-12 && (rising.p_value - 2.0 / 120.0).abs() < 1e-12);
        // Ranks 1.5, 1.5, 3 against 1, 2, 3: ρ = 1.5/sqrt(1.5 · 2)
        let tied = Spearman::test(&[1.0, 1.0, 2.0], &[1.0, 2.0, 3.0]).unwrap();
        assert!((tied.rho - 1.5 / 3.0_f64.sqrt()).abs() < 1e-12);
        assert!(matches!(Spearman::test(&[1.0, 1.0, 1.0], &[1.0, 2.0, 3.0]), Err(ModelError::TooFew { .. })));
    }

    #[test]
    fn many_pairs_use_random_orders_that_agree_with_the_exact_count() {
        let x: Vec<f64> = (0..10).map(f64::from).collect();
        let y = [0.0, 2.0, 1.0, 5.0, 3.0, 4.0, 9.0, 6.0, 8.0, 7.0];
        let found = Spearman::test(&x, &y).unwrap(); // Σd² = 22: ρ = 1 − 6 · 22/990
        assert!((found.rho - (1.0 - 132.0 / 990.0)).abs() < 1e-12);
        // Student's t with 8 degrees of freedom puts it at 0.0012.
        assert!((0.0006..0.003).contains(&found.p_value), "{found:?}");
    }
}
