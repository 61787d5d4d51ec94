//! Two bodies near each other: which of their spheres may touch, and for how long that is known.
//!
//! Most of the bed turns as a solid, so neighbours hardly move against each other. A list holds the sphere pairs with a
//! gap below a skin and stays complete until the bodies' *relative* motion has used the skin up. Tests of growing cost
//! watch over that: the sum of both odometers (motion against the turning drum); the exact relative displacement from the
//! pose that the list was made for; a new list.
//!
//! That pose is one ahead, where the bodies are likely to be when half of the list's life is over: from there it bears motion
//! both ways.
//!
//! A new list costs little because of the axis along which the bodies were nearest when the last one was made: spheres
//! that stay behind by more than the skin along it cannot be near the other body, whatever the shapes.

use super::batch::Place;
use super::body::{Ball, BodyConstants, Eight, Load, Outline, ROUNDING};
use super::extents::Extents;
use super::law::Spring;
use super::lease::Lease;
use super::links::{Cursor, Link, Links};
use super::side::Side;
use super::walls::Grip;
use crate::world::{Motion, Relative};
use nalgebra::Vector3;
use wide::f32x8;

/// Two bodies near each other: what is read of them to know whether their list is good.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Pair {
    /// Bodies, `a < b`.
    a: u32,
    b: u32,
    /// Sum of the odometers up to which the list is complete, m.
    mark: f64,
    /// Kept elsewhere: most pairs are passed over at most steps.
    list: Box<PairList>,
}

/// The lease of a pair's list; what it lists are links.
#[derive(Debug, Clone, PartialEq)]
struct PairList {
    lease: Lease,
    /// Unit vector from a to b along which their surfaces were nearest, a's axes; zero if they never were near.
    axis: Vector3<f32>,
}

/// What a pair reads while it works.
pub(super) struct Setting<'a> {
    pub outlines: &'a [Outline],
    /// The spheres of all outlines.
    pub balls: &'a [Ball],
    pub bodies: &'a [BodyConstants],
    pub motions: &'a [Motion],
    /// Distance each body's farthest sphere centre can have moved against the drum so far, m.
    pub odometers: &'a [f64],
    /// Of each body in the last step.
    pub loads: &'a [Load],
    pub materials: usize,
    /// Whether bodies are of several materials.
    pub mixed: bool,
    pub skin: f64,
    pub dt: f64,
}

impl Setting<'_> {
    pub(super) fn outline(&self, body: usize) -> &Outline {
        &self.outlines[self.bodies[body].shape]
    }

    /// Index of the law of two bodies.
    #[inline]
    pub(super) fn law_of(&self, a: usize, b: usize) -> usize {
        self.law(self.bodies[a].material, self.bodies[b].material)
    }

    /// Index of the law of two materials.
    pub(super) fn law(&self, a: usize, b: usize) -> usize {
        a * self.materials + b
    }

    #[inline]
    pub(super) fn side(&self, body: usize) -> Side<'_> {
        let constants = &self.bodies[body];
        Side {
            motion: &self.motions[body],
            inverse_mass: constants.inverse_mass,
            inverse_inertia: constants.inverse_inertia,
            softness: constants.softness,
            drag: self.loads[body].damping * constants.softness,
        }
    }
}

/// Memory that one pair after another works in.
#[derive(Debug, Clone, Default)]
pub(super) struct Scratch {
    extents: [Extents; 2],
    foremost: Vec<u16>,
    near: Candidates,
    /// A new list, and its links.
    spheres: Vec<(u16, u16)>,
    links: Vec<Link>,
    pub places: Vec<(Place, Spring)>,
    /// Facets near a body, and what of it touches walls.
    pub facets: Vec<u32>,
    pub grips: Vec<Grip>,
    /// Pairs to look at, and their leases.
    pub alert: Vec<u32>,
    pub leases: Vec<Lease>,
}

impl Pair {
    pub(super) fn new((a, b): (u32, u32)) -> Self {
        Self { a, b, mark: f64::NEG_INFINITY, list: Box::new(PairList::NONE) }
    }

    pub(super) fn key(&self) -> (u32, u32) {
        (self.a, self.b)
    }

    /// Whether the bodies have moved so far that the list may lack something.
    #[inline]
    pub(super) fn spent(&self, odometers: &[f64]) -> bool {
        self.mark <= odometers[self.a as usize] + odometers[self.b as usize]
    }

    /// What its list is good for.
    #[inline(always)]
    pub(super) fn lease(&self) -> Lease {
        self.list.lease
    }

    /// b's pose in a's axes.
    #[inline(always)]
    pub(super) fn pose(&self, motions: &[Motion]) -> Relative {
        motions[self.b as usize].seen_from(&motions[self.a as usize])
    }

    /// Sees whether a list with this lease is still complete with b `at` a pose in a's axes, and notes until when it surely is.
    /// False if it is worn.
    #[inline(always)]
    pub(super) fn holds(&mut self, lease: &Lease, at: &Relative, odometers: &[f64]) -> bool {
        let left = lease.left(at);
        self.mark = odometers[self.a as usize] + odometers[self.b as usize] + left;
        lease.holds(left)
    }

    /// Makes the list anew: for a pose ahead, or for the present one if that is not good enough.
    #[inline(always)]
    pub(super) fn renew(
        &mut self,
        setting: &Setting<'_>,
        scratch: &mut Scratch,
        (links, cursor): (&mut Links, &mut Cursor),
    ) {
        let Setting { motions, odometers, .. } = *setting;
        let (a, b) = (self.a as usize, self.b as usize);
        let outlines = [setting.outline(a), setting.outline(b)];
        let (at, course) = (self.pose(motions), motions[b].course_from(&motions[a]));
        let speed = self.list.lease.speed(&at, &course);
        let skin = skin(setting, speed);
        self.list.make(outlines, at.ahead(&course, speed, skin), skin, scratch);
        if !self.holds(&self.lease(), &at, odometers) {
            self.list.make(outlines, at, skin, scratch);
            self.holds(&self.lease(), &at, odometers);
        }
        links.replace(cursor, self.key(), outlines, &scratch.spheres, &mut scratch.links);
    }
}

impl PairList {
    const NONE: Self = Self { lease: Lease::NONE, axis: Vector3::new(0.0, 0.0, 0.0) };

    /// Lists the sphere pairs with a gap below the skin, m; `at` is b's pose in a's axes.
    #[inline(always)]
    fn make(&mut self, [oa, ob]: [&Outline; 2], at: Relative, skin: f64, scratch: &mut Scratch) {
        let Scratch { extents: [of_a, of_b], foremost, near, spheres, .. } = scratch;
        let never_near = self.axis == Vector3::zeros();
        let axis = if never_near { at.position } else { self.axis.map(f64::from) };
        let axis = axis.try_normalize(0.0).unwrap_or_else(Vector3::y);
        let to_f32 = |v: &Vector3<f64>| v.map(|x| x as f32);
        let (apart, turn) = (to_f32(&at.position), at.rotation.map(|x| x as f32));
        of_a.measure(oa, &to_f32(&axis));
        of_b.measure(ob, &to_f32(&at.rotation.tr_mul(&-axis)));
        let slack = rounding(oa, ob);
        // At most the gap between the bodies: what the axis leaves between them.
        let between = apart.dot(&to_f32(&axis)) - of_a.most - of_b.most - slack;
        let allowance = (skin as f32).max(between);
        let depth = allowance - between;
        // Bodies apart are followed where they are nearest.
        of_b.foremost(depth.max(allowance), foremost);
        let about = ob.middle(foremost);
        let lever = of_b.lever(ob, &about, depth, allowance);
        self.lease = Lease::new(&at, &about, f64::from(lever), f64::from(allowance));
        spheres.clear();
        if depth <= 0.0 {
            return;
        }
        near.clear();
        for &j in &*foremost {
            let [x, y, z, radius] = ob.sphere(j);
            near.push(j, apart + turn * Vector3::new(x, y, z), radius + allowance + slack);
        }
        of_a.foremost(depth, foremost);
        near.list(oa, foremost, spheres);
        self.axis = near.nearest().try_normalize(0.0).unwrap_or(to_f32(&axis));
    }
}

/// Spheres of the second body that may come near the first, in the first one's axes.
#[derive(Debug, Clone, Default)]
struct Candidates {
    numbers: Vec<u16>,
    eights: Vec<Eight>,
    /// Per lane the nearest so far to a sphere of the first: how near, m² (the square of the distance less that of the
    /// radii), and in which direction.
    nearest: [f32x8; 4],
    /// Spheres of the first body, eights they meet, and what of those.
    meeting: Vec<(u16, u16, u32)>,
}

/// A sphere nothing comes near, in places left over.
const NOWHERE: [f32; 4] = [1e15, 0.0, 0.0, 0.0];

impl Candidates {
    fn clear(&mut self) {
        self.numbers.clear();
        self.eights.clear();
        self.nearest = [f32x8::splat(f32::INFINITY), f32x8::ZERO, f32x8::ZERO, f32x8::ZERO];
    }

    #[inline(always)]
    fn push(&mut self, number: u16, center: Vector3<f32>, radius: f32) {
        let (at, k) = (self.numbers.len() / 8, self.numbers.len() % 8);
        if k == 0 {
            self.eights.push(NOWHERE.map(|x| [x; 8]));
        }
        for (row, value) in self.eights[at].iter_mut().zip([center.x, center.y, center.z, radius]) {
            row[k] = value;
        }
        self.numbers.push(number);
    }

    /// Lists what of them the `spheres` of `outline` meet, in order. What is met can hardly be foreseen, so that branches
    /// wait until all is measured.
    #[inline(always)]
    fn list(&mut self, outline: &Outline, spheres: &[u16], list: &mut Vec<(u16, u16)>) {
        let Self { numbers, eights, nearest, meeting } = self;
        meeting.resize(spheres.len() * eights.len(), (0, 0, 0));
        let mut count = 0;
        for &i in spheres {
            let [cx, cy, cz, radius] = outline.sphere(i).map(f32x8::splat);
            for (at, &[x, y, z, radii]) in eights.iter().enumerate() {
                let (dx, dy, dz) = (f32x8::new(x) - cx, f32x8::new(y) - cy, f32x8::new(z) - cz);
                let reach = radius + f32x8::new(radii);
                let excess = dx * dx + dy * dy + dz * dz - reach * reach;
                let nearer = excess.simd_lt(nearest[0]);
                for (nearest, this) in nearest.iter_mut().zip([excess, dx, dy, dz]) {
                    *nearest = nearer.select(this, *nearest);
                }
                let met = excess.simd_lt(f32x8::ZERO).to_bitmask();
                meeting[count] = (i, at as u16, met);
                count += usize::from(met != 0);
            }
        }
        for &(i, at, mut met) in &meeting[..count] {
            while met != 0 {
                list.push((i, numbers[8 * usize::from(at) + met.trailing_zeros() as usize]));
                met &= met - 1;
            }
        }
    }

    /// Direction in which the nearest of them is; zero if none was listed.
    #[inline(always)]
    fn nearest(&self) -> Vector3<f32> {
        let [excess, x, y, z] = self.nearest.map(f32x8::to_array);
        let k = (1..8).fold(0, |least, k| if excess[k] < excess[least] { k } else { least });
        Vector3::new(x[k], y[k], z[k])
    }
}

/// Error of a distance measured in f32, m.
#[inline(always)]
fn rounding(a: &Outline, b: &Outline) -> f32 {
    ROUNDING as f32 * a.bounding_radius.max(b.bounding_radius) as f32
}

/// Skin of a new list, m: wider for bodies that move fast against each other.
#[inline(always)]
fn skin(setting: &Setting<'_>, speed: f64) -> f64 {
    let (least, most) = SKIN;
    (speed * setting.dt * LENGTH * setting.skin).sqrt().clamp(least * setting.skin, most * setting.skin)
}

/// Least and most skin, in common skins.
const SKIN: (f64, f64) = (0.3, 5.0);
/// A wide skin makes lists long, a narrow one makes them anew often: at skin s and relative speed v the one costs as
/// s, the other as v dt/s, and both together least at s² = v dt L. This is L, in common skins.
const LENGTH: f64 = 30.0;
