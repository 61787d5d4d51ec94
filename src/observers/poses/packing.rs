//! How a pose is written in bytes.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};
use std::f64::consts::SQRT_2;

/// How poses are stored.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Packing {
    /// Seven `f64`: 56 bytes.
    Exact,
    /// 9 bytes. Positions are those of a cubic lattice of 2⁴¹ cells over the box, 14 µm apart in a drum of
    /// 250 × 250 × 100 mm; what lies outside is moved to the box. Orientations are off by 2 mrad as a rule and 6 mrad at
    /// most: 16 and 50 µm at the rim of a tablet.
    Compact {
        /// Corner with the smallest coordinates, m.
        min: Vector3<f64>,
        /// Corner with the largest coordinates, m.
        max: Vector3<f64>,
    },
}

/// Cells of the lattice of positions and steps of each kept component of a quaternion: 2⁴¹ · 4 · 812³ < 2⁷².
const CELLS: f64 = 2.199_023_255_552e12;
const STEPS: u64 = 812;
const TURNS: u128 = 4 * (STEPS as u128).pow(3);

impl Packing {
    /// Bytes of a pose.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Exact => 56,
            Self::Compact { .. } => 9,
        }
    }

    /// Appends a pose.
    pub(super) fn write(&self, position: &Vector3<f64>, orientation: &UnitQuaternion<f64>, to: &mut Vec<u8>) {
        match self {
            Self::Exact => {
                for value in position.iter().chain(orientation.coords.iter()) {
                    to.extend(value.to_le_bytes());
                }
            }
            Self::Compact { min, max } => {
                let cells = cells(min, max);
                let place = (0..3).fold(0_u128, |place, k| {
                    let share = (position[k] - min[k]) / (max[k] - min[k]);
                    let cell = (share * cells[k] as f64).floor().clamp(0.0, (cells[k] - 1) as f64) as u128;
                    place * u128::from(cells[k]) + cell
                });
                let code = place * TURNS + u128::from(turn_code(orientation));
                to.extend(&code.to_le_bytes()[..9]);
            }
        }
    }

    /// The pose in `self.bytes()` bytes.
    pub(super) fn read(&self, from: &[u8]) -> (Vector3<f64>, UnitQuaternion<f64>) {
        match self {
            Self::Exact => {
                let (values, _) = from.as_chunks::<8>();
                let value = |k: usize| f64::from_le_bytes(values[k]);
                let coords = Quaternion::new(value(6), value(3), value(4), value(5));
                // Normalising would change the last bits of what is already a unit.
                (Vector3::new(value(0), value(1), value(2)), UnitQuaternion::new_unchecked(coords))
            }
            Self::Compact { min, max } => {
                let mut bytes = [0; 16];
                bytes[..9].copy_from_slice(&from[..9]);
                let code = u128::from_le_bytes(bytes);
                let cells = cells(min, max);
                let mut place = code / TURNS;
                let mut position = Vector3::zeros();
                for k in (0..3).rev() {
                    let cell = (place % u128::from(cells[k])) as f64;
                    place /= u128::from(cells[k]);
                    position[k] = min[k] + (cell + 0.5) / cells[k] as f64 * (max[k] - min[k]);
                }
                (position, turn((code % TURNS) as u64))
            }
        }
    }
}

/// Cells of the lattice along each side of the box: as cubic as whole numbers allow.
fn cells(min: &Vector3<f64>, max: &Vector3<f64>) -> [u64; 3] {
    let sides = max - min;
    let cell = (sides.product() / CELLS).cbrt();
    std::array::from_fn(|k| ((sides[k] / cell).floor() as u64).max(1))
}

/// Number of a rotation: which component of the quaternion is the largest, and the three others, each within ±1/√2.
fn turn_code(orientation: &UnitQuaternion<f64>) -> u64 {
    let q = orientation.coords;
    let largest = q.iamax();
    let sign = q[largest].signum();
    (0..4).filter(|&k| k != largest).fold(largest as u64, |code, k| {
        let share = (q[k] * sign * SQRT_2).midpoint(1.0);
        code * STEPS + (share * STEPS as f64).floor().clamp(0.0, (STEPS - 1) as f64) as u64
    })
}

/// The rotation in the middle of those that share a number.
fn turn(mut code: u64) -> UnitQuaternion<f64> {
    let mut others = [0.0; 3];
    for other in others.iter_mut().rev() {
        *other = (2.0 * ((code % STEPS) as f64 + 0.5) / STEPS as f64 - 1.0) / SQRT_2;
        code /= STEPS;
    }
    let largest = code as usize;
    let mut q = nalgebra::Vector4::zeros();
    q[largest] = (1.0 - others.iter().map(|x| x * x).sum::<f64>()).max(0.0).sqrt();
    for (k, other) in (0..4).filter(|&k| k != largest).zip(others) {
        q[k] = other;
    }
    UnitQuaternion::new_normalize(Quaternion::from(q))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observers::coater::tests::tumbled;

    #[test]
    fn an_exact_pose_keeps_its_bits() {
        for body in tumbled(50, [0.1; 3], 1) {
            let mut bytes = Vec::new();
            Packing::Exact.write(&body.position, &body.orientation, &mut bytes);
            assert_eq!(bytes.len(), Packing::Exact.bytes());
            assert_eq!(Packing::Exact.read(&bytes), (body.position, body.orientation));
        }
    }

    #[test]
    fn a_compact_pose_is_off_by_micrometres_and_milliradians() {
        let packing =
            Packing::Compact { min: Vector3::new(-0.125, -0.25, -0.05), max: Vector3::new(0.125, 0.0, 0.05) };
        let bodies = tumbled(5000, [0.125, 0.125, 0.05], 2);
        let (mut far, mut turned) = (0.0_f64, Vec::new());
        for body in &bodies {
            let mut bytes = Vec::new();
            packing.write(&body.position, &body.orientation, &mut bytes);
            assert_eq!(bytes.len(), 9);
            let (position, orientation) = packing.read(&bytes);
            far = far.max((position - body.position).amax());
            turned.push(orientation.angle_to(&body.orientation));
        }
        assert!(far < 7.2e-6 && far > 6e-6, "{far}");
        // Three components off by at most h = √2/1624 and the fourth by Σ q_i h / q_max <= 3 h; an angle is twice the
        // change of the quaternion: 2 √12 h = 6.0e-3 at most.
        let mean = turned.iter().sum::<f64>() / turned.len() as f64;
        assert!(turned.iter().all(|&angle| angle < 6.1e-3) && (mean - 2e-3).abs() < 0.5e-3, "{mean}");
        assert!(TURNS as f64 * CELLS < 2.0_f64.powi(72));
    }

    #[test]
    fn what_is_outside_the_box_is_moved_to_it() {
        let packing = Packing::Compact { min: Vector3::zeros(), max: Vector3::repeat(0.1) };
        let mut bytes = Vec::new();
        packing.write(&Vector3::new(-1.0, 0.05, 7.0), &UnitQuaternion::identity(), &mut bytes);
        let (position, orientation) = packing.read(&bytes);
        assert!((position - Vector3::new(0.0, 0.05, 0.1)).amax() < 1e-5);
        assert!(orientation.angle() < 6.1e-3);
    }
}
