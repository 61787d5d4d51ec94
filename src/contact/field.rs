//! All contacts of a run.

use super::body::{BodyConstants, Outline};
use super::law::PairLaw;
use super::pairs::{BodyPair, PairWatch, Setting};
use super::resolve::Place;
use super::surface::Surface;
use super::walls::{Boundary, WallList};
use crate::scene::{DampingMass, Scene};
use crate::shapes::{SurfaceMesh, TabletShape};
use crate::world::{Motion, World};
use nalgebra::Vector3;
use rayon::prelude::*;

/// Lists keep sphere pairs with a gap below this share of the largest bounding radius. Small skins are used up quickly
/// and lists are rebuilt often; large ones hold many pairs that do not touch.
const SKIN: f64 = 0.03;
/// Pairs that one task takes: a fixed number, so that results do not depend on the number of threads.
const CHUNK: usize = 512;

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
    walls: Vec<WallList>,
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
            walls: Vec::new(),
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
        self.walls.extend((0..surfaces).map(|surface| WallList::new(body, surface)));
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
        let pairs = |(watches, pairs): (&mut [PairWatch], &mut [Box<BodyPair>])| {
            let (mut near, mut places) = (Vec::new(), Vec::<Place>::new());
            let mut rebuilt = 0;
            for (watch, pair) in watches.iter_mut().zip(pairs) {
                if watch.due(setting.odometers) {
                    rebuilt += u32::from(pair.refresh(watch, &setting, &mut near));
                }
                if watch.alert(setting.odometers) {
                    pair.evaluate(watch, &setting, &mut places);
                }
            }
            rebuilt
        };
        let walls = |chunk: &mut [WallList]| {
            let (mut near, mut places) = (Vec::new(), Vec::<Place>::new());
            for wall in chunk {
                let boundary = &boundaries[wall.surface as usize];
                let facets = |min: &Vector3<f64>, max: &Vector3<f64>, out: &mut Vec<u32>| {
                    world.facets_near(boundary.mesh, min, max, out);
                };
                wall.refresh(&setting, boundary, facets, &mut near);
                wall.evaluate(&setting, boundary, &mut places);
            }
        };
        let mut tally = Tally::default();
        if rayon::current_num_threads() > 1 {
            let (rebuilt, ()) = rayon::join(
                || {
                    let watches = self.watches.par_chunks_mut(CHUNK);
                    watches.zip(self.pairs.par_chunks_mut(CHUNK)).map(pairs).sum::<u32>()
                },
                || self.walls.par_chunks_mut(CHUNK).for_each(walls),
            );
            tally.rebuilt = rebuilt;
        } else {
            tally.rebuilt = pairs((&mut self.watches, &mut self.pairs));
            walls(&mut self.walls);
        }
        self.gather(wrenches, &mut tally);
        tally
    }

    /// Sums over lists in their order: the same bits for any number of threads.
    fn gather(&mut self, wrenches: &mut [Wrench], tally: &mut Tally) {
        for torque in &mut self.surface_torques {
            *torque = Vector3::zeros();
        }
        for wall in self.walls.iter().filter(|w| w.exchange.contacts > 0) {
            let body = &mut wrenches[wall.body as usize];
            body.force -= wall.exchange.force;
            body.torque += wall.exchange.torque_a;
            self.surface_torques[wall.surface as usize] += wall.exchange.torque_b;
            tally.wall_contacts += wall.exchange.contacts;
            tally.deepest = tally.deepest.max(wall.exchange.deepest);
        }
        for (watch, pair) in self.watches.iter().zip(&self.pairs).filter(|(w, _)| w.contacts > 0) {
            let a = &mut wrenches[watch.a as usize];
            a.force -= pair.exchange.force;
            a.torque += pair.exchange.torque_a;
            let b = &mut wrenches[watch.b as usize];
            b.force += pair.exchange.force;
            b.torque += pair.exchange.torque_b;
            tally.sphere_contacts += watch.contacts;
            tally.deepest = tally.deepest.max(pair.exchange.deepest);
        }
    }

    /// The deepest contact of the last step: its body, and the other body or the surface.
    pub fn deepest(&self) -> Option<(usize, Partner)> {
        let pairs = self.watches.iter().zip(&self.pairs).filter(|(watch, _)| watch.contacts > 0);
        let pairs = pairs.map(|(w, p)| (p.exchange.deepest, w.a as usize, Partner::Body(w.b as usize)));
        let walls = self.walls.iter().filter(|w| w.exchange.contacts > 0);
        let walls =
            walls.map(|w| (w.exchange.deepest, w.body as usize, Partner::Surface(w.surface as usize)));
        pairs.chain(walls).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, body, partner)| (body, partner))
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
        let walls = self.walls.iter().flat_map(|w| {
            let touching = w.grips.iter().filter(|g| g.touching);
            touching.map(|g| (w.body, w.surface, u32::from(g.sphere), g.patch, g.spring.stretch))
        });
        pairs.chain(walls)
    }
}
