//! Many contacts worked out side by side.
//!
//! Lists hand in what touches, two bodies at a time; [`Batch::work_out`] turns eight contacts at once into forces, in
//! loops that a compiler turns into the widest vector instructions of the machine. Every contact is computed by the same
//! operations in the same order whatever stands beside it, so that results do not depend on the vectors' width.
//!
//! A contact has one common point for both bodies, so that angular momentum is conserved to round-off.

use super::block::{Block, Entries};
use super::energy::Press;
use super::frames::{Four, Frame, less};
use super::lanes::{LANES, order};
use super::law::{Dashpots, PairLaw, Spring};
use super::side::{CROWD, DAMPED, Side, frequency};
use crate::scene::DampingMass;
use nalgebra::Vector3;
use pulp::Simd;
use std::ops::Range;

/// Contacts that are worked out together, those of the last two bodies beyond: what they need stays in the nearest memory.
const FULL: usize = 64;

/// Two spheres that touch, or a sphere and a surface.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place<'a> {
    /// From a's centre of mass to the centre of its sphere, world axes, m.
    pub arm: &'a Four,
    /// From there to the centre of b's sphere, or to the place of the surface that is nearest; distance at which they
    /// begin to touch, m.
    pub between: &'a Four,
    /// Radius of a's sphere, m.
    pub radius: f64,
    /// Curvature of the contact, 1/R*, 1/m.
    pub curvature: f64,
    /// Curvature of the smaller sphere, 1/m.
    pub sharpness: f64,
    pub spring: &'a Spring,
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

/// Two bodies whose contacts are in the batch: those from the end of the meeting before to `end`.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Meeting {
    bodies: (u32, u32),
    end: usize,
}

/// Before the first contact.
const NOBODY: Meeting = Meeting { bodies: (u32::MAX, u32::MAX), end: 0 };

/// Contacts of many bodies, all of one law.
#[derive(Debug, Clone, Default)]
pub(super) struct Batch {
    /// The first `len` are in use; places left over hold contacts of the past.
    entries: Vec<Entries>,
    blocks: Vec<Block>,
    len: usize,
    /// Index of the law.
    law: usize,
    /// [`NOBODY`], then `met` meetings.
    meetings: Vec<Meeting>,
    met: usize,
}

/// How the contacts of a batch are worked out.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rule<'a> {
    pub laws: &'a [PairLaw],
    pub damping: DampingMass,
    /// Part of the overlap by which the contact point lies inside a's sphere: half for two spheres that share it; none
    /// at a surface, which has no centre to share it with.
    pub inside: f64,
    /// Step, s.
    pub dt: f64,
    /// Whether to keep what single contacts come to.
    pub keep_contacts: bool,
}

impl Batch {
    /// Forgets all contacts.
    pub(super) fn clear(&mut self) {
        self.meetings.clear();
        self.meetings.push(NOBODY);
        (self.len, self.law, self.met) = (0, 0, 0);
    }

    /// Whether the batch must be worked out before it takes contacts of these bodies, whose law has the index `law`.
    #[inline(always)]
    pub(super) fn is_full(&self, bodies: (u32, u32), law: usize) -> bool {
        (law != self.law && self.len > 0) || (self.len >= FULL && self.meetings[self.met].bodies != bodies)
    }

    /// Takes a contact; those of the same two bodies come one after the other. `law` is the index of their law.
    #[inline(always)]
    pub(super) fn take(
        &mut self,
        bodies: (u32, u32),
        law: usize,
        place: &Place<'_>,
        (a, b): (&Frame, &Frame),
    ) {
        let (at, k) = (self.len / LANES, self.len % LANES);
        if at == self.blocks.len() {
            self.blocks.push(Block::default());
            self.entries.push(Entries::default());
        }
        let entries = &mut self.entries[at];
        entries.arm[k] = *place.arm;
        entries.between[k] = *place.between;
        entries.traits[k] =
            [place.curvature, place.sharpness, a.inverse_mass() + b.inverse_mass(), place.radius];
        entries.offset[k] = a.to(b);
        entries.drift[k] = less(&b.velocity, &a.velocity);
        entries.turn[k] = less(&b.spin, &a.spin);
        entries.mean_drift[k] = less(&b.mean_velocity, &a.mean_velocity);
        entries.mean_turn[k] = less(&b.mean_spin, &a.mean_spin);
        entries.spin[k] = b.spin;
        entries.mean_spin[k] = b.mean_spin;
        entries.common_spin[k] = a.mean_spin_with(b);
        self.blocks[at].spring[k] = place.spring.to_row();
        self.len += 1;
        self.law = law;
        self.met += usize::from(self.meetings[self.met].bodies != bodies);
        let meeting = Meeting { bodies, end: self.len };
        if self.met == self.meetings.len() {
            self.meetings.push(meeting);
        }
        self.meetings[self.met] = meeting;
    }

    /// Forces of all contacts taken. `sides` are the two partners of a meeting.
    #[inline(always)]
    pub(super) fn work_out<'a, S: Simd>(
        &mut self,
        simd: S,
        rule: &Rule<'_>,
        sides: impl Fn((u32, u32)) -> (Side<'a>, Side<'a>),
    ) {
        let (law, order) = (&rule.laws[self.law], order(simd));
        let used = self.len.div_ceil(LANES);
        for (block, entries) in self.blocks[..used].iter_mut().zip(&self.entries) {
            block.place(simd, entries, law, rule.inside);
        }
        for (bodies, contacts) in meetings(&self.meetings) {
            if rule.damping == DampingMass::Contact || contacts.len() >= CROWD {
                tune_dashpots(&mut self.blocks, &order, contacts, &sides(bodies), law, rule);
            }
        }
        for block in &mut self.blocks[..self.len.div_ceil(LANES)] {
            block.press(simd, law, rule.dt);
        }
    }

    /// What was worked out, in the order in which it was taken; `offset` is the vector from a's centre of mass to b's, m.
    #[inline(always)]
    pub(super) fn exchanges(
        &self,
        offset: impl Fn((u32, u32)) -> Vector3<f64>,
    ) -> impl Iterator<Item = Exchange> {
        meetings(&self.meetings).map(move |((a, b), contacts)| {
            let count = contacts.len() as u32;
            let (mut force, mut torque, mut deepest) = ([0.0; 4], [0.0; 4], 0.0_f64);
            for (at, k) in contacts.map(row) {
                let block = &self.blocks[at];
                for j in 0..4 {
                    force[j] += block.force[k][j];
                    torque[j] += block.torque[k][j];
                }
                deepest = deepest.max(block.force[k][3]);
            }
            let [force, torque] = [force, torque].map(|[x, y, z, _]| Vector3::new(x, y, z));
            let torque_b = torque - offset((a, b)).cross(&force);
            Exchange { a, b, contacts: count, deepest, force, torque_a: -torque, torque_b }
        })
    }

    /// The springs, in the order in which the contacts were taken.
    #[inline(always)]
    pub(super) fn springs(&self) -> impl Iterator<Item = Spring> {
        (0..self.len).map(row).map(|(at, k)| Spring::from_row(self.blocks[at].spring[k]))
    }

    /// What the contacts worked out last came to, in the order in which they were taken.
    pub(super) fn presses<S: Simd>(&self, simd: S, rule: &Rule<'_>) -> impl Iterator<Item = Press> {
        let (order, law) = (order(simd), &rule.laws[self.law]);
        let press =
            move |(at, k): (usize, usize)| self.blocks[at].pressed((k, order[k]), self.law, law, rule.dt);
        (0..self.len).map(row).map(press)
    }
}

/// Block and row of a contact.
#[inline(always)]
fn row(contact: usize) -> (usize, usize) {
    (contact / LANES, contact % LANES)
}

/// The bodies of each meeting, and their contacts.
#[inline(always)]
fn meetings(meetings: &[Meeting]) -> impl Iterator<Item = ((u32, u32), Range<usize>)> {
    meetings.windows(2).map(|pair| (pair[1].bodies, pair[0].end..pair[1].end))
}

/// Dashpots of two bodies' `contacts` that take more into account than each its own contact.
#[inline]
fn tune_dashpots(
    blocks: &mut [Block],
    order: &[usize; LANES],
    contacts: Range<usize>,
    sides: &(Side<'_>, Side<'_>),
    law: &PairLaw,
    rule: &Rule<'_>,
) {
    let (a, b) = sides;
    let lanes = contacts.clone().map(row).map(|(at, k)| (at, order[k]));
    if rule.damping == DampingMass::Contact {
        let offset = b.motion.position - a.motion.position;
        let felt = lanes.clone().map(|(at, k)| blocks[at].felt(k, &offset));
        if let Some(omega) = frequency(felt, sides, law) {
            for (at, k) in lanes.clone() {
                let Dashpots { normal, tangential } = law.dashpots_at(blocks[at].contact_radius[k], omega);
                (blocks[at].dashpot[0][k], blocks[at].dashpot[1][k]) = (normal, tangential);
            }
        }
    }
    if contacts.len() >= CROWD {
        let all: f64 = lanes.clone().map(|(at, k)| blocks[at].dashpot[0][k]).sum();
        let share = (DAMPED / (rule.dt * (a.softness + b.softness) * all)).min(1.0);
        for (at, k) in lanes {
            blocks[at].dashpot[0][k] *= share;
            blocks[at].dashpot[1][k] *= share;
        }
    }
}
