//! The drum in the spray: wall, end walls and baffles hide what is behind them and catch what passes the tablets.

use super::raster::IdRaster;
use super::triangle::{ScreenVertex, Sides};
use super::view::View;
use crate::shapes::{Part, SurfaceMesh};
use nalgebra::{Rotation3, Vector3};

/// The drum's surface, seen from both sides.
#[derive(Debug, Clone)]
pub(super) struct DrumMesh(SurfaceMesh);

/// Number of a part among the numbers that follow those of the panels.
fn number(part: Part) -> u32 {
    match part {
        Part::Wall => 0,
        Part::End(_) => 1,
        Part::Baffle(_) => 2,
    }
}

impl DrumMesh {
    pub(super) fn new(mesh: &SurfaceMesh) -> Self {
        Self(mesh.clone())
    }

    /// Draws the drum turned by `angle` (rad about +z), cut off at the near plane, under numbers from `first_id` on.
    pub(super) fn draw(&self, view: &View, angle: f64, first_id: u32, raster: &mut IdRaster) {
        let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
        let seen: Vec<_> = self.0.vertices.iter().map(|vertex| view.project(&(turn * vertex))).collect();
        for (triangle, &part) in self.0.triangles.iter().zip(&self.0.parts) {
            let below = below_near_plane(triangle.map(|vertex| seen[vertex as usize]));
            let vertices: Vec<_> =
                below.iter().map(|v| ScreenVertex::new(v.data.0[0].map(|x| x as f32))).collect();
            for k in 2..vertices.len() {
                raster.draw(
                    [vertices[0], vertices[k - 1], vertices[k]],
                    first_id + number(part),
                    Sides::Both,
                );
            }
        }
        raster.settle_all();
    }
}

/// The polygon that is left of a triangle (screen coordinates) below depth zero.
fn below_near_plane(triangle: [Vector3<f64>; 3]) -> Vec<Vector3<f64>> {
    let mut polygon = Vec::with_capacity(4);
    for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (triangle[a], triangle[b])) {
        if a.z >= 0.0 {
            polygon.push(a);
        }
        if (a.z < 0.0) != (b.z < 0.0) {
            polygon.push(a + (b - a) * (a.z / (a.z - b.z)));
        }
    }
    polygon
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_cut_at_the_near_plane() {
        let at = |z: [f64; 3]| {
            let corners =
                [Vector3::new(0.0, 0.0, z[0]), Vector3::new(4.0, 0.0, z[1]), Vector3::new(0.0, 4.0, z[2])];
            let polygon = below_near_plane(corners);
            (2..polygon.len())
                .map(|k| (polygon[k - 1] - polygon[0]).xy().perp(&(polygon[k] - polygon[0]).xy()) / 2.0)
                .sum::<f64>()
        };
        assert_eq!(at([1.0, 1.0, 1.0]), 8.0);
        assert_eq!(at([-1.0, -1.0, -1.0]), 0.0);
        assert!((at([1.0, -1.0, -1.0]) - 2.0).abs() < 1e-12);
        assert!((at([-1.0, 1.0, 1.0]) - 6.0).abs() < 1e-12);
    }
}
