//! Contacts by Rapier's own solver: impulses between convex hulls of the clumps, at steps of milliseconds.
//!
//! Bodies do not overlap and nothing is elastic: a quick look, and a comparison for what contact forces resolve. Friction
//! and restitution are those of the scene's pairs of materials.

use super::motion::Motion;
use super::plates::plates;
use super::{pose, to_f32, tuning};
use crate::scene::PairTable;
use crate::shapes::{Clump, SurfaceMesh};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use rapier3d::prelude::*;
use std::f64::consts::{PI, TAU};

/// Points on the hull of a clump: 60 lie within 2 % of a tablet's radius of its surface.
const HULL_POINTS: usize = 60;

/// Largest angle, as its cosine, between a contact and the face of the plate it is with.
const SIDEWAYS: f32 = 0.5;
/// Depth behind the face, m, up to which a contact with the side of a plate is one with its face.
const SHALLOW: f32 = 2e-3;
/// Natural frequency, Hz, and damping ratio of contacts at walls: twice as stiff and half as damped as Rapier's own, with
/// which baffles push tablets into the ends of a drum.
const WALLS: (f32, f32) = (120.0, 5.0);
/// Largest speed, m/s, at which bodies are moved out of each other and of walls: that of a drum's wall.
const CORRECTION: f32 = 0.3;

/// Gives every contact the friction and restitution of its pair of materials, and turns contacts with the sides of a
/// wall's plates into contacts with their faces: where plates meet there is nothing to bump into.
#[derive(Clone)]
struct PairHooks {
    pairs: PairTable,
    /// Of each surface, by index, a point and the normal of each plate's face in the surface's axes; none for a plane.
    faces: Vec<Vec<(Vec3, Vec3)>>,
}

/// What Rapier keeps with a body: its material, and for a surface its index + 1.
fn user_data(material: usize, surface: Option<usize>) -> u128 {
    material as u128 | (surface.map_or(0, |index| index as u128 + 1) << 64)
}

impl PairHooks {
    /// The face of a plate of a surface: a point and the normal, world axes.
    fn face(&self, surface: &RigidBody, plate: u32) -> Option<(Vec3, Vec3)> {
        let index = ((surface.user_data >> 64) as usize).checked_sub(1)?;
        let (point, normal) = self.faces[index].get(plate as usize)?;
        Some((*surface.position() * *point, surface.position().rotation * *normal))
    }
}

/// Makes contacts at the side of a plate contacts with its face, or none if they are deep behind it. `first`: the plate
/// is the first of the two bodies.
fn face_up(contacts: &mut ModifiableManifold<'_>, (point, face): (Vec3, Vec3), first: bool) {
    let sign = if first { 1.0 } else { -1.0 };
    if contacts.normal.dot(face) * sign >= SIDEWAYS {
        return;
    }
    *contacts.normal = face * sign;
    let mut deepest = 0.0_f32;
    for contact in contacts.solver_contacts.iter_mut() {
        let (wall, body) = if first {
            (&mut contact.anchor1, contact.anchor2)
        } else {
            (&mut contact.anchor2, contact.anchor1)
        };
        contact.dist = (body - point).dot(face);
        *wall = body - face * contact.dist;
        deepest = deepest.max(-contact.dist);
    }
    if deepest > SHALLOW {
        contacts.solver_contacts.clear();
    }
}

impl PhysicsHooks for PairHooks {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext<'_>) {
        let (Some(a), Some(b)) = (context.rigid_body1, context.rigid_body2) else { return };
        let (a, b) = (&context.bodies[a], &context.bodies[b]);
        let Some(contacts) = context.rigid_mut() else { return };
        let material = |body: &RigidBody| body.user_data as u64 as usize;
        let pair = self.pairs.get(material(a), material(b));
        *contacts.friction = pair.friction as f32;
        *contacts.restitution = pair.restitution as f32;
        if let Some(face) = self.face(a, contacts.manifold.subshape1) {
            face_up(contacts, face, true);
        } else if let Some(face) = self.face(b, contacts.manifold.subshape2) {
            face_up(contacts, face, false);
        }
    }
}

/// Bodies and surfaces that Rapier moves and solves by itself.
pub struct ImpulseWorld {
    bodies: RigidBodySet,
    colliders: ColliderSet,
    islands: IslandManager,
    broad_phase: DefaultBroadPhase,
    narrow_phase: NarrowPhase,
    pipeline: PhysicsPipeline,
    parameters: IntegrationParameters,
    gravity: Vec3,
    hooks: PairHooks,
    tablets: Vec<RigidBodyHandle>,
    surfaces: Vec<RigidBodyHandle>,
}

impl Clone for ImpulseWorld {
    /// A world that goes on like this one; Rapier's workspace is made anew.
    fn clone(&self) -> Self {
        Self {
            bodies: self.bodies.clone(),
            colliders: self.colliders.clone(),
            islands: self.islands.clone(),
            broad_phase: self.broad_phase.clone(),
            narrow_phase: self.narrow_phase.clone(),
            pipeline: PhysicsPipeline::new(),
            parameters: self.parameters,
            gravity: self.gravity,
            hooks: self.hooks.clone(),
            tablets: self.tablets.clone(),
            surfaces: self.surfaces.clone(),
        }
    }
}

impl ImpulseWorld {
    /// An empty world with gravity, m/s².
    pub fn new(pairs: PairTable, gravity: &Vector3<f64>) -> Self {
        Self {
            bodies: RigidBodySet::new(),
            colliders: ColliderSet::new(),
            islands: IslandManager::new(),
            broad_phase: DefaultBroadPhase::new(),
            narrow_phase: NarrowPhase::new(),
            pipeline: PhysicsPipeline::new(),
            parameters: IntegrationParameters {
                length_unit: tuning::LENGTH_UNIT,
                normalized_max_corrective_velocity: CORRECTION / tuning::LENGTH_UNIT,
                static_contact_softness: SpringCoefficients::new(WALLS.0, WALLS.1),
                ..IntegrationParameters::default()
            },
            gravity: to_f32(gravity),
            hooks: PairHooks { pairs, faces: Vec::new() },
            tablets: Vec::new(),
            surfaces: Vec::new(),
        }
    }

    /// Adds a driven triangle surface as plates.
    ///
    /// # Panics
    /// When the mesh has no triangle.
    pub fn add_mesh(&mut self, mesh: &SurfaceMesh, material: usize) {
        let plates = plates(mesh);
        let faces = plates.iter().map(|plate| (to_f32(&plate.point), to_f32(&plate.normal))).collect();
        let shapes = plates.into_iter().map(|plate| (plate.pose, plate.shape)).collect();
        self.add_surface(ColliderBuilder::new(SharedShape::compound(shapes)), material, faces);
    }

    /// Adds a driven unbounded plane with its unit normal towards the bodies.
    pub fn add_plane(&mut self, point: &Vector3<f64>, normal: &Vector3<f64>, material: usize) {
        let shape = SharedShape::halfspace(to_f32(normal));
        self.add_surface(ColliderBuilder::new(shape).translation(to_f32(point)), material, Vec::new());
    }

    fn add_surface(&mut self, collider: ColliderBuilder, material: usize, faces: Vec<(Vec3, Vec3)>) {
        let data = user_data(material, Some(self.surfaces.len()));
        let body = RigidBodyBuilder::kinematic_position_based().user_data(data);
        self.hooks.faces.push(faces);
        let handle = self.bodies.insert(body);
        let collider = collider.active_hooks(ActiveHooks::MODIFY_SOLVER_CONTACTS);
        self.colliders.insert_with_parent(collider, handle, &mut self.bodies);
        self.surfaces.push(handle);
    }

    /// Adds a tablet: the convex hull of its clump with the mass, kg, and principal moments, kg m², of the true solid.
    pub fn add_tablet(
        &mut self,
        clump: &Clump,
        material: usize,
        mass: f64,
        inertia: &Vector3<f64>,
        motion: &Motion,
    ) {
        let body = RigidBodyBuilder::dynamic()
            .pose(pose(&motion.seen_from(&Motion::at_rest())))
            .linvel(to_f32(&motion.velocity))
            .angvel(to_f32(&motion.spin))
            .can_sleep(false)
            .user_data(user_data(material, None));
        let handle = self.bodies.insert(body);
        let properties = MassProperties::new(Vec3::ZERO, mass as f32, to_f32(inertia));
        let collider = ColliderBuilder::new(hull(clump))
            .mass_properties(properties)
            .active_hooks(ActiveHooks::MODIFY_SOLVER_CONTACTS);
        self.colliders.insert_with_parent(collider, handle, &mut self.bodies);
        self.tablets.push(handle);
    }

    /// One step of `dt`, s, at whose end the surfaces are at `surfaces`, in the order in which they were added.
    pub fn step(&mut self, surfaces: &[Motion], dt: f64) {
        self.parameters.dt = dt as f32;
        for (handle, motion) in self.surfaces.iter().zip(surfaces) {
            let mut next = pose(&motion.seen_from(&Motion::at_rest()));
            let body = &mut self.bodies[*handle];
            // Of the two quaternions of a rotation the near one: Rapier takes the other for a whole turn in one step.
            if body.position().rotation.dot(next.rotation) < 0.0 {
                next.rotation = -next.rotation;
            }
            body.set_next_kinematic_position(next);
        }
        self.pipeline.step(
            self.gravity,
            &self.parameters,
            &mut self.islands,
            &mut self.broad_phase,
            &mut self.narrow_phase,
            &mut self.bodies,
            &mut self.colliders,
            &mut ImpulseJointSet::new(),
            &mut MultibodyJointSet::new(),
            &mut SoftBodySet::new(),
            &mut CCDSolver::new(),
            &self.hooks,
            &(),
        );
    }

    /// Orientation and motion of every tablet, in the order in which they were added.
    pub fn motions(&self) -> impl Iterator<Item = (UnitQuaternion<f64>, Motion)> {
        let vector = |v: Vec3| Vector3::new(f64::from(v.x), f64::from(v.y), f64::from(v.z));
        self.tablets.iter().map(move |handle| {
            let body = &self.bodies[*handle];
            let (at, q) = (body.position().translation, body.position().rotation);
            let [w, x, y, z] = [q.w, q.x, q.y, q.z].map(f64::from);
            let orientation = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z));
            let rotation = orientation.to_rotation_matrix().into_inner();
            let (velocity, spin) = (vector(body.linvel()), vector(body.angvel()));
            let motion = Motion { position: vector(at), rotation, velocity, spin };
            (orientation, motion)
        })
    }
}

/// A ball, or the convex hull of the clump's farthest points in directions spread evenly over the sphere.
fn hull(clump: &Clump) -> SharedShape {
    if let [ball] = &clump.spheres[..] {
        return SharedShape::ball(ball.radius as f32);
    }
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let points: Vec<Vec3> = (0..HULL_POINTS)
        .map(|k| {
            // Fibonacci lattice: equal steps in z, golden angle in turn.
            let z = 1.0 - (2.0 * k as f64 + 1.0) / HULL_POINTS as f64;
            let (sin, cos) = ((k as f64 * golden) % TAU).sin_cos();
            let direction = Vector3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + Vector3::z() * z;
            let point = |s: &crate::shapes::Sphere| s.center + direction * s.radius;
            let farthest = clump.spheres.iter().map(point);
            to_f32(
                &farthest.max_by(|a, b| a.dot(&direction).total_cmp(&b.dot(&direction))).unwrap_or_default(),
            )
        })
        .collect();
    SharedShape::convex_hull(&points).expect("spheres have points in all directions")
}
