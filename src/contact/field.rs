//! All contacts of a run.

use super::body::{BodyConstants, Outline};
use super::law::PairLaw;
use super::pairs::{BodyPair, PairWatch, Setting};
use super::resolve::{Exchange, Place};
use super::surface::Surface;
use super::walls::{Boundary, WallList, WallWatch};
use crate::scene::{DampingMass, Scene};
use crate::shapes::{SurfaceMesh, TabletShape};
use crate::world::{Motion, World};
use nalgebra::Vector3;
use rayon::prelude::*;

/// Lists keep sphere pairs with a gap below this share of the largest bounding radius. Small skins are used up quickly
/// and lists are rebuilt often; large ones hold many pairs that do not touch.
const SKIN: f64 = 0.02;
/// Pairs that one task takes: a fixed number, so that results do not depend on the number of threads.
const CHUNK: usize = 512;

/// Watches, their lists and what of them touches.
type Task<'a, Watch, List> = ((&'a mut [Watch], &'a mut [List]), &'a mut Vec<(u32, u32, Exchange)>);

/// Force and torque on one body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wrench {
    /// N.
    pub force: Vector3<f64>,
    /// About the centre of mass, N m.
    pub torque: Vector3<f64>,
}

/// What a body touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Partner {
    /// Another body, by index.
    Body(usize),
    /// A surface, by index: the drum first, then the boundaries.
    Surface(usize),
}

impl std::fmt::Display for Partner {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Body(k) => write!(f, "body {k}"),
            Self::Surface(k) => write!(f, "surface {k}"),
        }
    }
}

/// What the contacts of a step amount to.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Tally {
    /// Touching sphere pairs.
    pub sphere_contacts: u32,
    /// Touching spheres at surfaces.
    pub wall_contacts: u32,
    /// Largest overlap over the smaller sphere's radius, dimensionless.
    pub deepest: f64,
    /// Lists built anew.
    pub rebuilt: u32,
}

/// Every body, surface, list and spring.
pub struct ContactField {
    outlines: Vec<Outline>,
    bodies: Vec<BodyConstants>,
    laws: Vec<PairLaw>,
    materials: usize,
    damping: DampingMass,
    skin: f64,
    watches: Vec<PairWatch>,
    /// The lists of `watches`, in the same order.
    #[expect(clippy::vec_box, reason = "lists are large and change places at every search")]
    pairs: Vec<Box<BodyPair>>,
    boundaries: Vec<Boundary>,
    wall_watches: Vec<WallWatch>,
    /// The lists of `wall_watches`, in the same order.
    walls: Vec<WallList>,
    /// What touched in the last step, by task: bodies a and b.
    touching: Vec<Vec<(u32, u32, Exchange)>>,
    /// Likewise body and surface.
    touching_walls: Vec<Vec<(u32, u32, Exchange)>>,
    /// Torque on each surface about its own origin in the last step, N m.
    surface_torques: Vec<Vector3<f64>>,
}

impl ContactField {
    /// A field without bodies and surfaces.
    pub fn new(scene: &Scene, shapes: &[TabletShape]) -> Self {
        let outlines: Vec<Outline> = shapes.iter().map(|s| Outline::new(&s.clump)).collect();
        let largest = outlines.iter().map(|o| o.bounding_radius).fold(0.0, f64::max);
        let n = scene.materials.len();
        let laws = (0..n * n).map(|k| {
            let (a, b) = (k / n, k % n);
            PairLaw::new(&scene.materials[a], &scene.materials[b], scene.pairs.get(a, b), scene.contact)
        });
        Self {
            outlines,
            bodies: Vec::new(),
            laws: laws.collect(),
            materials: n,
            damping: scene.contact.damping_mass,
            skin: SKIN * largest,
            watches: Vec::new(),
            pairs: Vec::new(),
            boundaries: Vec::new(),
            wall_watches: Vec::new(),
            walls: Vec::new(),
            touching: Vec::new(),
            touching_walls: Vec::new(),
            surface_torques: Vec::new(),
        }
    }

    /// Adds a body of the given shape and material, mass in kg, principal moments in kg m².
    pub fn add_body(&mut self, shape: usize, material: usize, mass: f64, inertia: &Vector3<f64>) {
        let body = self.bodies.len() as u32;
        let inverse_inertia = inertia.map(|i| 1.0 / i);
        let inverse_mass = 1.0 / mass;
        let softness = inverse_mass + self.outlines[shape].bounding_radius.powi(2) * inverse_inertia.max();
        self.bodies.push(BodyConstants { shape, material, inverse_mass, inverse_inertia, softness });
        let surfaces = self.boundaries.len() as u32;
        self.wall_watches.extend((0..surfaces).map(|surface| WallWatch::new(body, surface)));
        self.walls.resize(self.wall_watches.len(), WallList::new());
    }

    /// Adds a triangle surface, which the world knows as `index`; must come before the bodies. `carrier`: the surface
    /// whose motion the bed shares.
    pub fn add_mesh(&mut self, mesh: &SurfaceMesh, index: usize, material: usize, carrier: bool) {
        self.add_surface(Surface::mesh(mesh), index, material, carrier);
    }

    /// Adds an unbounded plane through `point` with the unit normal pointing to the bodies; must come before the bodies.
    pub fn add_plane(&mut self, point: Vector3<f64>, normal: Vector3<f64>, material: usize) {
        self.add_surface(Surface::Plane(point, normal), 0, material, false);
    }

    fn add_surface(&mut self, surface: Surface, mesh: usize, material: usize, carrier: bool) {
        debug_assert!(self.bodies.is_empty());
        self.boundaries.push(Boundary { surface, mesh, material, carrier, motion: Motion::at_rest() });
        self.surface_torques.push(Vector3::zeros());
    }

    /// Tells the field which bodies are near each other; lists of pairs that stay are kept. Sorted, smaller index first.
    pub fn set_near(&mut self, near: &[(u32, u32)]) {
        let watches = std::mem::take(&mut self.watches).into_iter();
        let mut old = watches.zip(std::mem::take(&mut self.pairs)).peekable();
        let kept = near.iter().map(|&(a, b)| {
            while old.next_if(|(watch, _)| watch.key() < (a, b)).is_some() {}
            let same = old.next_if(|(watch, _)| watch.key() == (a, b));
            same.unwrap_or_else(|| (PairWatch::new(a, b), Box::new(BodyPair::new())))
        });
        (self.watches, self.pairs) = kept.unzip();
    }

    /// Forces and torques of all contacts, added to `wrenches` in the order of pairs and bodies whatever the number of
    /// threads. `surfaces` are the motions of all surfaces at the same instant; springs advance by `dt`, s.
    pub fn add_forces(
        &mut self,
        motions: &[Motion],
        surfaces: &[Motion],
        world: &World,
        dt: f64,
        wrenches: &mut [Wrench],
    ) -> Tally {
        for (boundary, motion) in self.boundaries.iter_mut().zip(surfaces) {
            boundary.motion = *motion;
        }
        let setting = Setting {
            outlines: &self.outlines,
            bodies: &self.bodies,
            motions,
            odometers: world.odometers(),
            laws: &self.laws,
            materials: self.materials,
            damping: self.damping,
            skin: self.skin,
            dt,
        };
        let boundaries = &self.boundaries;
        let facets = |surface: &Boundary, min: &Vector3<f64>, max: &Vector3<f64>, out: &mut Vec<u32>| {
            world.facets_near(surface.mesh, min, max, out);
        };
        let pairs = |((watches, pairs), touching): Task<'_, PairWatch, Box<BodyPair>>| {
            let (mut near, mut places) = (Vec::new(), Vec::<Place>::new());
            touching.clear();
            let mut rebuilt = 0;
            let alert = watches.iter_mut().zip(pairs).filter(|(w, _)| w.alert(setting.odometers));
            for (watch, pair) in alert {
                rebuilt += u32::from(pair.refresh(watch, &setting, &mut near));
                let exchange = pair.evaluate(watch, &setting, &mut places);
                touching.extend(exchange.map(|e| (watch.a, watch.b, e)));
            }
            rebuilt
        };
        let walls = |((watches, walls), touching): Task<'_, WallWatch, WallList>| {
            let (mut near, mut places) = (Vec::new(), Vec::<Place>::new());
            touching.clear();
            let alert = watches.iter_mut().zip(walls).filter(|(w, _)| w.alert(setting.odometers));
            for (watch, wall) in alert {
                let boundary = &boundaries[watch.surface as usize];
                wall.refresh(watch, &setting, boundary, facets, &mut near);
                let exchange = wall.evaluate(watch, &setting, boundary, &mut places);
                touching.extend(exchange.map(|e| (watch.body, watch.surface, e)));
            }
        };
        self.touching.resize_with(self.watches.len().div_ceil(CHUNK), Vec::new);
        self.touching_walls.resize_with(self.walls.len().div_ceil(CHUNK), Vec::new);
        let pair_lists = self.watches.par_chunks_mut(CHUNK).zip(self.pairs.par_chunks_mut(CHUNK));
        let wall_lists = self.wall_watches.par_chunks_mut(CHUNK).zip(self.walls.par_chunks_mut(CHUNK));
        let (rebuilt, ()) = rayon::join(
            || pair_lists.zip(&mut self.touching).map(pairs).sum::<u32>(),
            || wall_lists.zip(&mut self.touching_walls).for_each(walls),
        );
        self.gather(rebuilt, wrenches)
    }

    /// Sums over what touches in the order of the lists: the same bits for any number of threads.
    fn gather(&mut self, rebuilt: u32, wrenches: &mut [Wrench]) -> Tally {
        let mut tally = Tally { rebuilt, ..Tally::default() };
        for torque in &mut self.surface_torques {
            *torque = Vector3::zeros();
        }
        for (body, surface, exchange) in self.touching_walls.iter().flatten() {
            let body = &mut wrenches[*body as usize];
            body.force -= exchange.force;
            body.torque += exchange.torque_a;
            self.surface_torques[*surface as usize] += exchange.torque_b;
            tally.wall_contacts += exchange.contacts;
            tally.deepest = tally.deepest.max(exchange.deepest);
        }
        for (a, b, exchange) in self.touching.iter().flatten() {
            let a = &mut wrenches[*a as usize];
            a.force -= exchange.force;
            a.torque += exchange.torque_a;
            let b = &mut wrenches[*b as usize];
            b.force += exchange.force;
            b.torque += exchange.torque_b;
            tally.sphere_contacts += exchange.contacts;
            tally.deepest = tally.deepest.max(exchange.deepest);
        }
        tally
    }

    /// The deepest contact of the last step: its body, and the other body or the surface.
    pub fn deepest(&self) -> Option<(usize, Partner)> {
        let pairs = self.touching.iter().flatten();
        let pairs = pairs.map(|(a, b, e)| (e.deepest, *a, Partner::Body(*b as usize)));
        let walls = self.touching_walls.iter().flatten();
        let walls = walls.map(|(body, s, e)| (e.deepest, *body, Partner::Surface(*s as usize)));
        let deepest = pairs.chain(walls).max_by(|a, b| a.0.total_cmp(&b.0));
        deepest.map(|(_, body, partner)| (body as usize, partner))
    }

    /// Torque of the bodies on a surface about the surface's origin in the last step, N m.
    pub fn surface_torque(&self, surface: usize) -> Vector3<f64> {
        self.surface_torques[surface]
    }

    /// The springs of all touching contacts in a fixed order: (a, b, i, j, stretch).
    pub fn springs(&self) -> impl Iterator<Item = (u32, u32, u32, u32, Vector3<f64>)> + '_ {
        let pairs = self.watches.iter().zip(&self.pairs).flat_map(|(w, p)| {
            let touching = p.links.iter().filter(|l| l.touching);
            touching.map(|l| (w.a, w.b, u32::from(l.i), u32::from(l.j), l.spring.stretch))
        });
        let walls = self.wall_watches.iter().zip(&self.walls).flat_map(|(w, list)| {
            let touching = list.grips.iter().filter(|g| g.touching);
            touching.map(|g| (w.body, w.surface, u32::from(g.sphere), g.patch, g.spring.stretch))
        });
        pairs.chain(walls)
    }
}
