//! Steps that change which vertices are joined: split, collapse, flip.
//!
//! Each works in passes. Within a pass a change locks what it touched, so that the connectivity found at the start of
//! the pass stays true for all the others; passes are repeated until nothing changes.

use super::connectivity::{Connectivity, Edge, Role};
use super::guide::Guide;
use super::{Patchwork, normal, smallest_angle};
use nalgebra::Vector3;

/// Most passes of one step; twenty are enough to take a mesh of 100 000 triangles down to 1000.
const PASSES: usize = 60;

/// Cosine of the largest angle by which a triangle's normal may turn in one change (60 degrees).
const TURN: f64 = 0.5;

/// What edges are chosen by.
#[derive(Debug, Clone, Copy)]
pub(super) enum Size {
    /// Length, m.
    Length,
    /// Mean area of the two triangles, m².
    Area,
}

impl Patchwork {
    /// Splits edges in the middle whose size is above `limit`, largest first and at most `most`.
    pub(super) fn split_larger(&mut self, size: Size, limit: f64, mut most: usize, guide: &Guide) {
        for _ in 0..PASSES {
            let connectivity = Connectivity::new(self);
            let mut large = self.by_size(&connectivity, size, |size| size > limit);
            large.reverse();
            let mut locked = vec![false; self.triangles.len()];
            for edge in &large {
                if most == 0 || edge.sides.iter().any(|&t| locked[t]) {
                    continue;
                }
                most -= 1;
                edge.sides.iter().for_each(|&t| locked[t] = true);
                let role = edge.pair(self).map_or(Role::Inner(self.patches[edge.sides[0]]), Role::Rim);
                let [a, b] = edge.ends.map(|v| self.vertices[v as usize]);
                let middle = self.vertices.len() as u32;
                self.vertices.push(guide.hold(role, (a + b) / 2.0));
                for t in edge.sides {
                    let replace = |end: u32| self.triangles[t].map(|v| if v == end { middle } else { v });
                    let (first, second) = (replace(edge.ends[0]), replace(edge.ends[1]));
                    self.triangles[t] = first;
                    self.triangles.push(second);
                    self.patches.push(self.patches[t]);
                }
            }
            if large.is_empty() || most == 0 {
                break;
            }
        }
    }

    /// Collapses edges whose size is below `limit`, smallest first and at most `most`, unless that makes one longer than
    /// `longest` (m), turns a triangle over or breaks a sharp edge.
    pub(super) fn collapse_smaller(
        &mut self,
        size: Size,
        limit: f64,
        longest: f64,
        mut most: usize,
        guide: &Guide,
    ) {
        for _ in 0..PASSES {
            let connectivity = Connectivity::new(self);
            let mut locked = vec![false; self.vertices.len()];
            let mut dead = vec![false; self.triangles.len()];
            let mut changed = false;
            for edge in self.by_size(&connectivity, size, |size| size < limit) {
                let [u, v] = edge.ends;
                let rings = [connectivity.ring(self, u), connectivity.ring(self, v)];
                if most == 0 || rings.iter().flatten().any(|&w| locked[w as usize]) {
                    continue;
                }
                let Some((kept, point)) = self.merged(&connectivity, &edge, guide) else { continue };
                let shared = rings[0].iter().filter(|w| rings[1].binary_search(w).is_ok()).count();
                if shared != 2 || !self.may_merge(&connectivity, &edge, &point, longest) {
                    continue;
                }
                let gone = u ^ v ^ kept;
                for &t in connectivity.fan(gone) {
                    self.triangles[t as usize] =
                        self.triangles[t as usize].map(|w| if w == gone { kept } else { w });
                }
                self.vertices[kept as usize] = point;
                edge.sides.iter().for_each(|&t| dead[t] = true);
                rings.iter().flatten().for_each(|&w| locked[w as usize] = true);
                most -= 1;
                changed = true;
            }
            if !changed {
                break;
            }
            self.drop_triangles(&dead);
        }
    }

    /// Flips edges inside patches where that widens the smaller of the smallest angles of the two triangles.
    pub(super) fn flip(&mut self) {
        for _ in 0..PASSES {
            let connectivity = Connectivity::new(self);
            let mut locked = vec![false; self.vertices.len()];
            let mut changed = false;
            for edge in &connectivity.edges {
                let [u, v] = edge.ends;
                let [a, b] = edge.opposites(self);
                let touched = [u, v, a, b];
                if edge.pair(self).is_some()
                    || touched.iter().any(|&w| locked[w as usize])
                    || connectivity.ring(self, a).binary_search(&b).is_ok()
                {
                    continue;
                }
                // Side 0 holds u → v → a, side 1 holds v → u → b.
                let [old, new] = [[[u, v, a], [v, u, b]], [[u, b, a], [v, a, b]]];
                let at = |t: [u32; 3]| t.map(|w| self.vertices[w as usize]);
                let least =
                    |pair: [[u32; 3]; 2]| smallest_angle(&at(pair[0])).min(smallest_angle(&at(pair[1])));
                let outward = normal(&at(old[0])).normalize() + normal(&at(old[1])).normalize();
                let upright =
                    new.iter().all(|&t| normal(&at(t)).normalize().dot(&outward) > TURN * outward.norm());
                if upright && least(new) > least(old) + 1e-6 {
                    self.triangles[edge.sides[0]] = new[0];
                    self.triangles[edge.sides[1]] = new[1];
                    for w in touched {
                        locked[w as usize] = true;
                    }
                    changed = true;
                }
            }
            if !changed {
                break;
            }
        }
    }

    /// Edges whose size passes, smallest first.
    fn by_size(&self, connectivity: &Connectivity, size: Size, passes: impl Fn(f64) -> bool) -> Vec<Edge> {
        let of = |edge: &Edge| match size {
            Size::Length => edge.length(self),
            Size::Area => edge.sides.iter().map(|&t| normal(&self.corners(t)).norm() / 4.0).sum(),
        };
        let with_size = connectivity.edges.iter().map(|edge| (of(edge), *edge));
        let mut found: Vec<(f64, Edge)> = with_size.filter(|&(size, _)| passes(size)).collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.ends.cmp(&b.1.ends)));
        found.into_iter().map(|(_, edge)| edge).collect()
    }

    /// Which end stays when an edge collapses, and where; `None` when a sharp edge or corner would be lost.
    fn merged(&self, connectivity: &Connectivity, edge: &Edge, guide: &Guide) -> Option<(u32, Vector3<f64>)> {
        let [u, v] = edge.ends;
        let [a, b] = edge.ends.map(|w| self.vertices[w as usize]);
        let sharp = edge.pair(self).is_some();
        match [u, v].map(|w| connectivity.roles[w as usize]) {
            [Role::Inner(patch), Role::Inner(_)] => Some((u, guide.hold(Role::Inner(patch), (a + b) / 2.0))),
            [Role::Rim(pair), Role::Rim(_)] if sharp => Some((u, guide.hold(Role::Rim(pair), (a + b) / 2.0))),
            [Role::Inner(_), _] => Some((v, b)),
            [_, Role::Inner(_)] => Some((u, a)),
            [Role::Corner, Role::Rim(_)] if sharp => Some((u, a)),
            [Role::Rim(_), Role::Corner] if sharp => Some((v, b)),
            _ => None,
        }
    }

    /// Whether the triangles around a collapsing edge stay upright, and their edges short enough.
    fn may_merge(
        &self,
        connectivity: &Connectivity,
        edge: &Edge,
        point: &Vector3<f64>,
        longest: f64,
    ) -> bool {
        edge.ends.iter().flat_map(|&end| connectivity.fan(end)).map(|&t| t as usize).all(|t| {
            if edge.sides.contains(&t) {
                return true;
            }
            let old = self.corners(t);
            let moved = self.triangles[t].map(|w| edge.ends.contains(&w));
            let new: [Vector3<f64>; 3] = std::array::from_fn(|k| if moved[k] { *point } else { old[k] });
            let short = (0..3).all(|k| moved[k] || (new[k] - point).norm() < longest);
            let (before, after) = (normal(&old), normal(&new));
            short && before.dot(&after) > TURN * before.norm() * after.norm()
        })
    }

    /// Drops triangles and the vertices they leave unused.
    fn drop_triangles(&mut self, dead: &[bool]) {
        let alive = |t: usize| !dead[t];
        self.patches = (0..dead.len()).filter(|&t| alive(t)).map(|t| self.patches[t]).collect();
        self.triangles = (0..dead.len()).filter(|&t| alive(t)).map(|t| self.triangles[t]).collect();
        let mut used = vec![false; self.vertices.len()];
        self.triangles.iter().flatten().for_each(|&v| used[v as usize] = true);
        let mut numbers = vec![0; used.len()];
        let mut vertices = Vec::with_capacity(self.triangles.len() / 2 + 2);
        for v in (0..used.len()).filter(|&v| used[v]) {
            numbers[v] = vertices.len() as u32;
            vertices.push(self.vertices[v]);
        }
        self.vertices = vertices;
        self.triangles.iter_mut().flatten().for_each(|v| *v = numbers[*v as usize]);
    }
}
