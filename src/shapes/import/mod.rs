//! Triangle meshes from STL, OBJ and PLY files.
//!
//! The readers are our own because a fault has to be named by its line or facet and a lying header must not cost
//! memory; the crates of these formats do neither.

mod closed;
mod crossing;
mod obj;
mod ply;
mod repair;
mod stl;
mod weld;

pub use closed::{ClosedMesh, read_closed_mesh};
pub use repair::Repair;

use super::tree::Bounds;
use super::{MeshFault, Part, ShapeError, SurfaceMesh};
use nalgebra::Vector3;
use std::collections::BTreeMap;
use std::path::Path;
use weld::Welded;

/// Facets that are read at most. More take minutes and no surface of a tablet or drum needs them.
const MOST_FACETS: usize = 1_000_000;

/// Smallest and largest extent of a drum or boundary that is plausible, m.
const SURFACE_SIZE: [f64; 2] = [5e-3, 20.0];

/// Triangles as a file lists them.
#[derive(Debug, Default)]
struct Facets {
    /// Corners of each triangle, in units of the file.
    corners: Vec<[Vector3<f64>; 3]>,
    /// Number of the facet in the file each triangle comes from, from 1: a polygon gives several triangles.
    numbers: Vec<usize>,
}

impl Facets {
    /// Adds a polygon, cut into a fan of triangles.
    fn push(&mut self, polygon: &[Vector3<f64>]) {
        let number = self.numbers.last().map_or(1, |last| last + 1);
        for pair in polygon[1..].windows(2) {
            self.corners.push([polygon[0], pair[0], pair[1]]);
            self.numbers.push(number);
        }
    }
}

/// Reads a file in the format its name ends in, welds its vertices and scales it to m.
fn read_welded(path: &Path, scale: f64, size: [f64; 2]) -> Result<Welded, ShapeError> {
    let bytes = std::fs::read(path).map_err(|source| ShapeError::read(path, source))?;
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    let facets = match extension.as_deref() {
        Some("stl") => stl::parse(path, &bytes)?,
        Some("obj") => obj::parse(path, &bytes)?,
        Some("ply") => ply::parse(path, &bytes)?,
        _ => return Err(ShapeError::mesh(path, MeshFault::UnknownFormat)),
    };
    check(&facets, scale, size).map_err(|fault| ShapeError::mesh(path, fault))?;
    Ok(Welded::new(&facets, scale))
}

/// Number of facets, coordinates and size.
fn check(facets: &Facets, scale: f64, [least, most]: [f64; 2]) -> Result<(), MeshFault> {
    if facets.corners.is_empty() {
        return Err(MeshFault::Empty);
    }
    if facets.corners.len() > MOST_FACETS {
        return Err(MeshFault::TooMany { facets: facets.corners.len(), most: MOST_FACETS });
    }
    let bad = facets.corners.iter().position(|t| t.iter().flatten().any(|x| !(x * scale).is_finite()));
    if let Some(t) = bad {
        return Err(MeshFault::NotFinite { facet: facets.numbers[t] });
    }
    let extent = Bounds::of(facets.corners.iter().flatten()).extents().max() * scale;
    if !(least..=most).contains(&extent) {
        return Err(MeshFault::Size { extent, least, most });
    }
    Ok(())
}

/// A surface from a file.
#[derive(Debug, Clone, PartialEq)]
pub struct ImportedSurface {
    /// The surface, which may be open; every triangle is of [`Part::Wall`].
    pub mesh: SurfaceMesh,
    /// What had to be put right; to be shown to whoever gave the file.
    pub repairs: Vec<Repair>,
}

/// Reads the surface of a drum or boundary from an STL, OBJ or PLY file whose unit is `scale` metres. It may be open.
/// The facets have to be wound counter-clockwise seen from the tablets: nothing in a file tells on which side those
/// are.
///
/// # Errors
/// [`ShapeError::Read`], [`ShapeError::Content`] or [`ShapeError::Mesh`] when the file cannot be read, is damaged, has
/// an implausible size, or has neighbours wound against each other.
pub fn read_surface(path: &Path, scale: f64) -> Result<ImportedSurface, ShapeError> {
    let mesh = read_welded(path, scale, SURFACE_SIZE)?;
    let repairs = mesh.repairs();
    let mut directed: BTreeMap<(u32, u32), usize> = BTreeMap::new();
    let mut twice = None;
    let mut count: BTreeMap<(u32, u32), usize> = BTreeMap::new();
    for (t, [a, b, c]) in mesh.triangles.iter().enumerate() {
        for (u, v) in [(a, b), (b, c), (c, a)] {
            *count.entry((*u.min(v), *u.max(v))).or_default() += 1;
            if directed.insert((*u, *v), t).is_some() {
                twice.get_or_insert((*u.min(v), *u.max(v), t));
            }
        }
    }
    // Where three or more meet, as a baffle on a wall, any winding is possible.
    if let Some((u, v, t)) = twice
        && count[&(u, v)] == 2
    {
        return Err(ShapeError::mesh(path, MeshFault::Unlike { facet: mesh.numbers[t] }));
    }
    let parts = vec![Part::Wall; mesh.triangles.len()];
    let mesh = SurfaceMesh { vertices: mesh.vertices, triangles: mesh.triangles, parts };
    Ok(ImportedSurface { mesh, repairs })
}

/// Three numbers of a line of text.
fn three_numbers<'a>(
    path: &Path,
    line: usize,
    mut words: impl Iterator<Item = &'a str>,
) -> Result<Vector3<f64>, ShapeError> {
    let mut next = || -> Result<f64, ShapeError> {
        let word =
            words.next().ok_or_else(|| ShapeError::content(path, line, "expected three coordinates"))?;
        word.parse().map_err(|_| ShapeError::content(path, line, format!("`{word}` is not a number")))
    };
    Ok(Vector3::new(next()?, next()?, next()?))
}

#[cfg(test)]
mod tests;
