//! Are the values of many tablets normally distributed?

use super::ModelError;
use super::averaging::sample_sd;

/// Anderson-Darling test of normality with mean and standard deviation taken from the sample.
///
/// Source: D'Agostino and Stephens 1986, Goodness-of-Fit Techniques, section 4.8.5 and Table 4.9 (case 3): the statistic
/// A*² = A² (1 + 0.75/n + 2.25/n²) and its p-value by their fitted exponentials.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AndersonDarling {
    /// A*², dimensionless.
    pub statistic: f64,
    /// Probability of a statistic at least as large from a normal distribution; small means "not normal".
    pub p_value: f64,
}

impl AndersonDarling {
    /// Tests `values`.
    ///
    /// ```
    /// use pancoat::models::AndersonDarling;
    /// let lumps: Vec<f64> = (0..40).map(|k| f64::from(k % 2)).collect();
    /// assert!(AndersonDarling::test(&lumps)?.p_value < 1e-6);
    /// let even: Vec<f64> = (0..40).map(f64::from).collect(); // too few to be told from normal ones
    /// assert!(AndersonDarling::test(&even)?.p_value > 0.05);
    /// # Ok::<(), pancoat::models::ModelError>(())
    /// ```
    ///
    /// # Errors
    /// [`ModelError::TooFew`] below eight values, and when all are equal.
    pub fn test(values: &[f64]) -> Result<Self, ModelError> {
        let found = values.len();
        let too_few =
            ModelError::TooFew { what: "a test of normality", unit: "different values", found, needed: 8 };
        let sd = sample_sd(values).filter(|sd| *sd > 0.0 && found >= 8).ok_or(too_few)?;
        let n = found as f64;
        let mean = values.iter().sum::<f64>() / n;
        let mut sorted: Vec<f64> = values.iter().map(|v| (v - mean) / sd).collect();
        sorted.sort_by(f64::total_cmp);
        // ln Φ(z) and ln(1 − Φ(z)) = ln Φ(−z)
        let ln_phi = |z: f64| (0.5 * libm::erfc(-z / std::f64::consts::SQRT_2)).ln();
        let sum: f64 = sorted
            .iter()
            .zip(sorted.iter().rev())
            .enumerate()
            .map(|(i, (low, high))| (2 * i + 1) as f64 * (ln_phi(*low) + ln_phi(-high)))
            .sum();
        let statistic = (-n - sum / n) * (1.0 + 0.75 / n + 2.25 / (n * n));
        Ok(Self { statistic, p_value: p_value(statistic) })
    }
}

fn p_value(a: f64) -> f64 {
    let exponential = |c0: f64, c1: f64, c2: f64| (c0 + c1 * a + c2 * a * a).exp();
    match a {
        // Beyond 13 the fit turns up again.
        _ if a >= 13.0 => 0.0,
        _ if a >= 0.6 => exponential(1.2937, -5.709, 0.0186),
        _ if a > 0.34 => exponential(0.9177, -4.279, -1.38),
        _ if a > 0.2 => 1.0 - exponential(-8.318, 42.796, -59.938),
        _ => 1.0 - exponential(-13.436, 101.14, -223.73),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn five_in_a_hundred_normal_samples_are_called_abnormal_and_skewed_ones_are_found() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        let mut uniform = || rng.random_range(1e-12..1.0_f64);
        let (mut false_alarms, mut found) = (0, 0);
        for _ in 0..1000 {
            let normal: Vec<f64> = (0..60)
                .map(|_| (-2.0 * uniform().ln()).sqrt() * (std::f64::consts::TAU * uniform()).cos())
                .collect();
            false_alarms += usize::from(AndersonDarling::test(&normal).unwrap().p_value < 0.05);
            let skewed: Vec<f64> = (0..60).map(|_| -uniform().ln()).collect();
            found += usize::from(AndersonDarling::test(&skewed).unwrap().p_value < 0.05);
        }
        assert!((35..=65).contains(&false_alarms), "{false_alarms}");
        assert!(found > 980, "{found}");
    }

    #[test]
    fn the_p_value_is_continuous_at_its_joints_and_falls() {
        for joint in [0.2, 0.34, 0.6] {
            assert!((p_value(joint - 1e-9) - p_value(joint + 1e-9)).abs() < 0.01, "{joint}");
        }
        assert!((p_value(0.752) - 0.05).abs() < 0.001); // the tabulated 5 % point
        assert!((p_value(1.035) - 0.01).abs() < 0.001); // the tabulated 1 % point
        assert!(matches!(AndersonDarling::test(&[1.0; 20]), Err(ModelError::TooFew { .. })));
    }
}
