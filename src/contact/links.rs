//! The sphere pairs of near bodies that may touch, in one sequence: read through once a step. Those that touch have a spring.

use super::batch::Place;
use super::body::Ball;
use super::frames::{Four, add_less};
use super::law::Spring;
use super::pairs::Setting;
use nalgebra::Vector3;
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

    #[inline(always)]
    fn spheres<'a>(&self, setting: &Setting<'a>) -> (&'a Ball, &'a Ball) {
        (&setting.balls[self.balls.0 as usize], &setting.balls[self.balls.1 as usize])
    }
}

/// The place in [`Links::springs`] of what does not touch.
const AT_REST: u32 = 0;

/// The links of many bodies, sorted by bodies and spheres, and what springs they have.
#[derive(Debug, Clone)]
pub(super) struct Links {
    all: Vec<Link>,
    /// One at rest, then those of the links that touched in the last step, in their order.
    springs: Vec<Spring>,
}

impl Default for Links {
    fn default() -> Self {
        Self { all: Vec::new(), springs: vec![Spring::default()] }
    }
}

impl Links {
    /// Those that touched in the last step, with their springs.
    pub(super) fn touching(&self) -> impl Iterator<Item = (&Link, &Spring)> {
        let touching = self.all.iter().filter(|link| link.spring != AT_REST);
        touching.map(|link| (link, &self.springs[link.spring as usize]))
    }

    /// Keeps the links of those bodies that stay.
    pub(super) fn retain(&mut self, stays: impl Fn((u32, u32)) -> bool) {
        self.all.retain(|link| stays(link.bodies()));
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
    /// What touches, and memory left over.
    touching: Vec<Touching>,
    /// How many touch.
    found: usize,
    /// The springs of the step before.
    former: Vec<Spring>,
}

/// Two spheres that touch.
#[derive(Debug, Clone, Copy, Default)]
struct Touching {
    /// Place in the sequence.
    link: u32,
    /// Place of the spring of the last step.
    spring: u32,
    /// From a's centre of mass to the centre of its sphere, m.
    arm: Four,
    /// From there to the centre of b's sphere, m.
    between: Four,
}

impl LinkDesk {
    /// Puts new links of two bodies in the place of their old ones: spheres in order, bodies in order from call to call.
    /// [`LinkDesk::replaced`] must follow.
    ///
    /// `first` are the places of the bodies' first spheres in [`Setting::balls`].
    pub(super) fn replace(&mut self, (a, b): (u32, u32), first: (u32, u32), spheres: &[(u16, u16)]) {
        let left = &self.links.all[self.passed..];
        let (before, left) = left.split_at(left.partition_point(|link| link.bodies() < (a, b)));
        let old = &left[..left.iter().take_while(|link| link.bodies() == (a, b)).count()];
        self.passed += before.len() + old.len();
        self.next.extend_from_slice(before);
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

    /// Finds what touches. No branch depends on the outcome: none could be foreseen. [`LinkDesk::keep`] must follow for
    /// all that touch.
    #[inline(always)]
    pub(super) fn touch(&mut self, setting: &Setting<'_>) {
        let links = &mut self.links.all;
        if self.touching.len() < links.len() {
            self.touching.resize(links.len(), Touching::default());
        }
        let mut found = 0;
        for (k, link) in links.iter_mut().enumerate() {
            let (a, b) = (&setting.frames[link.a as usize], &setting.frames[link.b as usize]);
            let (ball_a, ball_b) = link.spheres(setting);
            let arm = a.turn(&ball_a.center);
            let between = add_less(&a.to(b), &b.turn(&ball_b.center), &arm);
            let [x, y, z, _] = between;
            let reach = ball_a.radius + ball_b.radius;
            let touches = x * x + y * y + z * z < reach * reach;
            self.touching[found] = Touching { link: k as u32, spring: link.spring, arm, between };
            found += usize::from(touches);
            link.spring = found as u32 * u32::from(touches);
        }
        self.found = found;
        std::mem::swap(&mut self.links.springs, &mut self.former);
        self.links.springs.clear();
        self.links.springs.push(Spring::default());
    }

    /// Number of spheres that touch.
    pub(super) fn touching(&self) -> usize {
        self.found
    }

    /// Those of the touching spheres from `first` on that are of the same two bodies, and the bodies.
    #[inline(always)]
    pub(super) fn meeting(&self, first: usize) -> (Range<usize>, (u32, u32)) {
        let bodies = |touching: &Touching| self.links.all[touching.link as usize].bodies();
        let met = bodies(&self.touching[first]);
        let count =
            self.touching[first..self.found].iter().take_while(|touching| bodies(touching) == met).count();
        (first..first + count, met)
    }

    /// Where the touching spheres number `k` are.
    #[inline(always)]
    pub(super) fn place(&self, k: usize, setting: &Setting<'_>) -> Place {
        let Touching { link, spring, arm: [ax, ay, az, _], between: [x, y, z, _] } = self.touching[k];
        let (ball_a, ball_b) = self.links.all[link as usize].spheres(setting);
        let between = Vector3::new(x, y, z);
        Place {
            arm: Vector3::new(ax, ay, az),
            between: if between == Vector3::zeros() { Vector3::y() * f64::EPSILON } else { between },
            reach: ball_a.radius + ball_b.radius,
            radius: ball_a.radius,
            curvature: ball_a.curvature + ball_b.curvature,
            sharpness: ball_a.curvature.max(ball_b.curvature),
            spring: self.former[spring as usize],
        }
    }

    /// Takes the new springs of the next contacts.
    #[inline]
    pub(super) fn keep(&mut self, springs: impl Iterator<Item = Spring>) {
        self.links.springs.extend(springs);
    }
}
