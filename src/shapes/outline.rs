//! The outline of a tablet seen along its axis, as a curve.

use super::quadrature::unit_rule;
use crate::scene::Outline;
use nalgebra::Vector2;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A closed convex curve around the origin, counter-clockwise.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct OutlineCurve {
    segments: Vec<Segment>,
    /// What is taken from the segments' coordinates to put the middle at the origin, m.
    middle: Vector2<f64>,
    /// Numbers of the segments that start at a corner.
    corners: Vec<usize>,
}

/// A smooth piece of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Segment {
    /// A whole outline by its support function p₀ + c₂ cos 2t + c₄ cos 4t + c₃ cos 3(t − turn), m: the curve is
    /// (p cos t − p' sin t, p sin t + p' cos t), its derivative (p + p'')(−sin t, cos t).
    Harmonic { coefficients: [f64; 4], turn: f64 },
    /// A straight line.
    Line { from: Vector2<f64>, to: Vector2<f64> },
    /// Part of a circle, counter-clockwise from an angle through another, rad.
    Arc { center: Vector2<f64>, radius: f64, from: f64, through: f64 },
}

/// A point of a curve with its derivative by the parameter.
#[derive(Debug, Clone, Copy)]
pub(super) struct OutlineNode {
    /// The point, m.
    pub(super) point: Vector2<f64>,
    /// Its derivative by the parameter, m.
    pub(super) derivative: Vector2<f64>,
    /// Weight of the node in an integral over the parameter.
    pub(super) weight: f64,
}

impl Segment {
    /// The point at parameter u, 0 to 1, m.
    fn point(&self, u: f64) -> Vector2<f64> {
        match *self {
            Self::Harmonic { coefficients: [mean, second, fourth, third], turn } => {
                let t = TAU * u;
                let odd = 3.0 * (t - turn);
                let p = mean + second * (2.0 * t).cos() + fourth * (4.0 * t).cos() + third * odd.cos();
                let slope = -2.0 * second * (2.0 * t).sin()
                    - 4.0 * fourth * (4.0 * t).sin()
                    - 3.0 * third * odd.sin();
                Vector2::new(p * t.cos() - slope * t.sin(), p * t.sin() + slope * t.cos())
            }
            Self::Line { from, to } => from + (to - from) * u,
            Self::Arc { center, radius, from, through } => center + direction(from + through * u) * radius,
        }
    }

    /// The derivative of the point by u, m.
    fn derivative(&self, u: f64) -> Vector2<f64> {
        match *self {
            Self::Harmonic { coefficients: [mean, second, fourth, third], turn } => {
                let t = TAU * u;
                let radius = mean
                    - 3.0 * second * (2.0 * t).cos()
                    - 15.0 * fourth * (4.0 * t).cos()
                    - 8.0 * third * (3.0 * (t - turn)).cos();
                direction(t + FRAC_PI_2) * (TAU * radius)
            }
            Self::Line { from, to } => to - from,
            Self::Arc { radius, from, through, .. } => {
                direction(from + through * u + FRAC_PI_2) * (radius * through)
            }
        }
    }
}

fn direction(angle: f64) -> Vector2<f64> {
    Vector2::new(angle.cos(), angle.sin())
}

impl OutlineCurve {
    /// A circle.
    pub(super) fn circle(diameter: f64) -> Self {
        Self::harmonic([diameter / 2.0, 0.0, 0.0, 0.0], 0.0)
    }

    /// The curve of a recipe. The middle, to which caps shrink the outline, is that of the support function, or the
    /// centroid of the plan for outlines made of lines and arcs.
    pub(super) fn new(outline: &Outline) -> Self {
        let (length, width) = outline.size();
        let half = width / 2.0;
        let at = Vector2::new;
        let half_circle =
            |x: f64, from: f64| Segment::Arc { center: at(x, 0.0), radius: half, from, through: PI };
        let line = |from, to| Segment::Line { from, to };
        match *outline {
            Outline::Oval { .. } | Outline::Almond { .. } | Outline::Triangular { .. } => {
                // sin 3t = cos 3(t − 30 degrees).
                let turn = if matches!(outline, Outline::Triangular { .. }) { PI / 6.0 } else { 0.0 };
                Self::harmonic(outline.harmonics().unwrap_or_default(), turn)
            }
            Outline::Capsule { .. } => {
                let x = (length - width) / 2.0;
                let mut segments = vec![half_circle(x, -FRAC_PI_2), half_circle(-x, FRAC_PI_2)];
                if x > 0.0 {
                    segments.insert(1, line(at(x, half), at(-x, half)));
                    segments.push(line(at(-x, -half), at(x, -half)));
                }
                Self { segments, middle: Vector2::zeros(), corners: Vec::new() }
            }
            Outline::Bullet { .. } => {
                let x = length - half;
                Self::with_corners(
                    vec![
                        line(at(0.0, -half), at(x, -half)),
                        half_circle(x, -FRAC_PI_2),
                        line(at(x, half), at(0.0, half)),
                        line(at(0.0, half), at(0.0, -half)),
                    ],
                    vec![0, 3],
                )
            }
            Outline::HalfMoon { .. } => {
                // Circle through the ends of a chord L and the top W above it: R = (L²/4 + W²)/2W.
                let radius = (length * length / 4.0 + width * width) / (2.0 * width);
                let from = (radius - width).atan2(length / 2.0);
                let center = at(0.0, width - radius);
                let arc = Segment::Arc { center, radius, from, through: PI - 2.0 * from };
                Self::with_corners(vec![line(at(-length / 2.0, 0.0), at(length / 2.0, 0.0)), arc], vec![0, 1])
            }
            Outline::Shield { .. } => {
                // Arc from (0, W/2), leaving along −x, to (−L, 0): its centre is (0, W/2 − R), R = (L² + W²/4)/W.
                let radius = (length * length + half * half) / width;
                let through = length.atan2(radius - half);
                let arc = |y: f64, from: f64| Segment::Arc { center: at(0.0, y), radius, from, through };
                Self::with_corners(
                    vec![
                        line(at(0.0, -half), at(0.0, half)),
                        arc(half - radius, FRAC_PI_2),
                        arc(radius - half, 3.0 * FRAC_PI_2 - through),
                    ],
                    vec![0, 1, 2],
                )
            }
        }
    }

    fn harmonic(coefficients: [f64; 4], turn: f64) -> Self {
        let segments = vec![Segment::Harmonic { coefficients, turn }];
        Self { segments, middle: Vector2::zeros(), corners: Vec::new() }
    }

    fn with_corners(segments: Vec<Segment>, corners: Vec<usize>) -> Self {
        let mut curve = Self { segments, middle: Vector2::zeros(), corners };
        let (mut area, mut first) = (0.0, Vector2::zeros());
        for node in curve.nodes() {
            let cross = node.point.perp(&node.derivative) * node.weight;
            area += cross / 2.0;
            first += node.point * (cross / 3.0);
        }
        curve.middle = first / area;
        curve
    }

    /// Nodes for integrals once round.
    pub(super) fn nodes(&self) -> Vec<OutlineNode> {
        let node = |segment: &Segment, (u, weight): (f64, f64)| OutlineNode {
            point: segment.point(u) - self.middle,
            derivative: segment.derivative(u),
            weight,
        };
        self.segments.iter().flat_map(|s| unit_rule(24).into_iter().map(move |rule| node(s, rule))).collect()
    }

    /// Length once round, m.
    pub(super) fn perimeter(&self) -> f64 {
        self.nodes().iter().map(|n| n.derivative.norm() * n.weight).sum()
    }

    /// About `count` points along the outline, evenly spaced. Without corners there are exactly `count`, the first
    /// `phase` spacings behind the start; with corners each is a point and `phase` counts for nothing.
    pub(super) fn divide(&self, count: usize, phase: f64) -> Vec<Vector2<f64>> {
        let starts: &[usize] = if self.corners.is_empty() { &[0] } else { &self.corners };
        let runs: Vec<Vec<Mark>> = (0..starts.len())
            .map(|k| self.run(starts[k], starts.get(k + 1).copied().unwrap_or(self.segments.len())))
            .collect();
        let length = |run: &[Mark]| run[run.len() - 1].length;
        let total: f64 = runs.iter().map(|run| length(run)).sum();
        let mut points = Vec::with_capacity(count);
        for run in &runs {
            let share =
                if runs.len() == 1 { count } else { (count as f64 * length(run) / total).round() as usize };
            let steps = share.max(1);
            let phase = if self.corners.is_empty() { phase } else { 0.0 };
            points.extend(
                (0..steps).map(|i| self.at_length(run, length(run) * (i as f64 + phase) / steps as f64)),
            );
        }
        points
    }

    /// Lengths along the segments `first..end`, finely divided.
    fn run(&self, first: usize, end: usize) -> Vec<Mark> {
        const STEPS: usize = 2000;
        let mut length = 0.0;
        let mut marks = Vec::with_capacity((end - first) * (STEPS + 1));
        for segment in first..end {
            let mut last = self.segments[segment].point(0.0);
            for k in 0..=STEPS {
                let u = k as f64 / STEPS as f64;
                let point = self.segments[segment].point(u);
                length += (point - last).norm();
                last = point;
                marks.push(Mark { length, segment, u });
            }
        }
        marks
    }

    /// The point at a length from the start of a run.
    fn at_length(&self, run: &[Mark], length: f64) -> Vector2<f64> {
        let k = run.partition_point(|mark| mark.length < length).max(1);
        let (before, after) = (run[k - 1], run[k]);
        let share = (length - before.length) / (after.length - before.length);
        let u = if share.is_finite() { before.u + (after.u - before.u) * share } else { before.u };
        self.segments[before.segment].point(u) - self.middle
    }
}

/// A parameter of a curve and how far along it that is.
#[derive(Debug, Clone, Copy)]
struct Mark {
    /// Length from the start of the run, m.
    length: f64,
    segment: usize,
    u: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn area(curve: &OutlineCurve) -> f64 {
        curve.nodes().iter().map(|n| 0.5 * n.point.perp(&n.derivative) * n.weight).sum()
    }

    fn extents(curve: &OutlineCurve) -> Vector2<f64> {
        let points = curve.divide(20_000, 0.0);
        let span = |f: fn(&Vector2<f64>) -> f64| {
            let of = || points.iter().map(f);
            of().fold(f64::MIN, f64::max) - of().fold(f64::MAX, f64::min)
        };
        Vector2::new(span(|p| p.x), span(|p| p.y))
    }

    #[test]
    fn lengths_and_areas_have_their_closed_forms() {
        // (outline, area, perimeter, extents)
        let lens = (5f64 * 5. + 2.5 * 2.5) / 5.;
        let tip = (5. / lens).asin();
        let cases = [
            (Outline::Capsule { length: 10., width: 4. }, 24. + 4. * PI, 12. + 4. * PI, [10., 4.]),
            (Outline::Bullet { length: 10., width: 4. }, 32. + 2. * PI, 20. + 2. * PI, [10., 4.]),
            (Outline::HalfMoon { length: 10., width: 5. }, 12.5 * PI, 10. + 5. * PI, [10., 5.]),
            (
                Outline::Shield { length: 5., width: 5. },
                // Twice the sector less the triangle to the centre of the arc.
                lens * lens * tip - 5. * (lens - 2.5),
                5. + 2. * lens * tip,
                [5., 5.],
            ),
        ];
        for (outline, plan, perimeter, [length, width]) in cases {
            let curve = OutlineCurve::new(&outline);
            assert_relative_eq!(area(&curve), plan, max_relative = 1e-12);
            assert_relative_eq!(curve.perimeter(), perimeter, max_relative = 1e-12);
            assert_relative_eq!(extents(&curve), Vector2::new(length, width), max_relative = 1e-6);
            let first: Vector2<f64> =
                curve.nodes().iter().map(|n| n.point * (n.point.perp(&n.derivative) * n.weight)).sum();
            assert!(first.norm() < 1e-9 * plan);
        }
    }

    #[test]
    fn harmonics_leave_length_and_width_exact() {
        let (length, width, fourth_harmonic, third_harmonic) = (19.2, 12.5, -0.1336, 0.35);
        for outline in [
            Outline::Almond { length, width, fourth_harmonic, third_harmonic },
            Outline::Triangular { length, width, fourth_harmonic, third_harmonic },
        ] {
            let curve = OutlineCurve::new(&outline);
            assert_relative_eq!(extents(&curve), Vector2::new(length, width), max_relative = 1e-6);
            // Cauchy: the perimeter is 2 π times the mean of the support function.
            assert_relative_eq!(
                curve.perimeter(),
                TAU * outline.harmonics().expect("harmonic")[0],
                epsilon = 1e-12
            );
        }
    }

    #[test]
    fn corners_are_points_of_every_division() {
        let curve = OutlineCurve::new(&Outline::HalfMoon { length: 10., width: 5. });
        for count in [4, 5, 37] {
            let points = curve.divide(count, 0.5);
            assert!(points.iter().any(|p| (p + curve.middle - Vector2::new(5., 0.)).norm() < 1e-12));
        }
    }
}
