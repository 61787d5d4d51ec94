//! Every sphere contact as Rapier's own narrow phase finds it: what our lists are checked against in tests.

use super::hooks::SURFACE;
use super::{Motion, pose, to_f32, tuning};
use crate::shapes::{Clump, SurfaceMesh};
use rapier3d::prelude::*;
use std::sync::Mutex;

/// A contact: bodies, their spheres, and the overlap, m. `b` is `None` for the surface, whose part is a facet.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Found {
    pub(crate) a: usize,
    pub(crate) b: Option<usize>,
    pub(crate) parts: (u32, u32),
    pub(crate) overlap: f64,
}

/// Notes what touches and leaves nothing to solve.
#[derive(Default)]
struct Harvest(Mutex<Vec<Found>>);

impl PhysicsHooks for Harvest {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext<'_>) {
        let name = |body: Option<RigidBodyHandle>| context.bodies[body.expect("has a body")].user_data;
        let names = (name(context.rigid_body1), name(context.rigid_body2));
        let contacts = context.rigid_mut().expect("no soft bodies");
        let manifold = contacts.manifold;
        let (mut names, mut parts) = (names, (manifold.subshape1, manifold.subshape2));
        if names.0 > names.1 {
            (names, parts) = ((names.1, names.0), (parts.1, parts.0));
        }
        let b = (names.1 != SURFACE).then_some(names.1 as usize);
        for point in manifold.points.iter().filter(|point| point.dist <= 0.0) {
            let found = Found { a: names.0 as usize, b, parts, overlap: -f64::from(point.dist) };
            self.0.lock().expect("no hook panics").push(found);
        }
        contacts.solver_contacts.clear();
    }
}

/// The contacts of clumps at their poses, and with a surface in its own axes.
pub(crate) fn harvest(clumps: &[(&Clump, Motion)], surface: &SurfaceMesh) -> Vec<Found> {
    let (mut bodies, mut colliders) = (RigidBodySet::new(), ColliderSet::new());
    let vertices = surface.vertices.iter().map(to_f32).collect();
    let mesh = SharedShape::trimesh(vertices, surface.triangles.clone()).expect("has triangles");
    let parent = bodies.insert(RigidBodyBuilder::kinematic_position_based().user_data(SURFACE));
    colliders.insert_with_parent(ColliderBuilder::new(mesh), parent, &mut bodies);
    for (k, (clump, motion)) in clumps.iter().enumerate() {
        let ball = |s: &crate::shapes::Sphere| {
            (Pose::from_translation(to_f32(&s.center)), SharedShape::ball(s.radius as f32))
        };
        let body = RigidBodyBuilder::dynamic().pose(pose(&motion.seen_from(&Motion::at_rest())));
        let parent = bodies.insert(body.user_data(k as u128));
        let balls = SharedShape::compound(clump.spheres.iter().map(ball).collect());
        let collider = ColliderBuilder::new(balls).active_hooks(ActiveHooks::MODIFY_SOLVER_CONTACTS);
        colliders.insert_with_parent(collider, parent, &mut bodies);
    }
    let hooks = Harvest::default();
    PhysicsPipeline::new().step(
        Vec3::ZERO,
        &IntegrationParameters {
            dt: 0.0,
            length_unit: tuning::LENGTH_UNIT,
            contact_clustering: false,
            contact_recycling: false,
            ..IntegrationParameters::default()
        },
        &mut IslandManager::new(),
        &mut DefaultBroadPhase::new(),
        &mut NarrowPhase::new(),
        &mut bodies,
        &mut colliders,
        &mut ImpulseJointSet::new(),
        &mut MultibodyJointSet::new(),
        &mut SoftBodySet::new(),
        &mut CCDSolver::new(),
        &hooks,
        &(),
    );
    hooks.0.into_inner().expect("no hook panics")
}
