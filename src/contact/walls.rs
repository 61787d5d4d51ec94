//! A body near a surface: the list of spheres and facets that may touch, its budget, and its forces.
//!
//! A sphere feels one contact per smooth patch, at the place of the patch nearest to it, and its spring stays with it
//! while it moves from facet to facet. Where two patches meet in a convex edge, the place is felt once; a spring moves
//! over to the patch that takes the sphere on. In a concave corner both patches push.

use super::batch::{Batch, Place};
use super::body::{Ball, Outline, ROUNDING};
use super::law::Spring;
use super::lease::Lease;
use super::pairs::{Scratch, Setting};
use super::side::Side;
use super::surface::{Nearest, Planes, Surface};
use crate::world::{FacetTree, Motion, Relative};
use nalgebra::Vector3;
use std::collections::BTreeMap;
use wide::f32x8;

/// One sphere against one patch.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Grip {
    pub sphere: u16,
    pub patch: u32,
    /// The patch's facets near the sphere: a range of [`WallList::facets`].
    facets: (u32, u32),
    pub touching: bool,
    /// Odometer up to which the sphere cannot touch the patch, m: known of a surface that odometers measure against.
    until: f64,
    pub spring: Spring,
}

/// One body against one surface.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct WallList {
    /// Sorted by (sphere, patch).
    pub grips: Vec<Grip>,
    /// Which of them hold in this step.
    held: Vec<u32>,
    facets: Vec<u32>,
    listed: Lease,
    /// Spheres, patches and facets that were near when they were `sought`, sorted.
    candidates: Vec<(u16, u32, u32)>,
    sought: Lease,
    mark: f64,
}

/// What is read of every body and surface in every step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WallWatch {
    pub body: u32,
    pub surface: u32,
    /// Odometer up to which the list is complete and nothing of it touches, m.
    quiet: f64,
}

impl WallWatch {
    pub(super) fn new(body: u32, surface: u32) -> Self {
        Self { body, surface, quiet: f64::NEG_INFINITY }
    }

    /// Where it stands among those of all bodies.
    pub(super) fn key(&self) -> (u32, u32) {
        (self.body, self.surface)
    }

    /// Whether the list needs work.
    #[inline]
    pub(super) fn alert(&self, odometers: &[f64]) -> bool {
        odometers[self.body as usize] > self.quiet
    }
}

/// A surface with its motion.
#[derive(Clone)]
pub(super) struct Boundary {
    pub surface: Surface,
    /// Of a mesh.
    pub facets: Option<FacetTree>,
    pub material: usize,
    /// Whether the odometers measure motion against this surface.
    pub carrier: bool,
    /// Origin and axes of the surface in the world, its velocity there and its spin.
    pub motion: Motion,
}

/// Skin of the candidates, in skins.
const WIDE: f64 = 6.0;
/// How far a body that has no candidate looks for walls, in skins: one far from all of them rests long.
const LOOKOUT: f64 = 24.0;

impl WallList {
    pub(super) fn new() -> Self {
        Self {
            grips: Vec::new(),
            held: Vec::new(),
            facets: Vec::new(),
            listed: Lease::NONE,
            candidates: Vec::new(),
            sought: Lease::NONE,
            mark: f64::NEG_INFINITY,
        }
    }

    /// Makes sure every sphere and facet that touch are listed.
    #[inline(always)]
    pub(super) fn refresh(
        &mut self,
        watch: &mut WallWatch,
        setting: &Setting<'_>,
        boundary: &Boundary,
        Scratch { facets: near, grips: memory, .. }: &mut Scratch,
    ) {
        let body = watch.body as usize;
        let travelled = setting.odometers[body];
        if boundary.carrier && travelled <= self.mark {
            return;
        }
        let now = setting.motions[body].seen_from(&boundary.motion);
        let outline = &setting.outlines[setting.bodies[body].shape];
        let left = self.listed.left(&now);
        if self.listed.holds(left) {
            self.mark = travelled + left;
            return;
        }
        if self.sought.left(&now) < setting.skin {
            near.clear();
            if let Some(facets) = &boundary.facets {
                let reach = Vector3::repeat(outline.bounding_radius + LOOKOUT * setting.skin);
                facets.near(&(now.position - reach), &(now.position + reach), near);
            } else {
                near.push(0);
            }
            self.seek(outline, &boundary.surface, now, setting.skin, near);
        }
        // What is no candidate has at least this gap.
        let rest = self.sought.left(&now);
        self.listed = self.list(outline, &boundary.surface, now, (setting.skin, rest), memory);
        self.mark = travelled + self.listed.left(&now);
    }

    /// Finds the candidates among the facets `near`: eight spheres at a time, with what their gap is at least.
    #[inline(always)]
    fn seek(&mut self, outline: &Outline, surface: &Surface, at: Relative, skin: f64, near: &[u32]) {
        let (wide, lookout) = (WIDE * skin, LOOKOUT * skin);
        let mut nearest = f32x8::splat(lookout as f32);
        self.candidates.clear();
        for &f in near {
            let planes = seen_by_body(&surface.planes(f), &at);
            for (k, &[x, y, z, radius]) in outline.eights.iter().enumerate() {
                let [x, y, z, radius] = [x, y, z, radius].map(f32x8::new);
                let [height, past @ ..] = planes.map(|[nx, ny, nz, from]| nx * x + ny * y + nz * z - from);
                let past = past.into_iter().fold(f32x8::ZERO, f32x8::fast_max);
                let gap = (height * height + past * past).sqrt() - radius;
                nearest = nearest.fast_min(gap);
                let mut met = gap.simd_lt(f32x8::splat(wide as f32)).to_bitmask();
                while met != 0 {
                    self.candidates.push((8 * k as u16 + met.trailing_zeros() as u16, surface.patch(f), f));
                    met &= met - 1;
                }
            }
        }
        self.candidates.sort_unstable();
        let nearest = nearest.to_array().into_iter().fold(f32::INFINITY, f32::min);
        let allowance = f64::from(nearest).max(wide) - ROUNDING * (outline.bounding_radius + lookout);
        self.sought = Lease::new(&at, &Vector3::zeros(), outline.reach, allowance);
    }

    /// Lists the candidates with a gap below the skin, and returns the lease of that: what is no candidate has a gap of `rest` at
    /// least, both in m. Springs of touching spheres stay; `memory` is where they are meanwhile.
    #[inline(always)]
    fn list(
        &mut self,
        outline: &Outline,
        surface: &Surface,
        at: Relative,
        (skin, rest): (f64, f64),
        memory: &mut Vec<Grip>,
    ) -> Lease {
        let mut allowance = rest;
        let Relative { position, rotation } = &at;
        memory.extend(self.grips.drain(..).filter(|grip| grip.touching));
        let mut memory = memory.drain(..).peekable();
        self.facets.clear();
        let patches = self.candidates.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1));
        for candidates in patches {
            let (sphere, patch, _) = candidates[0];
            let Ball { center, radius, .. } = &outline.balls[sphere as usize];
            let center = *position + *rotation * center;
            let first = self.facets.len() as u32;
            for &(.., f) in candidates {
                if surface.beyond(f, &center, radius + allowance) {
                    continue;
                }
                let gap = surface.nearest(&center, &[f]).distance - radius;
                if gap < skin {
                    self.facets.push(f);
                } else {
                    allowance = allowance.min(gap);
                }
            }
            let facets = (first, self.facets.len() as u32);
            if facets.0 == facets.1 {
                continue;
            }
            // What touched and is out of reach now must still let go of its spring: see `hand_over`.
            while let Some(gone) = memory.next_if(|g| (g.sphere, g.patch) < (sphere, patch)) {
                self.grips.push(Grip { facets: (0, 0), ..gone });
            }
            let known = memory.next_if(|g| (g.sphere, g.patch) == (sphere, patch));
            let (touching, spring) = known.map_or_else(Default::default, |g| (true, g.spring));
            self.grips.push(Grip { sphere, patch, facets, touching, until: f64::NEG_INFINITY, spring });
        }
        self.grips.extend(memory.map(|gone| Grip { facets: (0, 0), ..gone }));
        Lease::new(&at, &Vector3::zeros(), outline.reach, allowance)
    }

    /// Hands what touches to `batch`, whose owner keeps this list at `list`.
    #[inline(always)]
    pub(super) fn look(
        &mut self,
        watch: &mut WallWatch,
        list: usize,
        setting: &Setting<'_>,
        boundary: &Boundary,
        Scratch { places, .. }: &mut Scratch,
        batch: &mut Batch,
    ) {
        let body = watch.body as usize;
        let constants = &setting.bodies[body];
        let motion = &setting.motions[body];
        let balls = &setting.outlines[constants.shape].balls;
        let surface = &boundary.motion;
        let offset = motion.position - surface.position;
        let travelled = setting.odometers[body];
        places.clear();
        self.held.clear();
        let (mut seen, mut arm, mut local) = (None, Vector3::zeros(), Vector3::zeros());
        let (mut quiet, mut changed) = (self.mark, false);
        for k in 0..self.grips.len() {
            let grip = &self.grips[k];
            if travelled < grip.until {
                quiet = quiet.min(grip.until);
                continue;
            }
            let sphere = &balls[grip.sphere as usize];
            if seen != Some(grip.sphere) {
                seen = Some(grip.sphere);
                arm = motion.rotation * sphere.center;
                local = surface.rotation.tr_mul(&(offset + arm));
            }
            let nearest = boundary.surface.nearest(&local, self.facets_of(grip));
            let overlap = sphere.radius - nearest.distance;
            let holds =
                overlap > 0.0 && (nearest.shared.is_empty() || !self.taken(&nearest, k, &local, boundary));
            changed |= holds != grip.touching;
            if holds {
                self.held.push(k as u32);
                let between = surface.rotation * nearest.normal * nearest.distance.max(f64::EPSILON);
                places.push((Place { arm, between, radius: sphere.radius, other: 0.0 }, grip.spring));
            } else if overlap <= 0.0 && boundary.carrier {
                self.grips[k].until = travelled - overlap;
                quiet = quiet.min(travelled - overlap);
            }
        }
        watch.quiet = if boundary.carrier && places.is_empty() { quiet } else { f64::NEG_INFINITY };
        if changed {
            self.hand_over(places);
        }
        if !places.is_empty() {
            let law = setting.law(constants.material, boundary.material);
            let sides = (&setting.side(body), &Side::surface(surface));
            let springs = places.iter().map(|(_, spring)| *spring);
            let places = (batch.add(law, places.iter().map(|(place, _)| place)), springs);
            batch.meet((watch.body, watch.surface), list, places, law, sides);
        }
    }

    /// The springs of what touches, in the order of the places handed in.
    pub(super) fn keep(&mut self, springs: impl Iterator<Item = Spring>) {
        for (k, spring) in self.held.iter().zip(springs) {
            self.grips[*k as usize].spring = spring;
        }
    }

    /// The patch's facets near the sphere.
    #[inline(always)]
    fn facets_of(&self, grip: &Grip) -> &[u32] {
        &self.facets[grip.facets.0 as usize..grip.facets.1 as usize]
    }

    /// Whether another patch of the same sphere already feels this place of grip `own`: the place lies on a border with
    /// that patch, and that patch is nearer to the sphere (or as near and first).
    fn taken(&self, nearest: &Nearest<'_>, own: usize, local: &Vector3<f64>, boundary: &Boundary) -> bool {
        let same = |grip: &&Grip| grip.sphere == self.grips[own].sphere;
        let (before, after) = (&self.grips[..own], &self.grips[own + 1..]);
        let at = |other: &Grip| {
            let shares = nearest.shared.contains(&other.patch);
            if shares {
                boundary.surface.nearest(local, self.facets_of(other)).distance
            } else {
                f64::INFINITY
            }
        };
        before.iter().rev().take_while(same).any(|other| at(other) <= nearest.distance)
            || after.iter().take_while(same).any(|other| at(other) < nearest.distance)
    }

    /// The spring of a patch that lets go of a sphere moves to a patch that takes it on in the same step; `places` are
    /// those of the grips that hold.
    fn hand_over(&mut self, places: &mut [(Place, Spring)]) {
        let mut freed = BTreeMap::new();
        let mut held = self.held.iter().peekable();
        for (k, grip) in self.grips.iter_mut().enumerate() {
            let holds = held.next_if(|held| **held as usize == k).is_some();
            if grip.touching && !holds {
                grip.touching = false;
                freed.insert(grip.sphere, std::mem::take(&mut grip.spring));
            }
        }
        for (k, (_, spring)) in self.held.iter().zip(places) {
            let grip = &mut self.grips[*k as usize];
            if !grip.touching {
                grip.touching = true;
                *spring = freed.remove(&grip.sphere).unwrap_or_default();
            }
        }
    }
}

/// The planes in the body's axes.
#[inline(always)]
fn seen_by_body(planes: &Planes, at: &Relative) -> [[f32x8; 4]; 4] {
    std::array::from_fn(|k| {
        let [x, y, z, from] = planes.map(|row| row[k]);
        let normal = Vector3::new(x, y, z);
        let n = at.rotation.tr_mul(&normal);
        [n.x, n.y, n.z, from - normal.dot(&at.position)].map(|x| f32x8::splat(x as f32))
    })
}
