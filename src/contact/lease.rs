//! How long a list of what is near stays complete.

use crate::world::Relative;
use nalgebra::Vector3;

/// What a list is good for: while the one body has moved by less than `allowance`, seen from the other, nothing unlisted
/// touches.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lease {
    /// The one body's pose seen from the other when the list was made.
    pub at: Relative,
    /// The body's point whose way counts, its own axes, m.
    pub about: Vector3<f64>,
    /// Way of points that far from it, when the body turns, counts too, m.
    pub lever: f64,
    /// m.
    pub allowance: f64,
}

/// A list is made anew when less than this share of its allowance is left: a little left would call for a look at
/// every step.
const WORN: f64 = 0.3;

impl Lease {
    /// No list.
    pub(super) const NONE: Self =
        Self { at: Relative::NOWHERE, about: Vector3::new(0.0, 0.0, 0.0), lever: 0.0, allowance: 0.0 };

    /// Allowance that is left, m.
    #[inline]
    pub(super) fn left(&self, now: &Relative) -> f64 {
        self.allowance - now.moved_since(&self.at, &self.about, self.lever)
    }

    /// Whether a list with `left` m of its allowance goes on.
    #[inline]
    pub(super) fn holds(&self, left: f64) -> bool {
        left > WORN * self.allowance
    }
}
