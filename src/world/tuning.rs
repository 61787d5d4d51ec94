//! Every engine parameter we set: unit, reason, what breaks.

/// Length unit given to Rapier, m. Its margins are multiples of it and its default, 1 m, would pair every tablet with
/// every other. Smaller values make its fat boxes tighter and pairs change more often.
pub(super) const LENGTH_UNIT: f32 = 0.01;

/// Time that a body's margin should last at its present speed against the carrier, s: the box of a fast body is widened
/// more, so that all bodies need the next search at about the same time. Larger values give more pairs to watch, smaller
/// ones more searches.
pub(super) const HORIZON: f64 = 5e-3;

/// Least and most margin of a body, as a share of its bounding radius.
pub(super) const MARGIN: (f64, f64) = (0.05, 1.0);

/// Bodies that have used this share of their margin are searched together with those that have used it all.
pub(super) const EARLY: f64 = 0.4;

/// A body that has used this share of its margin calls for a search: what is left would not be worth a look at every
/// step.
pub(super) const SPENT: f64 = 0.95;

/// Odometers run this much fast: what a step's chord leaves of the arc, rounding included.
pub(super) const SAFETY: f64 = 1.01;

/// Subtracted from every allowed motion, m: f32 positions near 1 m are exact to 6e-8 m.
pub(super) const ROUNDING: f64 = 1e-6;
