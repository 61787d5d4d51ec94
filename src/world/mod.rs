//! The only room that knows Rapier: a kinematic body with a triangle mesh for the drum and every other surface, a
//! dynamic body with a compound of balls for every tablet, and [`hooks::ContactHooks`], which takes their contacts over.
//!
//! Rapier's world is seen from the carrier, the surface whose motion the bed shares: a bed that turns with its drum rests
//! there, so its bodies' boxes hold for long.
//!
//! In: poses in f64. Out: which bodies are near each other, and which facets are near a body. What it does not do: turn
//! contacts into forces (room `contact`) or move anything (room `stepping`), but for [`ImpulseWorld`], which does both
//! when a scene asks for it.

mod boxes;
mod facets;
#[cfg(test)]
pub(crate) mod harvest;
mod hooks;
mod impulse;
mod motion;
mod plates;
mod tuning;

pub use facets::FacetTree;
pub use impulse::ImpulseWorld;
pub use motion::{Course, Motion, Relative};

use crate::shapes::{Clump, SurfaceMesh};
use boxes::Boxes;
use hooks::{ContactHooks, SURFACE, context};
use nalgebra::{Rotation3, UnitQuaternion, Vector3};
use rapier3d::parry::shape::TriMesh;
use rapier3d::prelude::*;
use std::sync::Arc;

/// Rapier's sets and what it takes to run them.
pub struct World {
    bodies: RigidBodySet,
    colliders: ColliderSet,
    boxes: Boxes,
    hooks: ContactHooks,
    tablets: Vec<(RigidBodyHandle, ColliderHandle)>,
    surfaces: Vec<RigidBodyHandle>,
    tracks: Vec<Track>,
    /// Odometer up to which each tablet's margin holds for sure, m.
    marks: Vec<f64>,
}

/// What a search changes: pairs of bodies, smaller index first, sorted.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct NearChanges {
    /// No longer near each other.
    pub parted: Vec<(u32, u32)>,
    /// Near each other now.
    pub met: Vec<(u32, u32)>,
}

/// What a tablet's box is worth.
#[derive(Clone)]
struct Track {
    /// Pose that Rapier knows, seen from the carrier: one ahead of that in which the tablet was when the box was put.
    known: Relative,
    /// How far the tablet may move from there, m.
    margin: f64,
    /// Largest distance of a sphere's centre from the centre of mass, m.
    reach: f64,
    /// Largest distance of a sphere's far side from there, m.
    bounding_radius: f64,
}

impl Track {
    /// Whether a ball about this tablet meets one about another, wherever both move within their margins. Of tablets in a
    /// heap whose boxes overlap, two thirds are told apart by that.
    fn may_touch(&self, other: &Self) -> bool {
        let reach = self.bounding_radius + self.margin + other.bounding_radius + other.margin;
        (self.known.position - other.known.position).norm_squared() < reach * reach
    }
}

impl Default for World {
    fn default() -> Self {
        Self::new()
    }
}

impl Clone for World {
    /// A world that goes on like this one.
    fn clone(&self) -> Self {
        Self {
            bodies: self.bodies.clone(),
            colliders: self.colliders.clone(),
            boxes: self.boxes.clone(),
            tablets: self.tablets.clone(),
            surfaces: self.surfaces.clone(),
            tracks: self.tracks.clone(),
            marks: self.marks.clone(),
            ..Self::new()
        }
    }
}

impl World {
    /// An empty world.
    pub fn new() -> Self {
        Self {
            bodies: RigidBodySet::new(),
            colliders: ColliderSet::new(),
            boxes: Boxes::default(),
            hooks: ContactHooks::default(),
            tablets: Vec::new(),
            surfaces: Vec::new(),
            tracks: Vec::new(),
            marks: Vec::new(),
        }
    }

    /// Adds a driven surface and returns the tree of its facets.
    ///
    /// # Panics
    /// When the mesh has no triangle.
    pub fn add_surface(&mut self, mesh: &SurfaceMesh) -> FacetTree {
        let vertices = mesh.vertices.iter().map(|v| Vec3::new(v.x as f32, v.y as f32, v.z as f32)).collect();
        let shape = Arc::new(TriMesh::new(vertices, mesh.triangles.clone()).expect("a mesh has triangles"));
        let body = RigidBodyBuilder::kinematic_position_based().user_data(SURFACE);
        let handle = self.bodies.insert(body);
        let collider = ColliderBuilder::new(SharedShape(shape.clone()))
            .collision_groups(InteractionGroups::none())
            .density(0.0);
        self.colliders.insert_with_parent(collider, handle, &mut self.bodies);
        self.surfaces.push(handle);
        FacetTree(shape)
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
        let body = RigidBodyBuilder::dynamic()
            .pose(pose(&motion.seen_from(&Motion::at_rest())))
            .sleeping(true)
            .user_data(index as u128);
        let handle = self.bodies.insert(body);
        let collider = ColliderBuilder::new(SharedShape::compound(balls.collect()))
            .mass_properties(properties)
            .active_hooks(ActiveHooks::FILTER_CONTACT_PAIRS);
        let collider = self.colliders.insert_with_parent(collider, handle, &mut self.bodies);
        self.tablets.push((handle, collider));
        self.tracks.push(Track {
            known: Relative::NOWHERE,
            margin: 0.0,
            reach: clump.reach(),
            bounding_radius: clump.bounding_radius(),
        });
        self.marks.push(f64::NEG_INFINITY);
        index
    }

    /// Which pairs of bodies can touch before the next search that could not by the last one, and the other way round; to
    /// be called at every step, since it sees to it that no body uses up its margin. `odometers`: distance that each tablet's
    /// farthest sphere centre can have moved against the carrier so far, m.
    ///
    /// The tree learns the boxes of bodies that have used most of their margin and tells which others they are near and
    /// which no longer. Of those that met the hooks are asked at once: Rapier's narrow phase would ask them again for
    /// every pair of a moved body, and be answered that there is nothing to do.
    pub fn search(
        &mut self,
        motions: &[Motion],
        surfaces: &[Motion],
        carrier: &Motion,
        odometers: &[f64],
    ) -> NearChanges {
        for (k, (body, collider)) in self.tablets.iter().enumerate() {
            // False for a NaN.
            if odometers[k] <= self.marks[k] {
                continue;
            }
            let (motion, track) = (&motions[k], &mut self.tracks[k]);
            let now = motion.seen_from(carrier);
            let moved = now.moved_since(&track.known, track.reach);
            if moved < tuning::SPENT * track.margin {
                self.marks[k] = odometers[k] + track.margin - moved;
                continue;
            }
            let course = motion.course_from(carrier);
            let speed = course.speed(&Vector3::zeros(), track.reach);
            let (least, most) = tuning::MARGIN;
            let size = track.bounding_radius;
            let margin = (speed * tuning::HORIZON).clamp(least * size, most * size);
            track.known = now.ahead(&course, speed, margin);
            track.margin = margin - tuning::ROUNDING;
            let pose = pose(&track.known);
            self.bodies[*body].set_position(pose, false);
            let bounds = self.colliders[*collider].shape().compute_aabb(&pose).loosened(margin as f32);
            self.boxes.put(k as u32, bounds);
            let moved = now.moved_since(&track.known, track.reach);
            self.marks[k] = odometers[k] + track.margin - moved;
        }
        if self.boxes.unchanged() {
            return NearChanges::default();
        }
        for (handle, motion) in self.surfaces.iter().zip(surfaces) {
            self.bodies[*handle].set_position(pose(&motion.seen_from(carrier)), false);
        }
        let tracks = &self.tracks;
        let may_touch = |a: u32, b: u32| tracks[a as usize].may_touch(&tracks[b as usize]);
        let NearChanges { parted, met } = self.boxes.changes(may_touch);
        for (a, b) in met {
            self.hooks.met(&context(&self.bodies, &self.colliders, self.pair(a, b)));
        }
        NearChanges { parted, met: self.hooks.take() }
    }

    /// The tablets in an order in which near ones follow each other: all that a search has seen.
    pub fn by_place(&self) -> Vec<u32> {
        self.boxes.by_place()
    }

    /// Numbers the tablets anew, those whose numbers were `order` from 0 on; no two count as near each other until the
    /// next search.
    pub fn renumber(&mut self, order: &[u32]) {
        reorder(&mut self.tablets, order);
        reorder(&mut self.tracks, order);
        for (number, (body, _)) in self.tablets.iter().enumerate() {
            self.bodies[*body].user_data = number as u128;
        }
        self.forget();
    }

    /// No two tablets count as near each other until the next search, which looks at all of them.
    pub fn forget(&mut self) {
        self.tracks.iter_mut().for_each(|track| track.known = Relative::NOWHERE);
        self.marks.fill(f64::NEG_INFINITY);
        self.boxes = Boxes::default();
    }

    fn pair(&self, a: u32, b: u32) -> ColliderPair {
        ColliderPair::new(self.tablets[a as usize].1, self.tablets[b as usize].1)
    }
}

/// Brings items into the order of numbers that they have now.
pub fn reorder<T: Clone>(items: &mut Vec<T>, order: &[u32]) {
    *items = order.iter().map(|number| items[*number as usize].clone()).collect();
}

fn to_f32(v: &Vector3<f64>) -> Vec3 {
    Vec3::new(v.x as f32, v.y as f32, v.z as f32)
}

fn pose(seen: &Relative) -> Pose {
    let q = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(seen.rotation));
    let rotation = Rotation::from_xyzw(q.i as f32, q.j as f32, q.k as f32, q.w as f32);
    Pose::from_parts(to_f32(&seen.position), rotation)
}
