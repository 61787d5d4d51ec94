//! From the world to the screen of a view: pixels right and down, depth away from the viewer.

use crate::observers::SprayZone;
use crate::stepping::BodyState;
use nalgebra::Vector3;
use wide::f32x4;

/// Parallel projection along a zone's normal, with the zone's rectangle as the screen and the nozzle as near plane.
///
/// Screen coordinates are pixels, the centre of pixel (0, 0) being the origin; depth is in m, 0 at the nozzle.
#[derive(Debug, Clone, Copy)]
pub(in crate::observers) struct View {
    /// Rows: pixels to the right, pixels down, metres of depth, each per metre.
    rows: [Vector3<f64>; 3],
    /// Middle of the zone in the world, m.
    center: Vector3<f64>,
    /// Middle of the zone on the screen.
    origin: Vector3<f64>,
}

/// A body as a view sees it, `screen = turn · x + at` for x in body axes.
#[derive(Debug, Clone, Copy)]
pub(in crate::observers) struct Placement {
    /// Rows of the scaled rotation.
    pub(in crate::observers) turn: [[f32; 3]; 3],
    /// Screen coordinates of the centre of mass.
    pub(in crate::observers) at: [f32; 3],
}

impl View {
    /// The view of `zone` in `pixels`, its contents moved by `jitter` (pixels).
    pub(in crate::observers) fn new(zone: &SprayZone, pixels: [u32; 2], jitter: [f64; 2]) -> Self {
        let [width, height] = pixels.map(f64::from);
        Self {
            rows: [
                zone.spanwise * (width / zone.extent[0]),
                zone.streamwise * (height / zone.extent[1]),
                -zone.normal,
            ],
            center: zone.center,
            origin: Vector3::new(
                width / 2.0 - 0.5 + jitter[0],
                height / 2.0 - 0.5 + jitter[1],
                zone.distance,
            ),
        }
    }

    /// Screen coordinates of a point of the world.
    pub(in crate::observers) fn project(&self, point: &Vector3<f64>) -> Vector3<f64> {
        let seen = point - self.center;
        self.origin + Vector3::from(self.rows.map(|row| row.dot(&seen)))
    }

    /// Where a body comes to lie.
    pub(in crate::observers) fn place(&self, body: &BodyState) -> Placement {
        let inverse = body.orientation.inverse();
        Placement {
            turn: self.rows.map(|row| (inverse * row).data.0[0].map(|x| x as f32)),
            at: self.project(&body.position).data.0[0].map(|x| x as f32),
        }
    }
}

impl Placement {
    /// Screen coordinates of a point in body axes.
    pub(in crate::observers) fn apply(&self, [x, y, z]: [f32; 3]) -> [f32; 3] {
        std::array::from_fn(|k| {
            let [a, b, c] = self.turn[k];
            a * x + b * y + c * z + self.at[k]
        })
    }
}

impl Placement {
    /// The same for some points at once.
    pub(in crate::observers) fn apply_lanes(&self, [x, y, z]: &[f32x4; 3]) -> [f32x4; 3] {
        std::array::from_fn(|k| {
            let [a, b, c] = self.turn[k].map(f32x4::splat);
            a * *x + b * *y + c * *z + f32x4::splat(self.at[k])
        })
    }
}

/// How far frame `index` shifts the grid of pixels, in pixels, −½ to ½: the R2 sequence, whose points fill the square
/// evenly from any starting frame on. A frozen bed is then sampled ever more finely rather than always alike.
///
/// Source: Roberts 2018, "The unreasonable effectiveness of quasirandom sequences": steps 1/φ and 1/φ² with φ the real
/// root of φ³ = φ + 1.
pub(in crate::observers) fn jitter(index: u64) -> [f64; 2] {
    [0.754_877_666_246_692_7, 0.569_840_290_998_053_2].map(|step| (0.5 + step * index as f64).fract() - 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::UnitQuaternion;

    fn zone() -> SprayZone {
        SprayZone {
            center: Vector3::new(0.01, 0.02, 0.03),
            spanwise: Vector3::z(),
            streamwise: -Vector3::x(),
            normal: Vector3::y(),
            extent: [0.4, 0.1],
            distance: 0.05,
        }
    }

    #[test]
    fn corners_of_the_zone_are_corners_of_the_screen() {
        let view = View::new(&zone(), [400, 200], [0.0; 2]);
        let corner = zone().center - zone().spanwise * 0.2 - zone().streamwise * 0.05 + zone().normal * 0.01;
        assert!((view.project(&corner) - Vector3::new(-0.5, -0.5, 0.04)).norm() < 1e-12);
    }

    #[test]
    fn a_placed_body_projects_like_its_points() {
        let view = View::new(&zone(), [400, 200], [0.25, -0.125]);
        let body = BodyState {
            position: Vector3::new(0.02, 0.01, 0.04),
            orientation: UnitQuaternion::from_euler_angles(0.3, -1.1, 2.0),
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
        };
        let point = Vector3::new(3e-3, -7e-3, 2e-3);
        let expected = view.project(&(body.position + body.orientation * point));
        let got = view.place(&body).apply([3e-3, -7e-3, 2e-3]);
        for k in 0..3 {
            assert!((f64::from(got[k]) - expected[k]).abs() < 1e-4, "{got:?} {expected:?}");
        }
    }

    #[test]
    fn jitter_covers_the_pixel_evenly() {
        let mut cells = [0; 16];
        for index in 0..1600 {
            let [x, y] = jitter(index);
            assert!(x.abs() <= 0.5 && y.abs() <= 0.5);
            cells[((x + 0.5) * 4.0) as usize * 4 + ((y + 0.5) * 4.0) as usize] += 1;
        }
        assert!(cells.iter().all(|&n| (97..=103).contains(&n)), "{cells:?}");
    }
}
