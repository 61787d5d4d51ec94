//! What can be read of a run.

use super::frame::BodyState;
use super::simulation::Simulation;
use super::stopwatch::Stopwatch;
use super::time_step::TimeStep;
use crate::contact::Tally;
use crate::scene::Scene;
use crate::shapes::{SurfaceMesh, TabletShape};

impl Simulation {
    /// Simulated time since the start, s.
    pub fn clock(&self) -> f64 {
        (self.step as f64 + self.part) * self.time_step.step
    }

    /// Steps taken since the start.
    pub fn steps(&self) -> u64 {
        self.step
    }

    /// The scene being run.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The shapes of the scene, in its order.
    pub fn shapes(&self) -> &[TabletShape] {
        &self.shapes
    }

    /// Shape index of each body.
    pub fn body_shapes(&self) -> &[usize] {
        &self.kinds
    }

    /// Mass of each body, kg.
    pub fn masses(&self) -> Vec<f64> {
        self.in_order(|body| self.bodies[body].mass)
    }

    /// The drum's mesh in its own axes.
    pub fn drum(&self) -> Option<&SurfaceMesh> {
        self.drum.as_ref()
    }

    /// What had to be put right in mesh files.
    pub fn repairs(&self) -> &[String] {
        &self.repairs
    }

    /// The time step and its figures.
    pub fn time_step(&self) -> &TimeStep {
        &self.time_step
    }

    /// Contacts of the last step.
    pub fn tally(&self) -> Tally {
        self.tally
    }

    /// Largest overlap so far over the smaller sphere's radius, dimensionless.
    pub fn deepest_overlap(&self) -> f64 {
        self.deepest
    }

    /// Share of bodies and steps so far in which a body was held stiffer than the step bears and its forces were lowered.
    pub fn stiff_share(&self) -> f64 {
        self.stiff / (self.step * self.bodies.len() as u64).max(1) as f64
    }

    /// Share of the steps so far that were taken in pieces, because a body was fast.
    pub fn divided_share(&self) -> f64 {
        self.divided as f64 / self.step.max(1) as f64
    }

    /// Frames so far that went wrong and were repeated in finer steps.
    pub fn repeated_frames(&self) -> u64 {
        self.repeated
    }

    /// Where the run time went.
    pub fn stopwatch(&self) -> &Stopwatch {
        &self.stopwatch
    }

    /// Angle the drum has turned about +z, rad.
    pub fn drum_angle(&self) -> f64 {
        self.scene.drum.as_ref().map_or(0.0, |d| d.speed * self.clock())
    }

    /// Mean torque of the drive over the last frame, N m.
    pub fn drum_torque(&self) -> f64 {
        if self.torque_time == 0.0 { 0.0 } else { self.torque_sum / self.torque_time }
    }

    /// Pose and motion of all bodies at the present step.
    pub fn states(&self) -> Vec<BodyState> {
        self.in_order(|k| {
            let (body, motion) = (&self.bodies[k], &self.motions[k]);
            BodyState {
                position: motion.position,
                orientation: body.orientation,
                velocity: body.velocity,
                spin: body.spin(&motion.rotation),
            }
        })
    }
}
