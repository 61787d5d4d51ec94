//! STL, binary and text.

use super::{Facets, three_numbers};
use crate::scene::shown;
use crate::shapes::{MeshFault, ShapeError};
use nalgebra::Vector3;
use std::path::Path;

/// Length of the header with the facet count, and of one facet, in a binary file.
const HEADER: usize = 84;
const FACET: usize = 50;

/// Parses either kind: a file whose length is what a binary header announces is binary; else, when it begins with
/// `solid` and is text, it is text; else it is a damaged binary.
pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<Facets, ShapeError> {
    let count =
        bytes.get(HEADER - 4..HEADER).map(|b| u64::from(u32::from_le_bytes([b[0], b[1], b[2], b[3]])));
    let room = bytes.len().saturating_sub(HEADER) as u64 / FACET as u64;
    let whole = bytes.len() >= HEADER && (bytes.len() - HEADER).is_multiple_of(FACET);
    let text = std::str::from_utf8(bytes).ok().filter(|text| text.trim_start().starts_with("solid"));
    match (count, text) {
        (Some(announced), _) if announced == room && whole => Ok(binary(&bytes[HEADER..])),
        (_, Some(text)) => ascii(path, text),
        (announced, None) => {
            let announced = announced.unwrap_or(0);
            Err(ShapeError::mesh(path, MeshFault::FacetCount { announced, room }))
        }
    }
}

/// Facets of 12 little-endian f32 (normal, three corners) and two bytes each. The stored normal is not used: the
/// winding tells it.
fn binary(bytes: &[u8]) -> Facets {
    let mut facets = Facets::default();
    for facet in bytes.chunks_exact(FACET) {
        let number =
            |k: usize| f64::from(f32::from_le_bytes(std::array::from_fn(|byte| facet[4 * k + byte])));
        facets.push(&[3, 6, 9].map(|k| Vector3::new(number(k), number(k + 1), number(k + 2))));
    }
    facets
}

fn ascii(path: &Path, text: &str) -> Result<Facets, ShapeError> {
    let mut facets = Facets::default();
    let mut corners = Vec::new();
    let mut open = false;
    let fault = |line, what: &str| Err(ShapeError::content(path, line, what));
    for (line, row) in text.lines().enumerate().map(|(k, row)| (k + 1, row)) {
        let mut words = row.split_whitespace();
        match words.next().map(str::to_ascii_lowercase).as_deref() {
            Some("vertex") if corners.len() == 3 => return fault(line, "a facet has three vertices"),
            Some("vertex") => corners.push(three_numbers(path, line, words)?),
            Some("endfacet") if corners.len() != 3 => return fault(line, "a facet has three vertices"),
            Some("endfacet") => facets.push(&std::mem::take(&mut corners)),
            Some("facet") if !corners.is_empty() => return fault(line, "expected `endfacet`"),
            Some("solid") => open = true,
            Some("endsolid") => open = false,
            Some("facet" | "outer" | "endloop") | None => {}
            Some(word) => return fault(line, &format!("`{}` is not a word of STL", shown(word))),
        }
    }
    if open {
        return fault(text.lines().count(), "the file ends without `endsolid`: it is cut off");
    }
    Ok(facets)
}
