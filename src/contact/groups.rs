//! Near pairs in groups: what one task works on lies together, and a search changes few of them.

use super::body::Outline;
use super::links::{Cursor, Grasp, Links};
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

impl Groups {
    /// Makes groups for `count` bodies; those that there are stay.
    fn cover(&mut self, count: usize) {
        if self.all.is_empty() {
            self.bodies = (count as u32).div_ceil(GROUPS).clamp(FEWEST, MOST);
        }
        self.all.resize(count.div_ceil(self.bodies as usize), Group::default());
    }

    /// Tells the group of a body.
    fn group(&self) -> impl Fn(u32) -> usize + use<> {
        let bodies = self.bodies;
        move |body| (body / bodies) as usize
    }

    /// Takes the pairs `parted` from the groups, and adds those that `met`; each of the `count` bodies has an `outline`. Two
    /// single spheres need no list: their one link is there as long as they are near each other.
    pub(super) fn change<'a>(
        &mut self,
        parted: &[(u32, u32)],
        met: &[(u32, u32)],
        count: usize,
        outline: impl Fn(u32) -> &'a Outline,
    ) {
        self.cover(count);
        let group = self.group();
        for key in parted {
            let group = &mut self.all[group(key.0)];
            if let Ok(at) = group.pairs.binary_search_by_key(key, Pair::key) {
                group.pairs.remove(at);
            }
            group.links.remove(*key);
        }
        let mut links = Vec::new();
        for met in met.chunk_by(|x, y| group(x.0) == group(y.0)) {
            let group = &mut self.all[group(met[0].0)];
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
        let mut touching: Vec<_> = self.touching().map(|grasp| grasp.renumbered(numbers)).collect();
        touching.sort_unstable_by_key(|grasp| (grasp.bodies, grasp.balls));
        self.restore(&touching, numbers.len());
    }

    /// What touches, in order.
    pub(super) fn touching(&self) -> impl Iterator<Item = Grasp> {
        self.all.iter().flat_map(|group| group.links.touching())
    }

    /// Groups of `count` bodies, of whose pairs only what touches is there.
    pub(super) fn restore(&mut self, touching: &[Grasp], count: usize) {
        self.all.clear();
        self.cover(count);
        let group = self.group();
        for touching in touching.chunk_by(|x, y| group(x.bodies.0) == group(y.bodies.0)) {
            self.all[group(touching[0].bodies.0)].links = Links::of(touching);
        }
    }
}
