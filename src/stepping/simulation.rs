//! The loop.

use super::body::Body;
use super::drift::{Drift, Stride};
use super::energy::EnergyAudit;
use super::error::SimulationError;
use super::frame::BodyState;
use super::guard::MOST_TRAVEL;
use super::impulse;
use super::stopwatch::{Phase, Stopwatch};
use super::time_step::TimeStep;
use crate::contact::{ContactField, Tally, Wrench};
use crate::scene::{Boundary, BoundarySurface, ContactMode, Scene};
use crate::shapes::{ImportedSurface, SurfaceMesh, TabletShape, drum_surface, read_surface};
use crate::world::{ImpulseWorld, Motion, World};
use nalgebra::{Rotation3, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use std::time::{Duration, Instant};

/// Bodies that one thread moves at a time.
const CHUNK: usize = 128;
/// A step is divided where the fastest body would go farther than this share of what it may: less than all of it, as it may be pushed
/// on the way.
const HASTY: f64 = 0.75;
/// Pieces of a step at most.
const MOST_PIECES: f64 = 8.0;

/// A run: bodies, surfaces, contacts and the clock.
#[derive(Clone)]
pub struct Simulation {
    pub(super) scene: Scene,
    pub(super) shapes: Vec<TabletShape>,
    pub(super) drum: Option<SurfaceMesh>,
    /// What had to be put right in mesh files.
    pub(super) repairs: Vec<String>,
    pub(super) time_step: TimeStep,
    pub(super) step: u64,
    /// What is done of the step after these, if it is taken in pieces.
    pub(super) part: f64,
    pub(super) world: World,
    pub(super) field: ContactField,
    /// What moves bodies and solves contacts in place of `world` and `field`, if the scene says so.
    pub(super) impulses: Option<ImpulseWorld>,
    pub(super) bodies: Vec<Body>,
    /// Number in the scene of each body of the other sequences: see `numbering`.
    pub(super) numbers: Vec<u32>,
    /// Shape of each body, in the order of the scene.
    pub(super) kinds: Vec<usize>,
    pub(super) motions: Vec<Motion>,
    surfaces: Vec<Motion>,
    /// How many of the surfaces are meshes; they come first.
    meshes: usize,
    /// Velocity and spin of each surface.
    drives: Vec<(Vector3<f64>, Vector3<f64>)>,
    pub(super) wrenches: Vec<Wrench>,
    /// How long the kick that ends the last step takes, if it is still to be made, s.
    pub(super) owed: f64,
    /// Distance that each body's farthest sphere centre can have moved against the carrier so far, m.
    pub(super) odometers: Vec<f64>,
    /// How far the fastest body went in a whole step by its last motion, of what it may.
    pub(super) haste: f64,
    /// Steps that were taken in pieces.
    pub(super) divided: u64,
    /// Frames that were repeated in finer steps.
    pub(super) repeated: u64,
    pub(super) rng: ChaCha8Rng,
    pub(super) torque_sum: f64,
    pub(super) torque_time: f64,
    pub(super) deepest: f64,
    /// Bodies that were stiffer than the step bears, summed over all steps.
    pub(super) stiff: f64,
    pub(super) audit: Option<EnergyAudit>,
    pub(super) tally: Tally,
    /// Time, s, and bodies of the last frame that passed all guards.
    pub(super) good: (f64, Vec<BodyState>),
    pub(super) stopwatch: Stopwatch,
}

impl Simulation {
    /// Builds everything a scene needs; free bodies are placed, batches wait for [`Simulation::fill`].
    ///
    /// # Errors
    /// A shape that cannot be built, or bodies that begin deep in each other or in a wall.
    pub fn new(scene: &Scene) -> Result<Self, SimulationError> {
        let shapes = scene
            .shapes
            .iter()
            .map(|shape| TabletShape::build(shape, scene.spray.is_some()))
            .collect::<Result<Vec<_>, _>>()?;
        let drum = scene.drum.as_ref().map(drum_surface).transpose()?;
        let of_shape = |s: &TabletShape| {
            s.repairs.iter().map(|r| format!("shape `{}`: {r}", s.name)).collect::<Vec<_>>()
        };
        let of_drum = drum.iter().flat_map(|surface| surface.repairs.iter().map(|r| format!("drum: {r}")));
        let mut simulation = Self {
            time_step: TimeStep::choose(scene, &shapes),
            field: ContactField::new(scene, &shapes),
            repairs: shapes.iter().flat_map(of_shape).chain(of_drum).collect(),
            drum: drum.map(|surface| surface.mesh),
            scene: scene.clone(),
            shapes,
            step: 0,
            part: 0.0,
            world: World::new(),
            impulses: match scene.contact.mode {
                ContactMode::HertzMindlin => None,
                ContactMode::Impulse { .. } => Some(ImpulseWorld::new(scene.pairs.clone(), &scene.gravity)),
            },
            bodies: Vec::new(),
            numbers: Vec::new(),
            kinds: Vec::new(),
            motions: Vec::new(),
            surfaces: Vec::new(),
            meshes: 0,
            drives: Vec::new(),
            wrenches: Vec::new(),
            owed: 0.0,
            odometers: Vec::new(),
            haste: 0.0,
            divided: 0,
            repeated: 0,
            rng: ChaCha8Rng::seed_from_u64(scene.seed),
            torque_sum: 0.0,
            torque_time: 0.0,
            deepest: 0.0,
            stiff: 0.0,
            tally: Tally::default(),
            audit: None,
            good: (0.0, Vec::new()),
            stopwatch: Stopwatch::default(),
        };
        simulation.add_surfaces()?;
        for body in &scene.bodies {
            let state = BodyState {
                position: body.position,
                orientation: body.orientation,
                velocity: body.velocity,
                spin: body.spin,
            };
            simulation.add_body(body.shape, body.material, body.mass, &state);
        }
        if simulation.impulses.is_none() {
            simulation.feel(0.0);
            simulation.guard_start()?;
        }
        simulation.note_good();
        Ok(simulation)
    }

    fn add_surfaces(&mut self) -> Result<(), SimulationError> {
        if let (Some(drum), Some(mesh)) = (&self.scene.drum, &self.drum) {
            let facets = self.world.add_surface(mesh);
            self.field.add_mesh(mesh, facets, drum.material, true);
            self.impulses.iter_mut().for_each(|world| world.add_mesh(mesh, drum.material));
            self.drives.push((Vector3::zeros(), Vector3::z() * drum.speed));
            self.meshes += 1;
        }
        let is_mesh = |b: &&Boundary| matches!(b.surface, BoundarySurface::Mesh { .. });
        let boundaries = self.scene.boundaries.clone();
        let meshes_first = boundaries.iter().filter(is_mesh).chain(boundaries.iter().filter(|b| !is_mesh(b)));
        for boundary in meshes_first {
            let drive = (boundary.velocity, boundary.spin);
            match &boundary.surface {
                BoundarySurface::Plane { point, normal } => {
                    self.add_plane(*point, *normal, boundary.material, drive);
                }
                BoundarySurface::Box { min, max } => {
                    for axis in 0..3 {
                        let normal = Vector3::ith_axis(axis).into_inner();
                        self.add_plane(*min, normal, boundary.material, drive);
                        self.add_plane(*max, -normal, boundary.material, drive);
                    }
                }
                BoundarySurface::Mesh { path, scale } => {
                    let ImportedSurface { mesh, repairs } = read_surface(path, *scale)?;
                    self.repairs.extend(repairs.iter().map(|repair| format!("{}: {repair}", path.display())));
                    let facets = self.world.add_surface(&mesh);
                    self.field.add_mesh(&mesh, facets, boundary.material, false);
                    self.impulses.iter_mut().for_each(|world| world.add_mesh(&mesh, boundary.material));
                    self.drives.push(drive);
                    self.meshes += 1;
                }
            }
        }
        self.surfaces = vec![Motion::at_rest(); self.drives.len()];
        self.move_surfaces();
        Ok(())
    }

    fn add_plane(
        &mut self,
        point: Vector3<f64>,
        normal: Vector3<f64>,
        material: usize,
        drive: (Vector3<f64>, Vector3<f64>),
    ) {
        self.field.add_plane(point, normal, material);
        self.impulses.iter_mut().for_each(|world| world.add_plane(&point, &normal, material));
        self.drives.push(drive);
    }

    pub(super) fn add_body(&mut self, shape: usize, material: usize, mass: f64, state: &BodyState) {
        let inertia = self.shapes[shape].inertia_per_mass * mass;
        let rotation = state.orientation.to_rotation_matrix().into_inner();
        let BodyState { position, velocity, spin, .. } = *state;
        let motion = Motion { position, rotation, velocity, spin };
        self.world.add_tablet(&self.shapes[shape].clump, mass, &inertia, &motion);
        self.field.add_body(shape, material, mass, &inertia);
        let clump = &self.shapes[shape].clump;
        self.impulses.iter_mut().for_each(|world| world.add_tablet(clump, material, mass, &inertia, &motion));
        let momentum = rotation * rotation.tr_mul(&state.spin).component_mul(&inertia);
        self.bodies.push(Body {
            mass,
            inverse_mass: 1.0 / mass,
            inverse_inertia: inertia.map(|moment| 1.0 / moment),
            orientation: state.orientation,
            velocity: state.velocity,
            momentum,
            reach: clump.reach(),
            arms: clump.arms(),
            inverse_travel: 1.0 / (MOST_TRAVEL * clump.smallest_radius()),
        });
        self.numbers.push(self.kinds.len() as u32);
        self.kinds.push(shape);
        self.motions.push(motion);
        self.odometers.push(0.0);
        self.wrenches.push(Wrench::weight(&self.scene.gravity, mass));
    }

    /// One time step, in as many pieces as the fastest body asks for, and in `least` at least.
    fn advance(&mut self, least: f64) -> Result<(), SimulationError> {
        if self.impulses.is_some() {
            self.advance_by_impulses();
            return Ok(());
        }
        let pieces = (self.haste / HASTY).ceil().clamp(least, MOST_PIECES);
        for piece in 1..pieces as u64 {
            self.part = piece as f64 / pieces;
            self.advance_piece(1.0 / pieces)?;
        }
        (self.step, self.part) = (self.step + 1, 0.0);
        self.divided += u64::from(pieces > 1.0);
        self.advance_piece(1.0 / pieces)
    }

    /// Some share of a time step: kick, drift, forces at the new time level, kick. The last is made together with the first of the
    /// next one where nobody looks at the bodies in between.
    fn advance_piece(&mut self, share: f64) -> Result<(), SimulationError> {
        let dt = share * self.time_step.step;
        let haste = self.drift(dt);
        self.stopwatch.lap(Phase::Motion);
        self.feel(dt);
        self.owed = 0.5 * dt;
        if self.audit.is_some() {
            self.kick();
        }
        if let Some(audit) = &mut self.audit {
            let bodies = (&self.bodies[..], &self.motions[..]);
            audit.note(dt, &self.scene.gravity, bodies, &self.surfaces, self.field.contacts());
        }
        self.note_forces(dt);
        self.haste = haste / share;
        self.guard_step(dt, haste)
    }

    /// Brings velocities to the time of the places.
    fn kick(&mut self) {
        let owed = std::mem::take(&mut self.owed);
        for (body, wrench) in self.bodies.iter_mut().zip(&self.wrenches) {
            body.kick(wrench, owed);
        }
    }

    /// Adds forces and torques of contacts at the present time level to those of gravity; springs advance by `dt` s.
    fn feel(&mut self, dt: f64) {
        let carrier = self.carrier();
        let (world, motions, odometers) = (&mut self.world, &self.motions[..], &self.odometers[..]);
        let (surfaces, meshes) = (&self.surfaces[..], self.meshes);
        let mut searching = Duration::ZERO;
        let search = || {
            let start = Instant::now();
            let near = world.search(motions, &surfaces[..meshes], &carrier, odometers);
            searching = start.elapsed();
            near
        };
        self.tally = self.field.add_forces(motions, surfaces, odometers, search, dt, &mut self.wrenches);
        self.stopwatch.lap(Phase::Contact);
        self.stopwatch.split(Phase::Contact, Phase::Search, searching);
    }

    fn advance_by_impulses(&mut self) {
        let dt = self.time_step.step;
        self.step += 1;
        self.move_surfaces();
        if let Some(world) = &mut self.impulses {
            let (bodies, motions) = (&mut self.bodies, &mut self.motions);
            self.torque_sum +=
                dt * impulse::step(world, &self.surfaces, bodies, motions, &self.scene.gravity, dt);
            self.torque_time += dt;
        }
        self.stopwatch.lap(Phase::Contact);
    }

    /// Moves everything, and tells how far the fastest body went, of what it may.
    fn drift(&mut self, dt: f64) -> f64 {
        let owed = std::mem::take(&mut self.owed);
        let stride = Stride { dt, owed, gravity: self.scene.gravity, carrier: self.carrier().spin };
        let (wrenches, odometers) =
            (self.wrenches.par_chunks_mut(CHUNK), self.odometers.par_chunks_mut(CHUNK));
        let bodies = self.bodies.par_chunks_mut(CHUNK).zip(self.motions.par_chunks_mut(CHUNK));
        let drift = |(((bodies, motions), wrenches), odometers)| {
            pulp::Arch::new().dispatch(Drift { bodies, motions, wrenches, odometers, stride })
        };
        let haste = bodies.zip(wrenches).zip(odometers).with_max_len(1).map(drift).reduce(|| 0.0, f64::max);
        self.move_surfaces();
        haste
    }

    /// What the bed moves with: the drum, which is the first surface and turns about the origin, or nothing.
    fn carrier(&self) -> Motion {
        if self.drum.is_some() { self.surfaces[0] } else { Motion::at_rest() }
    }

    pub(super) fn move_surfaces(&mut self) {
        let time = self.clock();
        for (motion, (velocity, spin)) in self.surfaces.iter_mut().zip(&self.drives) {
            let rotation = Rotation3::new(spin * time).into_inner();
            *motion = Motion { position: velocity * time, rotation, velocity: *velocity, spin: *spin };
        }
    }

    fn note_forces(&mut self, dt: f64) {
        if self.scene.drum.is_some() {
            self.torque_sum -= dt * self.field.surface_torque(0).z;
        }
        self.torque_time += dt;
        self.deepest = self.deepest.max(self.tally.deepest);
        self.stiff += f64::from(self.tally.stiff) * dt / self.time_step.step;
    }

    /// Advances by one frame interval.
    pub(super) fn advance_frame(&mut self) -> Result<(), SimulationError> {
        self.try_frame()?;
        self.note_good();
        self.number_by_place(self.steps_per_frame());
        Ok(())
    }

    /// Takes all steps of a frame, each in `pieces` at least.
    pub(super) fn take_steps(&mut self, pieces: f64) -> Result<(), SimulationError> {
        self.torque_sum = 0.0;
        self.torque_time = 0.0;
        // All steps inside the pool: handing work to it from outside costs more than a step does.
        rayon::scope(|_| (0..self.steps_per_frame()).try_for_each(|_| self.advance(pieces)))?;
        self.kick();
        self.guard_frame()
    }

    fn steps_per_frame(&self) -> u64 {
        (self.scene.time.frame_interval / self.time_step.step).round() as u64
    }
}
