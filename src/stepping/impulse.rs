//! Steps by Rapier's own solver.

use super::body::Body;
use crate::world::{ImpulseWorld, Motion};
use nalgebra::Vector3;

/// One step of `dt`, s, to the end of which the surfaces are at `surfaces`. Returns the torque of the drive about z, N m:
/// what the angular momentum of the bodies gains beyond what gravity gives.
pub(super) fn step(
    world: &mut ImpulseWorld,
    surfaces: &[Motion],
    bodies: &mut [Body],
    motions: &mut [Motion],
    gravity: &Vector3<f64>,
    dt: f64,
) -> f64 {
    let angular = |bodies: &[Body], motions: &[Motion]| -> f64 {
        let momentum = |(b, m): (&Body, &Motion)| b.mass * m.position.cross(&m.velocity).z + b.momentum.z;
        bodies.iter().zip(motions).map(momentum).sum()
    };
    let before = angular(bodies, motions);
    world.step(surfaces, dt);
    for ((body, motion), (orientation, now)) in bodies.iter_mut().zip(&mut *motions).zip(world.motions()) {
        (body.orientation, body.velocity, *motion) = (orientation, now.velocity, now);
        body.momentum = now.rotation * now.rotation.tr_mul(&now.spin).component_div(&body.inverse_inertia);
    }
    let weight = |(b, m): (&Body, &Motion)| b.mass * m.position.cross(gravity).z;
    let weight: f64 = bodies.iter().zip(&*motions).map(weight).sum();
    (angular(bodies, motions) - before) / dt - weight
}
