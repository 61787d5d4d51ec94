//! The state of one body between steps, and its free motion.
//!
//! Translation: velocity Verlet. Rotation: angular momentum L is kept in space axes, so that it is conserved exactly
//! between contacts; the orientation follows the torque-free top of momentum L over the step to third order (Magnus
//! expansion of the body-frame angular velocity, derived at [`Body::turn`]).

use crate::world::Motion;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// One body.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Body {
    /// Mass, kg.
    pub mass: f64,
    /// Principal moments, kg m².
    pub inertia: Vector3<f64>,
    /// Turns body axes to world axes.
    pub orientation: UnitQuaternion<f64>,
    /// Velocity at the present step (between kicks: half a step on), m/s.
    pub velocity: Vector3<f64>,
    /// Angular momentum about the centre of mass, world axes, likewise, kg m²/s.
    pub momentum: Vector3<f64>,
    /// Force at the last force evaluation, gravity included, N.
    pub force: Vector3<f64>,
    /// Torque at the last force evaluation, N m.
    pub torque: Vector3<f64>,
}

impl Body {
    /// Second half of a step's kick (also the first half of the next one).
    #[inline]
    pub(super) fn kick(&mut self, half_step: f64) {
        self.velocity += self.force * (half_step / self.mass);
        self.momentum += self.torque * half_step;
    }

    /// Moves the body by `dt` with its half-step velocity and predicts its velocities at the end of the step for the
    /// force evaluation there. Returns how far it moved and turned (rotation vector, world axes).
    #[inline]
    pub(super) fn drift(&mut self, motion: &mut Motion, dt: f64) -> (Vector3<f64>, Vector3<f64>) {
        let moved = self.velocity * dt;
        motion.position += moved;
        let turned = self.turn(motion, dt);
        motion.velocity = self.velocity + self.force * (0.5 * dt / self.mass);
        motion.spin = self.spin_of(&motion.rotation, &(self.momentum + self.torque * (0.5 * dt)));
        (moved, turned)
    }

    /// Angular velocity, world axes, rad/s, of momentum `momentum` at `rotation`.
    #[inline]
    pub(super) fn spin_of(&self, rotation: &nalgebra::Matrix3<f64>, momentum: &Vector3<f64>) -> Vector3<f64> {
        rotation * rotation.tr_mul(momentum).component_div(&self.inertia)
    }

    /// Torque-free turn over `dt`.
    ///
    /// In body axes M = RᵀL obeys Ṁ = M × ω with ω = I⁻¹M, and q̇ = ½ q ω. With ω(t) = ω + ω̇ t + ½ ω̈ t² the
    /// Magnus exponent of q (right multiplication) is Ω = ω t + ω̇ t²/2 + ω̈ t³/6 + (ω × ω̇) t³/12 + O(t⁴).
    #[inline]
    fn turn(&mut self, motion: &mut Motion, dt: f64) -> Vector3<f64> {
        let m = motion.rotation.tr_mul(&self.momentum);
        let w = m.component_div(&self.inertia);
        let m1 = m.cross(&w);
        let w1 = m1.component_div(&self.inertia);
        let w2 = (m1.cross(&w) + m.cross(&w1)).component_div(&self.inertia);
        let turn = (w + (w1 + (w2 / 3.0 + w.cross(&w1) / 6.0) * dt) * (0.5 * dt)) * dt;
        let turned = motion.rotation * turn;
        let q = self.orientation.quaternion() * half_turn(&turn);
        // One Newton step towards unit length: the error per step is of the order of rounding.
        let q = q * (1.5 - 0.5 * q.norm_squared());
        self.orientation = UnitQuaternion::new_unchecked(q);
        motion.rotation = self.orientation.to_rotation_matrix().into_inner();
        turned
    }
}

/// The quaternion of a rotation vector, rad. Small turns by series, so that no library sine enters: truncation below
/// h¹⁰/10! < 3e-17 for half angles h < 0.1.
#[inline]
fn half_turn(turn: &Vector3<f64>) -> Quaternion<f64> {
    let h2 = 0.25 * turn.norm_squared();
    let (cos, sinc) = if h2 < 0.01 {
        let cos = 1.0 - h2 / 2.0 * (1.0 - h2 / 12.0 * (1.0 - h2 / 30.0 * (1.0 - h2 / 56.0)));
        let sinc = 1.0 - h2 / 6.0 * (1.0 - h2 / 20.0 * (1.0 - h2 / 42.0 * (1.0 - h2 / 72.0)));
        (cos, sinc)
    } else {
        let h = h2.sqrt();
        (h.cos(), h.sin() / h)
    };
    Quaternion::from_parts(cos, turn * (0.5 * sinc))
}
