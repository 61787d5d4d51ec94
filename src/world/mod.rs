//! The only room that knows Rapier: a kinematic body with a triangle mesh for the drum and every other surface, a
//! dynamic body with a compound of balls for every tablet, and [`hooks::ContactHooks`], which takes their contacts over.
//!
//! In: poses in f64. Out: which bodies are near each other, and which facets are near a body. What it does not do: turn
//! contacts into forces (room `contact`) or move anything (room `stepping`).

mod hooks;
mod motion;
mod tuning;

pub use motion::Motion;

use crate::shapes::{Clump, SurfaceMesh};
use hooks::{ContactHooks, SURFACE};
use nalgebra::{Rotation3, UnitQuaternion, Vector3};
use rapier3d::prelude::*;

/// Rapier's sets and what it takes to run them.
pub struct World {
    bodies: RigidBodySet,
    colliders: ColliderSet,
    islands: IslandManager,
    broad_phase: DefaultBroadPhase,
    narrow_phase: NarrowPhase,
    pipeline: PhysicsPipeline,
    hooks: ContactHooks,
    parameters: IntegrationParameters,
    tablets: Vec<(RigidBodyHandle, ColliderHandle)>,
    surfaces: Vec<(RigidBodyHandle, SharedShape)>,
    /// Poses that Rapier knows, by tablet.
    known: Vec<Motion>,
    /// How far each tablet may move from there, m.
    margins: Vec<f64>,
    reaches: Vec<f64>,
    near: Vec<(u32, u32)>,
}

impl Default for World {
    fn default() -> Self {
        Self::new()
    }
}

impl World {
    /// An empty world.
    pub fn new() -> Self {
        Self {
            bodies: RigidBodySet::new(),
            colliders: ColliderSet::new(),
            islands: IslandManager::new(),
            broad_phase: DefaultBroadPhase::new(),
            narrow_phase: NarrowPhase::new(),
            pipeline: PhysicsPipeline::new(),
            hooks: ContactHooks::default(),
            parameters: IntegrationParameters {
                dt: 0.0,
                length_unit: tuning::LENGTH_UNIT,
                normalized_prediction_distance: 0.0,
                max_ccd_substeps: 0,
                contact_clustering: false,
                contact_recycling: false,
                ..IntegrationParameters::default()
            },
            tablets: Vec::new(),
            surfaces: Vec::new(),
            known: Vec::new(),
            margins: Vec::new(),
            reaches: Vec::new(),
            near: Vec::new(),
        }
    }

    /// Adds a driven surface; its index counts from 0.
    ///
    /// # Panics
    /// When the mesh has no triangle.
    pub fn add_surface(&mut self, mesh: &SurfaceMesh) -> usize {
        let vertices = mesh.vertices.iter().map(|v| Vec3::new(v.x as f32, v.y as f32, v.z as f32)).collect();
        let shape = SharedShape::trimesh(vertices, mesh.triangles.clone()).expect("a mesh has triangles");
        let body = RigidBodyBuilder::kinematic_position_based().user_data(SURFACE);
        let handle = self.bodies.insert(body);
        let collider =
            ColliderBuilder::new(shape.clone()).collision_groups(InteractionGroups::none()).density(0.0);
        self.colliders.insert_with_parent(collider, handle, &mut self.bodies);
        self.surfaces.push((handle, shape));
        self.surfaces.len() - 1
    }

    /// Adds a tablet as a compound of balls with the mass, kg, and principal moments, kg m², of the true solid; its
    /// index counts from 0.
    pub fn add_tablet(&mut self, clump: &Clump, mass: f64, inertia: &Vector3<f64>, motion: &Motion) -> usize {
        let index = self.tablets.len();
        let balls = clump
            .spheres
            .iter()
            .map(|s| (Pose::from_translation(to_f32(&s.center)), SharedShape::ball(s.radius as f32)));
        let properties = MassProperties::new(Vec3::ZERO, mass as f32, to_f32(inertia));
        let body = RigidBodyBuilder::dynamic().pose(pose(motion)).sleeping(true).user_data(index as u128);
        let handle = self.bodies.insert(body);
        let collider = ColliderBuilder::new(SharedShape::compound(balls.collect()))
            .mass_properties(properties)
            .active_hooks(ActiveHooks::FILTER_CONTACT_PAIRS);
        let collider = self.colliders.insert_with_parent(collider, handle, &mut self.bodies);
        self.tablets.push((handle, collider));
        self.margins.push(0.0);
        self.known.push(Motion { position: Vector3::repeat(f64::INFINITY), ..*motion });
        self.reaches.push(clump.bounding_radius());
        index
    }

    /// Whether some body may have come near another since the last search: it has used up its share of the margin.
    #[inline]
    pub fn must_search(&self, motions: &[Motion]) -> bool {
        motions.iter().enumerate().any(|(k, motion)| !self.within(k, motion, 1.0))
    }

    /// Whether a body has used less than `share` of its margin since Rapier learnt its pose; false for a NaN pose.
    #[inline]
    fn within(&self, body: usize, now: &Motion, share: f64) -> bool {
        let (then, reach) = (&self.known[body], self.reaches[body]);
        let turned = (3.0 - now.rotation.dot(&then.rotation)).max(0.0).sqrt();
        let moved = (now.position - then.position).norm() + turned * reach;
        moved < share * self.margins[body]
    }

    /// All pairs of bodies that can touch before [`World::must_search`] says so: smaller index first, sorted.
    ///
    /// Rapier learns the poses of bodies that have used most of their margin, and its hooks report the pairs those
    /// bodies are in; all other pairs stay as they were.
    pub fn search(&mut self, motions: &[Motion], surfaces: &[Motion]) -> &[(u32, u32)] {
        for ((handle, _), motion) in self.surfaces.iter().zip(surfaces) {
            self.bodies[*handle].set_position(pose(motion), false);
        }
        let moved: Vec<bool> =
            motions.iter().enumerate().map(|(k, m)| !self.within(k, m, tuning::EARLY)).collect();
        for (k, (body, collider)) in self.tablets.iter().enumerate().filter(|(k, _)| moved[*k]) {
            let (motion, reach) = (&motions[k], self.reaches[k]);
            let speed = motion.velocity.norm() + motion.spin.norm() * reach;
            let (least, most) = tuning::MARGIN;
            let margin = (speed * tuning::HORIZON).clamp(least * reach, most * reach);
            self.bodies[*body].set_position(pose(motion), false);
            self.colliders[*collider].set_contact_skin(margin as f32);
            self.known[k] = *motion;
            self.margins[k] = margin - tuning::ROUNDING;
        }
        self.pipeline.step(
            Vec3::ZERO,
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
        self.near.retain(|(a, b)| !moved[*a as usize] && !moved[*b as usize]);
        self.near.extend(self.hooks.take());
        self.near.sort_unstable();
        self.near.dedup();
        &self.near
    }

    /// Fills `facets` with the facets of a surface whose boxes meet the box from `min` to `max` (surface axes, m), in no
    /// particular order.
    ///
    /// # Panics
    /// When there is no surface of that index.
    pub fn facets_near(&self, surface: usize, min: &Vector3<f64>, max: &Vector3<f64>, facets: &mut Vec<u32>) {
        let mesh = self.surfaces[surface].1.as_trimesh().expect("surfaces are triangle meshes");
        facets.extend(mesh.bvh().intersect_aabb(&Aabb::new(to_f32(min), to_f32(max))));
    }
}

fn to_f32(v: &Vector3<f64>) -> Vec3 {
    Vec3::new(v.x as f32, v.y as f32, v.z as f32)
}

fn pose(motion: &Motion) -> Pose {
    let q = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(motion.rotation));
    let rotation = Rotation::from_xyzw(q.i as f32, q.j as f32, q.k as f32, q.w as f32);
    Pose::from_parts(to_f32(&motion.position), rotation)
}
