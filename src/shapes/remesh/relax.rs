//! Slides vertices along the surface so that triangles become even.

use super::connectivity::{Connectivity, Role};
use super::guide::Guide;
use super::{Patchwork, normal, smallest_angle};
use nalgebra::Vector3;

/// A move may lower a smallest angle as long as it stays above this, rad (35 degrees); below, it may only widen it.
const GOOD_ANGLE: f64 = 0.61;

impl Patchwork {
    /// One slide of every vertex: inside a patch to the middle of its triangles, on a sharp edge to the
    /// middle between its neighbours on that edge; corners stay.
    pub(super) fn relax(&mut self, guide: &Guide) {
        let connectivity = Connectivity::new(self);
        let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); self.vertices.len()];
        for edge in connectivity.edges.iter().filter(|edge| edge.pair(self).is_some()) {
            let [u, v] = edge.ends;
            neighbours[u as usize].push(v);
            neighbours[v as usize].push(u);
        }
        for (v, &role) in connectivity.roles.iter().enumerate() {
            let target = match role {
                Role::Inner(_) => self.middle(connectivity.fan(v as u32)),
                Role::Rim(_) => {
                    neighbours[v].iter().map(|&w| self.vertices[w as usize]).sum::<Vector3<f64>>() / 2.0
                }
                Role::Corner => continue,
            };
            self.try_move(v, guide.hold(role, target), connectivity.fan(v as u32));
        }
    }

    /// Mean of the centroids of the triangles around a vertex, weighted by the square of their area: the vertex moves
    /// into the large ones.
    fn middle(&self, fan: &[u32]) -> Vector3<f64> {
        let (mut sum, mut total) = (Vector3::zeros(), 0.0);
        for &t in fan {
            let corners = self.corners(t as usize);
            let weight = normal(&corners).norm_squared();
            sum += (corners[0] + corners[1] + corners[2]) * (weight / 3.0);
            total += weight;
        }
        sum / total
    }

    /// Moves a vertex unless a triangle turns over or a poor angle gets poorer.
    fn try_move(&mut self, v: usize, target: Vector3<f64>, fan: &[u32]) {
        let least =
            |mesh: &Self| fan.iter().map(|&t| smallest_angle(&mesh.corners(t as usize))).fold(4.0, f64::min);
        let normals = |mesh: &Self| -> Vec<Vector3<f64>> {
            fan.iter().map(|&t| normal(&mesh.corners(t as usize)).normalize()).collect()
        };
        let (before, old, position) = (least(self), normals(self), self.vertices[v]);
        self.vertices[v] = target;
        let upright = normals(self).iter().zip(&old).all(|(new, old)| new.dot(old) > 0.5);
        if !upright || least(self) < before.min(GOOD_ANGLE) {
            self.vertices[v] = position;
        }
    }
}
