//! Poses of another program, as a table: `time_s,id,x,y,z,qw,qx,qy,qz` in SI units, one row per body and time.

use super::{PoseError, StoredFrame};
use crate::stepping::BodyState;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde::Deserialize;
use std::path::Path;

#[derive(Debug, Clone, Copy, Deserialize)]
struct Row {
    time_s: f64,
    id: u64,
    x: f64,
    y: f64,
    z: f64,
    qw: f64,
    qx: f64,
    qy: f64,
    qz: f64,
}

/// The frames of a CSV file with the columns `time_s,id,x,y,z,qw,qx,qy,qz`, in any order, others ignored.
///
/// Rows of one time follow each other; times increase. Within a time, bodies may come in any order and are sorted by
/// their `id`; every time has the same. Quaternions turn body axes to world axes. The drum turns at `drum_speed`
/// (rad/s) from time 0 on.
///
/// # Errors
/// [`PoseError::Table`] and [`PoseError::Row`] name the line.
pub fn read_pose_table(path: &Path, drum_speed: f64) -> Result<Vec<StoredFrame>, PoseError> {
    let table = |source| PoseError::Table { path: path.into(), source };
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(path).map_err(table)?;
    let headers = reader.headers().map_err(table)?.clone();
    let mut frames = Vec::new();
    let mut ids: Vec<u64> = Vec::new();
    let mut rows: Vec<Row> = Vec::new();
    let mut record = csv::StringRecord::new();
    loop {
        let more = reader.read_record(&mut record).map_err(table)?;
        let line = record.position().map_or(0, csv::Position::line);
        let fault = |what| PoseError::Row { path: path.into(), line, what };
        let row = if more { Some(record.deserialize::<Row>(Some(&headers)).map_err(table)?) } else { None };
        if let Some(last) = rows.last()
            && row.is_none_or(|row| row.time_s != last.time_s)
        {
            if row.is_some_and(|row| row.time_s < last.time_s) {
                return Err(fault("times must increase"));
            }
            rows.sort_by_key(|row| row.id);
            let found: Vec<u64> = rows.iter().map(|row| row.id).collect();
            if found.windows(2).any(|pair| pair[0] == pair[1]) {
                return Err(fault("the time before has a body twice"));
            }
            if frames.is_empty() {
                ids = found;
            } else if ids != found {
                return Err(fault("the time before has not the bodies of the first"));
            }
            frames.push(frame(frames.len() as u64, &rows, drum_speed));
            rows.clear();
        }
        let Some(row) = row else { return Ok(frames) };
        let norm = Quaternion::new(row.qw, row.qx, row.qy, row.qz).norm();
        if norm.is_nan() || (norm - 1.0).abs() > 1e-3 {
            return Err(fault("the quaternion is not of length 1"));
        }
        if ![row.time_s, row.x, row.y, row.z].iter().all(|value| value.is_finite()) {
            return Err(fault("expected finite numbers"));
        }
        rows.push(row);
    }
}

fn frame(index: u64, rows: &[Row], drum_speed: f64) -> StoredFrame {
    let time = rows[0].time_s;
    let body = |row: &Row| BodyState {
        position: Vector3::new(row.x, row.y, row.z),
        orientation: unit(Quaternion::new(row.qw, row.qx, row.qy, row.qz)),
        velocity: Vector3::zeros(),
        spin: Vector3::zeros(),
    };
    StoredFrame { index, time, drum_angle: drum_speed * time, bodies: rows.iter().map(body).collect() }
}

/// A unit quaternion that keeps the bits of one that is already as good a unit as numbers allow.
fn unit(q: Quaternion<f64>) -> UnitQuaternion<f64> {
    if (q.norm_squared() - 1.0).abs() < 1e-14 {
        UnitQuaternion::new_unchecked(q)
    } else {
        UnitQuaternion::new_normalize(q)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "id,time_s,x,y,z,qw,qx,qy,qz,colour\n";

    fn read(content: &str) -> Result<Vec<StoredFrame>, PoseError> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), content).unwrap();
        read_pose_table(file.path(), 2.0)
    }

    #[test]
    fn rows_become_frames_sorted_by_body() {
        let table = format!(
            "{HEADER}7,0,.3,0,0,1,0,0,0,a\n2,0,.1,0,0,1,0,0,0,b\n2,.5,.2,0,0,.7,.7,.1,.1,c\n7,.5,.4,0,0,1,0,0,0,d\n"
        );
        let frames = read(&table).unwrap();
        let x = |frame: usize| frames[frame].bodies.iter().map(|body| body.position.x).collect::<Vec<_>>();
        assert_eq!((x(0), x(1)), (vec![0.1, 0.3], vec![0.2, 0.4]));
        assert_eq!((frames[1].index, frames[1].time, frames[1].drum_angle), (1, 0.5, 1.0));
        assert!((frames[1].bodies[0].orientation.norm() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn faults_name_their_line() {
        let message = |rows: &str| {
            let text = read(&format!("{HEADER}{rows}")).unwrap_err().to_string();
            text.split_once(':').unwrap().1.to_owned()
        };
        assert_eq!(message("1,0,0,0,0,1,1,0,0,a\n"), "2: the quaternion is not of length 1");
        assert_eq!(message("1,1,0,0,0,1,0,0,0,a\n1,0,0,0,0,1,0,0,0,a\n"), "3: times must increase");
        assert_eq!(
            message("1,0,0,0,0,1,0,0,0,a\n1,0,0,0,0,1,0,0,0,a\n"),
            "4: the time before has a body twice"
        );
        assert!(
            message("1,0,0,0,0,1,0,0,0,a\n2,1,0,0,0,1,0,0,0,a\n").ends_with("not the bodies of the first")
        );
        assert_eq!(message("1,0,nan,0,0,1,0,0,0,a\n"), "2: expected finite numbers");
        assert!(message("1,0,x,0,0,1,0,0,0,a\n").contains("line: 2"));
        assert!(read("a,b\n1,2\n").unwrap_err().to_string().contains("missing field"));
    }
}
