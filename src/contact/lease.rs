//! How long a list of what is near stays complete.

use crate::world::Relative;

/// What a list is good for: all that comes nearer than `allowance` to something at the pose `at` is in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lease {
    /// The one body's pose seen from the other when the list was made.
    pub at: Relative,
    /// Relative motion that cannot bring anything unlisted to touch, m.
    pub allowance: f64,
}

/// A list is made anew when less than this share of its allowance is left: a little left would call for a look at
/// every step.
const WORN: f64 = 0.3;

impl Lease {
    /// No list.
    pub(super) const NONE: Self = Self { at: Relative::NOWHERE, allowance: 0.0 };

    /// Allowance that is left, m, for bodies whose farthest sphere centre is at `reach`.
    #[inline]
    pub(super) fn left(&self, now: &Relative, reach: f64) -> f64 {
        self.allowance - now.moved_since(&self.at, reach)
    }

    /// Whether a list with `left` m of its allowance goes on.
    #[inline]
    pub(super) fn holds(&self, left: f64) -> bool {
        left > WORN * self.allowance
    }
}
