//! From the world to the screen of a view: pixels right and down, depth away from the viewer.

use crate::observers::SprayZone;
use crate::scene::Rays;
use crate::stepping::BodyState;
use nalgebra::Vector3;
use wide::f32x4;

/// A pinhole sees what is further away than this share of its distance from the zone.
const PINHOLE_NEAR: f64 = 0.05;

/// A zone as seen from its nozzle. The zone's rectangle is the screen, the centre of pixel (0, 0) its origin.
///
/// Points pass through camera coordinates: pixels (of the zone's plane) right and down from the axis, and metres away
/// from the nozzle.
#[derive(Debug, Clone, Copy)]
pub(in crate::observers) struct View {
    /// Rows: pixels to the right, pixels down, metres away, each per metre.
    rows: [Vector3<f64>; 3],
    /// Middle of the zone in the world, m.
    center: Vector3<f64>,
    /// From the nozzle to the zone, m.
    distance: f64,
    lens: Lens,
}

/// From camera coordinates to the screen.
#[derive(Debug, Clone, Copy)]
pub(in crate::observers) struct Lens {
    rays: Rays,
    /// The axis on the screen, pixels.
    axis: [f32; 2],
    /// From the nozzle to the zone, m.
    distance: f32,
    /// From the nozzle to the near plane, m.
    near: f32,
}

/// A body as a view sees it, `camera = turn · x + at` for x in body axes.
#[derive(Debug, Clone, Copy)]
pub(in crate::observers) struct Placement {
    turn: [[f32; 3]; 3],
    at: [f32; 3],
}

/// The box about what a view may see of a body.
#[derive(Debug, Clone, Copy)]
pub(in crate::observers) struct ScreenBox {
    /// Left and top, pixels.
    pub(in crate::observers) min: [f32; 2],
    /// Right and bottom, pixels.
    pub(in crate::observers) max: [f32; 2],
    /// Depth of its nearest side.
    pub(in crate::observers) nearest: f32,
}

impl View {
    /// The view of `zone` along `rays` in `pixels`, its contents moved by `jitter` (pixels).
    pub(in crate::observers) fn new(
        zone: &SprayZone,
        rays: Rays,
        pixels: [u32; 2],
        jitter: [f64; 2],
    ) -> Self {
        let [width, height] = pixels.map(f64::from);
        let near = match rays {
            Rays::Parallel => 0.0,
            Rays::Diverging => PINHOLE_NEAR * zone.distance,
        };
        Self {
            rows: [
                zone.spanwise * (width / zone.extent[0]),
                zone.streamwise * (height / zone.extent[1]),
                -zone.normal,
            ],
            center: zone.center,
            distance: zone.distance,
            lens: Lens {
                rays,
                axis: [(width / 2.0 - 0.5 + jitter[0]) as f32, (height / 2.0 - 0.5 + jitter[1]) as f32],
                distance: zone.distance as f32,
                near: near as f32,
            },
        }
    }

    pub(in crate::observers) fn lens(&self) -> &Lens {
        &self.lens
    }

    /// Camera coordinates of a point of the world.
    pub(in crate::observers) fn camera(&self, point: &Vector3<f64>) -> Vector3<f64> {
        let seen = point - self.center;
        Vector3::from(self.rows.map(|row| row.dot(&seen))) + Vector3::new(0.0, 0.0, self.distance)
    }

    /// Screen coordinates of a point of the world.
    pub(in crate::observers) fn screen(&self, point: &Vector3<f64>) -> [f32; 3] {
        self.lens.screen(lanes(&self.camera(point))).map(|lanes| lanes.to_array()[0])
    }

    /// Where a body comes to lie.
    pub(in crate::observers) fn place(&self, body: &BodyState) -> Placement {
        let inverse = body.orientation.inverse();
        Placement {
            turn: self.rows.map(|row| (inverse * row).data.0[0].map(|x| x as f32)),
            at: self.camera(&body.position).data.0[0].map(|x| x as f32),
        }
    }
}

/// What a graphics card is told of a view.
#[cfg(feature = "gpu")]
impl View {
    /// Where what turns with the drum comes to lie when it has turned by `angle`, rad about +z.
    pub(super) fn place_turned(&self, angle: f64) -> Placement {
        let orientation = nalgebra::UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle);
        let still = Vector3::zeros();
        self.place(&BodyState { position: still, orientation, velocity: still, spin: still })
    }
}

#[cfg(feature = "gpu")]
impl Lens {
    pub(super) fn rays(&self) -> Rays {
        self.rays
    }

    /// The axis on the screen, pixels.
    pub(super) fn axis(&self) -> [f32; 2] {
        self.axis
    }

    /// From the nozzle to the zone, m.
    pub(super) fn distance(&self) -> f32 {
        self.distance
    }
}

#[cfg(feature = "gpu")]
impl Placement {
    /// Rows of the turn, the position last.
    pub(super) fn rows(&self) -> [[f32; 4]; 3] {
        std::array::from_fn(|k| [self.turn[k][0], self.turn[k][1], self.turn[k][2], self.at[k]])
    }
}

impl Lens {
    /// Screen coordinates of points in camera coordinates. Depth grows away from the nozzle and is linear over the screen
    /// within a plane: metres for parallel rays, the negative inverse of metres for diverging ones. Points nearer than
    /// the near plane are moved to it.
    #[inline]
    pub(in crate::observers) fn screen(&self, [x, y, away]: [f32x4; 3]) -> [f32x4; 3] {
        let away = away.fast_max(f32x4::splat(self.near));
        let [right, down] = self.axis.map(f32x4::splat);
        match self.rays {
            Rays::Parallel => [x + right, y + down, away],
            Rays::Diverging => {
                let inverse = f32x4::ONE / away;
                let scale = f32x4::splat(self.distance) * inverse;
                [x * scale + right, y * scale + down, -inverse]
            }
        }
    }

    /// From the nozzle to the near plane, m.
    pub(in crate::observers) fn near(&self) -> f32 {
        self.near
    }

    /// Metres from the nozzle, along the axis, of a depth.
    pub(in crate::observers) fn metres(&self, depth: f32) -> f32 {
        match self.rays {
            Rays::Parallel => depth,
            Rays::Diverging => -1.0 / depth,
        }
    }

    /// The box on the screen about a box in camera coordinates; `None` when that lies above the near plane, or when a
    /// pinhole would have to look at its inside.
    pub(in crate::observers) fn screen_box(&self, middle: [f32; 3], half: [f32; 3]) -> Option<ScreenBox> {
        let (nearest, furthest) = (middle[2] - half[2], middle[2] + half[2]);
        let sides = |k: usize| (middle[k] - half[k], middle[k] + half[k]);
        let [(left, right), (top, bottom)] = [sides(0), sides(1)];
        let [x, y] = self.axis;
        match self.rays {
            Rays::Parallel if furthest < self.near => None,
            Rays::Parallel => Some(ScreenBox {
                min: [left + x, top + y],
                max: [right + x, bottom + y],
                // A hair nearer than computed, so that rounding never hides a body at the same depth.
                nearest: nearest - 1e-5 * (half[2] + middle[2].abs()),
            }),
            Rays::Diverging if nearest <= self.near => None,
            Rays::Diverging => {
                let [large, small] = [nearest, furthest].map(|away| self.distance / away);
                let low = |side: f32| side * if side < 0.0 { large } else { small };
                let high = |side: f32| side * if side < 0.0 { small } else { large };
                Some(ScreenBox {
                    min: [low(left) + x, low(top) + y],
                    max: [high(right) + x, high(bottom) + y],
                    nearest: -(1.0 + 1e-5) / nearest,
                })
            }
        }
    }
}

impl Placement {
    /// Camera coordinates of points in body axes.
    #[inline]
    pub(in crate::observers) fn apply(&self, [x, y, z]: &[f32x4; 3]) -> [f32x4; 3] {
        std::array::from_fn(|k| {
            let [a, b, c] = self.turn[k].map(f32x4::splat);
            a * *x + b * *y + c * *z + f32x4::splat(self.at[k])
        })
    }

    /// The box in camera coordinates, as its middle and half its sides, about a box in body axes.
    pub(in crate::observers) fn box_about(&self, middle: [f32; 3], half: [f32; 3]) -> ([f32; 3], [f32; 3]) {
        let middle = self.apply(&middle.map(f32x4::splat)).map(|lanes| lanes.to_array()[0]);
        (middle, self.turn.map(|row| row.iter().zip(half).map(|(turn, half)| turn.abs() * half).sum()))
    }
}

/// The same point in all lanes.
pub(super) fn lanes(point: &Vector3<f64>) -> [f32x4; 3] {
    point.data.0[0].map(|x| f32x4::splat(x as f32))
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
        for rays in [Rays::Parallel, Rays::Diverging] {
            let view = View::new(&zone(), rays, [400, 200], [0.0; 2]);
            let corner = zone().center - zone().spanwise * 0.2 - zone().streamwise * 0.05;
            let [x, y, depth] = view.screen(&corner);
            assert!((x + 0.5).abs() < 1e-4 && (y + 0.5).abs() < 1e-4, "{x} {y}");
            assert!((view.lens().metres(depth) - 0.05).abs() < 1e-7);
        }
    }

    #[test]
    fn a_pinhole_sees_the_near_larger_and_parallel_rays_do_not() {
        let half_way = zone().center + zone().spanwise * 0.05 + zone().normal * 0.025;
        let [parallel, diverging] = [Rays::Parallel, Rays::Diverging]
            .map(|rays| View::new(&zone(), rays, [400, 200], [0.0; 2]).screen(&half_way)[0] - 199.5);
        assert!((parallel - 50.0).abs() < 1e-4 && (diverging - 100.0).abs() < 1e-4, "{parallel} {diverging}");
    }

    #[test]
    fn a_box_on_the_screen_holds_the_points_of_the_body() {
        let body = BodyState {
            position: Vector3::new(0.02, 0.01, 0.1),
            orientation: UnitQuaternion::from_euler_angles(0.3, -1.1, 2.0),
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
        };
        for rays in [Rays::Parallel, Rays::Diverging] {
            let view = View::new(&zone(), rays, [400, 200], [0.25, -0.125]);
            let placement = view.place(&body);
            let (middle, half) = placement.box_about([1e-3, 0.0, 0.0], [3e-3, 7e-3, 2e-3]);
            let bounds = view.lens().screen_box(middle, half).unwrap();
            for corner in 0..8 {
                let sign = |bit: usize| if corner >> bit & 1 == 0 { -1.0 } else { 1.0 };
                let point = Vector3::new(1e-3 + 3e-3 * sign(0), 7e-3 * sign(1), 2e-3 * sign(2));
                let [x, y, depth] = view.screen(&(body.position + body.orientation * point));
                let tolerance = 1e-3;
                assert!(x > bounds.min[0] - tolerance && x < bounds.max[0] + tolerance);
                assert!(y > bounds.min[1] - tolerance && y < bounds.max[1] + tolerance);
                assert!(depth > bounds.nearest);
                // A body's point is where the world's is.
                let placed =
                    view.lens().screen(placement.apply(&lanes(&point))).map(|lanes| lanes.to_array()[0]);
                assert!((placed[0] - x).abs() < 1e-3 && (placed[1] - y).abs() < 1e-3);
            }
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
