//! Wavefront OBJ: vertices and faces; everything else is passed over.

use super::{Facets, MOST_FACETS, three_numbers};
use crate::scene::shown;
use crate::shapes::{MeshFault, ShapeError};
use nalgebra::Vector3;
use std::path::Path;

pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<Facets, ShapeError> {
    let text = String::from_utf8_lossy(bytes);
    let mut vertices = Vec::new();
    let mut facets = Facets::default();
    for (line, row) in text.lines().enumerate().map(|(k, row)| (k + 1, row)) {
        let mut words = row.split_whitespace();
        match words.next() {
            Some("v") => vertices.push(three_numbers(path, line, words)?),
            Some("f") => {
                let number = facets.numbers.last().map_or(1, |last| last + 1);
                // A face with as many corners as this has too many triangles already.
                let polygon: Vec<Vector3<f64>> = words
                    .take(MOST_FACETS + 3)
                    .map(|word| vertex(path, line, word, number, &vertices))
                    .collect::<Result<_, _>>()?;
                if polygon.len() < 3 {
                    return Err(ShapeError::content(path, line, "a face has at least three vertices"));
                }
                facets.push(&polygon);
            }
            _ => {}
        }
    }
    Ok(facets)
}

/// The vertex a face names as `7`, `7/1`, `7//3` or `7/1/3`; negative numbers count back from the last vertex read.
fn vertex(
    path: &Path,
    line: usize,
    word: &str,
    facet: usize,
    vertices: &[Vector3<f64>],
) -> Result<Vector3<f64>, ShapeError> {
    let index: i64 = word.split('/').next().and_then(|first| first.parse().ok()).ok_or_else(|| {
        ShapeError::content(path, line, format!("`{}` is not a vertex number", shown(word)))
    })?;
    let count = vertices.len();
    let from_end = |back: u64| count.checked_sub(usize::try_from(back).ok()?);
    let place = if index < 0 { from_end(index.unsigned_abs()) } else { usize::try_from(index - 1).ok() };
    place
        .and_then(|k| vertices.get(k).copied())
        .ok_or_else(|| ShapeError::mesh(path, MeshFault::NoVertex { facet, vertex: index, vertices: count }))
}
