//! A body near a surface: the list of spheres and facets that may touch, its budget, and its forces.
//!
//! A sphere feels one contact per smooth patch, at the place of the patch nearest to it, and its spring stays with it
//! while it moves from facet to facet. Where two patches meet in a convex edge, the place is felt once; a spring moves
//! over to the patch that takes the sphere on. In a concave corner both patches push.

use super::law::Spring;
use super::pairs::Setting;
use super::resolve::{Exchange, Partner, Place, Remembers, resolve};
use super::surface::{Nearest, Surface};
use crate::world::Motion;
use nalgebra::{Matrix3, Vector3};

/// One sphere against one patch.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Grip {
    pub sphere: u16,
    pub patch: u32,
    /// The patch's facets near the sphere: a range of [`WallList::facets`].
    facets: (u32, u32),
    pub touching: bool,
    pub spring: Spring,
}

impl Remembers for Grip {
    fn spring(&mut self) -> &mut Spring {
        &mut self.spring
    }
}

/// One body against one surface.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct WallList {
    pub body: u32,
    pub surface: u32,
    /// Sorted by (sphere, patch).
    pub grips: Vec<Grip>,
    facets: Vec<u32>,
    built: (Vector3<f64>, Matrix3<f64>),
    allowance: f64,
    mark: f64,
    pub exchange: Exchange,
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

/// Lists look this many skins around, so that bodies far from a wall rest long.
const LOOKOUT: f64 = 16.0;
/// A list is renewed when less than this share of its skin is left.
const RENEW: f64 = 0.3;

impl WallList {
    pub(super) fn new(body: u32, surface: u32) -> Self {
        Self {
            body,
            surface,
            grips: Vec::new(),
            facets: Vec::new(),
            built: (Vector3::zeros(), Matrix3::zeros()),
            allowance: 0.0,
            mark: f64::NEG_INFINITY,
            exchange: Exchange::default(),
        }
    }

    /// Makes sure every sphere and facet that touch are listed. `facets_near` fills the facets of the surface whose
    /// boxes meet a box (surface axes, m).
    #[inline]
    pub(super) fn refresh(
        &mut self,
        setting: &Setting<'_>,
        boundary: &Boundary,
        facets_near: impl Fn(&Vector3<f64>, &Vector3<f64>, &mut Vec<u32>),
        scratch: &mut Vec<u32>,
    ) {
        let travelled = setting.odometers[self.body as usize];
        if boundary.carrier && travelled <= self.mark {
            return;
        }
        let motion = &setting.motions[self.body as usize];
        let position = boundary.motion.rotation.tr_mul(&(motion.position - boundary.motion.position));
        let rotation = boundary.motion.rotation.tr_mul(&motion.rotation);
        let outline = &setting.outlines[setting.bodies[self.body as usize].shape];
        let turned = (3.0 - self.built.1.dot(&rotation)).max(0.0).sqrt();
        let left = self.allowance - (position - self.built.0).norm() - turned * outline.reach;
        if left > RENEW * self.allowance {
            self.mark = travelled + left;
            return;
        }
        self.built = (position, rotation);
        let lookout = LOOKOUT * setting.skin;
        scratch.clear();
        match &boundary.surface {
            Surface::Plane(point, normal) => {
                if (position - point).dot(normal) < outline.bounding_radius + lookout {
                    scratch.push(0);
                }
            }
            Surface::Mesh(_) => {
                let reach = Vector3::repeat(outline.bounding_radius + lookout);
                facets_near(&(position - reach), &(position + reach), scratch);
                scratch.sort_unstable();
            }
        }
        self.rebuild(setting, boundary, scratch);
        self.mark = travelled + self.allowance;
    }

    fn rebuild(&mut self, setting: &Setting<'_>, boundary: &Boundary, near: &mut Vec<u32>) {
        let (position, rotation) = self.built;
        let outline = &setting.outlines[setting.bodies[self.body as usize].shape];
        let old = std::mem::take(&mut self.grips);
        let mut memory = old.into_iter().filter(|g| g.touching).peekable();
        self.facets.clear();
        let mut nearest = LOOKOUT * setting.skin;
        let patch_of = |f: u32| match &boundary.surface {
            Surface::Plane(..) => 0,
            Surface::Mesh(all) => all[f as usize].patch,
        };
        if let Surface::Mesh(all) = &boundary.surface {
            near.retain(|f| !all[*f as usize].beyond(&position, outline.bounding_radius + nearest));
        }
        near.sort_by_key(|f| (patch_of(*f), *f));
        for (i, sphere) in outline.spheres.iter().enumerate() {
            let center = position + rotation * sphere.center;
            let mut k = 0;
            while k < near.len() {
                let patch = patch_of(near[k]);
                let first = self.facets.len() as u32;
                while k < near.len() && patch_of(near[k]) == patch {
                    let f = near[k];
                    k += 1;
                    if let Surface::Mesh(all) = &boundary.surface
                        && all[f as usize].beyond(&center, sphere.radius + nearest)
                    {
                        continue;
                    }
                    let gap = boundary.surface.nearest(&center, &[f]).distance - sphere.radius;
                    if gap < setting.skin {
                        self.facets.push(f);
                    } else {
                        nearest = nearest.min(gap);
                    }
                }
                let last = self.facets.len() as u32;
                if last == first {
                    continue;
                }
                nearest = nearest.min(setting.skin);
                let key = (i as u16, patch);
                // What touched and is out of reach now must still let go of its spring: see `hand_over`.
                while let Some(gone) = memory.next_if(|g| (g.sphere, g.patch) < key) {
                    self.grips.push(Grip { facets: (first, first), ..gone });
                }
                let (touching, spring) = match memory.next_if(|g| (g.sphere, g.patch) == key) {
                    Some(grip) => (true, grip.spring),
                    None => (false, Spring::default()),
                };
                self.grips.push(Grip { sphere: key.0, patch, facets: (first, last), touching, spring });
            }
        }
        self.grips.extend(memory.map(|gone| Grip { facets: (0, 0), ..gone }));
        self.allowance = nearest.max(setting.skin);
    }

    /// Forces of this step, left in `exchange`.
    #[inline]
    pub(super) fn evaluate(&mut self, setting: &Setting<'_>, boundary: &Boundary, places: &mut Vec<Place>) {
        self.exchange.contacts = 0;
        if self.grips.is_empty() {
            return;
        }
        let constants = &setting.bodies[self.body as usize];
        let motion = &setting.motions[self.body as usize];
        let spheres = &setting.outlines[constants.shape].spheres;
        let surface = &boundary.motion;
        let between = motion.position - surface.position;
        places.clear();
        let mut deepest: f64 = 0.0;
        let mut first = 0;
        while first < self.grips.len() {
            let i = self.grips[first].sphere;
            let last = first + self.grips[first..].iter().take_while(|g| g.sphere == i).count();
            let sphere = &spheres[i as usize];
            let arm = motion.rotation * sphere.center;
            let local = surface.rotation.tr_mul(&(between + arm));
            let start = places.len();
            for k in first..last {
                let grip = &self.grips[k];
                let (from, to) = grip.facets;
                let nearest = boundary.surface.nearest(&local, &self.facets[from as usize..to as usize]);
                let overlap = sphere.radius - nearest.distance;
                if overlap <= 0.0 || self.taken(&nearest, first..last, k, &local, boundary) {
                    continue;
                }
                let normal = surface.rotation * nearest.normal;
                // The sphere's deepest point: a wall has no centre to share the overlap with.
                let arm_a = arm + normal * sphere.radius;
                let arm_b = between + arm_a;
                deepest = deepest.max(overlap / sphere.radius);
                places.push(Place {
                    link: k,
                    normal,
                    overlap,
                    contact_radius: (sphere.radius * overlap).sqrt(),
                    arm_a,
                    arm_b,
                    velocity: surface.velocity_at(&arm_b) - motion.velocity_at(&arm_a),
                });
            }
            self.hand_over(first..last, &places[start..]);
            first = last;
        }
        if places.is_empty() {
            return;
        }
        let law = setting.law(constants.material, boundary.material);
        let inverse_inertia = Vector3::zeros();
        let wall = Partner { motion: surface, inverse_mass: 0.0, inverse_inertia, softness: 0.0 };
        let sides = (setting.partner(self.body as usize), wall);
        self.exchange = resolve(places, sides, law, setting.damping, setting.dt, &mut self.grips);
        self.exchange.deepest = deepest;
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

    /// The spring of a patch that lets go of a sphere moves to a patch that takes it on in the same step.
    fn hand_over(&mut self, grips: std::ops::Range<usize>, places: &[Place]) {
        let mut freed = None;
        for k in grips {
            if self.grips[k].touching && !places.iter().any(|p| p.link == k) {
                self.grips[k].touching = false;
                freed = Some(std::mem::take(&mut self.grips[k].spring));
            }
        }
        for place in places {
            let grip = &mut self.grips[place.link];
            if !grip.touching {
                grip.touching = true;
                grip.spring = freed.take().unwrap_or_default();
            }
        }
    }
}
