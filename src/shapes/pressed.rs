//! Pressed tablets: a band of constant height along an outline, closed by two equal caps.

use super::cap::CapProfile;
use super::outline::Outline;
use super::rings::Builder;
use super::{MassProperties, Panels, Region};
use nalgebra::{Matrix3, Vector2, Vector3};

/// The solid between z = −(band/2 + height(s)) and band/2 + height(s), s being the gauge radius of the outline:
/// the point s r(u) has gauge radius s when r(u) is on the outline.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PressedSolid {
    /// The outline, wound counter-clockwise around the origin.
    pub(super) outline: Outline,
    /// Height of the band, m.
    pub(super) band: f64,
    /// The cap on each side.
    pub(super) cap: CapProfile,
}

impl PressedSolid {
    /// Mass properties by quadrature, relative error below 1e-9. With J = r × r' du ds s for the area element of the
    /// plan and H(s) = band + 2 height(s), all integrals are products of one along the outline and one over s.
    pub(super) fn mass(&self) -> MassProperties {
        let cap = self.cap.nodes();
        let over_s = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
            cap.iter().map(|n| n.weight * f(n.s, self.band + 2.0 * n.height)).sum()
        };
        let (mut area, mut first, mut second) = (0.0, Vector2::zeros(), nalgebra::Matrix2::zeros());
        for node in self.outline.nodes() {
            let cross = node.point.perp(&node.derivative) * node.weight;
            area += cross;
            first += node.point * cross;
            second += node.point * node.point.transpose() * cross;
        }
        let volume = area * over_s(&|s, h| s * h);
        let first = first * over_s(&|s, h| s * s * h);
        let in_plan = second * over_s(&|s, h| s.powi(3) * h);
        let along_axis = area * over_s(&|s, h| s * h.powi(3) / 12.0);
        let mut moments = Matrix3::zeros();
        moments.fixed_view_mut::<2, 2>(0, 0).copy_from(&in_plan);
        moments[(2, 2)] = along_axis;
        MassProperties::from_moments(volume, Vector3::new(first.x, first.y, 0.0), moments)
    }

    /// Area of both caps, m², by quadrature of |∂x/∂s × ∂x/∂u| = s √((r × r')² + (height' |r'|)²).
    pub(super) fn cap_area(&self) -> f64 {
        let outline = self.outline.nodes();
        let mut area = 0.0;
        for c in self.cap.nodes() {
            for n in &outline {
                let plan = n.point.perp(&n.derivative);
                area += 2.0 * c.weight * n.weight * c.s * plan.hypot(c.slope * n.derivative.norm());
            }
        }
        area
    }

    /// Area of the band, m².
    pub(super) fn band_area(&self) -> f64 {
        self.outline.perimeter() * self.band
    }

    /// A closed mesh of about `count` triangles with vertices on the true surface and edges along the rims, shifted so
    /// that `center` is the origin. Rows of equal triangles on the band; rings on the caps, each with as many
    /// vertices as its length asks for.
    pub(super) fn mesh(&self, count: usize, center: Vector3<f64>) -> Panels {
        let ideal = (4.0 * (self.cap_area() + self.band_area()) / (3f64.sqrt() * count as f64)).sqrt();
        // The division into whole rows and rings misses the count by some per cent; the best of a few edge lengths does not.
        let best = (-10..=10)
            .map(|k| Division::new(self, ideal * (1.0 + 0.01 * f64::from(k))))
            .min_by_key(|division| division.triangles().abs_diff(count))
            .expect("the range is not empty");
        best.mesh(self, center)
    }
}

/// Numbers of rows and of vertices in each ring.
struct Division {
    /// Vertices around the band.
    around: usize,
    /// Rows of triangles on the band.
    rows: usize,
    /// Gauge radius and number of vertices of each ring of a cap inside its rim; the last is the pole.
    rings: Vec<(f64, usize)>,
}

impl Division {
    /// For triangles of about this edge length, m.
    fn new(solid: &PressedSolid, edge: f64) -> Self {
        let row = edge * 3f64.sqrt() / 2.0;
        let perimeter = solid.outline.perimeter();
        let around = ((perimeter / edge).round() as usize).max(6);
        let rows = if solid.band > 0.0 { ((solid.band / row).round() as usize).max(1) } else { 0 };
        let steps = ((solid.cap.meridian_length() / row).round() as usize).max(2);
        let rings = solid.cap.divide(steps)[1..steps]
            .iter()
            .map(|&s| (s, ((around as f64 * s).round() as usize).max(5)))
            .chain([(0.0, 1)])
            .collect();
        Self { around, rows, rings }
    }

    /// Number of triangles.
    fn triangles(&self) -> usize {
        let ring_sum: usize = self.rings.iter().map(|&(_, n)| 2 * n).sum();
        2 * self.around * self.rows + 2 * (self.around + ring_sum - 2)
    }

    /// The mesh itself.
    fn mesh(&self, solid: &PressedSolid, center: Vector3<f64>) -> Panels {
        let mut build = Builder::default();
        let level = |count: usize, phase: f64, s: f64, z: f64| {
            let plan = solid.outline.divide(count, phase);
            plan.into_iter().map(move |p| Vector3::new(s * p.x, s * p.y, z) - center)
        };
        // Rows of the band are staggered by half a spacing.
        let rims: Vec<Vec<u32>> = (0..=self.rows)
            .map(|row| {
                let z = solid.band * (row as f64 / self.rows.max(1) as f64 - 0.5);
                build.ring(level(self.around, 0.5 * (row % 2) as f64, 1.0, z))
            })
            .collect();
        for pair in rims.windows(2) {
            build.stitch(&pair[0], &pair[1]);
        }
        let mut regions = vec![Region::Band; build.triangles.len()];
        for side in [1.0, -1.0] {
            let first = build.triangles.len();
            let mut outer = if side > 0.0 { rims[rims.len() - 1].clone() } else { rims[0].clone() };
            for (number, &(s, count)) in self.rings.iter().enumerate() {
                let z = side * (solid.band / 2.0 + solid.cap.height(s));
                let inner = build.ring(level(count, 0.5 * (number % 2) as f64, s, z));
                build.stitch(&outer, &inner);
                outer = inner;
            }
            if side < 0.0 {
                build.flip_from(first);
            }
        }
        regions.resize(build.triangles.len(), Region::Cap);
        Panels::new(build.vertices, build.triangles, regions)
    }
}
