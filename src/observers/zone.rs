//! The spray's own frame: where the zone lies and how it is turned.

use crate::scene::Spray;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// The rectangle that is sprayed, and the frame of the spray.
///
/// `(spanwise, streamwise, −normal)` is right-handed: seen from the nozzle, spanwise runs to the right and streamwise
/// down, as columns and rows of an image do.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SprayZone {
    /// Middle of the zone, on the surface of the bed, m.
    pub center: Vector3<f64>,
    /// Unit vector along the drum's axis.
    pub spanwise: Vector3<f64>,
    /// Unit vector down the slope of the bed.
    pub streamwise: Vector3<f64>,
    /// Unit vector from the zone to the nozzle.
    pub normal: Vector3<f64>,
    /// Spanwise and streamwise extent, m.
    pub extent: [f64; 2],
    /// From the middle of the zone to the nozzle, m.
    pub distance: f64,
}

impl SprayZone {
    /// The zone of `spray` about `center` (m), turned towards the unit vector `normal`.
    ///
    /// Streamwise is the steepest way down within the zone's plane that is square to the drum's axis z. When the spray
    /// points along the drum's axis, spanwise is x.
    pub fn facing(center: Vector3<f64>, normal: Vector3<f64>, spray: &Spray) -> Self {
        let along_axis = Vector3::z() - normal * normal.z;
        let spanwise =
            along_axis.try_normalize(1e-6).unwrap_or_else(|| (Vector3::x() - normal * normal.x).normalize());
        let streamwise = spanwise.cross(&normal);
        let downhill = if streamwise.y > 0.0 { -1.0 } else { 1.0 };
        Self {
            center,
            spanwise: spanwise * downhill,
            streamwise: streamwise * downhill,
            normal,
            extent: [spray.spanwise, spray.streamwise],
            distance: spray.distance,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Aim, Deposit, Pattern};

    fn spray() -> Spray {
        Spray {
            spanwise: 0.0762,
            streamwise: 0.0381,
            distance: 0.05,
            aim: Aim::Bed,
            pixels: [512, 256],
            deposit: Deposit::Sprayed { rate: 1.25e-4, solids: 0.2, film_density: 1300.0 },
            pattern: Pattern::default(),
        }
    }

    #[test]
    fn streamwise_runs_downhill_on_either_side() {
        for degrees in [-40.0_f64, -5.0, 5.0, 40.0] {
            let (s, c) = degrees.to_radians().sin_cos();
            let zone = SprayZone::facing(Vector3::zeros(), Vector3::new(-s, c, 0.0), &spray());
            assert!((zone.streamwise.y + s.abs()).abs() < 1e-15);
            assert!((zone.spanwise.z.abs() - 1.0).abs() < 1e-15);
            assert!((zone.spanwise.cross(&zone.streamwise) + zone.normal).norm() < 1e-15);
        }
    }

    #[test]
    fn a_spray_along_the_axis_has_a_frame_too() {
        let zone = SprayZone::facing(Vector3::zeros(), Vector3::z(), &spray());
        assert!((zone.spanwise.cross(&zone.streamwise) + Vector3::z()).norm() < 1e-15);
        assert_eq!(zone.streamwise, -Vector3::y());
    }
}
