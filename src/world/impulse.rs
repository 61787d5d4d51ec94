//! Contacts by Rapier's own solver: impulses between convex hulls of the clumps, at steps of milliseconds.
//!
//! Bodies do not overlap and nothing is elastic: a quick look, and a comparison for what contact forces resolve. Friction
//! and restitution are those of the scene's pairs of materials.

use super::motion::Motion;
use super::{pose, to_f32, tuning};
use crate::scene::PairTable;
use crate::shapes::{Clump, SurfaceMesh};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use rapier3d::prelude::*;
use std::f64::consts::{PI, TAU};

/// Points on the hull of a clump: 60 lie within 2 % of a tablet's radius of its surface.
const HULL_POINTS: usize = 60;

/// Thickness of walls, m: several times what a body moves in a step.
const PLATE: f64 = 4e-3;

/// Gives every contact the friction and restitution of its pair of materials.
#[derive(Clone)]
struct PairHooks(PairTable);

impl PhysicsHooks for PairHooks {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext<'_>) {
        let material = |body: Option<RigidBodyHandle>| body.map(|b| context.bodies[b].user_data as usize);
        let (a, b) = (material(context.rigid_body1), material(context.rigid_body2));
        if let (Some(a), Some(b), Some(contacts)) = (a, b, context.rigid_mut()) {
            let pair = self.0.get(a, b);
            *contacts.friction = pair.friction as f32;
            *contacts.restitution = pair.restitution as f32;
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
                ..IntegrationParameters::default()
            },
            gravity: to_f32(gravity),
            hooks: PairHooks(pairs),
            tablets: Vec::new(),
            surfaces: Vec::new(),
        }
    }

    /// Adds a driven triangle surface, each facet as a plate behind it.
    ///
    /// Rapier's own triangle meshes have no inside: what a body is pressed into them by may push it on to the other side,
    /// and tablets of a slowly turning drum cling to its wall or leave it.
    ///
    /// # Panics
    /// When the mesh has no triangle of any area.
    pub fn add_mesh(&mut self, mesh: &SurfaceMesh, material: usize) {
        let plates = (0..mesh.triangles.len()).filter_map(|t| {
            let corners = mesh.triangles[t].map(|v| mesh.vertices[v as usize]);
            let back = mesh.normal(t) * -PLATE;
            let points: Vec<Vec3> =
                corners.iter().flat_map(|corner| [to_f32(corner), to_f32(&(corner + back))]).collect();
            SharedShape::convex_hull(&points).map(|plate| (Pose::IDENTITY, plate))
        });
        self.add_surface(ColliderBuilder::new(SharedShape::compound(plates.collect())), material);
    }

    /// Adds a driven unbounded plane with its unit normal towards the bodies.
    pub fn add_plane(&mut self, point: &Vector3<f64>, normal: &Vector3<f64>, material: usize) {
        let shape = SharedShape::halfspace(to_f32(normal));
        self.add_surface(ColliderBuilder::new(shape).translation(to_f32(point)), material);
    }

    fn add_surface(&mut self, collider: ColliderBuilder, material: usize) {
        let body = RigidBodyBuilder::kinematic_position_based().user_data(material as u128);
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
            .user_data(material as u128);
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
            let motion = Motion::steady(vector(at), rotation, vector(body.linvel()), vector(body.angvel()));
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
