//! Poses of another program, as a table: `time_s,id,x,y,z,qw,qx,qy,qz` in SI units, one row per body and time.

use super::{PoseError, StoredFrame};
use crate::scene::{PoseRow, PoseTable};
use crate::stepping::BodyState;
use nalgebra::Vector3;
use std::path::Path;

const COLUMNS: [&str; 9] = ["time_s", "id", "x", "y", "z", "qw", "qx", "qy", "qz"];

/// The frames of a CSV file with the columns `time_s,id,x,y,z,qw,qx,qy,qz`, in any order, others ignored.
///
/// Rows of one time follow each other; times increase. Within a time, bodies may come in any order and are sorted by
/// their `id`; every time has the same. Quaternions turn body axes to world axes. The drum turns at `drum_speed`
/// (rad/s) from time 0 on.
///
/// # Errors
/// [`PoseError::Table`] names the line.
pub fn read_pose_table(path: &Path, drum_speed: f64) -> Result<Vec<StoredFrame>, PoseError> {
    let mut table = PoseTable::open(path, &COLUMNS)?;
    let mut frames: Vec<StoredFrame> = Vec::new();
    let mut ids: Vec<u64> = Vec::new();
    let (mut time, mut rows): (f64, Vec<(u64, PoseRow)>) = (f64::NEG_INFINITY, Vec::new());
    loop {
        let row = table.next_row()?;
        let stamped = row.map(|row| table.stamp().map(|stamp| (stamp, row))).transpose()?;
        if stamped.is_some_and(|(stamp, _)| !stamp.time_s.is_finite() || stamp.time_s < time) {
            return Err(table.fault("times must increase").into());
        }
        if !rows.is_empty() && stamped.is_none_or(|(stamp, _)| stamp.time_s != time) {
            rows.sort_by_key(|(id, _)| *id);
            let found: Vec<u64> = rows.iter().map(|(id, _)| *id).collect();
            if found.windows(2).any(|pair| pair[0] == pair[1]) {
                return Err(table.fault("the time before has a body twice").into());
            }
            if frames.is_empty() {
                ids = found;
            } else if ids != found {
                return Err(table.fault("the time before has not the bodies of the first").into());
            }
            let bodies = rows.drain(..).map(|(_, row)| at_rest(&row)).collect();
            frames.push(StoredFrame {
                index: frames.len() as u64,
                time,
                drum_angle: drum_speed * time,
                bodies,
            });
        }
        let Some((stamp, row)) = stamped else { return Ok(frames) };
        time = stamp.time_s;
        rows.push((stamp.id, row));
    }
}

fn at_rest(row: &PoseRow) -> BodyState {
    BodyState {
        position: row.position(),
        orientation: row.orientation(),
        velocity: Vector3::zeros(),
        spin: Vector3::zeros(),
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
        assert_eq!(message("1,0,nan,0,0,1,0,0,0,a\n"), "2: a position beyond 100 m, or no number");
        assert!(message("1,0,x,0,0,1,0,0,0,a\n").starts_with("2: "));
        assert!(read("a,b\n1,2\n").unwrap_err().to_string().contains("the header has no column `time_s`"));
    }
}
