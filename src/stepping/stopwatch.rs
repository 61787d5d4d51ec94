//! Where the run time goes.

use std::time::{Duration, Instant};

/// Parts of the work whose time is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Moving and kicking bodies.
    Motion,
    /// Search for near bodies.
    Search,
    /// Contact lists and forces.
    Contact,
    /// Observers, which work beside the other phases where there is a second thread.
    Observers,
}

/// Wall time per phase.
#[derive(Debug, Clone)]
pub struct Stopwatch {
    last: Instant,
    spent: [Duration; 4],
}

impl Default for Stopwatch {
    fn default() -> Self {
        Self { last: Instant::now(), spent: [Duration::ZERO; 4] }
    }
}

impl Stopwatch {
    /// Restarts the running interval without counting it.
    pub(super) fn skip(&mut self) {
        self.last = Instant::now();
    }

    /// Counts the time since the last call for `phase`.
    #[inline]
    pub(super) fn lap(&mut self, phase: Phase) {
        let now = Instant::now();
        self.spent[phase as usize] += now - self.last;
        self.last = now;
    }

    /// Counts `time` of what was counted for `whole` for its part `part` instead.
    #[inline]
    pub(super) fn split(&mut self, whole: Phase, part: Phase, time: Duration) {
        self.spent[whole as usize] = self.spent[whole as usize].saturating_sub(time);
        self.spent[part as usize] += time;
    }

    /// Counts `time` for `phase` in place of the running interval, which restarts.
    pub(super) fn put(&mut self, phase: Phase, time: Duration) {
        self.spent[phase as usize] += time;
        self.skip();
    }

    /// Seconds per phase, by name.
    pub fn seconds(&self) -> [(&'static str, f64); 4] {
        let s = self.spent.map(|d| d.as_secs_f64());
        [("motion", s[0]), ("near_search", s[1]), ("contact", s[2]), ("observers", s[3])]
    }
}
