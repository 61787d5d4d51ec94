//! Numerical integration of smooth functions.

/// Positive nodes and weights of the 8-point Gauss-Legendre rule on [−1, 1] (Abramowitz & Stegun 1964, table 25.4).
const GAUSS_8: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_5),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_3),
];

/// Nodes and weights of the 8-point rule on each of `cells` equal parts of [0, 1].
pub(super) fn unit_rule(cells: usize) -> Vec<(f64, f64)> {
    let half = 0.5 / cells as f64;
    (0..cells)
        .flat_map(|cell| {
            let middle = (2 * cell + 1) as f64 * half;
            GAUSS_8
                .iter()
                .flat_map(move |&(x, w)| [(middle - half * x, half * w), (middle + half * x, half * w)])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn degree_fifteen_is_exact() {
        let integral: f64 = unit_rule(1).iter().map(|(x, w)| w * x.powi(15)).sum();
        assert_relative_eq!(integral, 1.0 / 16.0, max_relative = 1e-14);
    }
}
