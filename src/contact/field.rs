//! All contacts of a run.

use super::body::{Ball, BodyConstants, Load, Outline};
use super::groups::{Group, Groups};
use super::law::PairLaw;
use super::links::Grasp;
use super::pairs::Setting;
use super::sieve::{GRAIN, Pose};
use super::surface::Surface;
use super::tasks::{DESK, Findings, PairTask, WallTask};
use super::walls::{Boundary, WallList, WallWatch};
use crate::scene::{DampingMass, Scene};
use crate::shapes::{SurfaceMesh, TabletShape};
use crate::world::{FacetTree, Motion, NearChanges, reorder};
use nalgebra::Vector3;
use rayon::prelude::*;

/// The common skin of lists, as a share of the largest bounding radius. Small skins are used up quickly and lists are
/// rebuilt often; large ones hold many pairs that do not touch.
const SKIN: f64 = 0.02;
/// Square of the angle, rad², by which an oscillation may go on in a step of velocity Verlet.
const STABLE: f64 = 4.0;
/// Bodies whose walls one task takes: a fixed number, so that results do not depend on the number of threads.
const CHUNK: usize = 128;

/// Force and torque on one body.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub struct Wrench {
    /// N.
    pub force: Vector3<f64>,
    /// About the centre of mass, N m.
    pub torque: Vector3<f64>,
}

impl Wrench {
    /// What `gravity`, m/s², does to a mass, kg.
    #[inline]
    pub fn weight(gravity: &Vector3<f64>, mass: f64) -> Self {
        Self { force: gravity * mass, torque: Vector3::zeros() }
    }
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
    /// Bodies held stiffer than the step bears, whose forces were lowered.
    pub stiff: u32,
}

/// What of all contacts lasts from one step to the next.
#[derive(Debug, Clone)]
pub struct Kept {
    touching: Vec<Grasp>,
    loads: Vec<Load>,
    walls: (Vec<WallWatch>, Vec<WallList>),
}

/// Every body, surface, list and spring.
#[derive(Clone)]
pub struct ContactField {
    outlines: Vec<Outline>,
    /// The spheres of all outlines.
    balls: Vec<Ball>,
    bodies: Vec<BodyConstants>,
    /// Of the bodies in this step; none where all shapes are single spheres.
    poses: Option<Vec<Pose>>,
    /// Of each body in the last step.
    loads: Vec<Load>,
    pub(super) laws: Vec<PairLaw>,
    materials: usize,
    /// Whether bodies are of several materials.
    mixed: bool,
    damping: DampingMass,
    /// Whether single contacts are kept for [`ContactField::contacts`].
    pub(super) keep_contacts: bool,
    skin: f64,
    /// m.
    grain: f64,
    /// Of each task over pairs.
    pub(super) groups: Groups,
    boundaries: Vec<Boundary>,
    pub(super) wall_watches: Vec<WallWatch>,
    /// The lists of `wall_watches`, in the same order.
    pub(super) walls: Vec<WallList>,
    /// Of each task over walls.
    pub(super) found_at_walls: Vec<Findings>,
    /// Torque on each surface about its own origin in the last step, N m.
    surface_torques: Vec<Vector3<f64>>,
}

impl ContactField {
    /// A field without bodies and surfaces.
    pub fn new(scene: &Scene, shapes: &[TabletShape]) -> Self {
        let largest = shapes.iter().map(|shape| shape.clump.bounding_radius()).fold(0.0, f64::max);
        let grain = GRAIN * largest;
        let mut balls = Vec::new();
        let outlines = shapes.iter().map(|shape| {
            let outline = Outline::new(&shape.clump, &shape.inertia_per_mass, balls.len() as u32, grain);
            balls.extend_from_slice(&outline.balls);
            outline
        });
        let outlines: Vec<_> = outlines.collect();
        let single = balls.iter().all(|ball| ball.center == Vector3::zeros());
        let n = scene.materials.len();
        let laws = (0..n * n).map(|k| {
            let (a, b) = (k / n, k % n);
            PairLaw::new(&scene.materials[a], &scene.materials[b], scene.pairs.get(a, b), scene.contact)
        });
        Self {
            outlines,
            balls,
            bodies: Vec::new(),
            poses: (!single).then(Vec::new),
            loads: Vec::new(),
            laws: laws.collect(),
            materials: n,
            mixed: false,
            damping: scene.contact.damping_mass,
            keep_contacts: false,
            skin: SKIN * largest,
            grain,
            groups: Groups::default(),
            boundaries: Vec::new(),
            wall_watches: Vec::new(),
            walls: Vec::new(),
            found_at_walls: Vec::new(),
            surface_torques: Vec::new(),
        }
    }

    /// Adds a body of the given shape and material, mass in kg, principal moments in kg m².
    pub fn add_body(&mut self, shape: usize, material: usize, mass: f64, inertia: &Vector3<f64>) {
        let body = self.bodies.len() as u32;
        let inverse_inertia = inertia.map(|i| 1.0 / i);
        let inverse_mass = 1.0 / mass;
        let softness = inverse_mass * self.outlines[shape].softness;
        self.loads.push(Load::default());
        self.mixed |= self.bodies.first().is_some_and(|first| first.material != material);
        self.bodies.push(BodyConstants { shape, material, inverse_mass, inverse_inertia, softness });
        let surfaces = self.boundaries.len() as u32;
        self.wall_watches.extend((0..surfaces).map(|surface| WallWatch::new(body, surface)));
        self.walls.resize(self.wall_watches.len(), WallList::new());
    }

    /// Numbers the bodies anew, those whose numbers were `order` from 0 on. Springs stay; no two bodies count as near each
    /// other until a search says so.
    pub fn renumber(&mut self, order: &[u32]) {
        let mut numbers = vec![0; order.len()];
        for (number, old) in order.iter().enumerate() {
            numbers[*old as usize] = number as u32;
        }
        reorder(&mut self.bodies, order);
        reorder(&mut self.loads, order);
        self.groups.renumber(&numbers);
        self.wall_watches.iter_mut().for_each(|watch| watch.body = numbers[watch.body as usize]);
        let mut walls: Vec<_> = self.wall_watches.drain(..).zip(self.walls.drain(..)).collect();
        walls.sort_unstable_by_key(|(watch, _)| watch.key());
        (self.wall_watches, self.walls) = walls.into_iter().unzip();
    }

    /// What lasts from step to step, to [`ContactField::restore`] it: the rest can be made anew.
    pub fn keep(&self) -> Kept {
        Kept {
            touching: self.groups.touching().collect(),
            loads: self.loads.clone(),
            walls: (self.wall_watches.clone(), self.walls.clone()),
        }
    }

    /// Goes back to what was kept of the same bodies; no two of them count as near each other until a search says so.
    pub fn restore(&mut self, kept: Kept) {
        self.groups.restore(&kept.touching, self.bodies.len());
        self.loads = kept.loads;
        (self.wall_watches, self.walls) = kept.walls;
    }

    /// Adds a triangle surface with the tree of its facets; must come before the bodies. `carrier`: the surface whose motion
    /// the bed shares.
    pub fn add_mesh(&mut self, mesh: &SurfaceMesh, facets: FacetTree, material: usize, carrier: bool) {
        self.add_surface(Surface::mesh(mesh), Some(facets), material, carrier);
    }

    /// Adds an unbounded plane through `point` with the unit normal pointing to the bodies; must come before the bodies.
    pub fn add_plane(&mut self, point: Vector3<f64>, normal: Vector3<f64>, material: usize) {
        self.add_surface(Surface::Plane(point, normal), None, material, false);
    }

    fn add_surface(&mut self, surface: Surface, facets: Option<FacetTree>, material: usize, carrier: bool) {
        debug_assert!(self.bodies.is_empty());
        self.boundaries.push(Boundary { surface, facets, material, carrier, motion: Motion::at_rest() });
        self.surface_torques.push(Vector3::zeros());
    }

    /// Forces and torques of all contacts, added to `wrenches` in the order of pairs and bodies whatever the number of
    /// threads. `surfaces` are the motions of all surfaces at the same instant, `odometers` the distances that each body's
    /// farthest sphere centre can have moved against the carrier so far, m; `search` tells which bodies are near each other,
    /// which walls need not wait for; springs advance by `dt`, s.
    pub fn add_forces(
        &mut self,
        motions: &[Motion],
        surfaces: &[Motion],
        odometers: &[f64],
        search: impl FnOnce() -> NearChanges + Send,
        dt: f64,
        wrenches: &mut [Wrench],
    ) -> Tally {
        for (boundary, motion) in self.boundaries.iter_mut().zip(surfaces) {
            boundary.motion = *motion;
        }
        let setting = Setting {
            outlines: &self.outlines,
            balls: &self.balls,
            bodies: &self.bodies,
            motions,
            odometers,
            loads: &self.loads,
            materials: self.materials,
            mixed: self.mixed,
            skin: self.skin,
            dt,
        };
        let (laws, boundaries, damping) = (&self.laws, &self.boundaries, self.damping);
        let (setting, keep_contacts) = (&setting, self.keep_contacts);
        let walls = |((watches, lists), findings)| {
            DESK.with_borrow_mut(|desk| {
                let task = WallTask {
                    watches,
                    lists,
                    desk,
                    findings,
                    setting,
                    laws,
                    damping,
                    keep_contacts,
                    boundaries,
                };
                pulp::Arch::new().dispatch(task);
            });
        };
        self.found_at_walls.resize_with(self.walls.len().div_ceil(CHUNK), Findings::default);
        let wall_lists = self.wall_watches.par_chunks_mut(CHUNK).zip(self.walls.par_chunks_mut(CHUNK));
        let (groups, poses, grain) = (&mut self.groups, &mut self.poses, self.grain);
        // Tasks go one by one: a thread that is through takes over what another has not begun.
        rayon::join(
            || {
                let NearChanges { parted, met } = search();
                groups.change(&parted, &met, motions.len(), |body| setting.outline(body as usize));
                if let Some(poses) = poses {
                    poses.resize(motions.len(), Pose::default());
                    poses.iter_mut().zip(motions).for_each(|(pose, motion)| pose.follow(motion, grain));
                }
                let poses = poses.as_deref();
                groups.all.par_iter_mut().with_max_len(1).for_each(|group| {
                    DESK.with_borrow_mut(|desk| {
                        let task = PairTask { group, desk, setting, poses, laws, damping, keep_contacts };
                        pulp::Arch::new().dispatch(task);
                    });
                });
            },
            || wall_lists.zip(&mut self.found_at_walls).with_max_len(1).for_each(walls),
        );
        let mut tally = self.gather(wrenches);
        tally.stiff = self.ease(wrenches, dt);
        tally
    }

    /// Sums over what touches in the order of the lists: the same bits for any number of threads.
    fn gather(&mut self, wrenches: &mut [Wrench]) -> Tally {
        let mut tally = Tally::default();
        let loads = &mut self.loads;
        loads.fill(Load::default());
        for torque in &mut self.surface_torques {
            *torque = Vector3::zeros();
        }
        for exchange in self.found_at_walls.iter().flat_map(|found| &found.touching) {
            let body = &mut wrenches[exchange.a as usize];
            body.force -= exchange.force;
            body.torque += exchange.torque_a;
            loads[exchange.a as usize] += exchange.load;
            self.surface_torques[exchange.b as usize] += exchange.torque_b;
            tally.wall_contacts += exchange.contacts;
            tally.deepest = tally.deepest.max(exchange.deepest);
        }
        for Group { findings, .. } in &self.groups.all {
            tally.rebuilt += findings.rebuilt;
            for exchange in &findings.touching {
                let a = &mut wrenches[exchange.a as usize];
                a.force -= exchange.force;
                a.torque += exchange.torque_a;
                let b = &mut wrenches[exchange.b as usize];
                b.force += exchange.force;
                b.torque += exchange.torque_b;
                loads[exchange.a as usize] += exchange.load;
                loads[exchange.b as usize] += exchange.load;
                tally.sphere_contacts += exchange.contacts;
                tally.deepest = tally.deepest.max(exchange.deepest);
            }
        }
        tally
    }

    /// Lowers all forces on bodies that are held stiffer than the step of `dt` s bears, and returns how many they are.
    ///
    /// Derived here: velocity Verlet is stable while λ dt² < [`STABLE`] for all squares λ of angular frequencies. A body whose
    /// partners hold still has none above K = s Σ k over its contacts, s its softness, whose tangential springs are no stiffer than
    /// the normal ones. One with K dt² above that answers all forces, weight included, as if its mass and moments were larger
    /// by as much. What balances still does; momentum is not conserved, as its partners feel the whole forces. No step fine
    /// enough knows of it.
    fn ease(&self, wrenches: &mut [Wrench], dt: f64) -> u32 {
        let mut stiff = 0;
        for ((wrench, load), body) in wrenches.iter_mut().zip(&self.loads).zip(&self.bodies) {
            let excess = load.stiffness * body.softness * (dt * dt) / STABLE;
            if excess > 1.0 {
                wrench.force /= excess;
                wrench.torque /= excess;
                stiff += 1;
            }
        }
        stiff
    }

    /// The deepest contact of the last step: its body, and the other body or the surface.
    pub fn deepest(&self) -> Option<(usize, Partner)> {
        let pairs = self.groups.all.iter().flat_map(|group| &group.findings.touching);
        let pairs = pairs.map(|e| (e.deepest, e.a, Partner::Body(e.b as usize)));
        let walls = self.found_at_walls.iter().flat_map(|found| &found.touching);
        let walls = walls.map(|e| (e.deepest, e.a, Partner::Surface(e.b as usize)));
        let deepest = pairs.chain(walls).max_by(|a, b| a.0.total_cmp(&b.0));
        deepest.map(|(_, body, partner)| (body as usize, partner))
    }

    /// Torque of the bodies on a surface about the surface's origin in the last step, N m.
    pub fn surface_torque(&self, surface: usize) -> Vector3<f64> {
        self.surface_torques[surface]
    }

    /// The numbers of touching spheres in their bodies.
    pub(super) fn spheres(&self, Grasp { bodies, balls, .. }: &Grasp) -> (u32, u32) {
        let first = |body: u32| self.outlines[self.bodies[body as usize].shape].first;
        (balls.0 - first(bodies.0), balls.1 - first(bodies.1))
    }

    /// The springs of all touching contacts in a fixed order: (a, b, i, j, stretch).
    pub fn springs(&self) -> impl Iterator<Item = (u32, u32, u32, u32, Vector3<f64>)> + '_ {
        let pairs = self.groups.touching().map(|grasp| {
            let (i, j) = self.spheres(&grasp);
            (grasp.bodies.0, grasp.bodies.1, i, j, grasp.spring.stretch)
        });
        let walls = self.wall_watches.iter().zip(&self.walls).flat_map(|(w, list)| {
            let touching = list.grips.iter().filter(|g| g.touching);
            touching.map(|g| (w.body, w.surface, u32::from(g.sphere), g.patch, g.spring.stretch))
        });
        pairs.chain(walls)
    }
}
