//! Equations 2 to 5 of the paper: panel numbers, pixels to film volume, film volume to thickness.
//!
//! Source: Freireich, Kumar, Ketterhagen, Su, Wassgren, Zeitler 2015, Chem. Eng. Sci. 131, 197,
//! doi 10.1016/j.ces.2015.03.013, section 4. Where we depart from the print:
//!
//! - Eq. 2, `p = i N_p + j`, has i "from 0 to N" and j "from 0 to N_p": panel (i, N_p) would be panel (i+1, 0). Both
//!   ranges are half-open here, and bodies of different shapes have their own N_p, so i N_p becomes a running sum.
//! - Eq. 3 turns p into a colour of 24 bits and prints G without its `% 256`. Numbers are not colours here but `u32`
//!   from end to end, which leaves Eq. 3 without a purpose and 2³² in place of 2²⁴ numbers.
//! - Eq. 4, `V_ij = Σ_n k_V c_ij,n`, as printed. The paper fits k_V to a measured mean thickness
//!   ([`film_volume_from_mean`]); here it follows from the spray rate ([`film_volume_per_count`]) where that is given.
//! - Eq. 5, `h_ij = V_ij / A_j`, as printed.

use super::CoaterError;
use std::ops::Range;

/// Numbers of all panels of all bodies (Eq. 2), and after them those of what is not a tablet.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PanelIds {
    /// First number of each body, and of the first thing after the bodies.
    first: Vec<u32>,
}

impl PanelIds {
    /// The drum's wall, counted from the first number after the panels; as are the following.
    pub(in crate::observers) const WALL: u32 = 0;
    /// An end wall.
    pub(in crate::observers) const END: u32 = 1;
    /// A baffle.
    pub(in crate::observers) const BAFFLE: u32 = 2;
    /// Nothing at all.
    pub(in crate::observers) const EMPTY: u32 = 3;
    /// How many they are.
    pub(super) const OTHERS: u32 = 4;

    /// Numbers the panels of bodies that have `panels` panels each.
    ///
    /// # Errors
    /// [`CoaterError::TooManyPanels`] when `u32` cannot hold the numbers.
    pub fn new(panels: impl IntoIterator<Item = usize>) -> Result<Self, CoaterError> {
        let mut total = 0_u64;
        let mut first = vec![0];
        for count in panels {
            total = total.saturating_add(count as u64);
            first.push(u32::try_from(total).unwrap_or(u32::MAX));
        }
        let limit = u64::from(u32::MAX - Self::OTHERS);
        if total > limit {
            Err(CoaterError::TooManyPanels { panels: total, limit })
        } else {
            Ok(Self { first })
        }
    }

    /// Number of panel `panel` of body `body`.
    pub fn id(&self, body: usize, panel: usize) -> u32 {
        self.first[body] + panel as u32
    }

    /// All numbers of a body.
    pub fn of_body(&self, body: usize) -> Range<usize> {
        self.first[body] as usize..self.first[body + 1] as usize
    }

    /// The same, as they stand in a raster.
    pub(super) fn numbers(&self, body: usize) -> Range<u32> {
        self.first[body]..self.first[body + 1]
    }

    /// The body whose panel has the number `id`; `None` for what is not a tablet.
    pub fn body(&self, id: u32) -> Option<usize> {
        (id < self.panels()).then(|| self.first.partition_point(|&first| first <= id) - 1)
    }

    /// How many panels there are, which is also the number of the drum's wall.
    pub fn panels(&self) -> u32 {
        self.first[self.first.len() - 1]
    }

    /// How many bodies there are.
    pub fn bodies(&self) -> usize {
        self.first.len() - 1
    }
}

/// The factor k_V of Eq. 4 from what a nozzle sprays: film volume that one count stands for, m³.
///
/// k_V = ṁ w Δt / (ρ C): what a nozzle of `rate` ṁ (kg/s) with a `solids` fraction w (dimensionless) and a `film_density` ρ
/// (kg/m³) sprays between two frames Δt (s) apart is shared by the C counts of a frame. Derived here, for a flux known
/// pixel by pixel; counts that fall beside the tablets are overspray, and nothing is scaled up for them.
///
/// 7.5 g/min of a 20 % suspension for 0.02 s, film density 1250 kg/m³, 512 × 256 pixels:
///
/// ```
/// # use pancoat::observers::film_volume_per_count;
/// let volume = film_volume_per_count(1.25e-4, 0.2, 1250.0, 0.02, 512 * 256);
/// assert!((volume * 131_072.0 - 4e-10).abs() < 1e-24);
/// ```
pub fn film_volume_per_count(
    rate: f64,
    solids: f64,
    film_density: f64,
    frame_interval: f64,
    counts_per_frame: u64,
) -> f64 {
    rate * solids * frame_interval / (film_density * counts_per_frame as f64)
}

/// The factor k_V of Eq. 4 from a measured mean thickness, as in the paper: film volume that one count stands for, m³.
///
/// k_V = h̄ A / C: a mean `thickness` h̄ (m) over the `area` A (m²) of all tablets is the volume of their C `counts`. Follows
/// from Eqs. 4 and 5, summed over all panels.
///
/// ```
/// # use pancoat::observers::film_volume_from_mean;
/// assert!((film_volume_from_mean(50e-6, 0.45, 9_000_000) - 2.5e-12).abs() < 1e-26);
/// ```
pub fn film_volume_from_mean(thickness: f64, area: f64, counts: u64) -> f64 {
    thickness * area / counts as f64
}

/// Film thickness of each panel of a tablet, m (Eqs. 4 and 5): h_j = k_V c_j / A_j.
///
/// `counts` are the tablet's, summed over frames; `areas` those of its panels, m²; `volume_per_count` is k_V, m³.
pub fn film_thickness(counts: &[u64], areas: &[f64], volume_per_count: f64) -> impl Iterator<Item = f64> {
    counts.iter().zip(areas).map(move |(&count, area)| volume_per_count * count as f64 / area)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_bodies_are_inverse() {
        let ids = PanelIds::new([3, 5, 2]).unwrap();
        assert_eq!((ids.bodies(), ids.panels()), (3, 10));
        for body in 0..3 {
            for id in ids.of_body(body) {
                assert_eq!(ids.body(id as u32), Some(body));
                assert_eq!(ids.id(body, id - ids.of_body(body).start) as usize, id);
            }
        }
        assert_eq!(ids.body(10), None);
    }

    #[test]
    fn a_body_of_no_panels_owns_no_number() {
        let ids = PanelIds::new([2, 0, 2]).unwrap();
        assert_eq!(ids.body(2), Some(2));
        assert!(ids.of_body(1).is_empty());
    }

    #[test]
    fn twenty_four_bits_are_no_limit_and_thirty_two_are() {
        let ids = PanelIds::new(std::iter::repeat_n(1856, 10_000)).unwrap();
        assert_eq!(ids.id(9_999, 1_855), 18_559_999);
        assert_eq!(ids.body(18_559_999), Some(9_999));
        assert!(PanelIds::new([(u32::MAX - PanelIds::OTHERS) as usize]).is_ok());
        let error = PanelIds::new([(u32::MAX - PanelIds::OTHERS) as usize, 1]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "4294967292 panels in all are more than the 4294967291 that can be numbered"
        );
        assert!(PanelIds::new([usize::MAX, usize::MAX]).is_err());
    }

    #[test]
    fn thickness_is_volume_over_area() {
        let h: Vec<f64> = film_thickness(&[4, 0, 6], &[2.0, 1.0, 3.0], 0.5).collect();
        assert_eq!(h, [1.0, 0.0, 1.0]);
    }
}
