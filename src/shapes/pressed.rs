//! Pressed tablets: a band of constant height along an outline, closed by two equal caps.

use super::cap::CapProfile;
use super::outline::OutlineCurve;
use super::remesh::Patchwork;
use super::rings::Builder;
use super::{MassProperties, Panels, Region};
use nalgebra::{Matrix3, Vector2, Vector3};
use std::collections::BTreeMap;

/// The solid between z = −(band/2 + height(s)) and band/2 + height(s), s being the gauge radius of the outline:
/// the point s r(u) has gauge radius s when r(u) is on the outline.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PressedSolid {
    /// The outline, wound counter-clockwise around the origin.
    pub(super) outline: OutlineCurve,
    /// Height of the band, m.
    pub(super) band: f64,
    /// The cap on each side.
    pub(super) cap: CapProfile,
    /// Mass properties in the axes of the outline.
    pub(super) mass: MassProperties,
}

impl PressedSolid {
    /// With its mass properties by quadrature, relative error below 1e-9. With J = r × r' du ds s for the area element of the
    /// plan and H(s) = band + 2 height(s), all integrals are products of one along the outline and one over s.
    pub(super) fn new(outline: OutlineCurve, band: f64, cap: CapProfile) -> Self {
        let nodes = cap.nodes();
        let over_s = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
            nodes.iter().map(|n| n.weight * f(n.s, band + 2.0 * n.height)).sum()
        };
        let (mut area, mut first, mut second) = (0.0, Vector2::zeros(), nalgebra::Matrix2::zeros());
        for node in outline.nodes() {
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
        let mass = MassProperties::from_moments(volume, Vector3::new(first.x, first.y, 0.0), moments);
        Self { outline, band, cap, mass }
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

    /// A closed mesh of about `count` triangles with edges along the rims, its centre of mass at the origin.
    ///
    /// Rings of vertices on the true surface, as long as that gives good panels: it does unless the outline is long
    /// or pointed. Then a finer mesh of rings is cut anew.
    pub(super) fn panels(&self, count: usize) -> Panels {
        let rings = self.rings(count);
        let quality = rings.quality();
        if quality.smallest_angle_deg > 25.0 && quality.area_ratio < 2.5 {
            return rings;
        }
        let fine = self.rings(4 * count);
        let alike = |s: usize, t: usize| fine.regions[s] == fine.regions[t];
        let surface = Patchwork::new(fine.vertices.clone(), fine.triangles.clone(), alike);
        let region_of: BTreeMap<u32, Region> = surface.patches.iter().copied().zip(fine.regions).collect();
        let mesh = surface.remesh(count);
        let regions = mesh.patches.iter().map(|patch| region_of[patch]).collect();
        Panels::new(mesh.vertices, mesh.triangles, regions)
    }

    /// A closed mesh of about `count` triangles: rows of equal triangles on the band, and rings on the caps, each with
    /// as many vertices as its length asks for.
    pub(super) fn rings(&self, count: usize) -> Panels {
        let ideal = (4.0 * (self.cap_area() + self.band_area()) / (3f64.sqrt() * count as f64)).sqrt();
        // The division into whole rows and rings misses the count by some per cent; the best of a few edge lengths does not.
        let divisions = (-15..=15).map(|k| Division::new(self, ideal * (1.0 + 0.01 * f64::from(k))));
        let best = divisions.min_by_key(|division| division.triangles().abs_diff(count));
        best.expect("the range is not empty").panels(self)
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
        let rings = solid.cap.divide(row)[1..]
            .iter()
            .map(|&s| (s, if s > 0.0 { ((around as f64 * s).round() as usize).max(5) } else { 1 }))
            .collect();
        Self { around, rows, rings }
    }

    /// Number of triangles.
    fn triangles(&self) -> usize {
        let ring_sum: usize = self.rings.iter().map(|&(_, n)| 2 * n).sum();
        2 * self.around * self.rows + 2 * (self.around + ring_sum - 2)
    }

    /// The mesh itself.
    fn panels(&self, solid: &PressedSolid) -> Panels {
        let mut build = Builder::default();
        let level = |count: usize, phase: f64, s: f64, z: f64| {
            let plan = if s > 0.0 { solid.outline.divide(count, phase) } else { vec![Vector2::zeros()] };
            plan.into_iter().map(move |p| Vector3::new(s * p.x, s * p.y, z) - solid.mass.center)
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
