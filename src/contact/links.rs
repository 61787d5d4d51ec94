//! The sphere pairs of near bodies that may touch, with their springs, in one sequence: read through once a step.

use super::batch::Place;
use super::body::Ball;
use super::frames::{Four, add_less};
use super::law::Spring;
use super::pairs::Setting;
use nalgebra::Vector3;
use std::ops::Range;

/// Spheres i of body a and j of body b.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Link {
    pub a: u32,
    pub b: u32,
    pub i: u16,
    pub j: u16,
    /// Where the spheres stand in [`Setting::balls`].
    balls: (u32, u32),
    /// At rest while they do not touch.
    pub spring: Spring,
}

impl Link {
    /// The bodies.
    #[inline]
    pub(super) fn bodies(&self) -> (u32, u32) {
        (self.a, self.b)
    }

    #[inline(always)]
    fn balls<'a>(&self, setting: &Setting<'a>) -> (&'a Ball, &'a Ball) {
        (&setting.balls[self.balls.0 as usize], &setting.balls[self.balls.1 as usize])
    }

    /// Whether the spheres touched in the last step.
    pub(super) fn touched(&self) -> bool {
        self.spring.radius > 0.0
    }
}

/// The links of many bodies, sorted by bodies and spheres, while they are worked on.
#[derive(Debug, Clone, Default)]
pub(super) struct Links {
    pub all: Vec<Link>,
    /// Memory for the next sequence.
    next: Vec<Link>,
    /// Those before this one are in `next`.
    passed: usize,
    /// What touches, and memory left over.
    touching: Vec<Touching>,
    /// How many touch.
    found: usize,
    /// How many of those have their new spring.
    sprung: usize,
}

/// Two spheres that touch.
#[derive(Debug, Clone, Copy, Default)]
struct Touching {
    /// Place in the sequence.
    link: usize,
    /// From a's centre of mass to the centre of its sphere, m.
    arm: Four,
    /// From there to the centre of b's sphere, m.
    between: Four,
}

impl Links {
    /// Puts new links of two bodies in the place of their old ones: spheres in order, bodies in order from call to call.
    /// [`Links::replaced`] must follow.
    ///
    /// `first` are the places of the bodies' first spheres in [`Setting::balls`].
    pub(super) fn replace(&mut self, (a, b): (u32, u32), first: (u32, u32), spheres: &[(u16, u16)]) {
        let left = &self.all[self.passed..];
        let (before, left) = left.split_at(left.partition_point(|link| link.bodies() < (a, b)));
        let old = &left[..left.iter().take_while(|link| link.bodies() == (a, b)).count()];
        self.passed += before.len() + old.len();
        self.next.extend_from_slice(before);
        let mut old = old.iter().peekable();
        self.next.extend(spheres.iter().map(|&(i, j)| {
            while old.next_if(|link| (link.i, link.j) < (i, j)).is_some() {}
            let known = old.next_if(|link| (link.i, link.j) == (i, j));
            let balls = (first.0 + u32::from(i), first.1 + u32::from(j));
            Link { a, b, i, j, balls, spring: known.map_or_else(Spring::default, |link| link.spring) }
        }));
    }

    /// Ends the replacing.
    pub(super) fn replaced(&mut self) {
        if self.passed > 0 || !self.next.is_empty() {
            self.next.extend_from_slice(&self.all[self.passed..]);
            std::mem::swap(&mut self.all, &mut self.next);
            self.next.clear();
            self.passed = 0;
        }
    }

    /// Finds what touches. No branch depends on the outcome: none could be foreseen.
    #[inline(always)]
    pub(super) fn touch(&mut self, setting: &Setting<'_>) {
        if self.touching.len() < self.all.len() {
            self.touching.resize(self.all.len(), Touching::default());
        }
        let mut found = 0;
        for (k, link) in self.all.iter_mut().enumerate() {
            let (a, b) = (&setting.frames[link.a as usize], &setting.frames[link.b as usize]);
            let (ball_a, ball_b) = link.balls(setting);
            let arm = a.turn(&ball_a.center);
            let between = add_less(&a.to(b), &b.turn(&ball_b.center), &arm);
            let [x, y, z, _] = between;
            let reach = ball_a.radius + ball_b.radius;
            let touches = x * x + y * y + z * z < reach * reach;
            self.touching[found] = Touching { link: k, arm, between };
            found += usize::from(touches);
            link.spring.keep_if(touches);
        }
        self.found = found;
        self.sprung = 0;
    }

    /// Number of spheres that touch.
    pub(super) fn touching(&self) -> usize {
        self.found
    }

    /// Those of the touching spheres from `first` on that are of the same two bodies, and the bodies.
    #[inline(always)]
    pub(super) fn meeting(&self, first: usize) -> (Range<usize>, (u32, u32)) {
        let bodies = |touching: &Touching| self.all[touching.link].bodies();
        let met = bodies(&self.touching[first]);
        let count =
            self.touching[first..self.found].iter().take_while(|touching| bodies(touching) == met).count();
        (first..first + count, met)
    }

    /// Where the touching spheres number `k` are.
    #[inline(always)]
    pub(super) fn place(&self, k: usize, setting: &Setting<'_>) -> Place {
        let Touching { link, arm: [ax, ay, az, _], between: [x, y, z, _] } = self.touching[k];
        let link = &self.all[link];
        let (ball_a, ball_b) = link.balls(setting);
        let between = Vector3::new(x, y, z);
        Place {
            arm: Vector3::new(ax, ay, az),
            between: if between == Vector3::zeros() { Vector3::y() * f64::EPSILON } else { between },
            reach: ball_a.radius + ball_b.radius,
            radius: ball_a.radius,
            curvature: ball_a.curvature + ball_b.curvature,
            sharpness: ball_a.curvature.max(ball_b.curvature),
            spring: link.spring,
        }
    }

    /// Takes the new springs of the next contacts.
    #[inline]
    pub(super) fn keep(&mut self, springs: impl Iterator<Item = Spring>) {
        for spring in springs {
            self.all[self.touching[self.sprung].link].spring = spring;
            self.sprung += 1;
        }
    }
}
