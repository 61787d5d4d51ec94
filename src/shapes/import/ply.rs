//! PLY (Stanford), text and binary of either byte order.

use super::{Facets, MOST_FACETS};
use crate::scene::shown;
use crate::shapes::{MeshFault, ShapeError};
use nalgebra::Vector3;
use std::path::Path;

/// A scalar type by its size in bytes and kind.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Scalar {
    Signed(usize),
    Unsigned(usize),
    Float(usize),
}

#[derive(Debug)]
struct Property {
    name: String,
    /// Type of the length, for a list.
    length: Option<Scalar>,
    value: Scalar,
}

#[derive(Debug)]
struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

/// Where the values come from.
enum Values<'a> {
    /// Words of a text file.
    Text(std::str::SplitWhitespace<'a>),
    /// Bytes left of a binary file, and whether the most significant comes first.
    Binary { left: &'a [u8], big_endian: bool },
}

pub(super) fn parse(path: &Path, bytes: &[u8]) -> Result<Facets, ShapeError> {
    let (elements, mut values) = header(path, bytes)?;
    let mut vertices: Vec<Vector3<f64>> = Vec::new();
    let mut facets = Facets::default();
    for element in elements.iter().filter(|e| !e.properties.is_empty()) {
        let name = match element.name.as_str() {
            "vertex" => "vertex",
            "face" => "face",
            _ => "element",
        };
        for number in 1..=element.count {
            let ends_early = || {
                let fault = MeshFault::EndsEarly { element: name, number, announced: element.count };
                ShapeError::mesh(path, fault)
            };
            let mut point = Vector3::repeat(f64::NAN);
            let mut corners: Option<Vec<f64>> = None;
            for property in &element.properties {
                let mut next = |scalar| values.next(scalar).ok_or_else(ends_early);
                let Some(length) = property.length else {
                    let value = next(property.value)?;
                    if let Some(axis) = ["x", "y", "z"].iter().position(|&axis| axis == property.name) {
                        point[axis] = value;
                    }
                    continue;
                };
                let length = next(length)? as usize;
                if length > MOST_FACETS {
                    let fault = MeshFault::TooMany { facets: length, most: MOST_FACETS };
                    return Err(ShapeError::mesh(path, fault));
                }
                let list: Vec<f64> = (0..length).map(|_| next(property.value)).collect::<Result<_, _>>()?;
                if property.name.starts_with("vertex_ind") {
                    corners = Some(list);
                }
            }
            match (name, corners) {
                ("vertex", _) => vertices.push(point),
                ("face", Some(corners)) => {
                    let corner = |&index: &f64| {
                        let fault = || {
                            let (facet, vertices) = (number, vertices.len());
                            ShapeError::mesh(
                                path,
                                MeshFault::NoVertex { facet, vertex: index as i64, vertices },
                            )
                        };
                        let inside = index >= 0.0 && index < vertices.len() as f64;
                        inside.then(|| vertices[index as usize]).ok_or_else(fault)
                    };
                    let polygon: Vec<_> = corners.iter().map(corner).collect::<Result<_, _>>()?;
                    if polygon.len() >= 3 {
                        facets.push(&polygon);
                    }
                }
                _ => {}
            }
        }
    }
    Ok(facets)
}

impl Values<'_> {
    /// The next value; `None` at the end or where a word is not a number.
    fn next(&mut self, scalar: Scalar) -> Option<f64> {
        match self {
            Self::Text(words) => words.next()?.parse().ok(),
            Self::Binary { left, big_endian } => {
                let (Scalar::Signed(size) | Scalar::Unsigned(size) | Scalar::Float(size)) = scalar;
                let (value, rest) = left.split_at_checked(size)?;
                *left = rest;
                // Put into eight bytes, the least significant first.
                let mut bytes = [0; 8];
                bytes[..size].copy_from_slice(value);
                if *big_endian {
                    bytes[..size].reverse();
                }
                let bits = u64::from_le_bytes(bytes);
                let unused = 64 - 8 * size as u32;
                Some(match scalar {
                    Scalar::Unsigned(_) => bits as f64,
                    Scalar::Signed(_) => ((bits << unused).cast_signed() >> unused) as f64,
                    Scalar::Float(4) => f64::from(f32::from_bits(bits as u32)),
                    Scalar::Float(_) => f64::from_bits(bits),
                })
            }
        }
    }
}

fn header<'a>(path: &Path, bytes: &'a [u8]) -> Result<(Vec<Element>, Values<'a>), ShapeError> {
    let fault = |line, what: String| ShapeError::content(path, line, what);
    let mut left = bytes;
    let mut elements: Vec<Element> = Vec::new();
    let mut binary = None;
    for line in 1.. {
        let end =
            left.iter().position(|&b| b == b'\n').ok_or_else(|| fault(line, "no `end_header`".to_owned()))?;
        let row = String::from_utf8_lossy(&left[..end]).into_owned();
        left = &left[end + 1..];
        let words: Vec<&str> = row.split_whitespace().collect();
        let what = || fault(line, format!("`{}` is not a line of a PLY header", shown(row.trim())));
        match words[..] {
            ["ply"] if line == 1 => {}
            _ if line == 1 => return Err(fault(1, "expected `ply`".to_owned())),
            ["format", "ascii", _] => binary = None,
            ["format", "binary_little_endian", _] => binary = Some(false),
            ["format", "binary_big_endian", _] => binary = Some(true),
            ["element", name, count] => {
                let count = count.parse().map_err(|_| what())?;
                elements.push(Element { name: name.to_owned(), count, properties: Vec::new() });
            }
            ["property", "list", length, value, name] => {
                let property = Property {
                    name: name.to_owned(),
                    length: Some(scalar(length).ok_or_else(what)?),
                    value: scalar(value).ok_or_else(what)?,
                };
                elements.last_mut().ok_or_else(what)?.properties.push(property);
            }
            ["property", value, name] => {
                let value = scalar(value).ok_or_else(what)?;
                let property = Property { name: name.to_owned(), length: None, value };
                elements.last_mut().ok_or_else(what)?.properties.push(property);
            }
            ["end_header"] => break,
            [] | ["comment" | "obj_info", ..] => {}
            _ => return Err(what()),
        }
    }
    let values = match binary {
        Some(big_endian) => Values::Binary { left, big_endian },
        None => Values::Text(std::str::from_utf8(left).unwrap_or_default().split_whitespace()),
    };
    Ok((elements, values))
}

fn scalar(word: &str) -> Option<Scalar> {
    Some(match word {
        "char" | "int8" => Scalar::Signed(1),
        "uchar" | "uint8" => Scalar::Unsigned(1),
        "short" | "int16" => Scalar::Signed(2),
        "ushort" | "uint16" => Scalar::Unsigned(2),
        "int" | "int32" => Scalar::Signed(4),
        "uint" | "uint32" => Scalar::Unsigned(4),
        "float" | "float32" => Scalar::Float(4),
        "double" | "float64" => Scalar::Float(8),
        _ => return None,
    })
}
