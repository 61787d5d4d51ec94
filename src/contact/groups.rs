//! Near pairs in groups: what one task works on lies together, and a search changes few of them.

use super::body::Outline;
use super::links::{Cursor, Links};
use super::pairs::Pair;
use super::tasks::Findings;

/// Bodies whose pairs with later bodies make a group, in small beds.
const FEWEST: u32 = 16;
/// As many in large beds: near bodies, which follow each other there, come from memory once for more of their pairs.
const MOST: u32 = 64;
/// Groups of a bed between the two: enough to share among threads.
const GROUPS: u32 = 64;

/// The pairs (a, b) of some bodies a.
#[derive(Debug, Clone, Default)]
pub(super) struct Group {
    /// In order; those of two single spheres are left out.
    pub pairs: Vec<Pair>,
    /// Spheres of the pairs that may touch, in order.
    pub links: Links,
    pub findings: Findings,
}

/// The groups of all bodies. What they compute does not depend on how large they are.
#[derive(Debug, Clone, Default)]
pub(super) struct Groups {
    /// Bodies to each.
    bodies: u32,
    pub all: Vec<Group>,
}

/// Bodies to each group of a bed of `count`.
fn share(count: usize) -> u32 {
    (count as u32).div_ceil(GROUPS).clamp(FEWEST, MOST)
}

impl Groups {
    /// Takes the pairs `parted` from the groups, and adds those that `met`; each of the `count` bodies has an `outline`. Two
    /// single spheres need no list: their one link is there as long as they are near each other.
    pub(super) fn change<'a>(
        &mut self,
        parted: &[(u32, u32)],
        met: &[(u32, u32)],
        count: usize,
        outline: impl Fn(u32) -> &'a Outline,
    ) {
        let Self { bodies, all } = self;
        if all.is_empty() {
            *bodies = share(count);
        }
        let group = |a: u32| (a / *bodies) as usize;
        if let Some(last) = met.iter().map(|(a, _)| group(*a)).max() {
            all.resize(all.len().max(last + 1), Group::default());
        }
        for parted in parted.chunk_by(|x, y| group(x.0) == group(y.0)) {
            if let Some(group) = all.get_mut(group(parted[0].0)) {
                for key in parted {
                    if let Ok(at) = group.pairs.binary_search_by_key(key, Pair::key) {
                        group.pairs.remove(at);
                    }
                    group.links.remove(*key);
                }
            }
        }
        let mut links = Vec::new();
        for met in met.chunk_by(|x, y| group(x.0) == group(y.0)) {
            let group = &mut all[group(met[0].0)];
            let mut cursor = Cursor::default();
            for key in met {
                let outlines = [outline(key.0), outline(key.1)];
                if outlines.iter().all(|outline| outline.balls.len() == 1) {
                    group.links.replace(&mut cursor, *key, outlines, &[(0, 0)], &mut links);
                } else if let Err(at) = group.pairs.binary_search_by_key(key, Pair::key) {
                    group.pairs.insert(at, Pair::new(*key));
                }
            }
        }
    }

    /// The groups when bodies have other `numbers`, by which near ones follow each other: of the pairs only what touches is left.
    pub(super) fn renumber(&mut self, numbers: &[u32]) {
        let touching = self.all.iter().flat_map(|group| group.links.touching());
        let mut touching: Vec<_> = touching.map(|grasp| grasp.renumbered(numbers)).collect();
        touching.sort_unstable_by_key(|grasp| (grasp.bodies, grasp.balls));
        self.bodies = share(numbers.len());
        self.all = vec![Group::default(); numbers.len().div_ceil(self.bodies as usize)];
        let group = |(a, _): (u32, u32)| (a / self.bodies) as usize;
        for touching in touching.chunk_by(|x, y| group(x.bodies) == group(y.bodies)) {
            self.all[group(touching[0].bodies)].links = Links::of(touching);
        }
    }
}
