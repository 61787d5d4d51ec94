//! Every engine parameter we set: unit, reason, what breaks.

/// Length unit given to Rapier, m. Its margins are multiples of it and its default, 1 m, would pair every tablet with
/// every other. Smaller values make its fat boxes tighter and pairs change more often.
pub(super) const LENGTH_UNIT: f32 = 0.01;

/// Half of this is added to every box of the near-pair search, m, as a multiple of the largest bounding radius: bodies
/// may move that half before the search must run again. Measured on 770 tablets: 1 % of the step time at 0.25; larger
/// values give more pairs to watch, smaller ones more searches.
pub(super) const MARGIN: f64 = 0.25;

/// Bodies that have used this share of their margin are searched together with those that have used it all.
pub(super) const EARLY: f64 = 0.5;

/// Subtracted from every allowed motion, m: f32 positions near 1 m are exact to 6e-8 m.
pub(super) const ROUNDING: f64 = 1e-6;
