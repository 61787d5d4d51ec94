//! Tables of poses and velocities that bodies start with.

use super::super::fault::FaultKind;
use super::super::model::FreeBody;
use super::moving::{FARTHEST, FASTEST, FASTEST_SPIN};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde::Deserialize;
use std::path::Path;

/// A row: position of the centre of mass, m; quaternion that turns body axes to world axes; velocity, m/s; angular
/// velocity, world axes, rad/s.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(default)]
pub(super) struct Pose {
    x: f64,
    y: f64,
    z: f64,
    qw: f64,
    qx: f64,
    qy: f64,
    qz: f64,
    vx: f64,
    vy: f64,
    vz: f64,
    wx: f64,
    wy: f64,
    wz: f64,
}

impl Default for Pose {
    /// At rest at the origin, not turned.
    fn default() -> Self {
        let [x, y, z, qx, qy, qz, vx, vy, vz, wx, wy, wz] = [0.0; 12];
        Self { x, y, z, qw: 1.0, qx, qy, qz, vx, vy, vz, wx, wy, wz }
    }
}

impl Pose {
    fn quaternion(&self) -> Quaternion<f64> {
        Quaternion::new(self.qw, self.qx, self.qy, self.qz)
    }

    fn fault(&self) -> Option<String> {
        let parts = [
            ([self.x, self.y, self.z], FARTHEST, "a position beyond", "m"),
            ([self.vx, self.vy, self.vz], FASTEST, "a velocity beyond", "m/s"),
            ([self.wx, self.wy, self.wz], FASTEST_SPIN, "a spin beyond", "rad/s"),
        ];
        let norm = self.quaternion().norm();
        if !(0.999..1.001).contains(&norm) {
            return Some("the quaternion is not of length 1".to_owned());
        }
        let beyond = parts.into_iter().find(|(part, most, ..)| !part.iter().all(|x| x.abs() <= *most));
        beyond.map(|(_, most, what, unit)| format!("{what} {most} {unit}, or no number"))
    }

    /// A body like `one` in this pose. A quaternion that is as good a unit as numbers allow keeps its bits.
    pub(super) fn placed(&self, one: &FreeBody) -> FreeBody {
        let q = self.quaternion();
        let unit = (q.norm_squared() - 1.0).abs() < 1e-14;
        FreeBody {
            position: Vector3::new(self.x, self.y, self.z),
            orientation: if unit {
                UnitQuaternion::new_unchecked(q)
            } else {
                UnitQuaternion::new_normalize(q)
            },
            velocity: Vector3::new(self.vx, self.vy, self.vz),
            spin: Vector3::new(self.wx, self.wy, self.wz),
            ..*one
        }
    }
}

/// Reads a CSV table whose header names the columns `x,y,z`, and as far as wanted `qw,qx,qy,qz`, `vx,vy,vz` and
/// `wx,wy,wz`, in any order; other columns are ignored.
pub(super) fn read(path: &Path) -> Result<Vec<Pose>, FaultKind> {
    let fault = |line, what| FaultKind::Poses { path: path.into(), line, what };
    let unreadable =
        |error: csv::Error| fault(error.position().map_or(0, csv::Position::line), error.to_string());
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_path(path).map_err(unreadable)?;
    let headers = reader.headers().map_err(unreadable)?.clone();
    if let Some(lacking) = ["x", "y", "z"].iter().find(|name| !headers.iter().any(|h| h == **name)) {
        return Err(fault(1, format!("the header has no column `{lacking}`")));
    }
    let mut poses = Vec::new();
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record).map_err(unreadable)? {
        let pose: Pose = record.deserialize(Some(&headers)).map_err(unreadable)?;
        if let Some(what) = pose.fault() {
            return Err(fault(record.position().map_or(0, csv::Position::line), what));
        }
        poses.push(pose);
    }
    if poses.is_empty() { Err(fault(1, "no row".to_owned())) } else { Ok(poses) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<Vec<Pose>, String> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        read(file.path()).map_err(|fault| fault.to_string().split_once(':').unwrap().1.to_owned())
    }

    #[test]
    fn rows_become_poses_and_faults_name_their_line() {
        let poses = read_text("id,x,y,z,vy\n3, 1,2,3, -4\n").unwrap();
        assert_eq!(poses, [Pose { x: 1.0, y: 2.0, z: 3.0, vy: -4.0, ..Pose::default() }]);
        let fault = |text: &str| read_text(text).unwrap_err();
        assert_eq!(fault("x,y\n1,2\n"), "1: the header has no column `z`");
        assert_eq!(fault("x,y,z\n"), "1: no row");
        assert_eq!(fault("x,y,z,qx\n0,0,0,0\n0,0,0,1\n"), "3: the quaternion is not of length 1");
        assert_eq!(fault("x,y,z\n0,101,0\n"), "2: a position beyond 100 m, or no number");
        assert_eq!(fault("x,y,z,vx\n0,0,0,nan\n"), "2: a velocity beyond 1000 m/s, or no number");
        assert!(fault("x,y,z\n0,0,0\n0,0,a\n").starts_with("3: "));
    }
}
