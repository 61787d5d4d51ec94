//! Every engine parameter we set: unit, reason, what breaks.

/// Length unit given to Rapier, m. Its margins are multiples of it and its default, 1 m, would pair every tablet with
/// every other. Smaller values make its fat boxes tighter and pairs change more often.
pub(super) const LENGTH_UNIT: f32 = 0.01;

/// Time that a body's margin should last at its present speed against the carrier, s: the box of a fast body is widened
/// more. Larger values give more pairs to watch, smaller ones more boxes to put in anew.
pub(super) const HORIZON: f64 = 7e-3;

/// Least and most margin of a body, as a share of its bounding radius. A smaller least one puts the boxes of a
/// slow bed in anew more often.
pub(super) const MARGIN: (f64, f64) = (0.2, 1.0);

/// A body that has used this share of its margin gets a new box: what is left would not be worth a look at every step.
pub(super) const SPENT: f64 = 0.95;

/// Subtracted from every allowed motion, m: f32 positions near 1 m are exact to 6e-8 m.
pub(super) const ROUNDING: f64 = 1e-6;
