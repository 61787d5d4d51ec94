//! Meshes that bound one solid.

use super::crossing::first_crossing;
use super::weld::Welded;
use super::{Repair, read_welded};
use crate::shapes::{MassProperties, MeshFault, ShapeError};
use nalgebra::Vector3;
use std::collections::BTreeMap;
use std::path::Path;

/// Smallest and largest extent of a tablet that is plausible, m.
const TABLET_SIZE: [f64; 2] = [0.5e-3, 0.1];

/// Facets with their corners on a line that are put right; a mesh with more is refused.
const MOST_STRAIGHT: usize = 1000;

/// A closed surface around one solid, wound counter-clockwise seen from outside.
#[derive(Debug, Clone, PartialEq)]
pub struct ClosedMesh {
    /// Vertices, m.
    pub vertices: Vec<Vector3<f64>>,
    /// Vertex indices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// What had to be put right; to be shown to whoever gave the file.
    pub repairs: Vec<Repair>,
}

/// Reads the surface of a tablet from an STL, OBJ or PLY file whose unit is `scale` metres.
///
/// # Errors
/// [`ShapeError::Read`], [`ShapeError::Content`] or [`ShapeError::Mesh`], naming the line or facet, when the file
/// cannot be read or is damaged, the size is not that of a tablet, or the facets do not bound exactly one solid.
pub fn read_closed_mesh(path: &Path, scale: f64) -> Result<ClosedMesh, ShapeError> {
    close(read_welded(path, scale, TABLET_SIZE)?).map_err(|fault| ShapeError::mesh(path, fault))
}

fn close(mut mesh: Welded) -> Result<ClosedMesh, MeshFault> {
    let mut repairs = mesh.repairs();
    let straight = mesh.replace_straight()?;
    if let Some(&first) = straight.first() {
        repairs.push(Repair::Straight { count: straight.len(), first });
    }
    repairs.extend(mesh.wind()?);
    mesh.check_points()?;
    if let Some((a, b)) = first_crossing(&mesh.vertices, &mesh.triangles) {
        return Err(MeshFault::Crossing { first: mesh.numbers[a], second: mesh.numbers[b] });
    }
    Ok(ClosedMesh { vertices: mesh.vertices, triangles: mesh.triangles, repairs })
}

/// The triangles at each edge.
pub(super) type EdgeMap = BTreeMap<[u32; 2], Vec<usize>>;

pub(super) fn edges_of([a, b, c]: [u32; 3]) -> [(u32, u32); 3] {
    [(a, b), (b, c), (c, a)]
}

impl Welded {
    pub(super) fn edges(&self) -> EdgeMap {
        let mut edges = EdgeMap::new();
        for (t, &triangle) in self.triangles.iter().enumerate() {
            for (u, v) in edges_of(triangle) {
                edges.entry([u.min(v), u.max(v)]).or_default().push(t);
            }
        }
        edges
    }

    /// Replaces triangles lower than the welding tolerance: the neighbour across the longest edge is split at the
    /// middle vertex, which closes the surface without them. Returns their facet numbers.
    fn replace_straight(&mut self) -> Result<Vec<usize>, MeshFault> {
        let mut replaced = Vec::new();
        while let Some((t, [a, b, middle])) =
            (0..self.triangles.len()).find_map(|t| Some((t, self.straight(t)?)))
        {
            let shares =
                |other: usize| other != t && [a, b].iter().all(|v| self.triangles[other].contains(v));
            let neighbour = (0..self.triangles.len()).find(|&other| shares(other));
            let Some(neighbour) = neighbour.filter(|_| replaced.len() < MOST_STRAIGHT) else {
                return Err(MeshFault::Straight { facet: self.numbers[t] });
            };
            let old = self.triangles[neighbour];
            replaced.push(self.numbers[t]);
            // The old triangle with one end of the shared edge put to the middle, once for each end.
            self.triangles[neighbour] = old.map(|v| if v == a { middle } else { v });
            self.triangles[t] = old.map(|v| if v == b { middle } else { v });
            self.numbers[t] = self.numbers[neighbour];
            if old.contains(&middle) {
                // Two triangles on the same three vertices: both go.
                for gone in [t.max(neighbour), t.min(neighbour)] {
                    self.triangles.remove(gone);
                    self.numbers.remove(gone);
                }
            }
        }
        Ok(replaced)
    }

    /// The ends of the longest edge and the third vertex of a triangle whose height is below the tolerance.
    fn straight(&self, t: usize) -> Option<[u32; 3]> {
        let at = |v: u32| self.vertices[v as usize];
        let [a, b, c] = self.triangles[t];
        let double_area = (at(b) - at(a)).cross(&(at(c) - at(a))).norm();
        let candidates = [[a, b, c], [b, c, a], [c, a, b]];
        let length = |e: &[u32; 3]| (at(e[1]) - at(e[0])).norm();
        let longest =
            candidates.into_iter().fold([a, b, c], |l, e| if length(&e) > length(&l) { e } else { l });
        (double_area < self.tolerance * length(&longest)).then_some(longest)
    }

    /// Checks that every edge has two triangles and all hang together, and winds them all outwards.
    fn wind(&mut self) -> Result<Option<Repair>, MeshFault> {
        let edges = self.edges();
        let with = |few: bool| edges.values().filter(move |at| if few { at.len() < 2 } else { at.len() > 2 });
        if let Some(first) = with(false).map(|at| at[0]).min() {
            return Err(MeshFault::ManyAtEdge { edges: with(false).count(), facet: self.numbers[first] });
        }
        if let Some(first) = with(true).map(|at| at[0]).min() {
            return Err(MeshFault::Open { edges: with(true).count(), facet: self.numbers[first] });
        }
        // Walk from triangle to triangle; `turned` of each is decided where it is first met.
        let mut turned: Vec<Option<bool>> = vec![None; self.triangles.len()];
        let mut bodies = 0;
        for start in 0..self.triangles.len() {
            if turned[start].is_some() {
                continue;
            }
            bodies += 1;
            turned[start] = Some(false);
            let mut stack = vec![start];
            while let Some(t) = stack.pop() {
                for (u, v) in edges_of(self.triangles[t]) {
                    let at = &edges[&[u.min(v), u.max(v)]];
                    let other = if at[0] == t { at[1] } else { at[0] };
                    let same_way = edges_of(self.triangles[other]).contains(&(u, v));
                    let wanted = Some((turned[t] == Some(true)) != same_way);
                    if turned[other].is_none() {
                        turned[other] = wanted;
                        stack.push(other);
                    } else if turned[other] != wanted {
                        return Err(MeshFault::OneSided { facet: self.numbers[other] });
                    }
                }
            }
        }
        if bodies > 1 {
            return Err(MeshFault::SeveralBodies { bodies });
        }
        let mut turn: Vec<bool> = turned.iter().map(|&t| t == Some(true)).collect();
        self.turn(&turn);
        if MassProperties::of_polyhedron(&self.vertices, &self.triangles).volume < 0.0 {
            self.turn(&vec![true; turn.len()]);
            turn = turn.iter().map(|t| !t).collect();
        }
        let count = turn.iter().filter(|&&t| t).count();
        Ok(match turn.iter().position(|&t| t) {
            None => None,
            Some(_) if count == turn.len() => Some(Repair::InsideOut),
            Some(first) => Some(Repair::Turned { count, first: self.numbers[first] }),
        })
    }

    fn turn(&mut self, which: &[bool]) {
        for (triangle, _) in self.triangles.iter_mut().zip(which).filter(|&(_, &turn)| turn) {
            triangle.swap(1, 2);
        }
    }

    /// Checks that the triangles around each vertex form one ring.
    fn check_points(&self) -> Result<(), MeshFault> {
        let mut around = vec![0; self.vertices.len()];
        self.triangles.iter().flatten().for_each(|&v| around[v as usize] += 1);
        let half: BTreeMap<(u32, u32), usize> =
            self.triangles.iter().enumerate().flat_map(|(t, &e)| edges_of(e).map(|edge| (edge, t))).collect();
        let mut seen = vec![false; self.vertices.len()];
        for (t, triangle) in self.triangles.iter().enumerate() {
            for &v in triangle {
                if std::mem::replace(&mut seen[v as usize], true) {
                    continue;
                }
                // From triangle (v, a, b) on to the one that has the edge v → b, until back at the first.
                let (mut steps, mut at) = (0, t);
                loop {
                    steps += 1;
                    let into = edges_of(self.triangles[at]).into_iter().find(|&(_, end)| end == v);
                    let Some((b, _)) = into else { break };
                    at = half[&(v, b)];
                    if at == t {
                        break;
                    }
                }
                if steps != around[v as usize] {
                    return Err(MeshFault::TouchesInPoint { facet: self.numbers[t] });
                }
            }
        }
        Ok(())
    }
}
