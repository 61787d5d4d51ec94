//! How well the mean of a few values is known.

use super::sample_sd;

/// Mean of `values` and half the width of its 95 % interval by Student's t, in their unit; `None` for fewer than two.
pub fn mean_95(values: &[f64]) -> Option<(f64, f64)> {
    let (n, sd) = (values.len() as f64, sample_sd(values)?);
    let t = match values.len() {
        2 => 12.706,
        3 => 4.303,
        4 => 3.182,
        _ => student_95(n - 1.0),
    };
    Some((values.iter().sum::<f64>() / n, t * sd / n.sqrt()))
}

/// Two-sided 95 % point of Student's t (Abramowitz and Stegun 1964, 26.7.5); within 2 % from four degrees of freedom on.
pub(super) fn student_95(degrees: f64) -> f64 {
    let z = 1.959_963_984_540_054_f64;
    let first = (z.powi(3) + z) / 4.0;
    let second = (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / 96.0;
    let third = (3.0 * z.powi(7) + 19.0 * z.powi(5) + 17.0 * z.powi(3) - 15.0 * z) / 384.0;
    z + first / degrees + second / degrees.powi(2) + third / degrees.powi(3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn students_t() {
        for (degrees, t) in [(4.0, 2.776), (9.0, 2.262), (30.0, 2.042), (1e6, 1.960)] {
            assert!((student_95(degrees) / t - 1.0).abs() < 0.005, "{degrees}: {}", student_95(degrees));
        }
    }

    #[test]
    fn a_mean_of_few() {
        assert_eq!(mean_95(&[1.0]), None);
        for (values, half) in [(vec![1.0, 3.0], 12.706), (vec![1.0, 2.0, 3.0], 4.303 / 3.0_f64.sqrt())] {
            let (mean, found) = mean_95(&values).expect("has an interval");
            assert!((mean - 2.0).abs() < 1e-12 && (found - half).abs() < 1e-12, "{mean} +- {found}");
        }
        let (_, half) = mean_95(&[1.0, 2.0, 3.0, 4.0, 5.0]).expect("has an interval");
        assert!((half / (2.776 * 0.5_f64.sqrt()) - 1.0).abs() < 0.005, "{half}");
    }
}
