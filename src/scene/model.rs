//! The validated scene. All numbers are SI; all references between parts are indices into the scene's own lists.

use super::Recipe;
use super::clump::{Placement, SphereBudget};
use super::drum::Drum;
use super::pattern::Pattern;
use nalgebra::{UnitQuaternion, Vector3};
use std::path::PathBuf;

/// Everything a run needs to know, checked: no later room meets a number out of range.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// One line that names the run in its report.
    pub title: String,
    /// Seed of every random choice (filling).
    pub seed: u64,
    /// Acceleration of gravity, m/s².
    pub gravity: Vector3<f64>,
    /// Materials of tablets and boundaries.
    pub materials: Vec<Material>,
    /// Friction and restitution of each pair of materials.
    pub pairs: PairTable,
    /// Tablet shapes, by name.
    pub shapes: Vec<Shape>,
    /// What is filled into the drum. Empty when the scene has free bodies only.
    pub batches: Vec<Batch>,
    /// The pan. `None`: free bodies and boundaries only.
    pub drum: Option<Drum>,
    /// Bodies placed one by one.
    pub bodies: Vec<FreeBody>,
    /// Planes, boxes and meshes other than the drum.
    pub boundaries: Vec<Boundary>,
    /// Choices of the contact law.
    pub contact: ContactSettings,
    /// Step, settling, duration and frames.
    pub time: Time,
    /// The spray. `None`: no panels, no coater.
    pub spray: Option<Spray>,
    /// What is written.
    pub outputs: Outputs,
}

/// A linear elastic material.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// Name by which shapes and pairs call it.
    pub name: String,
    /// Shear modulus G, Pa.
    pub shear_modulus: f64,
    /// Poisson's ratio, dimensionless.
    pub poisson: f64,
}

/// Properties of a pair of materials.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairProperties {
    /// Coefficient of sliding friction μ, dimensionless.
    pub friction: f64,
    /// Coefficient of restitution e, dimensionless, 0 to 1.
    pub restitution: f64,
}

/// Symmetric table of pair properties, `materials × materials`.
#[derive(Debug, Clone, PartialEq)]
pub struct PairTable {
    materials: usize,
    entries: Vec<PairProperties>,
}

impl PairTable {
    /// A table over `materials` materials in which every pair starts as `default`.
    pub fn new(materials: usize, default: PairProperties) -> Self {
        Self { materials, entries: vec![default; materials * materials] }
    }

    /// Sets the pair `(a, b)` and so `(b, a)`.
    pub fn set(&mut self, a: usize, b: usize, properties: PairProperties) {
        self.entries[a * self.materials + b] = properties;
        self.entries[b * self.materials + a] = properties;
    }

    /// The properties of materials `a` and `b`, in any order.
    pub fn get(&self, a: usize, b: usize) -> PairProperties {
        self.entries[a * self.materials + b]
    }
}

/// A tablet shape and how finely it is made of spheres and panels.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// Name by which batches and bodies call it.
    pub name: String,
    /// What the solid is.
    pub recipe: Recipe,
    /// How many spheres the clump has: 1 for a sphere, 0 for a clump file (as many as it lists).
    pub spheres: SphereBudget,
    /// How the clump lies to the surface; of no effect on a sphere or a clump file.
    pub placement: Placement,
    /// How many panels the surface is cut into, about.
    pub panels: usize,
}

/// A number of equal tablets.
#[derive(Debug, Clone, PartialEq)]
pub struct Batch {
    /// Index into [`Scene::shapes`].
    pub shape: usize,
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// Mass of one tablet, kg.
    pub tablet_mass: f64,
    /// How many tablets.
    pub count: usize,
}

/// A body placed by hand.
#[derive(Debug, Clone, PartialEq)]
pub struct FreeBody {
    /// Index into [`Scene::shapes`].
    pub shape: usize,
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass, m.
    pub position: Vector3<f64>,
    /// Turns body axes to world axes.
    pub orientation: UnitQuaternion<f64>,
    /// Velocity of the centre of mass, m/s.
    pub velocity: Vector3<f64>,
    /// Angular velocity, world axes, rad/s.
    pub spin: Vector3<f64>,
}

/// A fixed or steadily moving boundary.
#[derive(Debug, Clone, PartialEq)]
pub struct Boundary {
    /// Its surface.
    pub surface: BoundarySurface,
    /// Index into [`Scene::materials`].
    pub material: usize,
    /// Constant velocity, m/s.
    pub velocity: Vector3<f64>,
    /// Constant angular velocity about the world origin, rad/s.
    pub spin: Vector3<f64>,
}

/// The surface of a boundary.
#[derive(Debug, Clone, PartialEq)]
pub enum BoundarySurface {
    /// An unbounded plane; bodies are on the side its normal points to.
    Plane {
        /// A point of the plane, m.
        point: Vector3<f64>,
        /// Unit normal.
        normal: Vector3<f64>,
    },
    /// The inside of an axis-aligned box.
    Box {
        /// Corner with the smallest coordinates, m.
        min: Vector3<f64>,
        /// Corner with the largest coordinates, m.
        max: Vector3<f64>,
    },
    /// A triangle mesh read from a file.
    Mesh {
        /// File, as resolved from the scene file's folder.
        path: PathBuf,
        /// Metres per unit of the file.
        scale: f64,
    },
}

/// Choices of the contact law, each with the documented default.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactSettings {
    /// What works contacts out.
    pub mode: ContactMode,
    /// Cut the normal force at zero when the dashpot would pull.
    pub no_tension: bool,
    /// How the tangential spring follows a changing overlap.
    pub tangential: TangentialLaw,
    /// Which mass the dashpots see.
    pub damping_mass: DampingMass,
}

/// What works contacts out.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum ContactMode {
    /// Hertz-Mindlin contacts between the spheres of clumps.
    #[default]
    HertzMindlin,
    /// Rapier's own impulses between convex hulls of the clumps, for a quick look: no overlaps, no springs.
    Impulse {
        /// Step, s; the scene's own step is that of Hertz-Mindlin contacts.
        step: f64,
    },
}

impl ContactMode {
    /// The key of a scene that sets the step.
    pub(crate) fn step_key(self) -> &'static str {
        match self {
            ContactMode::HertzMindlin => "time.step",
            ContactMode::Impulse { .. } => "the step of contact.mode: Impulse",
        }
    }
}

/// Tangential spring law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TangentialLaw {
    /// F = −S(δ) ξ with the present stiffness (EDEM, LIGGGHTS, MUSEN, MFiX).
    #[default]
    Total,
    /// dF = −S(δ) dξ (Yade, LAMMPS `mindlin/force`).
    Incremental,
    /// Incremental, and the force shrinks with the contact radius on unloading: the passive one
    /// (LAMMPS `mindlin_rescale/force`).
    Rescaled,
}

/// The mass in the dashpots.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DampingMass {
    /// Reduced mass of the whole bodies (EDEM).
    #[default]
    Body,
    /// Mass the contact feels (lever arms included), the damping shared between simultaneous contacts of a body pair.
    Contact,
}

/// Time of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Time {
    /// How the time step is chosen.
    pub step: StepChoice,
    /// Highest approach speed expected in a contact, m/s; with the stiffness it gives the contact time.
    pub impact_speed: f64,
    /// How long the bed turns before it is sprayed.
    pub settle: Settle,
    /// Coated time (or simply run time without a spray), s.
    pub duration: f64,
    /// Time between frames, s.
    pub frame_interval: f64,
}

/// Choice of the time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StepChoice {
    /// Steps per Hertz contact at the expected impact speed.
    PerContact(f64),
    /// A fixed step, s.
    Fixed(f64),
}

/// Settling before the coated time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Settle {
    /// Until speed, centre of mass and energy are stationary, at most so long, s.
    Auto {
        /// Longest settling time, s.
        at_most: f64,
    },
    /// For a fixed time, s; 0 for none.
    For(f64),
}

/// The spray gun and how it is rastered.
#[derive(Debug, Clone, PartialEq)]
pub struct Spray {
    /// Extent along the drum's axis, m.
    pub spanwise: f64,
    /// Extent down the slope, m.
    pub streamwise: f64,
    /// Distance from nozzle to bed surface, m.
    pub distance: f64,
    /// Where it points.
    pub aim: Aim,
    /// Pixels along the spanwise and the streamwise extent.
    pub pixels: [u32; 2],
    /// How much is sprayed.
    pub deposit: Deposit,
    /// What the spray looks like.
    pub pattern: Pattern,
}

/// Where a spray points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Aim {
    /// Normal to a plane fitted to the free surface after settling, above its middle.
    Bed,
    /// Fixed in space.
    Fixed {
        /// Centre of the zone on the bed, m.
        target: Vector3<f64>,
        /// Unit vector from the zone to the nozzle.
        normal: Vector3<f64>,
    },
}

/// How much film there is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Deposit {
    /// What the nozzle sprays.
    Sprayed {
        /// Spray rate of suspension, kg/s.
        rate: f64,
        /// Solids mass fraction of the suspension, dimensionless.
        solids: f64,
        /// Density of the dry film, kg/m³.
        film_density: f64,
    },
    /// What was measured on real tablets.
    Measured {
        /// Mean thickness over all tablets at the end of the coated time, m.
        mean_thickness: f64,
        /// Density of the dry film, kg/m³.
        film_density: f64,
    },
}

impl Deposit {
    /// Density of the dry film, kg/m³.
    pub fn film_density(&self) -> f64 {
        match self {
            Self::Sprayed { film_density, .. } | Self::Measured { film_density, .. } => *film_density,
        }
    }
}

/// What a run writes beside its record.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own")]
pub struct Outputs {
    /// Time between rows of `series.csv`, s.
    pub series_interval: f64,
    /// Whether `report.html` is made.
    pub report: bool,
    /// Whether the bed picture is drawn.
    pub picture: bool,
    /// Whether bed statistics (angle of repose, speeds, torque) are kept.
    pub statistics: bool,
    /// Whether energy is audited; not with impulses.
    pub energy: bool,
    /// Whether and how poses are recorded.
    pub record: Option<Record>,
}

/// How poses are recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Record {
    /// In 9 bytes, a few micrometres and milliradians off.
    Compact,
    /// To the last bit, in 56 bytes.
    Exact,
}
