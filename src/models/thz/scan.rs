//! Measured points, read from a table.

use nalgebra::Vector3;
use std::io::Read;

/// One measured point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ThzPoint {
    /// Place on the surface in the scanner's axes, m.
    pub position: Vector3<f64>,
    /// Coating thickness, m.
    pub thickness: f64,
    /// Surface reflectivity over that of a mirror, 0 to 1.
    pub reflectivity: f64,
}

/// A measured tablet.
#[derive(Debug, Clone, PartialEq)]
pub struct ThzScan {
    /// Points kept.
    pub points: Vec<ThzPoint>,
    /// Points left out because they reflect too little, as those at edges and in debossing do.
    pub dropped: usize,
}

/// Why a table is not a scan.
#[derive(Debug, thiserror::Error)]
pub enum ThzError {
    /// The table cannot be read.
    #[error("the scan is not a table of numbers: {0}")]
    Table(#[from] csv::Error),
    /// A column is missing, or does not say its unit.
    #[error("the scan has no column {quantity} with its unit: one of {allowed}")]
    Column {
        /// Which quantity.
        quantity: &'static str,
        /// Names it may have.
        allowed: String,
    },
    /// A cell is not a number.
    #[error("line {line} of the scan: \"{text}\" in column {column} is not a number")]
    Number {
        /// Line of the file, from 1.
        line: u64,
        /// Column name.
        column: String,
        /// What stands there, the beginning.
        text: String,
    },
    /// Too few points are left to place the tablet.
    #[error("{0} points reflect enough, at least 100 are needed to place the tablet")]
    TooFewPoints(usize),
}

/// Name endings of lengths, m per unit.
const LENGTHS: [(&str, f64); 3] = [("_mm", 1e-3), ("_um", 1e-6), ("_m", 1.0)];
/// Name endings of the reflectivity.
const SHARES: [(&str, f64); 2] = [("_percent", 0.01), ("", 1.0)];

impl ThzScan {
    /// Reflectivity below which the paper leaves points out (section 7).
    pub const CUT: f64 = 0.12;

    /// Reads a CSV table with the columns x, y, z and thickness, each ending in `_m`, `_mm` or `_um`, and `reflectivity` (0 to 1) or
    /// `reflectivity_percent`, in any order; others are passed over. Points that reflect less than `cut` are left out.
    ///
    /// ```
    /// use pancoat::models::thz::ThzScan;
    /// let table = "x_mm,y_mm,z_mm,thickness_um,reflectivity_percent\n".to_string() + &"1,2,3,60,25\n".repeat(100) + "1,2,3,90,5\n";
    /// let scan = ThzScan::read(table.as_bytes(), ThzScan::CUT)?;
    /// assert_eq!((scan.points.len(), scan.dropped), (100, 1));
    /// assert!((scan.points[0].thickness - 60e-6).abs() < 1e-12 && (scan.points[0].position.z - 3e-3).abs() < 1e-12);
    /// # Ok::<(), pancoat::models::thz::ThzError>(())
    /// ```
    ///
    /// # Errors
    /// [`ThzError`] names the column or the line.
    pub fn read(table: impl Read, cut: f64) -> Result<Self, ThzError> {
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(table);
        let headers = reader.headers()?.clone();
        let columns = [
            column(&headers, "x", &LENGTHS)?,
            column(&headers, "y", &LENGTHS)?,
            column(&headers, "z", &LENGTHS)?,
            column(&headers, "thickness", &LENGTHS)?,
            column(&headers, "reflectivity", &SHARES)?,
        ];
        let mut scan = Self { points: Vec::new(), dropped: 0 };
        for record in reader.records() {
            let record = record?;
            let mut values = [0.0; 5];
            for (value, (index, unit)) in values.iter_mut().zip(columns) {
                let text = record.get(index).unwrap_or_default();
                let number: Option<f64> = text.parse().ok().filter(|v: &f64| v.is_finite());
                *value = unit
                    * number.ok_or_else(|| ThzError::Number {
                        line: record.position().map_or(0, csv::Position::line),
                        column: headers[index].into(),
                        text: text.chars().take(40).collect(),
                    })?;
            }
            let [x, y, z, thickness, reflectivity] = values;
            if reflectivity < cut {
                scan.dropped += 1;
            } else {
                scan.points.push(ThzPoint { position: Vector3::new(x, y, z), thickness, reflectivity });
            }
        }
        if scan.points.len() < 100 { Err(ThzError::TooFewPoints(scan.points.len())) } else { Ok(scan) }
    }
}

/// Index of a quantity's column and SI units per its unit.
fn column(
    headers: &csv::StringRecord,
    quantity: &'static str,
    units: &[(&str, f64)],
) -> Result<(usize, f64), ThzError> {
    let named = |(suffix, unit): &(&str, f64)| {
        let index = headers.iter().position(|h| h == format!("{quantity}{suffix}"))?;
        Some((index, *unit))
    };
    units.iter().find_map(named).ok_or_else(|| ThzError::Column {
        quantity,
        allowed: units.iter().map(|(suffix, _)| format!("{quantity}{suffix}")).collect::<Vec<_>>().join(", "),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faults_name_the_column_and_the_line() {
        let fault = |table: &str| ThzScan::read(table.as_bytes(), 0.12).unwrap_err().to_string();
        assert!(
            fault("x,y_mm,z_mm,thickness_um,reflectivity\n")
                .contains("no column x with its unit: one of x_mm, x_um, x_m")
        );
        let rows = "x_mm,y_mm,z_mm,thickness_um,reflectivity\n1,1,1,60,0.3\n1,1,1,n/a,0.3\n";
        assert!(
            fault(rows).contains("line 3 of the scan: \"n/a\" in column thickness_um"),
            "{}",
            fault(rows)
        );
        assert!(fault("x_m,y_m,z_m,thickness_m,reflectivity\n").contains("0 points"));
    }
}
