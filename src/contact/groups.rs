//! Near pairs in groups: what one task works on lies together, and a search changes few of them.

use super::body::Outline;
use super::links::{Cursor, Links};
use super::pairs::Pair;
use super::tasks::Findings;

/// Bodies whose pairs with later bodies make a group: a fixed number, so that results do not depend on the number of
/// threads.
const BODIES: u32 = 16;

/// The pairs (a, b) of some bodies a.
#[derive(Debug, Clone, Default)]
pub(super) struct Group {
    /// In order; those of two single spheres are left out.
    pub pairs: Vec<Pair>,
    /// Spheres of the pairs that may touch, in order.
    pub links: Links,
    pub findings: Findings,
}

/// The group of body `a`.
fn group(a: u32) -> usize {
    (a / BODIES) as usize
}

/// Takes the pairs `parted` from the groups, and adds those that `met`; bodies have an `outline`. Two single spheres need no
/// list: their one link is there as long as they are near each other.
pub(super) fn change<'a>(
    groups: &mut Vec<Group>,
    parted: &[(u32, u32)],
    met: &[(u32, u32)],
    outline: impl Fn(u32) -> &'a Outline,
) {
    if let Some(last) = met.iter().map(|(a, _)| group(*a)).max() {
        groups.resize(groups.len().max(last + 1), Group::default());
    }
    for parted in parted.chunk_by(|x, y| group(x.0) == group(y.0)) {
        if let Some(group) = groups.get_mut(group(parted[0].0)) {
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
        let group = &mut groups[group(met[0].0)];
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

/// The groups when bodies have other `numbers`: of the pairs only what touches is left.
pub(super) fn renumber(groups: &mut Vec<Group>, numbers: &[u32]) {
    let touching = groups.iter().flat_map(|group| group.links.touching());
    let mut touching: Vec<_> = touching.map(|grasp| grasp.renumbered(numbers)).collect();
    touching.sort_unstable_by_key(|grasp| (grasp.bodies, grasp.balls));
    *groups = vec![Group::default(); numbers.len().div_ceil(BODIES as usize)];
    for touching in touching.chunk_by(|x, y| group(x.bodies.0) == group(y.bodies.0)) {
        groups[group(touching[0].bodies.0)].links = Links::of(touching);
    }
}
