//! How contacts are taken away from Rapier's solver.

use rapier3d::prelude::*;
use std::sync::Mutex;

/// Takes every pair of near bodies out of Rapier's hands: the pair is noted for our own contact law, and answered with
/// `None`, so that Rapier neither computes nor solves anything for it.
///
/// **Threads**: Rapier may call it from several threads; the order of calls does not matter, pairs are sorted later.
#[derive(Default)]
pub(super) struct ContactHooks {
    near: Mutex<Vec<(u32, u32)>>,
}

/// `user_data` of Rapier bodies that are not tablets.
pub(super) const SURFACE: u128 = u128::MAX;

impl ContactHooks {
    /// The pairs seen since the last call, smaller index first, in any order.
    pub(super) fn take(&self) -> Vec<(u32, u32)> {
        std::mem::take(&mut *self.near.lock().expect("no hook panics"))
    }
}

impl PhysicsHooks for ContactHooks {
    fn filter_contact_pair(&self, context: &PairFilterContext<'_>) -> Option<SolverFlags> {
        let index = |handle: Option<RigidBodyHandle>| {
            handle.map(|h| context.bodies[h].user_data).filter(|data| *data != SURFACE)
        };
        if let (Some(a), Some(b)) = (index(context.rigid_body1), index(context.rigid_body2)) {
            let (a, b) = (a as u32, b as u32);
            self.near.lock().expect("no hook panics").push((a.min(b), a.max(b)));
        }
        None
    }
}
