//! Cap and band of a tablet.

use super::ModelError;

/// Mean thickness of the caps and of the band of one thickness map, in the unit of the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RegionMeans {
    /// Area-weighted mean over both caps.
    pub cap: f64,
    /// Area-weighted mean over the band.
    pub band: f64,
}

impl RegionMeans {
    /// Cap over band; above 1 the caps are favoured.
    pub fn ratio(&self) -> f64 {
        self.cap / self.band
    }

    /// Orientation index of Kalbag and Wassgren (AIChE Annual Meeting 2008, "Orientation Index of Tablets as a Means of
    /// Quantifying Intra-Tablet Coating Variation"): exposure of the band to that of the caps, over the ratio of their areas. 1 is
    /// uniform, below 1 caps are favoured. With exposure measured per area it is the inverse of [`Self::ratio`].
    ///
    /// Ketterhagen 2011 (Int. J. Pharm. 409, 137) uses an index of the same name that falls with less variability, by another
    /// definition; ours of that kind is the order parameter, [`super::OrderTensor::s2`].
    pub fn orientation_index(&self) -> f64 {
        self.band / self.cap
    }
}

/// Area-weighted means over the panels on a cap and over those on the band; `None` when the shape has only one of both,
/// as a sphere has.
///
/// ```
/// use pancoat::models::region_means;
/// let means = region_means(&[3.0, 1.0, 1.0], &[1.0, 2.0, 1.0], &[true, true, false])?.unwrap();
/// assert!((means.cap - 5.0 / 3.0).abs() < 1e-12 && (means.ratio() - 5.0 / 3.0).abs() < 1e-12);
/// # Ok::<(), pancoat::models::ModelError>(())
/// ```
///
/// # Errors
/// [`ModelError::Length`] when the lists differ in length.
pub fn region_means(
    thickness: &[f64],
    areas: &[f64],
    on_cap: &[bool],
) -> Result<Option<RegionMeans>, ModelError> {
    for (what, found) in [("panel areas", areas.len()), ("panel regions", on_cap.len())] {
        if found != thickness.len() {
            return Err(ModelError::Length { what, found, expected: thickness.len() });
        }
    }
    let mean = |wanted: bool| {
        let (volume, area) = (0..thickness.len())
            .filter(|&j| on_cap[j] == wanted)
            .fold((0.0, 0.0), |(v, a), j| (v + thickness[j] * areas[j], a + areas[j]));
        (area > 0.0).then(|| volume / area)
    };
    Ok(mean(true).zip(mean(false)).map(|(cap, band)| RegionMeans { cap, band }))
}
