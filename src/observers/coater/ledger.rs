//! What has been counted: pixels of each panel, and those that missed the tablets.

use super::film::PanelIds;
use serde::{Deserialize, Serialize};

/// Counts summed over frames. In every frame they add up to the pixels of the raster.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct CoatLedger {
    /// Counts of every panel of every body, then of wall, end walls, baffles and nothing.
    counts: Vec<u64>,
    frames: u64,
}

/// Counts that hit no tablet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct SprayLoss {
    /// On the drum's wall.
    pub wall: u64,
    /// On the end walls.
    pub ends: u64,
    /// On baffles.
    pub baffles: u64,
    /// On nothing at all.
    pub empty: u64,
}

impl SprayLoss {
    /// All of it.
    pub fn total(&self) -> u64 {
        self.wall + self.ends + self.baffles + self.empty
    }
}

/// A body seen in a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Exposure {
    /// Its place in the frame's list of bodies.
    pub body: usize,
    /// How many counts it received in this frame.
    pub counts: u64,
}

impl CoatLedger {
    pub(super) fn new(ids: &PanelIds) -> Self {
        Self { counts: vec![0; ids.panels() as usize + PanelIds::OTHERS as usize], frames: 0 }
    }

    /// Adds what a nozzle sees, each pixel as often as its weight says, and to `exposed` the bodies seen.
    pub(super) fn add<'a>(
        &mut self,
        rows: impl Iterator<Item = &'a [u32]>,
        weights: Option<&[u32]>,
        ids: &PanelIds,
        exposed: &mut Vec<Exposure>,
    ) {
        let seen = rows.flatten().copied();
        match weights {
            None => self.add_weighted(seen.map(|id| (id, 1)), ids, exposed),
            Some(weights) => self.add_weighted(seen.zip(weights.iter().copied()), ids, exposed),
        }
    }

    fn add_weighted(
        &mut self,
        seen: impl Iterator<Item = (u32, u32)>,
        ids: &PanelIds,
        exposed: &mut Vec<Exposure>,
    ) {
        // Neighbouring pixels mostly show the same body: it is looked up when it changes.
        let (mut body, mut numbers, mut counts) = (None, 0..0, 0);
        for (id, weight) in seen {
            self.counts[id as usize] += u64::from(weight);
            if !numbers.contains(&id) {
                exposed.extend(body.map(|body| Exposure { body, counts }));
                counts = 0;
                body = ids.body(id);
                numbers = body.map_or(ids.panels()..u32::MAX, |body| ids.numbers(body));
            }
            counts += u64::from(weight);
        }
        exposed.extend(body.map(|body| Exposure { body, counts }));
    }

    /// Ends a frame: makes one of all entries of a body in `exposed`, in the order of the bodies.
    pub(super) fn end_frame(&mut self, exposed: &mut Vec<Exposure>) {
        exposed.sort_unstable_by_key(|exposure| exposure.body);
        exposed.dedup_by(|next, kept| {
            let same = next.body == kept.body;
            kept.counts += if same { next.counts } else { 0 };
            same
        });
        exposed.retain(|exposure| exposure.counts > 0);
        self.frames += 1;
    }

    /// Adds the counts of every number in so many frames.
    pub(super) fn add_frames(&mut self, counts: &[u64], frames: u64) {
        self.counts.iter_mut().zip(counts).for_each(|(sum, more)| *sum += more);
        self.frames += frames;
    }

    /// How many counts another tally of the same bed has elsewhere.
    pub(super) fn differs_by(&self, counts: &[u64]) -> u64 {
        self.counts.iter().zip(counts).map(|(a, b)| a.abs_diff(*b)).sum::<u64>().div_ceil(2)
    }

    /// Adds what another ledger of the same bed has counted.
    pub(super) fn merge(&mut self, other: &Self) {
        self.add_frames(&other.counts, other.frames);
    }

    /// How many frames have been sprayed.
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Counts of what is not a tablet.
    pub fn loss(&self) -> SprayLoss {
        let [.., wall, ends, baffles, empty] = self.counts[..] else {
            unreachable!("a ledger ends with these four")
        };
        SprayLoss { wall, ends, baffles, empty }
    }

    /// Counts of all panels, body after body.
    pub(super) fn counts(&self) -> &[u64] {
        &self.counts[..self.counts.len() - PanelIds::OTHERS as usize]
    }

    /// All counts, tablets or not.
    pub fn total(&self) -> u64 {
        self.counts.iter().sum()
    }
}
