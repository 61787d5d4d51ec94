//! Two bodies near each other: the list of sphere pairs that may touch, its budget, and its forces.
//!
//! Most of the bed turns as a solid, so neighbours hardly move against each other. A list holds the sphere pairs with a
//! gap below the skin and stays valid until the bodies' *relative* motion has used the skin up. Tests of growing cost
//! watch over that: the sum of both odometers (motion against the turning drum) against a mark; the exact relative
//! displacement since the list was built; a new list from the candidates, which are the sphere pairs within a wider
//! skin; new candidates from all spheres.

use super::body::{BodyConstants, Outline};
use super::law::{PairLaw, Spring};
use super::lease::Lease;
use super::resolve::{Exchange, Partner, Place, Remembers, resolve};
use crate::scene::DampingMass;
use crate::world::{Motion, Relative};
use nalgebra::Vector3;
use smallvec::SmallVec;

/// Two spheres that may touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Link {
    pub i: u16,
    pub j: u16,
    pub touching: bool,
    /// Sum of the odometers up to which the spheres cannot touch, m: where they last were, plus the gap there.
    until: f64,
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
    /// Sum of the odometers up to which the list is complete and nothing in it can touch, m.
    quiet: f64,
}

/// The list of two bodies.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BodyPair {
    /// Sorted by (i, j).
    pub links: SmallVec<[Link; 4]>,
    /// Sum of the odometers up to which the list is complete, m.
    mark: f64,
    listed: Lease,
    /// Sphere pairs that were near when they were `sought`; sorted.
    candidates: Vec<(u16, u16)>,
    sought: Lease,
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
    fn outline(&self, body: usize) -> &Outline {
        &self.outlines[self.bodies[body].shape]
    }

    pub(super) fn law(&self, a: usize, b: usize) -> &PairLaw {
        &self.laws[a * self.materials + b]
    }

    pub(super) fn partner(&self, body: usize) -> Partner<'_> {
        let constants = &self.bodies[body];
        Partner {
            motion: &self.motions[body],
            inverse_mass: constants.inverse_mass,
            inverse_inertia: constants.inverse_inertia,
            softness: constants.softness,
        }
    }
}

/// Skin of the candidates, in skins: they are found anew so many times more rarely than lists are.
const WIDE: f64 = 6.0;

impl PairWatch {
    pub(super) fn new(a: u32, b: u32) -> Self {
        Self { a, b, quiet: f64::NEG_INFINITY }
    }

    pub(super) fn key(&self) -> (u32, u32) {
        (self.a, self.b)
    }

    /// Whether the pair needs work: its list may lack something, or something in it may touch.
    #[inline]
    pub(super) fn alert(&self, odometers: &[f64]) -> bool {
        self.travelled(odometers) > self.quiet
    }

    #[inline]
    fn travelled(&self, odometers: &[f64]) -> f64 {
        odometers[self.a as usize] + odometers[self.b as usize]
    }
}

impl BodyPair {
    pub(super) fn new() -> Self {
        Self {
            links: SmallVec::new(),
            mark: f64::NEG_INFINITY,
            listed: Lease::NONE,
            candidates: Vec::new(),
            sought: Lease::NONE,
        }
    }

    /// Makes sure that every sphere pair that touches is in the list. True if the list was built anew.
    #[inline]
    pub(super) fn refresh(
        &mut self,
        watch: &PairWatch,
        setting: &Setting<'_>,
        near: &mut Vec<(u16, Vector3<f64>)>,
    ) -> bool {
        let travelled = watch.travelled(setting.odometers);
        if travelled <= self.mark {
            return false;
        }
        let (a, b) = (watch.a as usize, watch.b as usize);
        let now = setting.motions[b].seen_from(&setting.motions[a]);
        let (oa, ob) = (setting.outline(a), setting.outline(b));
        let left = self.listed.left(&now, ob.reach);
        if self.listed.holds(left) {
            self.mark = travelled + left;
            return false;
        }
        if self.sought.left(&now, ob.reach) < setting.skin {
            self.seek(oa, ob, now, WIDE * setting.skin, near);
        }
        // What is no candidate has at least this gap.
        self.listed = Lease { at: now, allowance: self.sought.left(&now, ob.reach) };
        self.list(oa, ob, setting.skin, travelled);
        self.mark = travelled + self.listed.allowance;
        true
    }

    /// Finds the candidates, with gaps below `width`. `near` is scratch: b's spheres near a's box, in a's axes.
    fn seek(
        &mut self,
        oa: &Outline,
        ob: &Outline,
        at: Relative,
        width: f64,
        near: &mut Vec<(u16, Vector3<f64>)>,
    ) {
        let Relative { position, rotation } = at;
        let apart = oa.apart(ob, &at);
        self.sought = Lease { at, allowance: width.max(apart) };
        self.candidates.clear();
        near.clear();
        if apart > width {
            return;
        }
        let (mut min, mut max) = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
        for (j, sphere) in ob.spheres.iter().enumerate() {
            let center = position + rotation * sphere.center;
            if oa.near(&center, sphere.radius + width) {
                min = min.inf(&center.add_scalar(-sphere.radius));
                max = max.sup(&center.add_scalar(sphere.radius));
                near.push((j as u16, center));
            }
        }
        for (i, sphere) in oa.spheres.iter().enumerate() {
            let margin = sphere.radius + width;
            let c = &sphere.center;
            if near.is_empty() || (0..3).any(|k| c[k] < min[k] - margin || c[k] > max[k] + margin) {
                continue;
            }
            for (j, center) in near.iter() {
                let reach = margin + ob.spheres[*j as usize].radius;
                if (center - c).norm_squared() < reach * reach {
                    self.candidates.push((i as u16, *j));
                }
            }
        }
    }

    /// Lists the candidates with a gap below the skin; springs of touching spheres stay.
    fn list(&mut self, oa: &Outline, ob: &Outline, skin: f64, travelled: f64) {
        let Lease { at: Relative { position, rotation }, allowance } = &mut self.listed;
        let old = std::mem::take(&mut self.links);
        let mut memory = old.iter().filter(|l| l.touching).peekable();
        for &(i, j) in &self.candidates {
            let (si, sj) = (&oa.spheres[i as usize], &ob.spheres[j as usize]);
            let sum = si.radius + sj.radius;
            let distance2 = (*position + *rotation * sj.center - si.center).norm_squared();
            let reach = sum + *allowance;
            if distance2 >= reach * reach {
                continue;
            }
            let gap = distance2.sqrt() - sum;
            if gap >= skin {
                *allowance = gap;
                continue;
            }
            while memory.next_if(|l| (l.i, l.j) < (i, j)).is_some() {}
            let fresh = Link { i, j, touching: false, until: travelled + gap, spring: Spring::default() };
            self.links.push(*memory.next_if(|l| (l.i, l.j) == (i, j)).unwrap_or(&fresh));
        }
    }

    /// Forces of this step, if anything touches.
    #[inline]
    pub(super) fn evaluate(
        &mut self,
        watch: &mut PairWatch,
        setting: &Setting<'_>,
        places: &mut Vec<Place>,
    ) -> Option<Exchange> {
        let (a, b) = (watch.a as usize, watch.b as usize);
        let (ca, cb) = (&setting.bodies[a], &setting.bodies[b]);
        let (ma, mb) = (&setting.motions[a], &setting.motions[b]);
        let (sa, sb) = (&setting.outlines[ca.shape].spheres, &setting.outlines[cb.shape].spheres);
        let between = mb.position - ma.position;
        places.clear();
        let mut deepest: f64 = 0.0;
        let travelled = watch.travelled(setting.odometers);
        watch.quiet = self.mark;
        for (k, link) in self.links.iter_mut().enumerate() {
            if travelled < link.until {
                watch.quiet = watch.quiet.min(link.until);
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
                link.until = travelled + (distance2.sqrt() - sum);
                watch.quiet = watch.quiet.min(link.until);
                continue;
            }
            link.touching = true;
            link.until = f64::NEG_INFINITY;
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
            return None;
        }
        watch.quiet = f64::NEG_INFINITY;
        let law = setting.law(ca.material, cb.material);
        let sides = (setting.partner(a), setting.partner(b));
        let exchange = resolve(places, sides, law, setting.damping, setting.dt, &mut self.links);
        Some(Exchange { deepest, ..exchange })
    }
}
