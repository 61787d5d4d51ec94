//! Straight lines on log-log paper.

use super::ModelError;

/// y = prefactor · x^exponent, fitted by least squares of ln y on ln x.
///
/// The standard error takes the points as independent. Points of one running series are not (each holds all coating
/// before it), so for such series it is a lower bound; a bootstrap over tablets gives the full error.
///
/// ```
/// use pancoat::models::PowerLaw;
/// let points = [(1.0, 3.0), (4.0, 1.5), (16.0, 0.75)]; // 3 / sqrt(x)
/// let law = PowerLaw::fit(points)?;
/// assert!((law.exponent + 0.5).abs() < 1e-12 && (law.prefactor - 3.0).abs() < 1e-12);
/// # Ok::<(), pancoat::models::ModelError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PowerLaw {
    /// Slope on log-log paper, dimensionless.
    pub exponent: f64,
    /// Standard error of the exponent from the scatter about the line.
    pub exponent_error: f64,
    /// Value at x = 1, in the unit of y.
    pub prefactor: f64,
    /// How many points were used.
    pub points: usize,
}

impl PowerLaw {
    /// Fits points; those that are not positive in x and y are left out, as they have no place on log-log paper.
    ///
    /// # Errors
    /// [`ModelError::TooFew`] below three usable points.
    pub fn fit(points: impl IntoIterator<Item = (f64, f64)>) -> Result<Self, ModelError> {
        let logs: Vec<(f64, f64)> =
            points.into_iter().filter(|&(x, y)| x > 0.0 && y > 0.0).map(|(x, y)| (x.ln(), y.ln())).collect();
        let n = logs.len() as f64;
        let (mx, my) = logs.iter().fold((0.0, 0.0), |m, p| (m.0 + p.0 / n, m.1 + p.1 / n));
        let sxx: f64 = logs.iter().map(|p| (p.0 - mx).powi(2)).sum();
        if logs.len() < 3 || sxx == 0.0 {
            return Err(ModelError::TooFew {
                what: "a power law",
                unit: "different points",
                found: logs.len(),
                needed: 3,
            });
        }
        let sxy: f64 = logs.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum();
        let exponent = sxy / sxx;
        let scatter: f64 = logs.iter().map(|p| (p.1 - my - exponent * (p.0 - mx)).powi(2)).sum();
        Ok(Self {
            exponent,
            exponent_error: (scatter / (n - 2.0) / sxx).sqrt(),
            prefactor: (my - exponent * mx).exp(),
            points: logs.len(),
        })
    }

    /// Value of the law at `x`.
    pub fn at(&self, x: f64) -> f64 {
        self.prefactor * x.powf(self.exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_of_the_slope_is_the_textbook_one() {
        // ln y = 0, 1, 0 at ln x = 0, 1, 2: slope 0, scatter 2/3, s² = 2/3, error sqrt(2/3 / 2).
        let e = std::f64::consts::E;
        let law = PowerLaw::fit([(1.0, 1.0), (e, e), (e * e, 1.0)]).unwrap();
        assert!(law.exponent.abs() < 1e-12);
        assert!((law.exponent_error - (1.0_f64 / 3.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn zeros_are_left_out_and_two_points_are_too_few() {
        let fit = PowerLaw::fit([(0.0, 1.0), (1.0, 0.0), (1.0, 1.0), (2.0, 0.5)]);
        assert!(matches!(fit, Err(ModelError::TooFew { found: 2, .. })));
    }
}
