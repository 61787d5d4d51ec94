//! Tables of poses: what bodies start from, what is sprayed again, and what a run leaves.

use super::short_lines::ShortLines;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::path::{Path, PathBuf};

/// Farthest position, m; beyond it single precision in the near-pair search is too coarse.
pub(super) const FARTHEST: f64 = 100.0;
/// Highest speed, m/s, and highest spin, rad/s, that anything starts with.
pub(super) const FASTEST: f64 = 1e3;
pub(super) const FASTEST_SPIN: f64 = 1e5;

/// Columns of a row that tell whose pose it is and when.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PoseStamp {
    /// Time, s.
    pub time_s: f64,
    /// Number of the body.
    pub id: u64,
}

/// The other columns: position of the centre of mass, m; quaternion that turns body axes to world axes; velocity, m/s;
/// angular velocity, world axes, rad/s.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default)]
#[allow(missing_docs, reason = "the struct's own text says what they are")]
pub struct PoseRow {
    pub x: f64,
    pub y: f64,
    pub z: f64,
    pub qw: f64,
    pub qx: f64,
    pub qy: f64,
    pub qz: f64,
    pub vx: f64,
    pub vy: f64,
    pub vz: f64,
    pub wx: f64,
    pub wy: f64,
    pub wz: f64,
}

impl Default for PoseRow {
    /// At rest at the origin, not turned.
    fn default() -> Self {
        let [x, y, z, qx, qy, qz, vx, vy, vz, wx, wy, wz] = [0.0; 12];
        Self { x, y, z, qw: 1.0, qx, qy, qz, vx, vy, vz, wx, wy, wz }
    }
}

impl PoseRow {
    /// Position, m.
    pub fn position(&self) -> Vector3<f64> {
        Vector3::new(self.x, self.y, self.z)
    }

    /// Orientation. A quaternion that is as good a unit as numbers allow keeps its bits.
    pub fn orientation(&self) -> UnitQuaternion<f64> {
        let q = self.quaternion();
        if (q.norm_squared() - 1.0).abs() < 1e-14 {
            UnitQuaternion::new_unchecked(q)
        } else {
            UnitQuaternion::new_normalize(q)
        }
    }

    /// Velocity, m/s.
    pub fn velocity(&self) -> Vector3<f64> {
        Vector3::new(self.vx, self.vy, self.vz)
    }

    /// Angular velocity, rad/s.
    pub fn spin(&self) -> Vector3<f64> {
        Vector3::new(self.wx, self.wy, self.wz)
    }

    fn quaternion(&self) -> Quaternion<f64> {
        Quaternion::new(self.qw, self.qx, self.qy, self.qz)
    }

    fn fault(&self) -> Option<String> {
        if !(0.999..1.001).contains(&self.quaternion().norm()) {
            return Some("the quaternion is not of length 1".to_owned());
        }
        let parts = [
            (self.position(), FARTHEST, "a position beyond", "m"),
            (self.velocity(), FASTEST, "a velocity beyond", "m/s"),
            (self.spin(), FASTEST_SPIN, "a spin beyond", "rad/s"),
        ];
        let beyond = parts.into_iter().find(|(part, most, ..)| !part.iter().all(|x| x.abs() <= *most));
        beyond.map(|(_, most, what, unit)| format!("{what} {most} {unit}, or no number"))
    }
}

/// A table that is not one of poses.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}:{line}: {what}", path.display())]
pub struct PoseTableFault {
    /// The file.
    pub path: PathBuf,
    /// Line, from 1.
    pub line: u64,
    /// What is wrong.
    pub what: String,
}

/// A CSV table that is being read. Columns may stand in any order; those that are not known are passed over.
#[derive(Debug)]
pub struct PoseTable {
    path: PathBuf,
    reader: csv::Reader<ShortLines<File>>,
    headers: csv::StringRecord,
    record: csv::StringRecord,
}

impl PoseTable {
    /// Opens a table that has at least the columns `needed`.
    ///
    /// # Errors
    /// The file cannot be read or lacks a column.
    pub fn open(path: &Path, needed: &[&str]) -> Result<Self, PoseTableFault> {
        let fault = |what: String| PoseTableFault { path: path.to_owned(), line: 1, what };
        let file = ShortLines::open(path).map_err(|error| fault(error.to_string()))?;
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(file);
        let headers = reader.headers().map_err(|error| fault(error.to_string()))?.clone();
        match needed.iter().find(|name| !headers.iter().any(|header| header == **name)) {
            Some(lacking) => Err(fault(format!("the header has no column `{lacking}`"))),
            None => Ok(Self { path: path.to_owned(), reader, headers, record: csv::StringRecord::new() }),
        }
    }

    /// The next row; `None` after the last.
    ///
    /// # Errors
    /// The row cannot be read, its quaternion is not of length 1, or it has values that no body has.
    pub fn next_row(&mut self) -> Result<Option<PoseRow>, PoseTableFault> {
        let more = self.reader.read_record(&mut self.record).map_err(|error| self.unreadable(&error))?;
        if !more {
            return Ok(None);
        }
        let row: PoseRow = self.columns()?;
        row.fault().map_or(Ok(Some(row)), |what| Err(self.fault(what)))
    }

    /// Time and body of the last row.
    ///
    /// # Errors
    /// They cannot be read.
    pub fn stamp(&self) -> Result<PoseStamp, PoseTableFault> {
        self.columns()
    }

    /// A fault of the last row, or of the end after it.
    pub fn fault(&self, what: impl Into<String>) -> PoseTableFault {
        let line = self.record.position().map_or(1, csv::Position::line);
        PoseTableFault { path: self.path.clone(), line, what: what.into() }
    }

    fn columns<'a, T: Deserialize<'a>>(&'a self) -> Result<T, PoseTableFault> {
        self.record.deserialize(Some(&self.headers)).map_err(|error| self.unreadable(&error))
    }

    fn unreadable(&self, error: &csv::Error) -> PoseTableFault {
        let line = error.position().or(self.record.position()).map_or(1, csv::Position::line);
        PoseTableFault { path: self.path.clone(), line, what: error.to_string() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<Vec<PoseRow>, String> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        let rows = || {
            let mut table = PoseTable::open(file.path(), &["x", "y", "z"])?;
            let mut rows = Vec::new();
            while let Some(row) = table.next_row()? {
                rows.push(row);
            }
            Ok(rows)
        };
        rows().map_err(|fault: PoseTableFault| format!("{}: {}", fault.line, fault.what))
    }

    #[test]
    fn rows_become_poses_and_faults_name_their_line() {
        let rows = read_text("id,x,y,z,vy\na3, 1,2,3, -4\n").unwrap();
        assert_eq!(rows, [PoseRow { x: 1.0, y: 2.0, z: 3.0, vy: -4.0, ..PoseRow::default() }]);
        let fault = |text: &str| read_text(text).unwrap_err();
        assert_eq!(fault("x,y\n1,2\n"), "1: the header has no column `z`");
        assert_eq!(fault("x,y,z,qx\n0,0,0,0\n0,0,0,1\n"), "3: the quaternion is not of length 1");
        assert_eq!(fault("x,y,z\n0,101,0\n"), "2: a position beyond 100 m, or no number");
        assert_eq!(fault("x,y,z,vx\n0,0,0,nan\n"), "2: a velocity beyond 1000 m/s, or no number");
        assert!(fault("x,y,z\n0,0,0\n0,0,a\n").starts_with("3: "));
    }
}
