//! The sphere pairs of near bodies that may touch, in one sequence: read through once a step. Those that touch have a spring.

use super::batch::{Batch, Place};
use super::block::{LANES, Springs};
use super::law::Spring;
use super::pairs::Setting;
use std::ops::Range;

/// A sphere of body a and one of body b.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Link {
    pub a: u32,
    pub b: u32,
    /// Where the spheres stand in [`Setting::balls`].
    pub balls: (u32, u32),
    /// Where its spring stands in [`Links::springs`].
    spring: u32,
}

impl Link {
    /// The bodies.
    #[inline]
    pub(super) fn bodies(&self) -> (u32, u32) {
        (self.a, self.b)
    }

    /// The link with its spring when bodies have other numbers.
    pub(super) fn renumbered(self, spring: Spring, numbers: &[u32]) -> (Self, Spring) {
        let (a, b) = (numbers[self.a as usize], numbers[self.b as usize]);
        if a < b {
            return (Self { a, b, ..self }, spring);
        }
        let balls = (self.balls.1, self.balls.0);
        (Self { a: b, b: a, balls, ..self }, Spring { stretch: -spring.stretch, ..spring })
    }
}

/// The place in [`Links::springs`] of what does not touch.
const AT_REST: u32 = 0;

/// Where the links of two bodies are among sorted ones.
fn places_of(links: &[Link], bodies: (u32, u32)) -> Range<usize> {
    let first = links.partition_point(|link| link.bodies() < bodies);
    first..first + links[first..].iter().take_while(|link| link.bodies() == bodies).count()
}

/// The spring at a place.
#[inline(always)]
fn spring(springs: &[Springs], at: u32) -> Spring {
    springs[at as usize / LANES].get(at as usize % LANES)
}

/// The links of many bodies, sorted by bodies and spheres, and what springs they have.
#[derive(Debug, Clone)]
pub(super) struct Links {
    all: Vec<Link>,
    /// Eight at rest, then those of the links that touched in the last step, in their order.
    springs: Vec<Springs>,
}

impl Default for Links {
    fn default() -> Self {
        Self { all: Vec::new(), springs: vec![Springs::AT_REST] }
    }
}

impl Links {
    /// Links that touched in the last step, in order.
    pub(super) fn of(touching: &[(Link, Spring)]) -> Self {
        let mut links = Self::default();
        for (k, (link, spring)) in touching.iter().enumerate() {
            if k % LANES == 0 {
                links.springs.push(Springs::AT_REST);
            }
            links.springs[1 + k / LANES].set(k % LANES, spring);
            links.all.push(Link { spring: (LANES + k) as u32, ..*link });
        }
        links
    }

    /// Those that touched in the last step, with their springs.
    pub(super) fn touching(&self) -> impl Iterator<Item = (&Link, Spring)> {
        let touching = self.all.iter().filter(|link| link.spring != AT_REST);
        touching.map(|link| (link, spring(&self.springs, link.spring)))
    }

    /// Lets go of the links of two bodies.
    pub(super) fn remove(&mut self, bodies: (u32, u32)) {
        self.all.drain(places_of(&self.all, bodies));
    }
}

/// Where links are worked on.
#[derive(Debug, Default)]
pub(super) struct LinkDesk {
    pub links: Links,
    /// Memory for the next sequence.
    next: Vec<Link>,
    /// Those before this one are in `next`.
    passed: usize,
    /// What touches, by its place in the batch, and memory left over.
    touching: Vec<Touching>,
    /// The springs of the step before.
    former: Vec<Springs>,
}

/// Two spheres that touch.
#[derive(Debug, Clone, Copy)]
struct Touching {
    bodies: (u32, u32),
    /// Place of the spring of the last step.
    spring: u32,
}

impl Touching {
    /// A place left empty.
    const NOTHING: Self = Self { bodies: (u32::MAX, u32::MAX), spring: AT_REST };
}

impl LinkDesk {
    /// Puts new links of two bodies in the place of their old ones: spheres in order, bodies in order from call to call.
    /// [`LinkDesk::replaced`] must follow.
    ///
    /// `first` are the places of the bodies' first spheres in [`Setting::balls`].
    pub(super) fn replace(&mut self, (a, b): (u32, u32), first: (u32, u32), spheres: &[(u16, u16)]) {
        let left = &self.links.all[self.passed..];
        let places = places_of(left, (a, b));
        let old = &left[places.clone()];
        self.passed += places.end;
        self.next.extend_from_slice(&left[..places.start]);
        let mut old = old.iter().peekable();
        self.next.extend(spheres.iter().map(|&(i, j)| {
            let balls = (first.0 + u32::from(i), first.1 + u32::from(j));
            while old.next_if(|link| link.balls < balls).is_some() {}
            let known = old.next_if(|link| link.balls == balls);
            Link { a, b, balls, spring: known.map_or(AT_REST, |link| link.spring) }
        }));
    }

    /// Ends the replacing.
    pub(super) fn replaced(&mut self) {
        if self.passed > 0 || !self.next.is_empty() {
            self.next.extend_from_slice(&self.links.all[self.passed..]);
            std::mem::swap(&mut self.links.all, &mut self.next);
            self.next.clear();
            self.passed = 0;
        }
    }

    /// Finds what touches and puts it into an empty batch. No branch depends on the outcome: none could be foreseen.
    /// [`LinkDesk::keep`] must follow.
    #[inline(always)]
    pub(super) fn touch(&mut self, setting: &Setting<'_>, batch: &mut Batch) {
        let Setting { motions, balls, mixed, .. } = *setting;
        let links = &mut self.links.all[..];
        // Where the law changes a new block begins.
        let room = links.len() * if mixed { LANES } else { 1 };
        if self.touching.len() < room {
            self.touching.resize(room, Touching::NOTHING);
        }
        let touching = &mut self.touching[..];
        let blocks = batch.room(room);
        let (mut count, mut law) = (0_usize, None);
        for link in links {
            let (a, b) = (link.a as usize, link.b as usize);
            if mixed {
                let own = setting.law_of(a, b);
                if law.replace(own) != Some(own) {
                    let next = count.next_multiple_of(LANES);
                    touching[count..next].fill(Touching::NOTHING);
                    count = next;
                }
            }
            let (a, b) = (&motions[a], &motions[b]);
            let (ball_a, ball_b) = (&balls[link.balls.0 as usize], &balls[link.balls.1 as usize]);
            let arm = a.rotation * ball_a.center;
            let between = (b.position - a.position) + b.rotation * ball_b.center - arm;
            let reach = ball_a.radius + ball_b.radius;
            let touches = between.norm_squared() < reach * reach;
            touching[count] = Touching { bodies: link.bodies(), spring: link.spring };
            let place = Place { arm, between, radius: ball_a.radius, other: ball_b.radius };
            blocks[count / LANES].put(count % LANES, &place);
            link.spring = (LANES + count) as u32 * u32::from(touches);
            count += usize::from(touches);
        }
        batch.take(count);
        std::mem::swap(&mut self.links.springs, &mut self.former);
    }

    /// The next places from `first` to `end` of two bodies, and these.
    #[inline(always)]
    pub(super) fn meeting(&self, first: usize, end: usize) -> Option<(Range<usize>, (u32, u32))> {
        let empty = |touching: &&Touching| touching.bodies == Touching::NOTHING.bodies;
        let first = first + self.touching[first..end].iter().take_while(empty).count();
        let left = &self.touching[first..end];
        let met = left.first()?.bodies;
        let count = left.iter().take_while(|touching| touching.bodies == met).count();
        Some((first..first + count, met))
    }

    /// The springs of some places after the step before.
    #[inline(always)]
    pub(super) fn former(&self, places: Range<usize>) -> impl Iterator<Item = Spring> {
        self.touching[places].iter().map(|touching| spring(&self.former, touching.spring))
    }

    /// Takes the new springs of all contacts.
    #[inline(always)]
    pub(super) fn keep(&mut self, springs: impl Iterator<Item = Springs>) {
        self.links.springs.clear();
        self.links.springs.push(Springs::AT_REST);
        self.links.springs.extend(springs);
    }
}
