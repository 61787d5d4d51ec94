//! The free surface of the bed.

use crate::models::quantile;

/// What the surface is fitted to: one body in one frame, seen along the drum's axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceSample {
    /// Position, m: x and y from the drum's axis.
    pub position: [f64; 2],
    /// Velocity in x and y, m/s.
    pub velocity: [f64; 2],
    /// The tablet's axis of symmetry in x and y, dimensionless.
    pub axis: [f64; 2],
}

/// The plane through the upper surface of a bed in a drum, from all bodies in some frames.
///
/// First guess: the direction normal to the line from the drum's axis to the bed's centre. Along it the middle half of the
/// drum (|s| < R/2) is cut into ten bins; the surface is the line of least squares through the 95 % quantiles of height in
/// the bins, which leaves single tumbling tablets out. Derived here; checked against the angle of LIGGGHTS and LAMMPS beds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface {
    /// Dynamic angle of repose, rad: between the surface and the horizontal, positive when the bed climbs at +x.
    pub angle: f64,
    /// Height of the surface above the drum's axis along its normal, m.
    pub height: f64,
    /// Mean speed down the slope of the bodies in the surface, m/s: those within R/5 of the middle and R/10 of the height.
    pub speed: f64,
    /// Mean |cosine| between the axes of these bodies and the surface normal: 1/2 for random axes, 1 for caps up.
    pub axis_cosine: f64,
}

/// Bins along the surface.
const BINS: usize = 10;

impl Surface {
    /// Fits the surface of a bed in a drum of `radius` (m); `None` when fewer than three bins hold bodies.
    pub fn fit(samples: &[SurfaceSample], radius: f64) -> Option<Self> {
        let n = samples.len() as f64;
        let center =
            samples.iter().fold([0.0; 2], |c, p| [c[0] + p.position[0] / n, c[1] + p.position[1] / n]);
        let guess = center[0].atan2(-center[1]);

        let width = radius / BINS as f64;
        let mut bins = vec![Vec::new(); BINS];
        for p in samples {
            let (s, height) = turned(p.position, guess);
            let bin = ((s + radius / 2.0) / width).floor();
            if bin >= 0.0 && bin < BINS as f64 {
                bins[bin as usize].push(height);
            }
        }
        let tops: Vec<(f64, f64)> = bins
            .iter_mut()
            .enumerate()
            .filter(|(_, heights)| !heights.is_empty())
            .map(|(k, heights)| ((k as f64 + 0.5) * width - radius / 2.0, upper(heights)))
            .collect();
        let angle = guess + slope(&tops)?.atan();

        let middle = |p: &&SurfaceSample| turned(p.position, angle).0.abs() < radius / 5.0;
        let mut heights: Vec<f64> =
            samples.iter().filter(middle).map(|p| turned(p.position, angle).1).collect();
        if heights.is_empty() {
            return None;
        }
        let height = upper(&mut heights);
        let top: Vec<&SurfaceSample> = samples
            .iter()
            .filter(middle)
            .filter(|p| turned(p.position, angle).1 > height - radius / 10.0)
            .collect();
        let mean =
            |of: &dyn Fn(&SurfaceSample) -> f64| top.iter().map(|p| of(p)).sum::<f64>() / top.len() as f64;
        Some(Self {
            angle,
            height,
            speed: mean(&|p| -turned(p.velocity, angle).0),
            axis_cosine: mean(&|p| turned(p.axis, angle).1.abs()),
        })
    }
}

/// Components along a slope of `angle` (upwards) and normal to it.
fn turned([x, y]: [f64; 2], angle: f64) -> (f64, f64) {
    let (sin, cos) = angle.sin_cos();
    (x * cos + y * sin, y * cos - x * sin)
}

/// 95 % quantile.
fn upper(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    quantile(values, 0.95)
}

/// Slope of the line of least squares; `None` below three points.
fn slope(points: &[(f64, f64)]) -> Option<f64> {
    let n = points.len() as f64;
    let (mx, my) = points.iter().fold((0.0, 0.0), |m, p| (m.0 + p.0 / n, m.1 + p.1 / n));
    let sxx: f64 = points.iter().map(|p| (p.0 - mx).powi(2)).sum();
    let sxy: f64 = points.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum();
    (points.len() >= 3).then(|| sxy / sxx)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A full half-disc of bodies below a surface of `angle`, `height` above the axis, the upper layer flowing.
    fn bed(angle: f64, height: f64) -> Vec<SurfaceSample> {
        let (sin, cos) = f64::sin_cos(angle);
        let mut samples = Vec::new();
        for a in -100..=100 {
            for b in 0..100 {
                let (s, n) = (f64::from(a) * 1e-3, height - f64::from(b) * 1e-3);
                if s.hypot(n) < 0.1 {
                    let flow = if b < 15 { -0.4 } else { 0.1 };
                    samples.push(SurfaceSample {
                        position: [s * cos - n * sin, s * sin + n * cos],
                        velocity: [flow * cos, flow * sin],
                        axis: [-sin, cos],
                    });
                }
            }
        }
        samples
    }

    #[test]
    fn a_tilted_half_disc_gives_its_angle_speed_and_axes() {
        for degrees in [-35.0_f64, 25.0, 42.0] {
            let surface = Surface::fit(&bed(degrees.to_radians(), -0.01), 0.1).unwrap();
            assert!((surface.angle.to_degrees() - degrees).abs() < 0.6, "{surface:?}");
            assert!((surface.height + 0.01).abs() < 0.006);
            assert!((surface.speed - 0.4).abs() < 0.03);
            assert!(surface.axis_cosine > 0.999);
        }
    }

    #[test]
    fn no_bodies_no_surface() {
        assert_eq!(Surface::fit(&[], 0.1), None);
    }
}
