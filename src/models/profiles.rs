//! Thickness along the band and across the caps.

use super::{ModelError, TabletSurface};
use std::f64::consts::{PI, TAU};

/// Mean thickness of the panels about one place of a profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfileBin {
    /// Middle of the bin: angle in rad, height in m, or relative radius.
    pub at: f64,
    /// Area-weighted mean, in the unit of the thickness.
    pub mean: f64,
    /// Area of its panels, m².
    pub area: f64,
}

impl TabletSurface<'_> {
    /// Band thickness against the angle about z, from −π to π; 0 along x, the length of the tablet.
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use pancoat::models::TabletSurface;
    /// let places = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| Vector3::new(x, y, 0.0));
    /// let band = TabletSurface::new(&places, &places, &[1.0; 4], &[false; 4])?;
    /// let profile = band.band_by_angle(&[1.0, 2.0, 3.0, 5.0], 2)?;
    /// assert_eq!([profile[0].mean, profile[1].mean], [1.5, 4.0]);
    /// # Ok::<(), pancoat::models::ModelError>(())
    /// ```
    ///
    /// # Errors
    /// [`ModelError::Length`] unless there is a thickness per panel.
    pub fn band_by_angle(&self, thickness: &[f64], bins: usize) -> Result<Vec<ProfileBin>, ModelError> {
        self.profile(thickness, bins, -PI, PI, |j| (!self.on_cap[j]).then(|| self.angle(j)))
    }

    /// Band thickness against the height z over the mid-plane, m.
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use pancoat::models::TabletSurface;
    /// let places = [-1e-3, 1e-3, 1e-3].map(|z| Vector3::new(8e-3, 0.0, z));
    /// let band = TabletSurface::new(&places, &places, &[1.0, 1.0, 3.0], &[false; 3])?;
    /// let profile = band.band_by_height(&[7.0, 1.0, 5.0], 2)?;
    /// assert_eq!([profile[0].mean, profile[1].mean], [7.0, 4.0]); // (1 + 3 · 5)/4 above
    /// # Ok::<(), pancoat::models::ModelError>(())
    /// ```
    ///
    /// # Errors
    /// [`ModelError::Length`] unless there is a thickness per panel.
    pub fn band_by_height(&self, thickness: &[f64], bins: usize) -> Result<Vec<ProfileBin>, ModelError> {
        let band = (0..self.on_cap.len()).filter(|&j| !self.on_cap[j]);
        let half = band.map(|j| self.centroids[j].z.abs()).fold(0.0, f64::max) * (1.0 + 1e-9);
        self.profile(thickness, bins, -half, half, |j| (!self.on_cap[j]).then(|| self.centroids[j].z))
    }

    /// Thickness of both caps against the radius relative to the outline at the same angle: 0 at the axis, 1 at the band.
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use pancoat::models::TabletSurface;
    /// let places = [1e-3, 3e-3, 8e-3].map(|x| Vector3::new(x, 0.0, 0.0)); // the last one is on the band
    /// let cap = TabletSurface::new(&places, &places, &[1.0; 3], &[true, true, false])?;
    /// let profile = cap.cap_by_radius(&[3.0, 5.0, 9.0], 2)?;
    /// assert_eq!(profile[0].mean, 4.0); // at 1/8 and 3/8 of the outline
    /// # Ok::<(), pancoat::models::ModelError>(())
    /// ```
    ///
    /// # Errors
    /// [`ModelError::Length`] unless there is a thickness per panel.
    pub fn cap_by_radius(&self, thickness: &[f64], bins: usize) -> Result<Vec<ProfileBin>, ModelError> {
        const SECTORS: f64 = 72.0;
        let sector = |j: usize| (((self.angle(j) + PI) / TAU * SECTORS) as usize).min(SECTORS as usize - 1);
        let radius = |j: usize| self.centroids[j].xy().norm();
        let mut outline = vec![0.0_f64; SECTORS as usize];
        for j in 0..self.centroids.len() {
            outline[sector(j)] = outline[sector(j)].max(radius(j));
        }
        self.profile(thickness, bins, 0.0, 1.0, |j| {
            self.on_cap[j].then(|| (radius(j) / outline[sector(j)]).min(1.0))
        })
    }

    fn angle(&self, panel: usize) -> f64 {
        self.centroids[panel].y.atan2(self.centroids[panel].x)
    }

    fn profile(
        &self,
        thickness: &[f64],
        bins: usize,
        from: f64,
        to: f64,
        place: impl Fn(usize) -> Option<f64>,
    ) -> Result<Vec<ProfileBin>, ModelError> {
        self.expect("thickness values", thickness.len())?;
        let mut sums = vec![(0.0, 0.0); bins];
        for (panel, h) in thickness.iter().enumerate() {
            if let Some(at) = place(panel) {
                let bin = (((at - from) / (to - from) * bins as f64) as usize).min(bins - 1);
                sums[bin].0 += h * self.areas[panel];
                sums[bin].1 += self.areas[panel];
            }
        }
        let bin = |(k, (volume, area)): (usize, (f64, f64))| ProfileBin {
            at: from + (to - from) * (k as f64 + 0.5) / bins as f64,
            mean: volume / area,
            area,
        };
        Ok(sums.into_iter().enumerate().filter(|(_, sum)| sum.1 > 0.0).map(bin).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    /// Band panels around an oval outline at three heights, cap panels on rays; thickness is what the test wants to see.
    #[test]
    fn profiles_give_back_what_was_laid_down() {
        let (mut centroids, mut on_cap) = (Vec::new(), Vec::new());
        let outline = |angle: f64| 1.0 / ((angle.cos() / 2.0).powi(2) + angle.sin().powi(2)).sqrt();
        for step in 0..360 {
            let angle = (f64::from(step) + 0.5).to_radians() - PI;
            let at = |r: f64, z: f64| Vector3::new(r * angle.cos(), r * angle.sin(), z);
            for z in [-0.5, 0.0, 0.5] {
                centroids.push(at(outline(angle), z));
                on_cap.push(false);
            }
            for k in 0..10 {
                centroids.push(at(outline(angle) * (f64::from(k) + 0.5) / 10.0, 1.0));
                on_cap.push(true);
            }
        }
        let areas = vec![1.0; centroids.len()];
        let places = TabletSurface::new(&centroids, &centroids, &areas, &on_cap).unwrap();

        let by_angle: Vec<f64> = centroids.iter().map(|c| 3.0 + (2.0 * c.y.atan2(c.x)).cos()).collect();
        let profile = places.band_by_angle(&by_angle, 36).unwrap();
        assert_eq!(profile.len(), 36);
        assert!(profile.iter().all(|b| (b.mean - 3.0 - (2.0 * b.at).cos()).abs() < 0.01 && b.area == 30.0));

        let by_height: Vec<f64> = centroids.iter().map(|c| 2.0 - c.z).collect();
        let profile = places.band_by_height(&by_height, 3).unwrap();
        assert_eq!(profile.iter().map(|b| b.mean).collect::<Vec<_>>(), [2.5, 2.0, 1.5]);

        let by_radius: Vec<f64> = centroids.iter().map(|c| c.xy().norm() / outline(c.y.atan2(c.x))).collect();
        let profile = places.cap_by_radius(&by_radius, 5).unwrap();
        assert!(profile.iter().all(|b| (b.mean - b.at).abs() < 0.02), "{profile:?}");
        assert!(matches!(places.band_by_angle(&areas[1..], 4), Err(ModelError::Length { .. })));
    }
}
