//! The state of one body between steps.
//!
//! Angular momentum L is kept in space axes, so that it is conserved exactly between contacts.

use crate::contact::Wrench;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// One body.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Body {
    /// Mass, kg.
    pub mass: f64,
    /// 1/kg.
    pub inverse_mass: f64,
    /// Inverse principal moments, 1/(kg m²).
    pub inverse_inertia: Vector3<f64>,
    /// Turns body axes to world axes.
    pub orientation: UnitQuaternion<f64>,
    /// Velocity at the present step (between kicks: half a step on), m/s.
    pub velocity: Vector3<f64>,
    /// Angular momentum about the centre of mass, world axes, likewise, kg m²/s.
    pub momentum: Vector3<f64>,
    /// Largest distance of a sphere's centre from the centre of mass, m.
    pub reach: f64,
    /// Largest distance of a sphere's centre from each principal axis, m.
    pub arms: Vector3<f64>,
    /// Of the farthest that any sphere's centre may move in a step, 1/m.
    pub inverse_travel: f64,
}

impl Body {
    /// A kick of some time, s.
    #[inline]
    pub(super) fn kick(&mut self, wrench: &Wrench, time: f64) {
        self.velocity += wrench.force * (time * self.inverse_mass);
        self.momentum += wrench.torque * time;
    }

    /// Angular velocity at `rotation`, world axes, rad/s.
    #[inline]
    pub(super) fn spin(&self, rotation: &Matrix3<f64>) -> Vector3<f64> {
        rotation * rotation.tr_mul(&self.momentum).component_mul(&self.inverse_inertia)
    }
}
