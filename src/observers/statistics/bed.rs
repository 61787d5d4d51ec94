//! How the bed moves.

use super::{Figure, Surface, SurfaceSample};
use crate::observers::Observer;
use crate::stepping::{BodyState, Frame};
use nalgebra::Vector3;

/// Mass and inertia of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyInertia {
    /// Mass, kg.
    pub mass: f64,
    /// Principal moments in body axes, kg m².
    pub moments: Vector3<f64>,
}

impl BodyInertia {
    fn energies(&self, body: &BodyState) -> (f64, f64) {
        let spin = body.orientation.inverse() * body.spin;
        let rotation = 0.5 * self.moments.dot(&spin.component_mul(&spin));
        (0.5 * self.mass * body.velocity.norm_squared(), rotation)
    }
}

/// Time averages of the bed with standard errors. Angles in rad; see [`Surface`] for the surface figures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BedFigures {
    /// Mean speed of the centres of mass, m/s.
    pub mean_speed: Figure,
    /// Translational kinetic energy of the bed, J.
    pub kinetic_energy: Figure,
    /// Rotational kinetic energy of the bed, J.
    pub rotational_energy: Figure,
    /// Centre of mass of the bed, m.
    pub center: [Figure; 3],
    /// Angle between the vertical and the line from the drum's axis to the centre of mass, rad.
    pub center_angle: Figure,
    /// Dynamic angle of repose, rad; `None` when no surface could be fitted.
    pub repose_angle: Option<Figure>,
    /// Height of the surface above the drum's axis, m.
    pub surface_height: Option<Figure>,
    /// Speed down the slope in the surface, m/s.
    pub surface_speed: Option<Figure>,
    /// Mean |cosine| between tablet axes and surface normal in the surface, dimensionless.
    pub surface_axis_cosine: Option<Figure>,
    /// Torque that the drive puts on the drum about +z, N m.
    pub drum_torque: Figure,
    /// Frames seen.
    pub frames: u64,
    /// Blocks averaged over.
    pub blocks: usize,
}

/// The figures of one block.
#[derive(Debug, Clone)]
struct Block {
    speed: f64,
    kinetic: f64,
    rotational: f64,
    center: Vector3<f64>,
    torque: f64,
    surface: Option<Surface>,
}

/// Watches the motion of a bed in a drum about z.
#[derive(Debug, Clone)]
pub struct BedStatistics {
    bodies: Vec<BodyInertia>,
    drum_radius: f64,
    block_length: f64,
    block_start: Option<f64>,
    /// Sums over the frames of the running block.
    sums: Block,
    frames_in_block: u64,
    samples: Vec<SurfaceSample>,
    blocks: Vec<Block>,
    frames: u64,
}

impl BedStatistics {
    /// Statistics of these bodies (the order of the frames) in a drum of `drum_radius` (m), in blocks of `block_length` (s),
    /// which should be longer than what happens in the bed lasts; 1 s is about a surface passage.
    pub fn new(bodies: Vec<BodyInertia>, drum_radius: f64, block_length: f64) -> Self {
        Self {
            bodies,
            drum_radius,
            block_length,
            block_start: None,
            sums: Block::empty(),
            frames_in_block: 0,
            samples: Vec::new(),
            blocks: Vec::new(),
            frames: 0,
        }
    }

    /// The averages over all whole blocks, or over the first one while it is not complete; `None` before the first frame.
    pub fn figures(&self) -> Option<BedFigures> {
        let running;
        let blocks = if self.blocks.is_empty() {
            running = [self.running_block()?];
            &running[..]
        } else {
            &self.blocks
        };
        let figure =
            |of: &dyn Fn(&Block) -> f64| Figure::of_blocks(&blocks.iter().map(of).collect::<Vec<_>>());
        let surface = |of: &dyn Fn(&Surface) -> f64| {
            Figure::of_blocks(&blocks.iter().filter_map(|b| b.surface.as_ref()).map(of).collect::<Vec<_>>())
        };
        Some(BedFigures {
            mean_speed: figure(&|b| b.speed)?,
            kinetic_energy: figure(&|b| b.kinetic)?,
            rotational_energy: figure(&|b| b.rotational)?,
            center: [figure(&|b| b.center.x)?, figure(&|b| b.center.y)?, figure(&|b| b.center.z)?],
            center_angle: figure(&|b| b.center.x.atan2(-b.center.y))?,
            repose_angle: surface(&|s| s.angle),
            surface_height: surface(&|s| s.height),
            surface_speed: surface(&|s| s.speed),
            surface_axis_cosine: surface(&|s| s.axis_cosine),
            drum_torque: figure(&|b| b.torque)?,
            frames: self.frames,
            blocks: blocks.len(),
        })
    }

    fn running_block(&self) -> Option<Block> {
        let per_frame = 1.0 / self.frames_in_block as f64;
        (self.frames_in_block > 0).then(|| Block {
            speed: self.sums.speed * per_frame,
            kinetic: self.sums.kinetic * per_frame,
            rotational: self.sums.rotational * per_frame,
            center: self.sums.center * per_frame,
            torque: self.sums.torque * per_frame,
            surface: Surface::fit(&self.samples, self.drum_radius),
        })
    }

    fn close_block(&mut self, time: f64) {
        self.blocks.extend(self.running_block());
        self.block_start = Some(time);
        self.sums = Block::empty();
        self.frames_in_block = 0;
        self.samples.clear();
    }
}

impl Block {
    fn empty() -> Self {
        Self {
            speed: 0.0,
            kinetic: 0.0,
            rotational: 0.0,
            center: Vector3::zeros(),
            torque: 0.0,
            surface: None,
        }
    }
}

impl Observer for BedStatistics {
    fn observe(&mut self, frame: &Frame<'_>) {
        // A thousandth of a block keeps round-off in the time from adding a frame to a block.
        match self.block_start {
            Some(start) if frame.time < start + 0.999 * self.block_length => {}
            _ => self.close_block(frame.time),
        }
        let mass: f64 = self.bodies.iter().map(|b| b.mass).sum();
        let per_body = 1.0 / frame.bodies.len() as f64;
        for (body, inertia) in frame.bodies.iter().zip(&self.bodies) {
            let (kinetic, rotational) = inertia.energies(body);
            self.sums.speed += body.velocity.norm() * per_body;
            self.sums.kinetic += kinetic;
            self.sums.rotational += rotational;
            self.sums.center += body.position * (inertia.mass / mass);
            let axis = body.orientation * Vector3::z();
            self.samples.push(SurfaceSample {
                position: [body.position.x, body.position.y],
                velocity: [body.velocity.x, body.velocity.y],
                axis: [axis.x, axis.y],
            });
        }
        self.sums.torque += frame.drum_torque;
        self.frames_in_block += 1;
        self.frames += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::UnitQuaternion;

    fn body(position: Vector3<f64>, velocity: Vector3<f64>, spin: Vector3<f64>) -> BodyState {
        let orientation = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::FRAC_PI_2);
        BodyState { position, orientation, velocity, spin }
    }

    #[test]
    fn energies_centre_and_errors_of_two_bodies_over_blocks() {
        let inertia = BodyInertia { mass: 2.0, moments: Vector3::new(1.0, 2.0, 3.0) };
        let mut statistics = BedStatistics::new(vec![inertia; 2], 0.1, 1.0);
        for index in 0..40_u64 {
            let speed = if index < 10 { 1.0 } else { 3.0 }; // block means 1, 3, 3; the last block is not complete
            let bodies = [
                body(Vector3::new(0.3, -0.3, 0.0), Vector3::x() * speed, Vector3::zeros()),
                // Body axes turned by 90 degrees about x: world y is body z, moment 3... and world spin 1 about y.
                body(Vector3::new(0.1, -0.1, 0.2), Vector3::zeros(), Vector3::y()),
            ];
            let time = index as f64 * 0.1;
            let frame = Frame { index, time, bodies: &bodies, drum_angle: 0.0, drum_torque: 0.5 };
            statistics.observe(&frame);
        }
        let figures = statistics.figures().unwrap();
        assert_eq!((figures.frames, figures.blocks), (40, 3));
        let (means, error) = ([0.5, 1.5, 1.5], 1.0 / 3.0); // half the bodies move; sd of the means 0.577, three blocks
        assert!((figures.mean_speed.mean - means.iter().sum::<f64>() / 3.0).abs() < 1e-12);
        assert!((figures.mean_speed.standard_error.unwrap() - error).abs() < 1e-12);
        assert!((figures.kinetic_energy.mean - (1.0 + 9.0 + 9.0) / 3.0).abs() < 1e-12);
        assert!((figures.rotational_energy.mean - 1.5).abs() < 1e-12);
        assert!((figures.center_angle.mean.to_degrees() - 45.0).abs() < 1e-9);
        assert!((figures.center[2].mean - 0.1).abs() < 1e-12);
        assert!((figures.drum_torque.mean - 0.5).abs() < 1e-12);
        assert_eq!(figures.repose_angle, None);
    }
}
