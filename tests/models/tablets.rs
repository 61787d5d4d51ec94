//! The four tablets of Freireich et al. 2015, Table 4, as panels.
//!
//! Plan outline by its support function p(t) = p0 + c2 cos 2t + c4 cos 4t + c3 odd(3t), with p0 = (L + W)/4 − c4 and
//! c2 = (L − W)/4; points x = p cos t − p' sin t, y = p sin t + p' cos t. Upright band, caps z = band/2 + cap (1 − s^m) with s from
//! 0 at the axis to 1 at the outline. Parameters in mm, fitted to length, width, thickness, area, volume and band-to-face ratio.

use nalgebra::Vector3;
use pancoat::models::TabletSurface;

pub(crate) struct Tablet {
    pub(crate) name: &'static str,
    length: f64,
    width: f64,
    c4: f64,
    c3: f64,
    /// Turns odd(3t) = cos(3t − phase): 0 for the almond, π/2 for the triangular tablet.
    phase: f64,
    band: f64,
    cap: f64,
    exponent: f64,
    /// Surface by Table 4, mm².
    pub(crate) area: f64,
}

const RIGHT: f64 = std::f64::consts::FRAC_PI_2;

pub(crate) const ALMOND: Tablet = Tablet {
    name: "almond",
    length: 20.6,
    width: 12.1,
    c4: -0.0403,
    c3: 0.1807,
    phase: 0.0,
    band: 4.8671,
    cap: 1.4965,
    exponent: 1.6302,
    area: 644.7,
};
pub(crate) const OVAL: Tablet = Tablet {
    name: "oval",
    length: 19.2,
    width: 10.8,
    c4: -0.2211,
    c3: 0.0,
    phase: 0.0,
    band: 4.6971,
    cap: 1.5814,
    exponent: 3.5728,
    area: 588.6,
};
pub(crate) const ROUND: Tablet = Tablet {
    name: "round",
    length: 15.9,
    width: 15.9,
    c4: 0.0,
    c3: 0.0,
    phase: 0.0,
    band: 3.2452,
    cap: 1.6973,
    exponent: 2.8823,
    area: 584.5,
};
/// With a band-to-face ratio of 0.6151; the printed 0.1561 is out of reach of a band with convex caps.
pub(crate) const TRIANGULAR: Tablet = Tablet {
    name: "triangular",
    length: 19.2,
    width: 12.5,
    c4: -0.1336,
    c3: 0.35,
    phase: RIGHT,
    band: 4.9048,
    cap: 1.7776,
    exponent: 2.5124,
    area: 652.1,
};

pub(crate) struct Surface {
    pub(crate) vertices: Vec<Vector3<f64>>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) normals: Vec<Vector3<f64>>,
    pub(crate) centroids: Vec<Vector3<f64>>,
    pub(crate) areas: Vec<f64>,
    pub(crate) on_cap: Vec<bool>,
}

impl Tablet {
    /// Panels in mm: `around` of them about the axis, `rings` on each cap.
    pub(crate) fn surface(&self, around: u32, rings: u32) -> Surface {
        let mut vertices = vec![];
        let outline = |step: u32| {
            let t = f64::from(step) / f64::from(around) * std::f64::consts::TAU;
            let (c2, p0) = ((self.length - self.width) / 4.0, (self.length + self.width) / 4.0 - self.c4);
            let odd = 3.0 * t - self.phase;
            let p = p0 + c2 * (2.0 * t).cos() + self.c4 * (4.0 * t).cos() + self.c3 * odd.cos();
            let slope =
                -2.0 * c2 * (2.0 * t).sin() - 4.0 * self.c4 * (4.0 * t).sin() - 3.0 * self.c3 * odd.sin();
            (p * t.cos() - slope * t.sin(), p * t.sin() + slope * t.cos())
        };
        // Rows of points from the top's centre outwards, down the band, and back to the bottom's centre.
        let profile: Vec<(f64, f64, bool)> = (0..=rings)
            .map(|k| f64::from(k) / f64::from(rings))
            .map(|s| (s, self.band / 2.0 + self.cap * (1.0 - s.powf(self.exponent)), true))
            .collect();
        let mut rows = profile.clone();
        rows.extend((1..4).map(|k| (1.0, self.band * (0.5 - f64::from(k) / 4.0), false)));
        rows.extend(profile.iter().rev().map(|&(s, z, _)| (s, -z, false)));
        for &(s, z, _) in &rows {
            vertices
                .extend((0..around).map(|step| Vector3::new(s * outline(step).0, s * outline(step).1, z)));
        }
        let mut surface = Surface {
            vertices,
            triangles: vec![],
            normals: vec![],
            centroids: vec![],
            areas: vec![],
            on_cap: vec![],
        };
        for row in 0..rows.len() as u32 - 1 {
            let on_cap = row < rings || row >= rings + 4;
            for step in 0..around {
                let (a, b) = (row * around + step, row * around + (step + 1) % around);
                for triangle in [[a, a + around, b], [b, a + around, b + around]] {
                    surface.push(triangle, on_cap);
                }
            }
        }
        surface
    }
}

impl Surface {
    fn push(&mut self, triangle: [u32; 3], on_cap: bool) {
        let [a, b, c] = triangle.map(|v| self.vertices[v as usize]);
        let cross = (b - a).cross(&(c - a));
        if cross.norm() > 1e-9 {
            self.triangles.push(triangle);
            self.normals.push(cross.normalize());
            self.centroids.push((a + b + c) / 3.0);
            self.areas.push(cross.norm() / 2.0);
            self.on_cap.push(on_cap);
        }
    }

    pub(crate) fn view(&self) -> TabletSurface<'_> {
        TabletSurface::new(&self.centroids, &self.normals, &self.areas, &self.on_cap)
            .expect("one entry per panel each")
    }

    /// Area-weighted mean over the panels.
    pub(crate) fn mean(&self, value: impl Fn(usize) -> f64) -> f64 {
        (0..self.areas.len()).map(|j| value(j) * self.areas[j]).sum::<f64>() / self.areas.iter().sum::<f64>()
    }
}
