//! Which bodies are near each other, for the cost of those whose boxes change.

use super::NearChanges;
use rapier3d::parry::partitioning::Bvh;
use rapier3d::prelude::Aabb;

/// The boxes of bodies in Rapier's tree, and which of them are near each other.
#[derive(Clone, Default)]
pub(super) struct Boxes {
    tree: Bvh,
    /// Of each body the others that are near it, in any order.
    near: Vec<Vec<u32>>,
    /// Bodies whose boxes were put since the last call of [`Boxes::changes`].
    put: Vec<u32>,
}

impl Boxes {
    /// Gives a body a box in place of the one it has.
    pub(super) fn put(&mut self, body: u32, bounds: Aabb) {
        // A leaf put in anew finds the best place in the tree: one that changes where it is spoils the tree by and by.
        self.tree.remove(body);
        self.tree.insert(bounds, body);
        self.near.resize_with(self.near.len().max(body as usize + 1), Vec::new);
        self.put.push(body);
    }

    /// All bodies, near ones following each other.
    pub(super) fn by_place(&self) -> Vec<u32> {
        self.tree.leaves(|_| true).collect()
    }

    /// Whether no box was put since the last call of [`Boxes::changes`].
    pub(super) fn unchanged(&self) -> bool {
        self.put.is_empty()
    }

    /// Which pairs of bodies are near each other that were not when this was last called, and the other way round: their
    /// boxes overlap, and they `may_touch`. The cost is that of the boxes put since, however many others there are.
    pub(super) fn changes(&mut self, may_touch: impl Fn(u32, u32) -> bool) -> NearChanges {
        let mut changes = NearChanges::default();
        let mut found = Vec::new();
        for body in self.put.drain(..) {
            let leaf = self.tree.leaf_node(body).expect("its box was put");
            found.clear();
            let others = self.tree.leaves(|node| node.intersects(leaf));
            found.extend(others.filter(|other| *other != body && may_touch(body, *other)));
            let near = &self.near[body as usize];
            let pair = |other: &u32| (body.min(*other), body.max(*other));
            changes.parted.extend(near.iter().filter(|other| !found.contains(other)).map(pair));
            changes.met.extend(found.iter().filter(|other| !near.contains(other)).map(pair));
        }
        for pairs in [&mut changes.parted, &mut changes.met] {
            pairs.sort_unstable();
            pairs.dedup();
        }
        for &(a, b) in &changes.parted {
            self.near[a as usize].retain(|other| *other != b);
            self.near[b as usize].retain(|other| *other != a);
        }
        for &(a, b) in &changes.met {
            self.near[a as usize].push(b);
            self.near[b as usize].push(a);
        }
        changes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rapier3d::prelude::Vec3;
    use std::collections::{BTreeMap, BTreeSet};

    proptest! {
        #[test]
        fn the_changes_lead_to_all_boxes_that_overlap(
            rounds in prop::collection::vec(
                prop::collection::btree_map(0..40_u32, (prop::array::uniform3(-1.0..1.0_f32), 0.05..0.5_f32), 0..20),
                1..8,
            ),
        ) {
            let (mut boxes, mut bounds, mut near) = (Boxes::default(), BTreeMap::new(), BTreeSet::new());
            for round in rounds {
                for (body, (center, half)) in round {
                    let bound = Aabb::from_half_extents(Vec3::from_array(center), Vec3::splat(half));
                    boxes.put(body, bound);
                    bounds.insert(body, bound);
                }
                let changes = boxes.changes(|_, _| true);
                for pairs in [&changes.parted, &changes.met] {
                    prop_assert!(pairs.is_sorted_by(|x, y| x < y));
                }
                prop_assert!(changes.parted.iter().all(|pair| near.remove(pair)));
                prop_assert!(changes.met.iter().all(|pair| near.insert(*pair)));
                let pairs = bounds.keys().flat_map(|a| bounds.keys().map(move |b| (*a, *b)));
                let overlap = |(a, b): &(u32, u32)| a < b && {
                    let apart = |x: &Aabb, y: &Aabb| x.mins.cmpgt(y.maxs).any();
                    !apart(&bounds[a], &bounds[b]) && !apart(&bounds[b], &bounds[a])
                };
                prop_assert_eq!(&near, &pairs.filter(overlap).collect::<BTreeSet<_>>());
            }
        }
    }
}
