//! Two bodies near each other: the list of sphere pairs that may touch, its budget, and its forces.
//!
//! Most of the bed turns as a solid, so neighbours hardly move against each other. A list holds the sphere pairs with a
//! gap below the skin and stays valid until the bodies' *relative* motion has used the skin up. Three tests of growing
//! cost watch over that: the sum of both odometers (motion against the turning drum) against a mark; the exact
//! relative displacement since the list was built; a new list.

use super::body::{BodyConstants, Outline};
use super::law::{PairLaw, Spring};
use super::resolve::{Exchange, Partner, Place, Remembers, resolve};
use crate::scene::DampingMass;
use crate::world::Motion;
use nalgebra::{Matrix3, Vector3};

/// Two spheres that may touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Link {
    pub i: u16,
    pub j: u16,
    pub touching: bool,
    pub spring: Spring,
}

impl Remembers for Link {
    fn spring(&mut self) -> &mut Spring {
        &mut self.spring
    }
}

/// Two bodies, `a < b`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BodyPair {
    pub a: u32,
    pub b: u32,
    /// Sorted by (i, j).
    pub links: Vec<Link>,
    /// Pose of b in a's axes when the list was built.
    built: (Vector3<f64>, Matrix3<f64>),
    /// Relative motion the list allows, m.
    allowance: f64,
    /// Sum of the odometers up to which nothing needs a look, m.
    mark: f64,
    pub exchange: Exchange,
}

/// What a pair reads while it works.
pub(super) struct Setting<'a> {
    pub outlines: &'a [Outline],
    pub bodies: &'a [BodyConstants],
    pub motions: &'a [Motion],
    /// Distance each body's farthest sphere centre can have moved against the drum so far, m.
    pub odometers: &'a [f64],
    /// Laws by material pair, `materials × materials`.
    pub laws: &'a [PairLaw],
    pub materials: usize,
    pub damping: DampingMass,
    pub skin: f64,
    pub dt: f64,
}

impl Setting<'_> {
    pub(super) fn law(&self, a: usize, b: usize) -> &PairLaw {
        &self.laws[a * self.materials + b]
    }

    pub(super) fn partner(&self, body: usize) -> Partner<'_> {
        let constants = &self.bodies[body];
        Partner {
            motion: &self.motions[body],
            inverse_mass: constants.inverse_mass,
            inverse_inertia: constants.inverse_inertia,
        }
    }
}

/// Lists are also searched this many skins deep, so that a pair without links knows how long it may rest.
const LOOKOUT: f64 = 4.0;
/// A list is renewed when less than this share of its skin is left.
const RENEW: f64 = 0.3;

impl BodyPair {
    pub(super) fn new(a: u32, b: u32) -> Self {
        Self {
            a,
            b,
            links: Vec::new(),
            built: (Vector3::zeros(), Matrix3::zeros()),
            allowance: 0.0,
            mark: f64::NEG_INFINITY,
            exchange: Exchange::default(),
        }
    }

    /// Makes sure that every sphere pair that touches is in the list. True if the list was built anew.
    #[inline]
    pub(super) fn refresh(&mut self, setting: &Setting<'_>, kept: &mut Vec<u16>) -> bool {
        let travelled = setting.odometers[self.a as usize] + setting.odometers[self.b as usize];
        if travelled <= self.mark {
            return false;
        }
        let (ma, mb) = (&setting.motions[self.a as usize], &setting.motions[self.b as usize]);
        let position = ma.rotation.tr_mul(&(mb.position - ma.position));
        let rotation = ma.rotation.tr_mul(&mb.rotation);
        let reach = setting.outlines[setting.bodies[self.b as usize].shape].reach;
        // |Q s − Q₀ s| ≤ 2 sin(θ/2) |s|, and 3 − tr(Q₀ᵀ Q) = 4 sin²(θ/2).
        let turned = (3.0 - self.built.1.dot(&rotation)).max(0.0).sqrt();
        let left = self.allowance - (position - self.built.0).norm() - turned * reach;
        if left > RENEW * self.allowance {
            self.mark = travelled + left;
            return false;
        }
        self.built = (position, rotation);
        self.rebuild(setting, kept);
        self.mark = travelled + self.allowance;
        true
    }

    fn rebuild(&mut self, setting: &Setting<'_>, kept: &mut Vec<u16>) {
        let (position, rotation) = self.built;
        let oa = &setting.outlines[setting.bodies[self.a as usize].shape];
        let ob = &setting.outlines[setting.bodies[self.b as usize].shape];
        let lookout = LOOKOUT * setting.skin;
        kept.clear();
        for (j, sphere) in ob.spheres.iter().enumerate() {
            if oa.near(&(position + rotation * sphere.center), sphere.radius + lookout) {
                kept.push(j as u16);
            }
        }
        let old = std::mem::take(&mut self.links);
        let mut nearest = lookout;
        if !kept.is_empty() {
            let mut memory = old.iter().filter(|l| l.touching).peekable();
            for (i, sphere) in oa.spheres.iter().enumerate() {
                let local = rotation.tr_mul(&(sphere.center - position));
                if !ob.near(&local, sphere.radius + lookout) {
                    continue;
                }
                for &j in kept.iter() {
                    let other = &ob.spheres[j as usize];
                    let reach = sphere.radius + other.radius + nearest;
                    let distance2 = (other.center - local).norm_squared();
                    if distance2 >= reach * reach {
                        continue;
                    }
                    let gap = distance2.sqrt() - sphere.radius - other.radius;
                    nearest = nearest.min(gap.max(setting.skin));
                    if gap >= setting.skin {
                        continue;
                    }
                    let key = (i as u16, j);
                    while memory.next_if(|l| (l.i, l.j) < key).is_some() {}
                    let link = match memory.next_if(|l| (l.i, l.j) == key) {
                        Some(link) => *link,
                        None => Link { i: key.0, j, touching: false, spring: Spring::default() },
                    };
                    self.links.push(link);
                }
            }
        }
        self.allowance = nearest;
    }

    /// Forces of this step, left in `exchange`.
    #[inline]
    pub(super) fn evaluate(&mut self, setting: &Setting<'_>, places: &mut Vec<Place>) {
        if self.links.is_empty() {
            self.exchange.contacts = 0;
            return;
        }
        let (a, b) = (self.a as usize, self.b as usize);
        let (ca, cb) = (&setting.bodies[a], &setting.bodies[b]);
        let (ma, mb) = (&setting.motions[a], &setting.motions[b]);
        let (sa, sb) = (&setting.outlines[ca.shape].spheres, &setting.outlines[cb.shape].spheres);
        let between = mb.position - ma.position;
        places.clear();
        let mut deepest: f64 = 0.0;
        for (k, link) in self.links.iter_mut().enumerate() {
            let (si, sj) = (&sa[link.i as usize], &sb[link.j as usize]);
            let center_a = ma.rotation * si.center;
            let center_b = mb.rotation * sj.center;
            let d = between + center_b - center_a;
            let sum = si.radius + sj.radius;
            let distance2 = d.norm_squared();
            if distance2 >= sum * sum {
                if link.touching {
                    link.touching = false;
                    link.spring = Spring::default();
                }
                continue;
            }
            link.touching = true;
            let distance = distance2.sqrt();
            let normal = if distance > 0.0 { d / distance } else { Vector3::y() };
            let overlap = sum - distance;
            let radius = si.radius * sj.radius / sum;
            deepest = deepest.max(overlap / si.radius.min(sj.radius));
            let arm_a = center_a + normal * (si.radius - 0.5 * overlap);
            let arm_b = arm_a - between;
            places.push(Place {
                link: k,
                normal,
                overlap,
                contact_radius: (radius * overlap).sqrt(),
                arm_a,
                arm_b,
                velocity: mb.velocity_at(&arm_b) - ma.velocity_at(&arm_a),
            });
        }
        if places.is_empty() {
            self.exchange.contacts = 0;
            return;
        }
        let law = setting.law(ca.material, cb.material);
        let sides = (setting.partner(a), setting.partner(b));
        self.exchange = resolve(places, sides, law, setting.damping, setting.dt, &mut self.links);
        self.exchange.deepest = deepest;
    }
}
