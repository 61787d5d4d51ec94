//! The averages over a batch: four ways to one number, and the identities that tie them.

use super::{Amount, CoatMap, ModelError};
use rayon::prelude::*;

/// Tablets per unit of parallel work. Fixed, so that sums are taken in the same order on any number of threads.
const CHUNK: usize = 32;

/// Mean and standard deviation of the thickness over one tablet (Eqs 9-10), m.
///
/// Eqs 6-7 of the paper print 1/N_p where 1/A is meant: with 1/N_p the mean has the unit m³.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TabletMoments {
    /// μ_i, m.
    pub mean: f64,
    /// σ_i, m.
    pub sd: f64,
}

impl TabletMoments {
    /// CoV_intra,i (Eq 11); `None` for a tablet without coating.
    pub fn cov(&self) -> Option<f64> {
        (self.mean > 0.0).then(|| self.sd / self.mean)
    }
}

/// How far the computed averages are from identities that hold exactly. All are round-off, 1e-12 or less, unless the
/// arithmetic is wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Identities {
    /// Eq 25, μ_t = μ_m = μ_T: largest difference over μ_T.
    pub means: f64,
    /// Eq 30, σ_T² = σ_m² + σ_inter²: difference over μ_T² + σ_T².
    pub variances: f64,
    /// Eq 34, σ_t² ≤ σ_m²: how far σ_t² is above σ_m², over μ_T² + σ_T²; 0 when it is not.
    pub average_tablet_excess: f64,
}

impl Identities {
    /// Largest of the three.
    pub fn worst(&self) -> f64 {
        self.means.max(self.variances).max(self.average_tablet_excess)
    }
}

/// Everything the appendix of the paper defines for a batch at one time.
///
/// The variances over tablets and panels are those of the whole batch (divisor N, area weights), as in the paper; only
/// [`BatchStatistics::sd_cov_intra`] is a sample standard deviation.
///
/// Two tablets with two panels of equal area and thicknesses (1, 3) and (2, 2) µm: σ_1 = 1, σ_2 = 0, all means 2 µm, the
/// average tablet has (1.5, 2.5):
///
/// ```
/// use pancoat::models::{BatchStatistics, CoatMap};
/// let areas = [1.0e-6, 1.0e-6];
/// let map = CoatMap::new(&areas, &[1_u32, 3, 2, 2], 1.0e-12)?;
/// let batch = BatchStatistics::of(&map)?;
/// assert!((batch.mean_thickness - 2.0e-6).abs() < 1e-18);
/// assert!((batch.each_tablet.unwrap() - 0.25).abs() < 1e-12); // (1/2 + 0)/2
/// assert!((batch.moments - 0.5_f64.sqrt() / 2.0).abs() < 1e-12); // sqrt((1 + 0)/2) / 2
/// assert!((batch.average_tablet - 0.25).abs() < 1e-12); // 0.5 / 2
/// assert!((batch.total_area - batch.moments).abs() < 1e-12); // no inter-tablet variance
/// assert!(batch.inter.abs() < 1e-12);
/// # Ok::<(), pancoat::models::ModelError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct BatchStatistics {
    /// μ_T = μ_m = μ_t, m (Eq 25).
    pub mean_thickness: f64,
    /// Mean of CoV_intra,i over tablets (Eq 12); `None` while a tablet has no coating.
    pub each_tablet: Option<f64>,
    /// σ_m/μ_m, "averaging moments" (Eqs 8, 15): the paper's CoV_intra.
    pub moments: f64,
    /// σ_t/μ_t of the average tablet (Eq 19).
    pub average_tablet: f64,
    /// σ_T/μ_T over the whole area of the batch (Eq 22).
    pub total_area: f64,
    /// σ_inter/μ of the mean thickness per tablet (second term of Eq 29).
    pub inter: f64,
    /// Sample standard deviation of CoV_intra,i over tablets; `None` while a tablet has no coating.
    pub sd_cov_intra: Option<f64>,
    /// σ_m², m² (Eq 14).
    pub variance_moments: f64,
    /// σ_t², m² (Eq 18).
    pub variance_average_tablet: f64,
    /// Moments of each tablet.
    pub tablets: Vec<TabletMoments>,
    /// h_j, thickness of each panel of the average tablet, m (Eq 16).
    pub average: Vec<f64>,
    /// Standard deviation over tablets of the thickness of each panel, m: how far a single tablet's map is from the average's.
    pub panel_sd: Vec<f64>,
    /// How well the identities hold.
    pub identities: Identities,
}

/// What one chunk of tablets adds up to.
struct Part {
    tablets: Vec<TabletMoments>,
    /// Σ_i c_ij
    columns: Vec<f64>,
    /// Σ_i c_ij²
    column_squares: Vec<f64>,
    /// Σ_i Σ_j c_ij² / A_j
    squares: f64,
}

impl BatchStatistics {
    /// The statistics of a map: one pass over the amounts, parallel over tablets, the same bits on any number of threads.
    ///
    /// # Errors
    /// [`ModelError::Uncoated`] when nothing is coated yet, [`ModelError::TooFew`] without tablets.
    pub fn of<T: Amount>(map: &CoatMap<'_, T>) -> Result<Self, ModelError> {
        let n = map.tablets() as f64;
        if map.tablets() == 0 {
            return Err(ModelError::TooFew { what: "a batch average", unit: "tablets", found: 0, needed: 1 });
        }
        let area = map.tablet_area();
        let parts: Vec<Part> =
            map.amounts().par_chunks(CHUNK * map.panels()).map(|rows| part(map, rows, area)).collect();

        let mut tablets = Vec::with_capacity(map.tablets());
        let mut columns = vec![0.0; map.panels()];
        let mut column_squares = vec![0.0; map.panels()];
        let mut squares = 0.0;
        for part in parts {
            tablets.extend(part.tablets);
            columns.iter_mut().zip(part.columns).for_each(|(sum, c)| *sum += c);
            column_squares.iter_mut().zip(part.column_squares).for_each(|(sum, c)| *sum += c);
            squares += part.squares;
        }
        let kv = map.unit_volume();
        let mean_total = kv * columns.iter().sum::<f64>() / (area * n);
        if mean_total <= 0.0 {
            return Err(ModelError::Uncoated);
        }
        let average: Vec<f64> = columns.iter().zip(map.areas()).map(|(c, a)| kv * c / (a * n)).collect();
        let panel_sd = (0..map.panels())
            .map(|j| kv / map.areas()[j] * (column_squares[j] / n - (columns[j] / n).powi(2)).max(0.0).sqrt())
            .collect();
        let (mean_average, variance_average_tablet) = area_moments(&average, map.areas());
        let mean_moments = tablets.iter().map(|t| t.mean).sum::<f64>() / n;
        let variance_moments = tablets.iter().map(|t| t.sd * t.sd).sum::<f64>() / n;
        let variance_inter = tablets.iter().map(|t| (t.mean - mean_moments).powi(2)).sum::<f64>() / n;
        // From raw second moments, so that Eq 30 is checked and not assumed.
        let mean_square = kv * kv * squares / (area * n);
        let variance_total = (mean_square - mean_total * mean_total).max(0.0);

        let identities = Identities {
            means: (mean_average - mean_total).abs().max((mean_moments - mean_total).abs()) / mean_total,
            variances: (variance_total - variance_moments - variance_inter).abs() / mean_square,
            average_tablet_excess: ((variance_average_tablet - variance_moments) / mean_square).max(0.0),
        };
        let covs: Option<Vec<f64>> = tablets.iter().map(TabletMoments::cov).collect();
        Ok(Self {
            mean_thickness: mean_total,
            each_tablet: covs.as_ref().map(|c| c.iter().sum::<f64>() / n),
            moments: variance_moments.sqrt() / mean_moments,
            average_tablet: variance_average_tablet.sqrt() / mean_average,
            total_area: variance_total.sqrt() / mean_total,
            inter: variance_inter.sqrt() / mean_moments,
            sd_cov_intra: covs.as_ref().and_then(|c| sample_sd(c)),
            variance_moments,
            variance_average_tablet,
            tablets,
            average,
            panel_sd,
            identities,
        })
    }
}

impl BatchStatistics {
    /// The tablets in the order of their CoV_intra,i, most uniform first; those without coating are left out.
    pub fn ranked(&self) -> Vec<usize> {
        let mut coated: Vec<(f64, usize)> =
            self.tablets.iter().enumerate().filter_map(|(i, t)| Some((t.cov()?, i))).collect();
        coated.sort_by(|a, b| a.0.total_cmp(&b.0));
        coated.into_iter().map(|(_, tablet)| tablet).collect()
    }
}

/// One pass over the rows of a chunk; each row is short enough to stay in the cache between its mean and its deviations.
fn part<T: Amount>(map: &CoatMap<'_, T>, rows: &[T], area: f64) -> Part {
    let mut part = Part {
        tablets: Vec::with_capacity(CHUNK),
        columns: vec![0.0; map.panels()],
        column_squares: vec![0.0; map.panels()],
        squares: 0.0,
    };
    let kv = map.unit_volume();
    for row in rows.chunks_exact(map.panels()) {
        let mut sum = 0.0;
        for (&c, column) in row.iter().zip(&mut part.columns) {
            let c = c.value();
            sum += c;
            *column += c;
        }
        let mean = sum / area; // counts per m²: μ_i / k_V
        let (mut deviations, mut squares) = (0.0, 0.0);
        for ((&c, a), column_square) in row.iter().zip(map.areas()).zip(&mut part.column_squares) {
            let c = c.value();
            *column_square += c * c;
            let h = c / a;
            deviations += (h - mean) * (h - mean) * a;
            squares += h * c;
        }
        part.squares += squares;
        part.tablets.push(TabletMoments { mean: kv * mean, sd: kv * (deviations / area).sqrt() });
    }
    part
}

/// Mean and variance over a surface of panels with `areas`.
pub(super) fn area_moments(thickness: &[f64], areas: &[f64]) -> (f64, f64) {
    let area: f64 = areas.iter().sum();
    let mean = thickness.iter().zip(areas).map(|(h, a)| h * a).sum::<f64>() / area;
    let variance = thickness.iter().zip(areas).map(|(h, a)| (h - mean).powi(2) * a).sum::<f64>() / area;
    (mean, variance)
}

/// Standard deviation with divisor n − 1; `None` below two values.
pub fn sample_sd(values: &[f64]) -> Option<f64> {
    let n = values.len() as f64;
    if values.len() < 2 {
        return None;
    }
    let mean = values.iter().sum::<f64>() / n;
    Some((values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn random_map(tablets: usize, panels: usize) -> (Vec<f64>, Vec<u32>) {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let areas = (0..panels).map(|_| rng.random_range(0.2e-6..0.5e-6)).collect();
        let amounts = (0..tablets * panels).map(|i| rng.random_range(0..(3 + i as u32 % 5))).collect();
        (areas, amounts)
    }

    #[test]
    fn identities_hold_to_round_off_and_the_order_is_the_papers() {
        let (areas, amounts) = random_map(75, 40);
        let s = BatchStatistics::of(&CoatMap::new(&areas, &amounts, 3.0e-14).unwrap()).unwrap();
        assert!(s.identities.worst() < 1e-13, "{:?}", s.identities);
        assert!(s.average_tablet <= s.moments && s.moments < s.total_area);
    }

    #[test]
    fn matches_the_defining_sums_written_out() {
        let (areas, amounts) = random_map(70, 9);
        let map = CoatMap::new(&areas, &amounts, 2.0e-13).unwrap();
        let s = BatchStatistics::of(&map).unwrap();
        let area: f64 = areas.iter().sum();
        let mut variance = 0.0;
        for i in 0..70 {
            for (j, a) in areas.iter().enumerate() {
                variance += (map.thickness(i, j) - s.mean_thickness).powi(2) * a / (70.0 * area); // Eq 21
            }
        }
        assert!((variance.sqrt() / s.mean_thickness / s.total_area - 1.0).abs() < 1e-12);
        let h3 = (0..70).map(|i| map.thickness(i, 3)).sum::<f64>() / 70.0; // Eq 16
        assert!((s.average[3] / h3 - 1.0).abs() < 1e-12);
        let sd3 = ((0..70).map(|i| (map.thickness(i, 3) - h3).powi(2)).sum::<f64>() / 70.0).sqrt();
        assert!((s.panel_sd[3] / sd3 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_unit_of_the_amounts_does_not_change_a_ratio() {
        let (areas, amounts) = random_map(40, 12);
        let a = BatchStatistics::of(&CoatMap::new(&areas, &amounts, 1.0).unwrap()).unwrap();
        let b = BatchStatistics::of(&CoatMap::new(&areas, &amounts, 1.0e-17).unwrap()).unwrap();
        assert!((a.moments / b.moments - 1.0).abs() < 1e-12);
        assert!((a.inter / b.inter - 1.0).abs() < 1e-12);
    }

    #[test]
    fn same_bits_on_one_and_on_three_threads() {
        let (areas, amounts) = random_map(300, 33);
        let amounts: Vec<f64> = amounts.iter().map(|&c| f64::from(c) * 0.1).collect();
        let of = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| BatchStatistics::of(&CoatMap::new(&areas, &amounts, 1.0).unwrap()).unwrap())
        };
        assert_eq!(of(1), of(3));
    }

    #[test]
    fn an_uncoated_tablet_hides_each_tablet_but_nothing_else() {
        let s = BatchStatistics::of(&CoatMap::new(&[1.0, 1.0], &[1_u32, 3, 0, 0], 1.0).unwrap()).unwrap();
        assert_eq!((s.each_tablet, s.sd_cov_intra), (None, None));
        assert!(s.moments > 0.0);
        assert_eq!(s.ranked(), [0]);
        let none = BatchStatistics::of(&CoatMap::new(&[1.0], &[0_u32; 4], 1.0).unwrap());
        assert_eq!(none, Err(ModelError::Uncoated));
    }
}
