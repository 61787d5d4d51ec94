//! Many contacts worked out side by side.
//!
//! Lists hand in what touches, two bodies at a time; [`Batch::work_out`] turns eight contacts at once into forces, in
//! loops that a compiler turns into the widest vector instructions of the machine. Every contact is computed by the same
//! operations in the same order whatever stands beside it, so that results do not depend on the vectors' width.
//!
//! A contact has one common point for both bodies, so that angular momentum is conserved to round-off.

use super::block::{Block, EMPTY, LANES, get, set};
use super::energy::Press;
use super::law::{Dashpots, PairLaw, Spring};
use super::side::{CROWD, DAMPED, Side, frequency};
use crate::scene::DampingMass;
use nalgebra::Vector3;

/// Two spheres that touch, or a sphere and a surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    /// From a's centre of mass to the centre of its sphere, world axes, m.
    pub arm: Vector3<f64>,
    /// From there to the centre of b's sphere, or to the place of the surface that is nearest, m; never zero.
    pub between: Vector3<f64>,
    /// Distance at which they begin to touch, m.
    pub reach: f64,
    /// Radius of a's sphere, m.
    pub radius: f64,
    /// Curvature of the contact, 1/R*, 1/m.
    pub curvature: f64,
    /// Curvature of the smaller sphere, 1/m.
    pub sharpness: f64,
    pub spring: Spring,
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
    /// Force on b; a feels the opposite, N.
    pub force: Vector3<f64>,
    /// Torque on a about its centre of mass, N m.
    pub torque_a: Vector3<f64>,
    /// Torque on b about its centre of mass (a surface: about its origin), N m.
    pub torque_b: Vector3<f64>,
}

/// Two bodies whose contacts are in the batch.
#[derive(Debug, Clone, Copy)]
struct Meeting {
    a: u32,
    b: u32,
    /// Where their springs belong.
    list: usize,
    first: usize,
    count: usize,
    /// From a's centre of mass to b's, m.
    offset: Vector3<f64>,
}

/// What the contacts of two bodies have in common.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shared {
    law: usize,
    /// Reduced mass, kg.
    mass: f64,
    /// Velocity of b against a at the contact point is `drift + turn × arm`.
    drift: Vector3<f64>,
    turn: Vector3<f64>,
    /// Mean spin of the two bodies.
    spin: Vector3<f64>,
}

/// Contacts of many bodies, in blocks of one law each.
#[derive(Debug, Clone, Default)]
pub(super) struct Batch {
    blocks: Vec<Block>,
    /// How many of the blocks are in use: the others, and lanes left over, hold contacts of the past.
    used: usize,
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
        self.used = 0;
        self.len = 0;
    }

    /// Contacts so far.
    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// Begins the contacts of two bodies; `list` is where their springs belong, `law` the index of their law.
    #[inline(always)]
    pub(super) fn meet(
        &mut self,
        (a, b): (u32, u32),
        list: usize,
        law: usize,
        (side_a, side_b): (&Side<'_>, &Side<'_>),
    ) -> Shared {
        if self.used > 0 && self.blocks[self.used - 1].law != law {
            self.len = self.used * LANES;
        }
        let (ma, mb) = (side_a.motion, side_b.motion);
        let offset = mb.position - ma.position;
        self.meetings.push(Meeting { a, b, list, first: self.len, count: 0, offset });
        Shared {
            law,
            mass: 1.0 / (side_a.inverse_mass + side_b.inverse_mass),
            drift: mb.velocity - ma.velocity - mb.spin.cross(&offset),
            turn: mb.spin - ma.spin,
            spin: (ma.spin + mb.spin) * 0.5,
        }
    }

    /// Takes a contact of the two bodies that met last.
    #[inline(always)]
    pub(super) fn take(&mut self, shared: &Shared, place: &Place) {
        let (at, k) = (self.len / LANES, self.len % LANES);
        if at == self.used {
            if at == self.blocks.len() {
                self.blocks.push(EMPTY);
            }
            self.blocks[at].law = shared.law;
            self.used += 1;
        }
        let block = &mut self.blocks[at];
        set(&mut block.arm, k, &place.arm);
        set(&mut block.between, k, &place.between);
        block.reach[k] = place.reach;
        block.radius[k] = place.radius;
        block.curvature[k] = place.curvature;
        block.sharpness[k] = place.sharpness;
        block.mass[k] = shared.mass;
        set(&mut block.drift, k, &shared.drift);
        set(&mut block.turn, k, &shared.turn);
        set(&mut block.spin, k, &shared.spin);
        set(&mut block.stretch, k, &place.spring.stretch);
        block.stretch_radius[k] = place.spring.radius;
        self.len += 1;
        if let Some(meeting) = self.meetings.last_mut() {
            meeting.count += 1;
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
        let blocks = &mut self.blocks[..self.used];
        for block in blocks.iter_mut() {
            block.place(&laws[block.law], rule);
        }
        for meeting in &self.meetings {
            if rule.damping == DampingMass::Contact || meeting.count >= CROWD {
                meeting.tune_dashpots(blocks, laws, rule, &sides);
            }
        }
        for block in blocks.iter_mut() {
            block.press(&laws[block.law], rule.dt);
        }
    }

    /// What was worked out, in the order in which it was taken: what two bodies do to each other, the list their springs
    /// belong to, and the springs.
    #[inline(always)]
    pub(super) fn outcome(&self) -> impl Iterator<Item = (Exchange, usize, impl Iterator<Item = Spring>)> {
        self.meetings.iter().map(|meeting| {
            let springs = meeting.lanes().map(|(at, k)| self.blocks[at].spring(k));
            (meeting.exchange(&self.blocks), meeting.list, springs)
        })
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
    fn tune_dashpots<'a>(
        &self,
        blocks: &mut [Block],
        laws: &[PairLaw],
        rule: &Rule,
        sides: &impl Fn(u32, u32) -> (Side<'a>, Side<'a>),
    ) {
        let law = &laws[blocks[self.first / LANES].law];
        if rule.damping == DampingMass::Contact {
            let felt = self.lanes().map(|(at, k)| blocks[at].felt(k, &self.offset));
            if let Some(omega) = frequency(felt, &sides(self.a, self.b), law) {
                for (at, k) in self.lanes() {
                    let Dashpots { normal, tangential } =
                        law.dashpots_at(blocks[at].contact_radius[k], omega, rule.dt);
                    (blocks[at].dashpot[0][k], blocks[at].dashpot[1][k]) = (normal, tangential);
                }
            }
        }
        if self.count >= CROWD {
            let all: f64 = self.lanes().map(|(at, k)| blocks[at].dashpot[0][k]).sum();
            let (a, b) = sides(self.a, self.b);
            let share = (DAMPED / (rule.dt * (a.softness + b.softness) * all)).min(1.0);
            for (at, k) in self.lanes() {
                blocks[at].dashpot[0][k] *= share;
                blocks[at].dashpot[1][k] *= share;
            }
        }
    }

    #[inline(always)]
    fn exchange(&self, blocks: &[Block]) -> Exchange {
        let (mut force, mut torque, mut deepest) = (Vector3::zeros(), Vector3::zeros(), 0.0_f64);
        for (at, k) in self.lanes() {
            let block = &blocks[at];
            force += get(&block.force, k);
            torque += get(&block.torque, k);
            deepest = deepest.max(block.overlap[k] * block.sharpness[k]);
        }
        Exchange {
            a: self.a,
            b: self.b,
            contacts: self.count as u32,
            deepest,
            force,
            torque_a: -torque,
            torque_b: torque - self.offset.cross(&force),
        }
    }
}
