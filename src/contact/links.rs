//! The sphere pairs of near bodies that may touch before their lists are made anew, in one sequence. Sieves tell which may
//! touch in a step; only those are measured. What touches has a spring.

use super::batch::{Batch, Place};
use super::block::{LANES, Springs};
use super::body::Outline;
use super::law::Spring;
use super::pairs::Setting;
use super::sieve::{Pose, Sieve};
use nalgebra::Vector3;
use std::ops::Range;

/// Two spheres that touched in the last step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Grasp {
    /// The bodies.
    pub bodies: (u32, u32),
    /// Where the spheres stand in [`Setting::balls`].
    pub balls: (u32, u32),
    pub spring: Spring,
}

impl Grasp {
    /// The same when bodies have other numbers.
    pub(super) fn renumbered(self, numbers: &[u32]) -> Self {
        let Self { bodies, balls, spring } = self;
        let (a, b) = (numbers[bodies.0 as usize], numbers[bodies.1 as usize]);
        if a < b {
            return Self { bodies: (a, b), ..self };
        }
        let spring = Spring { stretch: -spring.stretch, ..spring };
        Self { bodies: (b, a), balls: (balls.1, balls.0), spring }
    }
}

/// A sphere of body a and one of body b.
#[derive(Debug, Clone, Copy)]
pub(super) struct Link {
    bodies: (u32, u32),
    /// Where the spheres stand in [`Setting::balls`].
    balls: (u32, u32),
    /// The step in which it was measured last, and where its spring stood then: at [`AT_REST`] if it did not touch.
    measured: (u32, u32),
}

/// A place in the sequences: links and sieves before it.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Cursor {
    link: usize,
    sieve: usize,
}

/// The place of a spring at rest.
const AT_REST: u32 = 0;

/// Links of many bodies.
#[derive(Debug, Clone)]
pub(super) struct Links {
    /// Sorted by bodies and balls.
    all: Vec<Link>,
    /// Of the same links, up to eight of two bodies each.
    sieves: Vec<Sieve>,
    /// Eight at rest, then those of the links that touched in the last step, in their order.
    springs: Vec<Springs>,
    /// The number of the last step, which begins anew after 2³².
    step: u32,
}

impl Default for Links {
    fn default() -> Self {
        Self { all: Vec::new(), sieves: Vec::new(), springs: vec![Springs::AT_REST], step: 1 }
    }
}

impl Links {
    /// Links that touched in the last step, sorted, of pairs whose lists are all to be made anew.
    pub(super) fn of(touching: &[Grasp]) -> Self {
        let mut links = Self::default();
        for (k, Grasp { bodies, balls, spring }) in touching.iter().enumerate() {
            if k % LANES == 0 {
                links.springs.push(Springs::AT_REST);
            }
            links.springs[1 + k / LANES].set(k % LANES, spring);
            let measured = (links.step, (LANES + k) as u32);
            links.all.push(Link { bodies: *bodies, balls: *balls, measured });
        }
        for same in touching.chunk_by(|x, y| x.bodies == y.bodies) {
            links.sieves.extend(same.chunks(LANES).map(|same| Sieve::closed(same[0].bodies, same.len())));
        }
        links
    }

    /// Those that touched in the last step, in order.
    pub(super) fn touching(&self) -> impl Iterator<Item = Grasp> {
        self.all.iter().filter_map(|&Link { bodies, balls, measured: (step, at) }| {
            let touches = step == self.step && at != AT_REST;
            touches.then(|| Grasp { bodies, balls, spring: spring(&self.springs, at) })
        })
    }

    /// Moves a cursor on while it is at bodies that it is to `pass`.
    fn seek(&self, at: &mut Cursor, pass: impl Fn((u32, u32)) -> bool) {
        while let Some(sieve) = self.sieves.get(at.sieve).filter(|sieve| pass(sieve.bodies)) {
            *at = Cursor { link: at.link + sieve.len as usize, sieve: at.sieve + 1 };
        }
    }

    /// Where the links and sieves of two bodies are. The cursor is at or before them, and behind them afterwards.
    fn places_of(&self, bodies: (u32, u32), at: &mut Cursor) -> (Range<usize>, Range<usize>) {
        self.seek(at, |other| other < bodies);
        let first = *at;
        self.seek(at, |other| other == bodies);
        (first.link..at.link, first.sieve..at.sieve)
    }

    /// Lets go of the links of two bodies.
    pub(super) fn remove(&mut self, bodies: (u32, u32)) {
        let (links, sieves) = self.places_of(bodies, &mut Cursor::default());
        self.all.drain(links);
        self.sieves.drain(sieves);
    }

    /// Puts new links of two bodies in the place of their old ones: `spheres` by their numbers, in order. The cursor is at or
    /// before them, and behind them afterwards. `next` is memory to work in.
    pub(super) fn replace(
        &mut self,
        at: &mut Cursor,
        bodies: (u32, u32),
        outlines: [&Outline; 2],
        spheres: &[(u16, u16)],
        next: &mut Vec<Link>,
    ) {
        let first = outlines.map(|outline| outline.first);
        let (places, sieves) = self.places_of(bodies, at);
        let mut known = self.all[places.clone()].iter().peekable();
        next.clear();
        next.extend(spheres.iter().map(|&(i, j)| {
            let balls = (first[0] + u32::from(i), first[1] + u32::from(j));
            while known.next_if(|link| link.balls < balls).is_some() {}
            let known = known.next_if(|link| link.balls == balls);
            Link { bodies, balls, measured: known.map_or((0, AT_REST), |link| link.measured) }
        }));
        let sieve = |spheres: &[(u16, u16)]| Sieve::of(bodies, outlines, spheres);
        *at = Cursor {
            link: places.start + spheres.len(),
            sieve: sieves.start + spheres.len().div_ceil(LANES),
        };
        self.all.splice(places, next.iter().copied());
        self.sieves.splice(sieves, spheres.chunks(LANES).map(sieve));
    }

    /// Puts the numbers of the links that may touch first in `near`, and returns how many there are.
    #[inline(always)]
    fn sift(&self, poses: Option<&[Pose]>, near: &mut [u32]) -> usize {
        let Some(poses) = poses else {
            for (near, k) in near[..self.all.len()].iter_mut().zip(0..) {
                *near = k;
            }
            return self.all.len();
        };
        let (mut first, mut found) = (0, 0);
        for sieve in &self.sieves {
            let (a, b) = sieve.bodies;
            let picked = sieve.passed(&poses[a as usize], &poses[b as usize]);
            for (near, k) in near[found..found + LANES].iter_mut().zip(&picked.numbers) {
                *near = first + u32::from(*k);
            }
            first += sieve.len;
            found += picked.count;
        }
        found
    }

    /// Finds what touches and puts it into an empty batch. No branch depends on the outcome: none could be foreseen. There are no
    /// `poses` where all bodies are single spheres: they do not turn, and all links may touch. [`Links::keep`] must follow.
    #[inline(always)]
    pub(super) fn touch(
        &mut self,
        desk: &mut LinkDesk,
        setting: &Setting<'_>,
        poses: Option<&[Pose]>,
        batch: &mut Batch,
    ) {
        let Setting { motions, balls, mixed, .. } = *setting;
        let LinkDesk { near, touching, .. } = desk;
        let before = self.step;
        self.step = before.wrapping_add(1);
        // Where the law changes a new block begins.
        let room = LANES + self.all.len() * if mixed { LANES } else { 1 };
        if touching.len() < room {
            touching.resize(room, Touching::NOTHING);
            near.resize(room, 0);
        }
        let blocks = batch.room(room);
        let found = self.sift(poses, near);
        let links = &mut self.all[..];
        let (mut count, mut law) = (0_usize, None);
        for &near in &near[..found] {
            let link = &mut links[near as usize];
            let (a, b) = (link.bodies.0 as usize, link.bodies.1 as usize);
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
            let mut arm = Vector3::zeros();
            let mut between = b.position - a.position;
            if poses.is_some() {
                arm = a.rotation * ball_a.center;
                between = between + b.rotation * ball_b.center - arm;
            }
            let reach = ball_a.radius + ball_b.radius;
            let touches = between.norm_squared() < reach * reach;
            let spring = if link.measured.0 == before { link.measured.1 } else { AT_REST };
            touching[count] = Touching { bodies: link.bodies, spring };
            let place = Place { arm, between, radius: ball_a.radius, other: ball_b.radius };
            blocks[count / LANES].put(count % LANES, &place);
            link.measured = (self.step, (LANES + count) as u32 * u32::from(touches));
            count += usize::from(touches);
        }
        batch.take(count);
        std::mem::swap(&mut self.springs, &mut desk.former);
    }

    /// Takes the new springs of all contacts.
    #[inline(always)]
    pub(super) fn keep(&mut self, springs: impl Iterator<Item = Springs>) {
        self.springs.clear();
        self.springs.push(Springs::AT_REST);
        self.springs.extend(springs);
    }
}

/// Where links are worked on.
#[derive(Debug, Default)]
pub(super) struct LinkDesk {
    /// Numbers of the links that may touch, and memory left over.
    near: Vec<u32>,
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
}

/// The spring at a place.
#[inline(always)]
fn spring(springs: &[Springs], at: u32) -> Spring {
    springs[at as usize / LANES].get(at as usize % LANES)
}
