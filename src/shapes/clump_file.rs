//! Clumps given sphere by sphere in a text file.

use super::{Clump, ShapeError, Sphere};
use crate::scene::{ShortLines, shown};
use nalgebra::Vector3;
use std::path::Path;

/// Reads rows of `x y z r` in m, separated by blanks; empty lines and lines that start with `#` are skipped.
///
/// # Errors
/// [`ShapeError::Read`] when the file cannot be read, [`ShapeError::Content`] with the line when a row is not four
/// finite numbers with a positive radius, or when there is no row.
pub(super) fn read_clump(path: &Path) -> Result<Clump, ShapeError> {
    let text = ShortLines::open(path).and_then(std::io::read_to_string);
    let text = text.map_err(|source| ShapeError::read(path, source))?;
    let fault = |line: usize, fault: String| ShapeError::Content { path: path.to_owned(), line, fault };
    let mut spheres = Vec::new();
    for (number, row) in text.lines().enumerate() {
        if row.trim().is_empty() || row.trim_start().starts_with('#') {
            continue;
        }
        let numbers: Vec<f64> = row
            .split_whitespace()
            .map(|word| {
                word.parse().map_err(|_| fault(number + 1, format!("`{}` is not a number", shown(word))))
            })
            .collect::<Result<_, _>>()?;
        let &[x, y, z, radius] = &numbers[..] else {
            let found = numbers.len();
            return Err(fault(number + 1, format!("expected four numbers `x y z r` in m, found {found}")));
        };
        if !numbers.iter().all(|n| n.is_finite()) || radius <= 0.0 {
            return Err(fault(number + 1, "a sphere needs a finite centre and a positive radius".to_owned()));
        }
        spheres.push(Sphere { center: Vector3::new(x, y, z), radius });
    }
    if spheres.is_empty() {
        return Err(fault(1, "no sphere; expected rows of `x y z r` in m".to_owned()));
    }
    Ok(Clump { spheres })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Clump, String> {
        let file = tempfile::NamedTempFile::new().expect("a file for the test");
        std::fs::write(file.path(), text).expect("written");
        read_clump(file.path()).map_err(|e| e.to_string().rsplit('/').next().expect("a name").to_owned())
    }

    #[test]
    fn rows_become_spheres() {
        let clump = read("# x y z r, m\n0 0 0 1e-3\n\n 1e-3 0 -2e-3 5e-4\n").expect("a good file");
        assert_eq!(clump.spheres[1], Sphere { center: Vector3::new(1e-3, 0.0, -2e-3), radius: 5e-4 });
    }

    #[test]
    fn faults_name_the_line() {
        for (text, message) in [
            ("0 0 0 1\n0 0 zero 1\n", ":2: `zero` is not a number"),
            ("0 0 0\n", ":1: expected four numbers `x y z r` in m, found 3"),
            ("0 0 0 1\n\n0 0 0 -1\n", ":3: a sphere needs a finite centre and a positive radius"),
            ("0 0 nan 1\n", ":1: a sphere needs a finite centre and a positive radius"),
            ("# nothing\n", ":1: no sphere; expected rows of `x y z r` in m"),
        ] {
            let fault = read(text).expect_err("a bad file");
            assert!(fault.ends_with(message), "{fault}");
        }
    }
}
