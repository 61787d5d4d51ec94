//! The drum in the spray: wall, end walls and baffles hide what is behind them and catch what passes the tablets.

use super::film::PanelIds;
use super::raster::IdRaster;
use super::triangle::{ScreenVertex, Sides};
use super::view::{View, lanes};
use crate::shapes::{Part, SurfaceMesh};
use nalgebra::{Rotation3, Vector3};

/// The drum's surface, seen from both sides; empty where there is no drum.
#[derive(Debug, Clone)]
pub(super) struct DrumMesh {
    vertices: Vec<Vector3<f64>>,
    /// Triangles by what they belong to: its place among the numbers that follow those of the panels.
    parts: Vec<(u32, Vec<[u32; 3]>)>,
}

impl DrumMesh {
    pub(super) fn new(mesh: Option<&SurfaceMesh>) -> Self {
        let Some(mesh) = mesh else { return Self { vertices: Vec::new(), parts: Vec::new() } };
        let of = |number: u32| {
            let belongs = |part: &Part| match part {
                Part::Wall => number == PanelIds::WALL,
                Part::End(_) => number == PanelIds::END,
                Part::Baffle(_) => number == PanelIds::BAFFLE,
            };
            let triangles = mesh.triangles.iter().zip(&mesh.parts).filter(|(_, part)| belongs(part));
            (number, triangles.map(|(triangle, _)| *triangle).collect())
        };
        Self {
            vertices: mesh.vertices.clone(),
            parts: [PanelIds::WALL, PanelIds::END, PanelIds::BAFFLE].map(of).to_vec(),
        }
    }

    #[cfg(feature = "gpu")]
    pub(super) fn vertices(&self) -> &[Vector3<f64>] {
        &self.vertices
    }

    #[cfg(feature = "gpu")]
    pub(super) fn parts(&self) -> &[(u32, Vec<[u32; 3]>)] {
        &self.parts
    }

    /// Draws the drum turned by `angle` (rad about +z), cut off at the near plane, under numbers from `first_id` on.
    pub(super) fn draw(&self, view: &View, angle: f64, first_id: u32, raster: &mut IdRaster) {
        let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
        let near = f64::from(view.lens().near());
        let seen: Vec<_> = self.vertices.iter().map(|vertex| view.camera(&(turn * vertex))).collect();
        let on_screen = |v: &Vector3<f64>| ScreenVertex::snap(view.lens().screen(lanes(v)))[0];
        let vertices: Vec<_> = seen.iter().map(on_screen).collect();
        for (number, triangles) in &self.parts {
            for triangle in triangles {
                let corners = triangle.map(|vertex| seen[vertex as usize]);
                match corners.iter().filter(|corner| corner.z >= near).count() {
                    0 => {}
                    3 => {
                        let corners = triangle.map(|vertex| &vertices[vertex as usize]);
                        raster.draw(corners, first_id + number, Sides::Both);
                    }
                    _ => {
                        let cut: Vec<_> = beyond(near, corners).iter().map(on_screen).collect();
                        for k in 2..cut.len() {
                            raster.draw([&cut[0], &cut[k - 1], &cut[k]], first_id + number, Sides::Both);
                        }
                    }
                }
            }
        }
        raster.settle_all();
    }
}

/// The polygon that is left of a triangle (camera coordinates) beyond the near plane.
fn beyond(near: f64, triangle: [Vector3<f64>; 3]) -> Vec<Vector3<f64>> {
    let mut polygon = Vec::with_capacity(4);
    for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (triangle[a], triangle[b])) {
        if a.z >= near {
            polygon.push(a);
        }
        if (a.z < near) != (b.z < near) {
            polygon.push(a + (b - a) * ((a.z - near) / (a.z - b.z)));
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
            let polygon = beyond(0.5, corners);
            (2..polygon.len())
                .map(|k| (polygon[k - 1] - polygon[0]).xy().perp(&(polygon[k] - polygon[0]).xy()) / 2.0)
                .sum::<f64>()
        };
        assert_eq!(at([1.5, 1.5, 1.5]), 8.0);
        assert_eq!(at([-0.5, -0.5, -0.5]), 0.0);
        assert!((at([1.5, -0.5, -0.5]) - 2.0).abs() < 1e-12);
        assert!((at([-0.5, 1.5, 1.5]) - 6.0).abs() < 1e-12);
    }
}
