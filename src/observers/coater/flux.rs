//! How much each pixel of the zone is worth.

use super::CoaterError;
use crate::scene::{Flux, Footprint, Pattern, ShortLines};
use std::path::Path;

/// Weight of the pixel that receives the most.
const FULL: u32 = u16::MAX as u32;
/// Points along each side of a pixel over which the flux is averaged.
const SAMPLES: u32 = 4;

/// Weights of the pixels of a zone, row by row.
///
/// Whole numbers, so that sums do not depend on their order; a pixel that receives the most counts 65 535.
pub(super) fn weights(pattern: &Pattern, pixels: [u32; 2]) -> Result<Vec<u32>, CoaterError> {
    let table = match &pattern.flux {
        Flux::Table { path } => Some(Table::read(path)?),
        _ => None,
    };
    let flux = |s: f64, t: f64| match (&pattern.flux, &table) {
        _ if pattern.footprint == Footprint::Ellipse && s.hypot(t) > 1.0 => 0.0,
        (Flux::Gaussian { sigma }, _) => gauss(s.hypot(t), *sigma),
        (Flux::Annular { inner }, _) => f64::from(s.hypot(t) >= *inner),
        (Flux::Dumbbell { offset, sigma }, _) => {
            gauss((s - offset).hypot(t), *sigma) + gauss((s + offset).hypot(t), *sigma)
        }
        (_, Some(table)) => table.at(s, t),
        _ => 1.0,
    };
    // From −1 to 1 over the extents.
    let place = |pixel: u32, sample: u32, size: u32| {
        2.0 * (f64::from(pixel) + (f64::from(sample) + 0.5) / f64::from(SAMPLES)) / f64::from(size) - 1.0
    };
    let [width, height] = pixels;
    let means: Vec<f64> = (0..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .map(|(x, y)| {
            let samples = (0..SAMPLES).flat_map(|i| (0..SAMPLES).map(move |j| (i, j)));
            samples.map(|(i, j)| flux(place(x, i, width), place(y, j, height))).sum()
        })
        .collect();
    let most = means.iter().copied().fold(0.0, f64::max);
    if most > 0.0 && most.is_finite() {
        Ok(means.iter().map(|mean| (mean / most * f64::from(FULL)).round() as u32).collect())
    } else {
        Err(CoaterError::NoFlux)
    }
}

fn gauss(distance: f64, sigma: f64) -> f64 {
    (-0.5 * (distance / sigma).powi(2)).exp()
}

/// A measured spray.
struct Table {
    columns: usize,
    values: Vec<f64>,
}

impl Table {
    fn read(path: &Path) -> Result<Self, CoaterError> {
        let fault = |line: u64, what: &'static str| CoaterError::Table { path: path.into(), line, what };
        let unreadable = |source| CoaterError::ReadTable { path: path.into(), source };
        let file = ShortLines::open(path).map_err(|error| unreadable(error.into()))?;
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .trim(csv::Trim::All)
            .comment(Some(b'#'))
            .from_reader(file);
        let mut values = Vec::new();
        let mut columns = 0;
        for record in reader.records() {
            let record = record.map_err(unreadable)?;
            let line = record.position().map_or(0, csv::Position::line);
            columns = record.len();
            for field in &record {
                let value = field.parse::<f64>().map_err(|_| fault(line, "expected numbers"))?;
                if !(value >= 0.0 && value.is_finite()) {
                    return Err(fault(line, "amounts are not negative"));
                }
                values.push(value);
            }
        }
        Ok(Self { columns: columns.max(1), values })
    }

    /// Value at (s, t), each −1 to 1, between the centres of the cells bilinear, beyond them constant.
    fn at(&self, s: f64, t: f64) -> f64 {
        let rows = self.values.len() / self.columns;
        if rows == 0 {
            return 0.0;
        }
        let between = |place: f64, cells: usize| {
            let at = (place.midpoint(1.0) * cells as f64 - 0.5).clamp(0.0, (cells - 1) as f64);
            let low = at.floor() as usize;
            (low, (low + 1).min(cells - 1), at.fract())
        };
        let (left, right, u) = between(s, self.columns);
        let (top, bottom, v) = between(t, rows);
        let row = |row: usize| {
            let cells = &self.values[row * self.columns..];
            cells[left] * (1.0 - u) + cells[right] * u
        };
        row(top) * (1.0 - v) + row(bottom) * v
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn share(pattern: &Pattern) -> f64 {
        let weights = weights(pattern, [64, 32]).unwrap();
        weights.iter().map(|&w| f64::from(w)).sum::<f64>() / (64.0 * 32.0 * f64::from(FULL))
    }

    #[test]
    fn an_ellipse_covers_pi_over_four_of_its_rectangle() {
        let ellipse = Pattern { footprint: Footprint::Ellipse, ..Pattern::default() };
        assert!((share(&ellipse) - std::f64::consts::FRAC_PI_4).abs() < 2e-3);
        assert_eq!(share(&Pattern::default()), 1.0);
        let ring = Pattern { flux: Flux::Annular { inner: 0.5 }, ..ellipse };
        assert!((share(&ring) - 0.75 * std::f64::consts::FRAC_PI_4).abs() < 3e-3);
    }

    #[test]
    fn bells_have_their_middle_and_width() {
        let at = |flux: Flux, x: usize, y: usize| {
            let pattern = Pattern { flux, ..Pattern::default() };
            f64::from(weights(&pattern, [65, 33]).unwrap()[y * 65 + x]) / f64::from(FULL)
        };
        let gaussian = Flux::Gaussian { sigma: 0.5 };
        assert_eq!(at(gaussian.clone(), 32, 16), 1.0);
        // The last column's centre is 64/65 of the half extent away.
        let expected = (-0.5 * (64.0_f64 / 65.0 / 0.5).powi(2)).exp();
        assert!((at(gaussian, 64, 16) - expected).abs() < 1e-3);
        let dumbbell = Flux::Dumbbell { offset: 0.6, sigma: 0.2 };
        assert!(at(dumbbell.clone(), 32, 16) < 0.05);
        assert!(at(dumbbell, 12, 16) > 0.98);
    }

    #[test]
    fn a_measured_table_is_spread_over_the_zone() {
        let mut file = tempfile::NamedTempFile::new().unwrap();
        writeln!(file, "# g/min\n0, 2\n0, 4").unwrap();
        let flux = Flux::Table { path: file.path().into() };
        let weights = weights(&Pattern { flux, ..Pattern::default() }, [4, 4]).unwrap();
        // Columns of cells are at −½ and ½, pixels at −¾, −¼, ¼, ¾: shares 0, ¼, ¾, 1, rows alike.
        let relative =
            |row: usize, column: usize| f64::from(weights[4 * row + column]) / f64::from(weights[15]);
        assert!((relative(3, 1) - 0.25).abs() < 0.04 && (relative(3, 2) - 0.75).abs() < 0.04);
        assert!(relative(3, 0) == 0.0 && (relative(0, 3) - 0.5).abs() < 1e-3);
    }

    #[test]
    fn faults_of_a_table_are_named() {
        let message = |content: &str| {
            let mut file = tempfile::NamedTempFile::new().unwrap();
            write!(file, "{content}").unwrap();
            let flux = Flux::Table { path: file.path().into() };
            let error = weights(&Pattern { flux, ..Pattern::default() }, [4, 4]).unwrap_err();
            error.to_string().replace(&file.path().display().to_string(), "F")
        };
        assert_eq!(message("1,2\n1,x\n"), "F:2: expected numbers");
        assert_eq!(message("1,-2\n"), "F:1: amounts are not negative");
        assert_eq!(message(""), "the spray's flux is zero everywhere");
        assert!(message("1,2\n1\n").starts_with("cannot read the spray's table F"));
    }
}
