//! Many contacts worked out side by side.
//!
//! Lists hand in what touches, two bodies at a time; [`Batch::work_out`] turns eight contacts at once into forces, in
//! loops that a compiler turns into the widest vector instructions of the machine. Every contact is computed by the same
//! operations in the same order whatever stands beside it, so that results do not depend on the vectors' width.
//!
//! A contact has one common point for both bodies, so that angular momentum is conserved to round-off.

use super::block::{Block, EMPTY, LANES, Springs, get, set};
use super::body::Load;
use super::energy::Press;
use super::law::{Dashpots, PairLaw, Spring, brevity};
use super::side::{CROWD, DAMPED, Felt, Side, frequency};
use crate::scene::DampingMass;
use nalgebra::Vector3;
use std::ops::Range;

/// Two spheres that touch, or a sphere and a surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    /// From a's centre of mass to the centre of its sphere, world axes, m.
    pub arm: Vector3<f64>,
    /// From there to the centre of b's sphere, or to the place of the surface that is nearest, m.
    pub between: Vector3<f64>,
    /// Radius of a's sphere, m.
    pub radius: f64,
    /// Radius of b's sphere; 0 for a surface, m.
    pub other: f64,
}

/// What two bodies do to each other in a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Exchange {
    pub a: u32,
    /// A body or a surface.
    pub b: u32,
    /// Touching places.
    pub contacts: u32,
    /// Largest overlap over the smaller sphere's radius, dimensionless.
    pub deepest: f64,
    /// Of its contacts.
    pub load: Load,
    /// Force on b; a feels the opposite, N.
    pub force: Vector3<f64>,
    /// Torque on a about its centre of mass, N m.
    pub torque_a: Vector3<f64>,
    /// Torque on b about its centre of mass (a surface: about its origin), N m.
    pub torque_b: Vector3<f64>,
}

/// Two bodies whose contacts are in the batch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Meeting {
    a: u32,
    b: u32,
    /// Where their springs belong.
    list: usize,
    first: usize,
    count: usize,
    /// From a's centre of mass to b's, m.
    offset: Vector3<f64>,
}

/// Contacts of many bodies, in blocks of one law each.
#[derive(Debug, Clone, Default)]
pub(super) struct Batch {
    /// Blocks and lanes left over hold contacts of the past.
    blocks: Vec<Block>,
    /// Contacts so far; blocks that a law left unfilled count as full.
    len: usize,
    meetings: Vec<Meeting>,
}

/// How the contacts of a batch are worked out.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rule {
    pub damping: DampingMass,
    /// Part of the overlap by which the contact point lies inside a's sphere: half for two spheres that share it; none
    /// at a surface, which has no centre to share it with.
    pub inside: f64,
    /// Step, s.
    pub dt: f64,
}

impl Batch {
    /// Forgets all contacts.
    pub(super) fn clear(&mut self) {
        self.meetings.clear();
        self.len = 0;
    }

    /// Contacts so far.
    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// The blocks for as many as `count` contacts in all.
    pub(super) fn room(&mut self, count: usize) -> &mut [Block] {
        let blocks = count.div_ceil(LANES);
        if self.blocks.len() < blocks {
            self.blocks.resize(blocks, EMPTY);
        }
        &mut self.blocks
    }

    /// Says that there are `count` contacts in the blocks.
    pub(super) fn take(&mut self, count: usize) {
        self.len = count;
    }

    /// Adds contacts of a law, and returns their places.
    #[inline(always)]
    pub(super) fn add<'a>(
        &mut self,
        law: usize,
        places: impl ExactSizeIterator<Item = &'a Place>,
    ) -> Range<usize> {
        let mixed = self.len > 0 && self.blocks[(self.len - 1) / LANES].law != law;
        let first = if mixed { self.len.next_multiple_of(LANES) } else { self.len };
        let range = first..first + places.len();
        let blocks = self.room(range.end);
        for (k, place) in range.clone().zip(places) {
            blocks[k / LANES].put(k % LANES, place);
        }
        self.len = range.end;
        range
    }

    /// Says whose the contacts `places` are, and by which law and springs they act; `list` is where the springs belong.
    #[inline(always)]
    pub(super) fn meet(
        &mut self,
        (a, b): (u32, u32),
        list: usize,
        (places, springs): (Range<usize>, impl Iterator<Item = Spring>),
        law: usize,
        (side_a, side_b): (&Side<'_>, &Side<'_>),
    ) {
        let (ma, mb) = (side_a.motion, side_b.motion);
        let offset = mb.position - ma.position;
        let inverse_mass = side_a.inverse_mass + side_b.inverse_mass;
        let drag = side_a.drag + side_b.drag;
        // The velocity of b against a is `drift + turn × arm`.
        let drift = mb.velocity - ma.velocity - mb.spin.cross(&offset);
        let turn = mb.spin - ma.spin;
        let spin = (ma.spin + mb.spin) * 0.5;
        let (first, count) = (places.start, places.len());
        self.meetings.push(Meeting { a, b, list, first, count, offset });
        for (place, spring) in places.zip(springs) {
            let (block, k) = (&mut self.blocks[place / LANES], place % LANES);
            block.law = law;
            block.inverse_mass[k] = inverse_mass;
            block.drag[k] = drag;
            set(&mut block.drift, k, &drift);
            set(&mut block.turn, k, &turn);
            set(&mut block.spin, k, &spin);
            block.springs.set(k, &spring);
        }
    }

    /// Forces of all contacts taken. `sides` are the two partners of a meeting.
    #[inline(always)]
    pub(super) fn work_out<'a>(
        &mut self,
        laws: &[PairLaw],
        rule: &Rule,
        sides: impl Fn(u32, u32) -> (Side<'a>, Side<'a>),
    ) {
        let blocks = &mut self.blocks[..self.len.div_ceil(LANES)];
        for block in blocks.iter_mut() {
            block.place(laws[block.law], *rule);
        }
        for meeting in &self.meetings {
            if rule.damping == DampingMass::Contact || meeting.count >= CROWD {
                meeting.tune_dashpots(blocks, laws, rule, sides(meeting.a, meeting.b));
            }
        }
        for block in blocks.iter_mut() {
            block.press(&laws[block.law], rule.dt);
        }
    }

    /// Who met, in order; see [`Batch::exchange`].
    pub(super) fn meetings(&self) -> &[Meeting] {
        &self.meetings
    }

    /// What was worked out between two bodies.
    #[inline(always)]
    pub(super) fn exchange(&self, meeting: &Meeting, laws: &[PairLaw]) -> Exchange {
        meeting.exchange(&self.blocks, laws)
    }

    /// The springs between two bodies, and the list they belong to.
    pub(super) fn springs_of(&self, meeting: &Meeting) -> (usize, impl Iterator<Item = Spring>) {
        (meeting.list, meeting.lanes().map(|(at, k)| self.blocks[at].springs.get(k)))
    }

    /// The springs of all contacts, in blocks.
    pub(super) fn springs(&self) -> impl Iterator<Item = Springs> {
        self.blocks[..self.len.div_ceil(LANES)].iter().map(|block| block.springs)
    }

    /// What the contacts worked out last came to, in the order in which they were taken.
    pub(super) fn presses(&self, laws: &[PairLaw], dt: f64) -> impl Iterator<Item = Press> {
        let lanes = self.meetings.iter().flat_map(Meeting::lanes);
        lanes.map(move |(at, k)| self.blocks[at].pressed(k, laws, dt))
    }
}

impl Meeting {
    /// Block and lane of each of its contacts.
    fn lanes(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        (self.first..self.first + self.count).map(|k| (k / LANES, k % LANES))
    }

    /// Dashpots that take more into account than their own contact.
    #[inline]
    fn tune_dashpots(
        &self,
        blocks: &mut [Block],
        laws: &[PairLaw],
        rule: &Rule,
        sides: (Side<'_>, Side<'_>),
    ) {
        if rule.damping == DampingMass::Contact {
            let law = &laws[blocks[self.first / LANES].law];
            let felt = self.lanes().map(|(at, k)| blocks[at].felt(k, &self.offset));
            if let Some(omega) = frequency(felt, &sides, law) {
                for (at, k) in self.lanes() {
                    let Felt { speed, contact_radius, .. } = blocks[at].felt(k, &self.offset);
                    let Dashpots { normal, tangential } = law.dashpots_at(contact_radius, omega, rule.dt);
                    let brief = brevity(blocks[at].overlap[k], speed.abs() * rule.dt);
                    blocks[at].dashpot[0][k] = normal * brief;
                    blocks[at].dashpot[1][k] = tangential * brief;
                }
            }
        }
        if self.count >= CROWD {
            let all: f64 = self.lanes().map(|(at, k)| blocks[at].dashpot[0][k]).sum();
            let share = (DAMPED / (rule.dt * (sides.0.softness + sides.1.softness) * all)).min(1.0);
            for (at, k) in self.lanes() {
                blocks[at].dashpot[0][k] *= share;
                blocks[at].dashpot[1][k] *= share;
            }
        }
    }

    #[inline(always)]
    fn exchange(&self, blocks: &[Block], laws: &[PairLaw]) -> Exchange {
        let (mut force, mut torque) = (Vector3::zeros(), Vector3::zeros());
        let (mut deepest, mut damping, mut contact_radii) = (0.0_f64, 0.0, 0.0);
        for (at, k) in self.lanes() {
            let block = &blocks[at];
            force += get(&block.force, k);
            torque += get(&block.torque, k);
            deepest = deepest.max(block.depth[k]);
            damping += block.dashpot[0][k];
            contact_radii += block.contact_radius[k];
        }
        let stiffness = laws[blocks[self.first / LANES].law].normal_stiffness(contact_radii);
        Exchange {
            a: self.a,
            b: self.b,
            contacts: self.count as u32,
            deepest,
            load: Load { damping, stiffness },
            force,
            torque_a: -torque,
            torque_b: torque - self.offset.cross(&force),
        }
    }
}
