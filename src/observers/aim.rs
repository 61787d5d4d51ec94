//! Aiming the spray at the bed: a plane through the free surface of the turning bed, and the zone on it.

use super::SprayZone;
use crate::scene::Spray;
use nalgebra::{Rotation3, Vector3};

/// Stretches along the slope in each of which the height of the surface is taken.
const BINS: usize = 9;
/// Fewest bodies in a stretch that say where its surface is.
const FEWEST: usize = 20;
/// Share of the distance from the drum's axis to the far ends of the bed that is fitted: the upper and the lower end of
/// a cascading bed curve away from the slope.
const MIDDLE: f64 = 0.4;
/// The centres of the uppermost tablets are at this quantile of the heights of a stretch.
const TOP: f64 = 0.95;

/// The free surface of a bed that turns about the z axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BedSurface {
    /// Its slope: angle from the horizontal, rad, positive when it climbs towards +x.
    pub slope: f64,
    /// Its height above the drum's axis, m, measured along its normal; negative when it lies below.
    pub height: f64,
}

/// Why a bed's surface cannot be found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum AimError {
    /// Too little to fit a plane to.
    #[error(
        "the bed is too small to aim at: {bodies} bodies in the middle of its slope; fix the spray's aim in the scene"
    )]
    TooFewBodies {
        /// Bodies in the stretch that has the fewest.
        bodies: usize,
    },
}

impl BedSurface {
    /// Fits the surface to the centres of all bodies (m), of several frames one after the other.
    ///
    /// `radius` (m) is how far a tablet's surface reaches above its centre: half its thickness to half its length,
    /// depending on how it lies; the radius of the sphere of its volume stands for all.
    ///
    /// The drum's axis is z through the origin. In a frame turned with the slope, the heights of nine stretches of the
    /// slope, each that of its uppermost centres, are fitted by a line (least squares); the frame is turned to it until
    /// nothing changes. Stretches and quantile make it blind to how deep the bed is and to single flying tablets.
    ///
    /// # Errors
    /// [`AimError::TooFewBodies`].
    pub fn fit(positions: &[Vector3<f64>], radius: f64) -> Result<Self, AimError> {
        let mean = positions.iter().sum::<Vector3<f64>>() / positions.len().max(1) as f64;
        // A bed at rest lies square to the line from the axis to its centre of mass.
        let mut slope = mean.x.atan2(-mean.y);
        let mut height = 0.0;
        for _ in 0..4 {
            let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), -slope);
            let [change, level] = line(&tops(positions.iter().map(|p| turn * p))?);
            height = level * change.atan().cos();
            slope += change.atan();
        }
        Ok(Self { slope, height: height + radius })
    }

    /// Unit vector out of the bed.
    pub fn normal(&self) -> Vector3<f64> {
        Vector3::new(-self.slope.sin(), self.slope.cos(), 0.0)
    }

    /// Angle from the horizontal, degrees, 0 to 90.
    pub fn angle_of_repose_deg(&self) -> f64 {
        self.slope.abs().to_degrees()
    }

    /// The zone of `spray` in the middle of the surface, square to it. A level chord of a circular drum has its middle
    /// where the normal through the axis meets it.
    pub fn zone(&self, spray: &Spray) -> SprayZone {
        SprayZone::facing(self.normal() * self.height, self.normal(), spray)
    }
}

/// Place along the slope and height of the uppermost centres of each stretch.
fn tops(positions: impl Iterator<Item = Vector3<f64>> + Clone) -> Result<[[f64; 2]; BINS], AimError> {
    let reach = positions.clone().map(|p| p.x.abs()).fold(0.0, f64::max);
    let width = 2.0 * MIDDLE * reach / BINS as f64;
    let mut heights = vec![Vec::new(); BINS];
    for p in positions {
        let bin = (p.x / width + BINS as f64 / 2.0).floor();
        if (0.0..BINS as f64).contains(&bin) {
            heights[bin as usize].push(p.y);
        }
    }
    let bodies = heights.iter().map(Vec::len).min().unwrap_or(0);
    if bodies < FEWEST {
        return Err(AimError::TooFewBodies { bodies });
    }
    Ok(std::array::from_fn(|bin| {
        let stretch = &mut heights[bin];
        let top = (TOP * (stretch.len() - 1) as f64).round() as usize;
        let (_, height, _) = stretch.select_nth_unstable_by(top, f64::total_cmp);
        [(bin as f64 + 0.5 - BINS as f64 / 2.0) * width, *height]
    }))
}

/// Slope and value at zero of the least-squares line through points evenly spaced about zero.
fn line(points: &[[f64; 2]; BINS]) -> [f64; 2] {
    let square: f64 = points.iter().map(|[x, _]| x * x).sum();
    let product: f64 = points.iter().map(|[x, y]| x * y).sum();
    [product / square, points.iter().map(|[_, y]| y).sum::<f64>() / BINS as f64]
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Centres of a bed, of many frames, in a drum of radius 125 mm below a chord, with some tablets in flight.
    fn bed(slope_deg: f64, height: f64, flying: usize) -> Vec<Vector3<f64>> {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let (s, c) = slope_deg.to_radians().sin_cos();
        let mut positions = Vec::new();
        while positions.len() < 40_000 {
            let [x, y, z] = [0.12, 0.12, 0.045].map(|half| half * random.random_range(-1.0..1.0));
            let below = -x * s + y * c < height || positions.len() < flying;
            if x.hypot(y) < 0.12 && below {
                positions.push(Vector3::new(x, y, z));
            }
        }
        positions
    }

    #[test]
    fn slope_and_height_of_a_plane_bed_are_found() {
        for (slope, height) in [(40.0, -0.04), (-25.0, -0.06), (0.0, -0.01)] {
            let surface = BedSurface::fit(&bed(slope, height, 300), 0.006).unwrap();
            assert_relative_eq!(surface.slope.to_degrees(), slope, epsilon = 0.6);
            assert_relative_eq!(surface.angle_of_repose_deg(), slope.abs(), epsilon = 0.6);
            // The uppermost twentieth of a bed 60 to 110 mm deep lies above the quantile.
            assert_relative_eq!(surface.height, height + 0.006, epsilon = 0.006);
        }
    }

    #[test]
    fn the_zone_lies_on_the_surface_and_faces_out_of_the_bed() {
        let spray = Spray {
            spanwise: 0.0762,
            streamwise: 0.0381,
            distance: 0.05,
            aim: crate::scene::Aim::Bed,
            pixels: [512, 256],
            deposit: crate::scene::Deposit::Sprayed { rate: 1.25e-4, solids: 0.2, film_density: 1300.0 },
            pattern: crate::scene::Pattern::default(),
        };
        let surface = BedSurface { slope: 40.0_f64.to_radians(), height: -0.04 };
        let zone = surface.zone(&spray);
        assert_relative_eq!(zone.center.norm(), 0.04, epsilon = 1e-15);
        assert!(zone.normal.y > 0.0 && zone.normal.x < 0.0 && zone.center.x > 0.0);
        assert_relative_eq!(zone.streamwise.y, -40.0_f64.to_radians().sin(), epsilon = 1e-15);
    }

    #[test]
    fn a_handful_of_tablets_is_no_bed() {
        let error = BedSurface::fit(&bed(30.0, -0.04, 0)[..50], 0.006).unwrap_err();
        assert!(matches!(error, AimError::TooFewBodies { bodies } if bodies < FEWEST));
        assert!(BedSurface::fit(&[], 0.006).is_err());
    }
}
