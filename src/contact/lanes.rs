//! Rows of four numbers, one after the other, to lanes of eight numbers of one kind, and back: a few shuffles where the
//! machine has them.

use super::frames::Four;
use pulp::Simd;

/// Contacts side by side.
pub(super) const LANES: usize = 8;
/// One number of each contact.
pub(super) type Lanes = [f64; LANES];
/// Four numbers of each contact.
pub(super) type Rows = [Four; LANES];

/// The four numbers of eight rows, each in lanes. The order in which rows become lanes is that of [`order`].
#[inline(always)]
pub(super) fn lanes<S: Simd>(simd: S, rows: &Rows) -> [Lanes; 4] {
    let mut lanes = [[0.0; LANES]; 4];
    let (quads, _) = pulp::as_arrays::<4, _>(S::as_simd_f64s(rows.as_flattened()).0);
    for (k, quad) in quads.iter().enumerate() {
        for (lanes, four) in lanes.iter_mut().zip(simd.deinterleave_shfl_f64s(*quad)) {
            S::as_mut_simd_f64s(lanes).0[k] = four;
        }
    }
    lanes
}

/// The way back.
#[inline(always)]
pub(super) fn rows<S: Simd>(simd: S, lanes: &[Lanes; 4]) -> Rows {
    let mut rows = [[0.0; 4]; LANES];
    let (quads, _) = pulp::as_arrays_mut::<4, _>(S::as_mut_simd_f64s(rows.as_flattened_mut()).0);
    let [x, y, z, w] = lanes;
    let (x, y) = (S::as_simd_f64s(x).0, S::as_simd_f64s(y).0);
    let (z, w) = (S::as_simd_f64s(z).0, S::as_simd_f64s(w).0);
    for (k, quad) in quads.iter_mut().enumerate() {
        *quad = simd.interleave_shfl_f64s([x[k], y[k], z[k], w[k]]);
    }
    rows
}

/// In which lane each row is.
#[inline(always)]
pub(super) fn order<S: Simd>(simd: S) -> [usize; LANES] {
    let numbers = lanes(simd, &std::array::from_fn(|k| [k as f64; 4]))[0];
    std::array::from_fn(|row| numbers.iter().position(|n| *n as usize == row).unwrap_or(row))
}

#[cfg(test)]
mod tests {
    use super::*;

    struct RoundTrip(Rows);

    impl pulp::WithSimd for RoundTrip {
        type Output = ();

        fn with_simd<S: Simd>(self, simd: S) {
            let (lanes, order) = (lanes(simd, &self.0), order(simd));
            for (row, lane) in order.into_iter().enumerate() {
                assert_eq!(lanes.map(|lanes| lanes[lane]), self.0[row]);
            }
            assert_eq!(rows(simd, &lanes), self.0);
        }
    }

    #[test]
    fn rows_become_lanes_and_rows_again_on_every_machine() {
        let rows = std::array::from_fn(|k| std::array::from_fn(|j| (10 * k + j) as f64));
        pulp::Arch::new().dispatch(RoundTrip(rows));
        pulp::WithSimd::with_simd(RoundTrip(rows), pulp::Scalar::new());
        if let Some(simd) = pulp::x86::V3::try_new() {
            simd.vectorize(|| pulp::WithSimd::with_simd(RoundTrip(rows), simd));
        }
    }
}
