//! A body near a surface: the list of spheres and facets that may touch, its budget, and its forces.
//!
//! A sphere feels one contact per smooth patch, at the place of the patch nearest to it, and its spring stays with it
//! while it moves from facet to facet. Where two patches meet in a convex edge, the place is felt once; a spring moves
//! over to the patch that takes the sphere on. In a concave corner both patches push.

use super::batch::{Batch, Place};
use super::body::{Ball, Outline};
use super::law::Spring;
use super::lease::Lease;
use super::pairs::{Scratch, Setting};
use super::side::Side;
use super::surface::{Nearest, Surface};
use crate::world::{Motion, Relative};
use nalgebra::Vector3;

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
    /// Spheres and facets that were near when they were `sought`, sorted by (sphere, patch).
    candidates: Vec<(u16, u32)>,
    sought: Lease,
    mark: f64,
}

/// What is read of every body and surface in every step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct WallWatch {
    pub body: u32,
    pub surface: u32,
    /// Odometer up to which the list is complete and empty, m.
    quiet: f64,
}

impl WallWatch {
    pub(super) fn new(body: u32, surface: u32) -> Self {
        Self { body, surface, quiet: f64::NEG_INFINITY }
    }

    /// Whether the list needs work.
    #[inline]
    pub(super) fn alert(&self, odometers: &[f64]) -> bool {
        odometers[self.body as usize] > self.quiet
    }
}

/// A surface with its motion.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Boundary {
    pub surface: Surface,
    /// Index of the world's surface, for a mesh.
    pub mesh: usize,
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

    /// Makes sure every sphere and facet that touch are listed. `facets_near` fills the facets of the surface whose
    /// boxes meet a box (surface axes, m).
    #[inline]
    pub(super) fn refresh(
        &mut self,
        watch: &mut WallWatch,
        setting: &Setting<'_>,
        boundary: &Boundary,
        facets_near: impl Fn(&Boundary, &Vector3<f64>, &Vector3<f64>, &mut Vec<u32>),
        scratch: &mut Vec<u32>,
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
            scratch.clear();
            if let Surface::Mesh(_) = &boundary.surface {
                let reach = Vector3::repeat(outline.bounding_radius + LOOKOUT * setting.skin);
                facets_near(boundary, &(now.position - reach), &(now.position + reach), scratch);
            } else {
                scratch.push(0);
            }
            self.seek(outline, &boundary.surface, now, setting.skin, scratch);
        }
        // What is no candidate has at least this gap.
        self.listed = Lease { at: now, allowance: self.sought.left(&now), ..self.sought };
        self.list(outline, &boundary.surface, setting.skin);
        self.mark = travelled + self.listed.allowance;
    }

    /// Finds the candidates among the facets `near`.
    fn seek(&mut self, outline: &Outline, surface: &Surface, at: Relative, skin: f64, near: &mut Vec<u32>) {
        let Relative { position, rotation } = at;
        let (wide, mut nearest) = (WIDE * skin, LOOKOUT * skin);
        self.candidates.clear();
        near.retain(|f| !surface.beyond(*f, &position, outline.bounding_radius + nearest));
        near.sort_unstable_by_key(|f| (surface.patch(*f), *f));
        for (i, sphere) in outline.balls.iter().enumerate() {
            let center = position + rotation * sphere.center;
            for &f in near.iter() {
                if surface.beyond(f, &center, sphere.radius + nearest) {
                    continue;
                }
                let gap = surface.nearest(&center, &[f]).distance - sphere.radius;
                if gap < wide {
                    self.candidates.push((i as u16, f));
                    nearest = wide;
                } else {
                    nearest = nearest.min(gap);
                }
            }
        }
        self.sought = Lease { at, about: Vector3::zeros(), lever: outline.reach, allowance: nearest };
    }

    /// Lists the candidates with a gap below the skin; springs of touching spheres stay.
    fn list(&mut self, outline: &Outline, surface: &Surface, skin: f64) {
        let Lease { at: Relative { position, rotation }, allowance, .. } = &mut self.listed;
        let old = std::mem::take(&mut self.grips);
        let mut memory = old.into_iter().filter(|g| g.touching).peekable();
        self.facets.clear();
        let patches = self.candidates.chunk_by(|a, b| a.0 == b.0 && surface.patch(a.1) == surface.patch(b.1));
        for candidates in patches {
            let (sphere, patch) = (candidates[0].0, surface.patch(candidates[0].1));
            let Ball { center, radius, .. } = &outline.balls[sphere as usize];
            let center = *position + *rotation * center;
            let first = self.facets.len() as u32;
            for &(_, f) in candidates {
                if surface.beyond(f, &center, radius + *allowance) {
                    continue;
                }
                let gap = surface.nearest(&center, &[f]).distance - radius;
                if gap < skin {
                    self.facets.push(f);
                } else {
                    *allowance = allowance.min(gap);
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
    }

    /// Hands what touches to `batch`, whose owner keeps this list at `list`.
    #[inline]
    pub(super) fn look(
        &mut self,
        watch: &mut WallWatch,
        list: usize,
        setting: &Setting<'_>,
        boundary: &Boundary,
        Scratch { places, .. }: &mut Scratch,
        batch: &mut Batch,
    ) {
        if self.grips.is_empty() {
            watch.quiet = if boundary.carrier { self.mark } else { f64::NEG_INFINITY };
            return;
        }
        watch.quiet = f64::NEG_INFINITY;
        let body = watch.body as usize;
        let constants = &setting.bodies[body];
        let motion = &setting.motions[body];
        let balls = &setting.outlines[constants.shape].balls;
        let surface = &boundary.motion;
        let offset = motion.position - surface.position;
        let travelled = setting.odometers[body];
        places.clear();
        self.held.clear();
        let mut first = 0;
        while first < self.grips.len() {
            let i = self.grips[first].sphere;
            let last = first + self.grips[first..].iter().take_while(|g| g.sphere == i).count();
            if self.grips[first..last].iter().all(|g| travelled < g.until) {
                first = last;
                continue;
            }
            let sphere = &balls[i as usize];
            let arm = motion.rotation * sphere.center;
            let local = surface.rotation.tr_mul(&(offset + arm));
            let start = places.len();
            for k in first..last {
                let grip = &self.grips[k];
                if travelled < grip.until {
                    continue;
                }
                let (from, to) = grip.facets;
                let nearest = boundary.surface.nearest(&local, &self.facets[from as usize..to as usize]);
                let overlap = sphere.radius - nearest.distance;
                if overlap <= 0.0 && boundary.carrier {
                    self.grips[k].until = travelled - overlap;
                }
                if overlap <= 0.0 || self.taken(&nearest, first..last, k, &local, boundary) {
                    continue;
                }
                self.held.push(k as u32);
                places.push(Place {
                    arm,
                    between: surface.rotation * nearest.normal * nearest.distance.max(f64::EPSILON),
                    reach: sphere.radius,
                    radius: sphere.radius,
                    curvature: sphere.curvature,
                    sharpness: sphere.curvature,
                    spring: self.grips[k].spring,
                });
            }
            self.hand_over(first..last, start, &mut places[start..]);
            first = last;
        }
        if !places.is_empty() {
            let law = setting.law(constants.material, boundary.material);
            let sides = (&setting.side(body), &Side::surface(surface));
            let shared = batch.meet((watch.body, watch.surface), list, law, sides);
            for place in &*places {
                batch.take(&shared, place);
            }
        }
    }

    /// The springs of what touches, in the order of the places handed in.
    pub(super) fn keep(&mut self, springs: impl Iterator<Item = Spring>) {
        for (k, spring) in self.held.iter().zip(springs) {
            self.grips[*k as usize].spring = spring;
        }
    }

    /// Whether another patch of the same sphere already feels this place: the place lies on a border with that patch,
    /// and that patch is nearer to the sphere (or as near and first).
    fn taken(
        &self,
        nearest: &Nearest<'_>,
        same_sphere: std::ops::Range<usize>,
        own: usize,
        local: &Vector3<f64>,
        boundary: &Boundary,
    ) -> bool {
        if nearest.shared.is_empty() {
            return false;
        }
        same_sphere.into_iter().any(|k| {
            let other = &self.grips[k];
            if k == own || !nearest.shared.contains(&other.patch) {
                return false;
            }
            let (from, to) = other.facets;
            let there = boundary.surface.nearest(local, &self.facets[from as usize..to as usize]).distance;
            there < nearest.distance || (there == nearest.distance && k < own)
        })
    }

    /// The spring of a patch that lets go of a sphere moves to a patch that takes it on in the same step; `places` are
    /// those of the grips that hold from `start` on.
    fn hand_over(&mut self, grips: std::ops::Range<usize>, start: usize, places: &mut [Place]) {
        let held = &self.held[start..];
        let mut freed = None;
        for k in grips {
            if self.grips[k].touching && !held.contains(&(k as u32)) {
                self.grips[k].touching = false;
                freed = Some(std::mem::take(&mut self.grips[k].spring));
            }
        }
        for (k, place) in held.iter().zip(places) {
            let grip = &mut self.grips[*k as usize];
            if !grip.touching {
                grip.touching = true;
                place.spring = freed.take().unwrap_or_default();
            }
        }
    }
}
