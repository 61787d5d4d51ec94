//! Meshes of walls, which may be open.

use super::closed::edges_of;
use super::weld::Welded;
use super::{Repair, SURFACE_SIZE, read_welded};
use crate::shapes::{MeshFault, Part, ShapeError, SurfaceMesh};
use std::collections::BTreeSet;
use std::path::Path;

/// A surface from a file.
#[derive(Debug, Clone, PartialEq)]
pub struct ImportedSurface {
    /// The surface, which may be open; every triangle is of [`Part::Wall`].
    pub mesh: SurfaceMesh,
    /// What had to be put right; to be shown to whoever gave the file.
    pub repairs: Vec<Repair>,
}

/// Reads the surface of a drum or boundary from an STL, OBJ or PLY file whose unit is `scale` metres. It may be open,
/// three or more facets may meet in an edge, and facets may cross.
/// The facets have to be wound counter-clockwise seen from the tablets: nothing in a file tells on which side those
/// are.
///
/// # Errors
/// [`ShapeError::Read`], [`ShapeError::Content`] or [`ShapeError::Mesh`] when the file cannot be read, is damaged, has
/// an implausible size, or has neighbours wound against each other.
pub fn read_surface(path: &Path, scale: f64) -> Result<ImportedSurface, ShapeError> {
    let mut mesh = read_welded(path, scale, SURFACE_SIZE)?;
    let mut repairs = mesh.repairs();
    repairs.extend(mesh.drop_repeated());
    if let Some(facet) = mesh.unlike() {
        return Err(ShapeError::mesh(path, MeshFault::Unlike { facet }));
    }
    let parts = vec![Part::Wall; mesh.triangles.len()];
    let mesh = SurfaceMesh { vertices: mesh.vertices, triangles: mesh.triangles, parts };
    Ok(ImportedSurface { mesh, repairs })
}

impl Welded {
    /// Drops facets on the corners of an earlier one, wound alike or not: tablets would feel both.
    fn drop_repeated(&mut self) -> Option<Repair> {
        let mut known = BTreeSet::new();
        let new = |triangle: &[u32; 3]| {
            let mut corners = *triangle;
            corners.sort_unstable();
            known.insert(corners)
        };
        let kept: Vec<bool> = self.triangles.iter().map(new).collect();
        let first = self.numbers[kept.iter().position(|kept| !kept)?];
        let before = self.triangles.len();
        let (mut of_triangles, mut of_numbers) = (kept.iter(), kept.iter());
        self.triangles.retain(|_| of_triangles.next() == Some(&true));
        self.numbers.retain(|_| of_numbers.next() == Some(&true));
        Some(Repair::Repeated { count: before - self.triangles.len(), first })
    }

    /// The first facet that is wound against its only neighbour at an edge. Where three or more meet, as a baffle on a
    /// wall, any winding is possible.
    fn unlike(&self) -> Option<usize> {
        let edges = self.edges();
        let unlike = edges.iter().filter_map(|(&[u, v], at)| match at[..] {
            [s, t] => {
                let [s_winds, t_winds] = [s, t].map(|t| edges_of(self.triangles[t]).contains(&(u, v)));
                (s_winds == t_winds).then_some(t)
            }
            _ => None,
        });
        unlike.min().map(|t| self.numbers[t])
    }
}
