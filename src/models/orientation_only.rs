//! The limit of CoV_intra without shadowing: tablets as they lie in the zone, coated by what they turn to the spray.

use super::averaging::area_moments;
use super::{ModelError, OrderTensor, TabletSurface};
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// Thickness relative to its mean over the tablet.
#[derive(Debug, Clone, PartialEq)]
pub struct CoatPattern {
    /// h_j/μ of each panel, dimensionless.
    pub relative: Vec<f64>,
    /// Standard deviation over mean.
    pub cov: f64,
}

impl CoatPattern {
    fn of(thickness: &[f64], areas: &[f64]) -> Result<Self, ModelError> {
        let (mean, variance) = area_moments(thickness, areas);
        if mean <= 0.0 {
            return Err(ModelError::Uncoated);
        }
        Ok(Self { cov: variance.sqrt() / mean, relative: thickness.iter().map(|h| h / mean).collect() })
    }
}

/// The model of Freireich, Ketterhagen and Wassgren 2011, "Intra-tablet coating variability for several pharmaceutical tablet
/// shapes", Chem. Eng. Sci. 66, 2535: a panel with normal n under a spray from the direction s receives max(0, n·s) per area. The
/// surface must be convex, and neighbours cast no shadow, so that the limit is above that of the real bed.
impl TabletSurface<'_> {
    /// The exact limit for a set of spray directions (unit vectors in body axes, towards the nozzle): the mean of
    /// max(0, n·s) over the directions, which the Monte Carlo model nears with more and more trials.
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use pancoat::models::TabletSurface;
    /// // A thin plate that always lies with the same face up: one face gets all, the other nothing.
    /// let (places, normals) = ([Vector3::zeros(); 2], [Vector3::z(), -Vector3::z()]);
    /// let plate = TabletSurface::new(&places, &normals, &[1.0, 1.0], &[true, true])?;
    /// assert_eq!(plate.orientation_limit(&[Vector3::z()])?.cov, 1.0);
    /// // Turned over every other time it is coated evenly.
    /// assert_eq!(plate.orientation_limit(&[Vector3::z(), -Vector3::z()])?.cov, 0.0);
    /// # Ok::<(), pancoat::models::ModelError>(())
    /// ```
    ///
    /// # Errors
    /// [`ModelError::Uncoated`] without directions.
    pub fn orientation_limit(&self, directions: &[Vector3<f64>]) -> Result<CoatPattern, ModelError> {
        let mean = |n: &Vector3<f64>| {
            directions.iter().map(|s| n.dot(s).max(0.0)).sum::<f64>() / directions.len() as f64
        };
        if directions.is_empty() {
            return Err(ModelError::Uncoated);
        }
        CoatPattern::of(&self.normals.par_iter().map(mean).collect::<Vec<_>>(), self.areas)
    }

    /// The limit from the order tensor alone: h(n) = 1/4 + n·⟨s⟩/2 + (5/16) n·Q·n.
    ///
    /// Derived here: max(0, x) = 1/4 P₀ + 1/2 P₁ + 5/16 P₂ − 3/32 P₄ + … in Legendre polynomials, and ⟨P₂(n·s)⟩ = n·Q·n. What
    /// is left out is of fourth order in the orientation; against [`Self::orientation_limit`] the CoV is within 0.5 % for S₂ < 0.3 and
    /// 2 % at S₂ = 0.56, and off by up to a tenth for nearly frozen tablets. With ⟨s⟩ = 0 this is
    /// CoV = (5/4) sd_A(n·Q·n) / (1 + (5/4) mean_A(n·Q·n)).
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use pancoat::models::{OrderTensor, TabletSurface};
    /// let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    /// let normals: Vec<_> = axes.iter().flat_map(|a| [*a, -a]).collect();
    /// let cube = TabletSurface::new(&normals, &normals, &[1.0; 6], &[false; 6])?;
    /// // Up and down alike: Q = diag(-1/2, -1/2, 1), hence 9/16 on two faces and 3/32 on four of mean 1/4.
    /// let order = OrderTensor::of(&[Vector3::z(), -Vector3::z()]);
    /// assert!((cube.orientation_expansion(&order)?.cov - 1.25 / f64::sqrt(2.0)).abs() < 1e-12);
    /// # Ok::<(), pancoat::models::ModelError>(())
    /// ```
    ///
    /// # Errors
    /// [`ModelError::Uncoated`] when the expansion gives no positive mean.
    pub fn orientation_expansion(&self, order: &OrderTensor) -> Result<CoatPattern, ModelError> {
        let (mean, q) = (order.mean(), order.q());
        let thickness = |n: &Vector3<f64>| 0.25 + 0.5 * n.dot(&mean) + 0.3125 * n.dot(&(q * n));
        CoatPattern::of(&self.normals.iter().map(thickness).collect::<Vec<_>>(), self.areas)
    }

    /// The Monte Carlo model as published: each of `tablets` tablets is coated from directions drawn at random out of
    /// `directions`; CoV_intra by averaging moments (Eq 8) after each of the numbers of `trials` (ascending).
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use pancoat::models::TabletSurface;
    /// let (places, normals) = ([Vector3::zeros(); 2], [Vector3::z(), -Vector3::z()]);
    /// let plate = TabletSurface::new(&places, &normals, &[1.0, 1.0], &[true, true])?;
    /// // Which face is up is thrown like a coin: CoV² = 1/trials on average, so 1 after one trial and 0.1 after a hundred.
    /// let cov = plate.orientation_monte_carlo(&normals, 10_000, &[1, 100], 1)?;
    /// assert!(cov[0] == 1.0 && (cov[1] - 0.1).abs() < 0.003);
    /// # Ok::<(), pancoat::models::ModelError>(())
    /// ```
    ///
    /// # Errors
    /// [`ModelError::Uncoated`] without directions.
    pub fn orientation_monte_carlo(
        &self,
        directions: &[Vector3<f64>],
        tablets: usize,
        trials: &[u64],
        seed: u64,
    ) -> Result<Vec<f64>, ModelError> {
        if directions.is_empty() || tablets == 0 {
            return Err(ModelError::Uncoated);
        }
        let play = |tablet: usize| {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            rng.set_stream(tablet as u64);
            let mut thickness = vec![0.0; self.areas.len()];
            let mut done = 0;
            let coat = |&until: &u64| {
                for _ in done..until {
                    let s = directions[rng.random_range(0..directions.len())];
                    thickness.iter_mut().zip(self.normals).for_each(|(h, n)| *h += n.dot(&s).max(0.0));
                }
                done = until;
                area_moments(&thickness, self.areas)
            };
            trials.iter().map(coat).collect::<Vec<_>>()
        };
        let played: Vec<Vec<(f64, f64)>> = (0..tablets).into_par_iter().map(play).collect();
        let batch = |k: usize| {
            let n = tablets as f64;
            let mean = played.iter().map(|tablet| tablet[k].0).sum::<f64>() / n;
            let variance = played.iter().map(|tablet| tablet[k].1).sum::<f64>() / n;
            variance.sqrt() / mean
        };
        Ok((0..trials.len()).map(batch).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube() -> (Vec<Vector3<f64>>, Vec<f64>) {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        (axes.iter().flat_map(|a| [*a, -a]).collect(), vec![1.0; 6])
    }

    #[test]
    fn a_cube_sprayed_on_one_face_and_on_all() {
        let (normals, areas) = cube();
        let cube = TabletSurface::new(&normals, &normals, &areas, &[true; 6]).unwrap();
        let one = cube.orientation_limit(&[Vector3::z()]).unwrap();
        assert!((one.cov - 5.0_f64.sqrt()).abs() < 1e-12); // 6 times on one face of six, mean 1, variance 5
        assert!((one.relative[4] - 6.0).abs() < 1e-12);
        assert!(cube.orientation_limit(&normals).unwrap().cov < 1e-12);
    }

    #[test]
    fn random_orientations_leave_no_variation_in_the_expansion() {
        let (normals, areas) = cube();
        let cube = TabletSurface::new(&normals, &normals, &areas, &[true; 6]).unwrap();
        assert!(cube.orientation_expansion(&OrderTensor::of(&normals)).unwrap().cov < 1e-12);
        assert_eq!(cube.orientation_limit(&[]), Err(ModelError::Uncoated));
    }

    #[test]
    fn monte_carlo_falls_to_the_exact_limit() {
        let (normals, areas) = cube();
        let cube = TabletSurface::new(&normals, &normals, &areas, &[true; 6]).unwrap();
        let directions = [Vector3::z(), -Vector3::z(), Vector3::x()];
        let limit = cube.orientation_limit(&directions).unwrap().cov;
        let once = 5.0_f64.sqrt();
        let found = cube.orientation_monte_carlo(&directions, 400, &[1, 10, 100, 1000], 8).unwrap();
        for (trials, found) in [1.0_f64, 10.0, 100.0, 1000.0].into_iter().zip(found) {
            // Each tablet's map is a mean of independent draws: CoV² = limit² + (once² − limit²)/trials.
            let expected = (limit * limit + (once * once - limit * limit) / trials).sqrt();
            assert!((found / expected - 1.0).abs() < 0.02, "{trials}: {found} {expected}");
        }
    }
}
