//! All contacts of a run.

use super::body::{BodyConstants, Outline};
use super::law::PairLaw;
use super::pairs::{BodyPair, Setting};
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
/// Odometers run this much fast: what a step's chord leaves of the arc, rounding included.
const SAFETY: f64 = 1.01;
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
    pairs: Vec<BodyPair>,
    boundaries: Vec<Boundary>,
    walls: Vec<WallList>,
    odometers: Vec<f64>,
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
            pairs: Vec::new(),
            boundaries: Vec::new(),
            walls: Vec::new(),
            odometers: Vec::new(),
            surface_torques: Vec::new(),
        }
    }

    /// Adds a body of the given shape and material, mass in kg, principal moments in kg m².
    pub fn add_body(&mut self, shape: usize, material: usize, mass: f64, inertia: &Vector3<f64>) {
        let body = self.bodies.len() as u32;
        let inverse_inertia = inertia.map(|i| 1.0 / i);
        self.bodies.push(BodyConstants { shape, material, inverse_mass: 1.0 / mass, inverse_inertia });
        self.odometers.push(0.0);
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
        let mut old = std::mem::take(&mut self.pairs).into_iter().peekable();
        self.pairs = near
            .iter()
            .map(|&(a, b)| {
                while old.next_if(|p| (p.a, p.b) < (a, b)).is_some() {}
                old.next_if(|p| (p.a, p.b) == (a, b)).unwrap_or_else(|| BodyPair::new(a, b))
            })
            .collect();
    }

    /// Tells the field that a body moved by `moved` m and turned by `turned` rad against the carrier.
    #[inline]
    pub fn travel(&mut self, body: usize, moved: f64, turned: f64) {
        let reach = self.outlines[self.bodies[body].shape].reach;
        self.odometers[body] += SAFETY * (moved + turned * reach);
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
            odometers: &self.odometers,
            laws: &self.laws,
            materials: self.materials,
            damping: self.damping,
            skin: self.skin,
            dt,
        };
        let boundaries = &self.boundaries;
        let pairs = |chunk: &mut [BodyPair]| {
            let (mut kept, mut places) = (Vec::new(), Vec::<Place>::new());
            let mut rebuilt = 0;
            for pair in chunk {
                rebuilt += u32::from(pair.refresh(&setting, &mut kept));
                pair.evaluate(&setting, &mut places);
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
                || self.pairs.par_chunks_mut(CHUNK).map(pairs).sum::<u32>(),
                || self.walls.par_chunks_mut(CHUNK).for_each(walls),
            );
            tally.rebuilt = rebuilt;
        } else {
            tally.rebuilt = pairs(&mut self.pairs);
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
        for pair in self.pairs.iter().filter(|p| p.exchange.contacts > 0) {
            let a = &mut wrenches[pair.a as usize];
            a.force -= pair.exchange.force;
            a.torque += pair.exchange.torque_a;
            let b = &mut wrenches[pair.b as usize];
            b.force += pair.exchange.force;
            b.torque += pair.exchange.torque_b;
            tally.sphere_contacts += pair.exchange.contacts;
            tally.deepest = tally.deepest.max(pair.exchange.deepest);
        }
    }

    /// Torque of the bodies on a surface about the surface's origin in the last step, N m.
    pub fn surface_torque(&self, surface: usize) -> Vector3<f64> {
        self.surface_torques[surface]
    }

    /// The springs of all touching contacts in a fixed order: (a, b, i, j, stretch).
    pub fn springs(&self) -> impl Iterator<Item = (u32, u32, u32, u32, Vector3<f64>)> + '_ {
        let pairs = self.pairs.iter().flat_map(|p| {
            let touching = p.links.iter().filter(|l| l.touching);
            touching.map(|l| (p.a, p.b, u32::from(l.i), u32::from(l.j), l.spring.stretch))
        });
        let walls = self.walls.iter().flat_map(|w| {
            let touching = w.grips.iter().filter(|g| g.touching);
            touching.map(|g| (w.body, w.surface, u32::from(g.sphere), g.patch, g.spring.stretch))
        });
        pairs.chain(walls)
    }
}
