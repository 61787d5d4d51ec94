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
    /// Gap when the list was built, m: until the bodies have moved that far the spheres cannot touch.
    gap: f64,
    pub spring: Spring,
}

impl Remembers for Link {
    fn spring(&mut self) -> &mut Spring {
        &mut self.spring
    }
}

/// What is read of every near pair in every step: kept apart from the lists, which most pairs do not need.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PairWatch {
    /// Bodies, `a < b`.
    pub a: u32,
    pub b: u32,
    /// Sum of the odometers up to which nothing needs a look, m.
    mark: f64,
    /// Sphere pairs in the list.
    pub links: u32,
    /// Sphere pairs that touch.
    pub contacts: u32,
}

/// The list of two bodies.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BodyPair {
    /// Sorted by (i, j).
    pub links: Vec<Link>,
    /// Pose of b in a's axes when the list was built.
    built: (Vector3<f64>, Matrix3<f64>),
    /// Relative motion the list allows, m.
    allowance: f64,
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

impl PairWatch {
    pub(super) fn new(a: u32, b: u32) -> Self {
        Self { a, b, mark: f64::NEG_INFINITY, links: 0, contacts: 0 }
    }

    pub(super) fn key(&self) -> (u32, u32) {
        (self.a, self.b)
    }

    /// Whether the list may no longer hold all that touches.
    #[inline]
    pub(super) fn due(&self, odometers: &[f64]) -> bool {
        self.left(odometers) < 0.0
    }

    /// Relative motion that the list still allows, m.
    #[inline]
    fn left(&self, odometers: &[f64]) -> f64 {
        self.mark - (odometers[self.a as usize] + odometers[self.b as usize])
    }
}

impl BodyPair {
    pub(super) fn new() -> Self {
        Self {
            links: Vec::new(),
            built: (Vector3::zeros(), Matrix3::zeros()),
            allowance: 0.0,
            exchange: Exchange::default(),
        }
    }

    /// Makes sure that every sphere pair that touches is in the list. True if the list was built anew.
    pub(super) fn refresh(
        &mut self,
        watch: &mut PairWatch,
        setting: &Setting<'_>,
        near: &mut Vec<(u16, Vector3<f64>)>,
    ) -> bool {
        let (a, b) = (watch.a as usize, watch.b as usize);
        let travelled = setting.odometers[a] + setting.odometers[b];
        let (ma, mb) = (&setting.motions[a], &setting.motions[b]);
        let position = ma.rotation.tr_mul(&(mb.position - ma.position));
        let rotation = ma.rotation.tr_mul(&mb.rotation);
        let reach = setting.outlines[setting.bodies[b].shape].reach;
        // |Q s − Q₀ s| ≤ 2 sin(θ/2) |s|, and 3 − tr(Q₀ᵀ Q) = 4 sin²(θ/2).
        let turned = (3.0 - self.built.1.dot(&rotation)).max(0.0).sqrt();
        let left = self.allowance - (position - self.built.0).norm() - turned * reach;
        if left > RENEW * self.allowance {
            watch.mark = travelled + left;
            return false;
        }
        self.built = (position, rotation);
        self.rebuild((a, b), setting, near);
        watch.mark = travelled + self.allowance;
        watch.links = self.links.len() as u32;
        true
    }

    /// Lists all sphere pairs with a gap below the skin. `near` is scratch: b's spheres near a's box, in a's axes.
    fn rebuild(
        &mut self,
        (a, b): (usize, usize),
        setting: &Setting<'_>,
        near: &mut Vec<(u16, Vector3<f64>)>,
    ) {
        let (position, rotation) = self.built;
        let oa = &setting.outlines[setting.bodies[a].shape];
        let ob = &setting.outlines[setting.bodies[b].shape];
        let lookout = LOOKOUT * setting.skin;
        let old = std::mem::take(&mut self.links);
        self.allowance = position.norm() - oa.bounding_radius - ob.bounding_radius;
        if self.allowance > lookout {
            return;
        }
        self.allowance = lookout;
        near.clear();
        let (mut min, mut max) = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
        for (j, sphere) in ob.spheres.iter().enumerate() {
            let center = position + rotation * sphere.center;
            if oa.near(&center, sphere.radius + lookout) {
                min = min.inf(&center.add_scalar(-sphere.radius));
                max = max.sup(&center.add_scalar(sphere.radius));
                near.push((j as u16, center));
            }
        }
        if near.is_empty() {
            return;
        }
        let mut memory = old.iter().filter(|l| l.touching).peekable();
        for (i, sphere) in oa.spheres.iter().enumerate() {
            let margin = sphere.radius + self.allowance;
            if (0..3).any(|k| sphere.center[k] < min[k] - margin || sphere.center[k] > max[k] + margin) {
                continue;
            }
            for (j, center) in near.iter() {
                let sum = sphere.radius + ob.spheres[*j as usize].radius;
                let distance2 = (center - sphere.center).norm_squared();
                let reach = sum + self.allowance;
                if distance2 >= reach * reach {
                    continue;
                }
                let gap = distance2.sqrt() - sum;
                self.allowance = self.allowance.min(gap.max(setting.skin));
                if gap >= setting.skin {
                    continue;
                }
                let key = (i as u16, *j);
                while memory.next_if(|l| (l.i, l.j) < key).is_some() {}
                self.links.push(match memory.next_if(|l| (l.i, l.j) == key) {
                    Some(link) => Link { gap, ..*link },
                    None => Link { i: key.0, j: key.1, touching: false, gap, spring: Spring::default() },
                });
            }
        }
    }

    /// Forces of this step, left in `exchange`.
    #[inline]
    pub(super) fn evaluate(&mut self, watch: &mut PairWatch, setting: &Setting<'_>, places: &mut Vec<Place>) {
        let (a, b) = (watch.a as usize, watch.b as usize);
        let (ca, cb) = (&setting.bodies[a], &setting.bodies[b]);
        let (ma, mb) = (&setting.motions[a], &setting.motions[b]);
        let (sa, sb) = (&setting.outlines[ca.shape].spheres, &setting.outlines[cb.shape].spheres);
        let between = mb.position - ma.position;
        places.clear();
        let mut deepest: f64 = 0.0;
        let moved = self.allowance - watch.left(setting.odometers);
        for (k, link) in self.links.iter_mut().enumerate() {
            if link.gap > moved && !link.touching {
                continue;
            }
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
        watch.contacts = places.len() as u32;
        if places.is_empty() {
            return;
        }
        let law = setting.law(ca.material, cb.material);
        let sides = (setting.partner(a), setting.partner(b));
        self.exchange = resolve(places, sides, law, setting.damping, setting.dt, &mut self.links);
        self.exchange.deepest = deepest;
    }
}
