//! How contacts are taken away from Rapier's solver.

use rapier3d::prelude::*;
use std::sync::Mutex;

/// Takes every pair of near bodies out of Rapier's hands: the pair is noted for our own contact law, and answered with
/// `None`, so that Rapier neither computes nor solves anything for it.
///
/// **Order**: pairs are noted in the order in which they are asked for, which is theirs.
#[derive(Default)]
pub(super) struct ContactHooks {
    near: Mutex<Vec<(u32, u32)>>,
}

/// `user_data` of Rapier bodies that are not tablets.
pub(super) const SURFACE: u128 = u128::MAX;

impl ContactHooks {
    /// Asks for two colliders whose boxes have met.
    pub(super) fn met(&self, context: &PairFilterContext<'_>) {
        let left_to_rapier = self.filter_contact_pair(context);
        debug_assert!(left_to_rapier.is_none());
    }

    /// The pairs seen since the last call, smaller index first.
    pub(super) fn take(&self) -> Vec<(u32, u32)> {
        std::mem::take(&mut *self.near.lock().expect("no hook panics"))
    }
}

/// Two colliders as hooks see them.
pub(super) fn context<'a>(
    bodies: &'a RigidBodySet,
    colliders: &'a ColliderSet,
    pair: ColliderPair,
) -> PairFilterContext<'a> {
    let parent = |collider: ColliderHandle| colliders.get(collider).and_then(Collider::parent);
    PairFilterContext {
        bodies,
        colliders,
        collider1: pair.collider1,
        collider2: pair.collider2,
        rigid_body1: parent(pair.collider1),
        rigid_body2: parent(pair.collider2),
    }
}

/// The tablets of a pair, smaller index first.
fn tablets(context: &PairFilterContext<'_>) -> Option<(u32, u32)> {
    let index = |handle: Option<RigidBodyHandle>| {
        handle.map(|h| context.bodies[h].user_data).filter(|data| *data != SURFACE).map(|data| data as u32)
    };
    let (a, b) = (index(context.rigid_body1)?, index(context.rigid_body2)?);
    Some((a.min(b), a.max(b)))
}

impl PhysicsHooks for ContactHooks {
    fn filter_contact_pair(&self, context: &PairFilterContext<'_>) -> Option<SolverFlags> {
        if let Some(pair) = tablets(context) {
            self.near.lock().expect("no hook panics").push(pair);
        }
        None
    }
}
