//! What observers are shown.

use nalgebra::{UnitQuaternion, Vector3};

/// Pose and motion of one body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyState {
    /// Centre of mass, m.
    pub position: Vector3<f64>,
    /// Turns body axes to world axes.
    pub orientation: UnitQuaternion<f64>,
    /// Velocity of the centre of mass, m/s.
    pub velocity: Vector3<f64>,
    /// Angular velocity, world axes, rad/s.
    pub spin: Vector3<f64>,
}

/// One instant of a run, read-only.
#[derive(Debug, Clone, Copy)]
pub struct Frame<'a> {
    /// Number of the frame, 0 for the first one coated.
    pub index: u64,
    /// Time since coating began (since the start, without settling), s.
    pub time: f64,
    /// All bodies, in the order of the simulation: batches first, then free bodies.
    pub bodies: &'a [BodyState],
    /// Angle the drum has turned about +z, rad.
    pub drum_angle: f64,
    /// Torque about +z that the drive puts on the drum, mean since the last frame, N m.
    pub drum_torque: f64,
}

/// Something that looks at every frame of a run, on another thread while the run goes on.
pub trait Observer: Send {
    /// Takes note of a frame.
    fn observe(&mut self, frame: &Frame<'_>);
}
