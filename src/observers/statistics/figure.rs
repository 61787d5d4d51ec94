//! A mean with its error.

use serde::{Deserialize, Serialize};

/// A time average with the standard error of its block means, in the unit of the quantity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// Mean over blocks.
    pub mean: f64,
    /// Standard deviation of the block means over the root of their number; `None` below two blocks.
    pub standard_error: Option<f64>,
}

impl Figure {
    /// Mean and standard error of block means; `None` without blocks.
    ///
    /// ```
    /// use pancoat::observers::statistics::Figure;
    /// let figure = Figure::of_blocks(&[1.0, 2.0, 3.0]).unwrap();
    /// assert_eq!(figure.mean, 2.0);
    /// assert!((figure.standard_error.unwrap() - (1.0_f64 / 3.0).sqrt()).abs() < 1e-12); // sd 1, three blocks
    /// assert_eq!(Figure::of_blocks(&[]), None);
    /// ```
    pub fn of_blocks(values: &[f64]) -> Option<Self> {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let spread: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        let standard_error = (values.len() > 1).then(|| (spread / (n - 1.0) / n).sqrt());
        (!values.is_empty()).then_some(Self { mean, standard_error })
    }
}
