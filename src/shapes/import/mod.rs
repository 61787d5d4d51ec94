//! Triangle meshes from STL, OBJ and PLY files.
//!
//! The readers are our own because a fault has to be named by its line or facet and a lying header must not cost
//! memory; the crates of these formats do neither.

mod closed;
mod crossing;
mod obj;
mod open;
mod ply;
mod repair;
mod stl;
mod weld;

pub use closed::{ClosedMesh, read_closed_mesh};
pub use open::{ImportedSurface, read_surface};
pub use repair::Repair;

use super::tree::Bounds;
use super::{MeshFault, ShapeError};
use crate::scene::shown;
use nalgebra::Vector3;
use std::fs::File;
use std::io::Read;
use std::path::Path;
use weld::Welded;

/// Facets that are read at most. A wall of so many takes seconds, a tablet a minute; no surface of either needs them.
const MOST_FACETS: usize = 1_000_000;

/// Longest file, bytes: above it there are more facets than that in any format.
const LONGEST_FILE: u64 = 1 << 29;

/// Smallest and largest extent of a drum or boundary that is plausible, m.
const SURFACE_SIZE: [f64; 2] = [5e-3, 20.0];

/// Triangles as a file lists them; of more than [`MOST_FACETS`] only the first are kept.
#[derive(Debug, Default)]
struct Facets {
    /// Corners of each triangle, in units of the file.
    corners: Vec<[Vector3<f64>; 3]>,
    /// Number of the facet in the file each triangle comes from, from 1: a polygon gives several triangles.
    numbers: Vec<usize>,
    /// How many triangles there are, kept or not.
    count: usize,
}

impl Facets {
    /// Adds a polygon, cut into a fan of triangles.
    fn push(&mut self, polygon: &[Vector3<f64>]) {
        let number = self.numbers.last().map_or(1, |last| last + 1);
        let triangles = polygon[1..].windows(2).map(|pair| [polygon[0], pair[0], pair[1]]);
        self.count += triangles.len();
        self.corners.extend(triangles.take(MOST_FACETS - self.corners.len()));
        self.numbers.resize(self.corners.len(), number);
    }
}

/// Reads a file in the format its name ends in, welds its vertices and scales it to m.
fn read_welded(path: &Path, scale: f64, size: [f64; 2]) -> Result<Welded, ShapeError> {
    let bytes = bytes(path)?;
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

/// The whole file, unless it is too long to be looked into.
fn bytes(path: &Path) -> Result<Vec<u8>, ShapeError> {
    let read = |source| ShapeError::read(path, source);
    let mut bytes = Vec::new();
    File::open(path).and_then(|file| file.take(LONGEST_FILE + 1).read_to_end(&mut bytes)).map_err(read)?;
    if bytes.len() as u64 > LONGEST_FILE {
        return Err(ShapeError::mesh(path, MeshFault::TooLong { most: LONGEST_FILE }));
    }
    Ok(bytes)
}

/// Number of facets, coordinates and size.
fn check(facets: &Facets, scale: f64, [least, most]: [f64; 2]) -> Result<(), MeshFault> {
    if facets.corners.is_empty() {
        return Err(MeshFault::Empty);
    }
    if facets.count > MOST_FACETS {
        return Err(MeshFault::TooMany { facets: facets.count, most: MOST_FACETS });
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

/// Three numbers of a line of text.
fn three_numbers<'a>(
    path: &Path,
    line: usize,
    mut words: impl Iterator<Item = &'a str>,
) -> Result<Vector3<f64>, ShapeError> {
    let mut next = || -> Result<f64, ShapeError> {
        let word =
            words.next().ok_or_else(|| ShapeError::content(path, line, "expected three coordinates"))?;
        word.parse()
            .map_err(|_| ShapeError::content(path, line, format!("`{}` is not a number", shown(word))))
    };
    Ok(Vector3::new(next()?, next()?, next()?))
}

#[cfg(test)]
mod tests;
