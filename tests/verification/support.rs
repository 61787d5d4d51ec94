//! The scenes of `scenes/verification`, run, and what came of them.

use nalgebra::Vector3;
use pancoat::contact::{Dashpots, PairLaw, Spring, Touch};
use pancoat::scene::{ContactSettings, Material, PairProperties, Scene};
use pancoat::stepping::{BodyState, Frame, Observer, Simulation, SimulationError};
use std::path::{Path, PathBuf};

/// Folder of the scenes.
pub(crate) fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/verification")
}

/// A scene with values set as `pancoat run --set` does.
pub(crate) fn scene(name: &str, set: &[String]) -> Scene {
    let path = folder().join(name).with_extension("ron");
    Scene::load(&path, set).unwrap_or_else(|faults| panic!("{faults}"))
}

/// Frames of a run: time, s, and bodies.
pub(crate) type Frames = Vec<(f64, Vec<BodyState>)>;

/// Keeps every frame.
#[derive(Default)]
pub(crate) struct History(pub(crate) Frames);

impl Observer for History {
    fn observe(&mut self, frame: &Frame<'_>) {
        self.0.push((frame.time, frame.bodies.to_vec()));
    }
}

/// Runs a scene's duration, as far as it goes.
pub(crate) fn attempt(scene: &Scene) -> (Result<(), SimulationError>, Frames) {
    let mut simulation = match Simulation::new(scene) {
        Ok(simulation) => simulation,
        Err(fault) => return (Err(fault), Vec::new()),
    };
    let mut history = History(vec![(0.0, simulation.states())]);
    let frames = (scene.time.duration / scene.time.frame_interval).round() as u64;
    let ended = simulation.run(0, frames, &mut [&mut history], &mut |_| true);
    (ended, history.0)
}

/// All frames of a scene, the start first.
pub(crate) fn watch(name: &str, set: &[String]) -> Frames {
    let (ended, history) = attempt(&scene(name, set));
    ended.unwrap_or_else(|fault| panic!("{name}: {fault}"));
    history
}

/// The bodies at the end of a scene.
pub(crate) fn run(name: &str, set: &[String]) -> Vec<BodyState> {
    watch(name, set).pop().expect("has a start").1
}

/// A clump of rows "x y z r", m, in a file that goes away with the first, and that file's path.
pub(crate) fn clump_file(rows: &str) -> (tempfile::NamedTempFile, String) {
    let file = tempfile::Builder::new().suffix(".txt").tempfile().expect("can be made");
    std::fs::write(file.path(), rows).expect("can be written");
    let path = file.path().display().to_string();
    (file, path)
}

/// `format!` into a list of values to set.
macro_rules! set {
    ($($text:literal),* $(,)?) => { [$(format!($text)),*] };
}
pub(crate) use set;

pub(crate) fn near(found: f64, expected: f64, tolerance: f64, what: &str) {
    let error = found / expected - 1.0;
    assert!(
        error.abs() <= tolerance,
        "{what}: {found:e} for {expected:e}, off by {error:.2e} of {tolerance:.0e}"
    );
}

pub(crate) fn close(found: f64, expected: f64, tolerance: f64, what: &str) {
    let error = found - expected;
    assert!(
        error.abs() <= tolerance,
        "{what}: {found:e} for {expected:e}, off by {error:.2e} of {tolerance:.0e}"
    );
}

/// What a normal impact shows: from positions at every step, touching at the first one.
pub(crate) struct Impact {
    pub(crate) overlap: f64,
    pub(crate) force: f64,
    pub(crate) time: f64,
}

/// `gaps`: overlap at every step of `dt`, s; `mass`: reduced mass, kg. Velocity Verlet gives the exact acceleration at a
/// step as the second difference of positions.
pub(crate) fn impact(gaps: &[f64], dt: f64, mass: f64) -> Impact {
    let peak = (1..gaps.len() - 1).max_by(|a, b| gaps[*a].total_cmp(&gaps[*b])).expect("touches");
    let top = |v: [f64; 3]| v[1] + (v[0] - v[2]).powi(2) / (8.0 * (2.0 * v[1] - v[0] - v[2]));
    let force = |k: usize| mass * (2.0 * gaps[k] - gaps[k - 1] - gaps[k + 1]) / (dt * dt);
    let last = (peak..gaps.len()).find(|k| gaps[*k] <= 0.0).expect("lets go");
    let part = gaps[last - 1] / (gaps[last - 1] - gaps[last]);
    Impact {
        overlap: top([gaps[peak - 1], gaps[peak], gaps[peak + 1]]),
        force: top([force(peak - 1), force(peak), force(peak + 1)]),
        time: dt * (last as f64 - 1.0 + part),
    }
}

/// One sphere against a rigid plane y = 0 by the law alone, without engine: an independent loop to tell apart what the
/// scene cannot switch.
#[derive(Clone)]
pub(crate) struct Single {
    pub(crate) radius: f64,
    pub(crate) mass: f64,
    pub(crate) law: PairLaw,
    /// What the tangential dashpot is multiplied by.
    pub(crate) tangential_dashpot: f64,
    pub(crate) velocity: Vector3<f64>,
    /// About z, rad/s.
    pub(crate) spin: f64,
    /// Steps in an elastic contact.
    pub(crate) steps: f64,
}

/// A law of two materials of given shear moduli, Pa, and Poisson's ratios.
pub(crate) fn law(
    a: (f64, f64),
    b: (f64, f64),
    friction: f64,
    restitution: f64,
    settings: ContactSettings,
) -> PairLaw {
    let material = |(shear_modulus, poisson)| Material { name: String::new(), shear_modulus, poisson };
    PairLaw::new(&material(a), &material(b), PairProperties { friction, restitution }, settings)
}

impl Single {
    /// Velocity and spin after the contact, and whether it slid in each step. Semi-implicit Euler.
    pub(crate) fn collide(&self) -> (Vector3<f64>, f64, Vec<bool>) {
        let speed = -self.velocity.y;
        let time = pancoat::stepping::hertz_time(self.law.effective_modulus, self.radius, self.mass, speed);
        let dt = time / self.steps;
        let (mut v, mut w, mut overlap) = (self.velocity, self.spin, 0.5 * speed * dt);
        let (mut spring, mut slides) = (Spring::default(), Vec::new());
        while overlap > 0.0 {
            let radius = (self.radius * overlap).sqrt();
            // The surface moves against the sphere; n points from the sphere to the surface.
            let at_contact = v + Vector3::new(0.0, 0.0, w).cross(&Vector3::new(0.0, -self.radius, 0.0));
            let velocity = -at_contact;
            let touch = Touch { normal: -Vector3::y(), overlap, velocity, twirl: 0.0 };
            let Dashpots { normal, tangential } = self.law.dashpots(radius, self.mass);
            let dashpots = Dashpots { normal, tangential: tangential * self.tangential_dashpot };
            let force = self.law.force(&touch, radius, dashpots, dt, &mut spring);
            let on_sphere = -(touch.normal * force.normal + force.tangential);
            v += on_sphere * (dt / self.mass);
            w += self.radius * on_sphere.x * dt / (0.4 * self.mass * self.radius * self.radius);
            overlap -= v.y * dt;
            slides.push(force.sliding);
        }
        (v, w, slides)
    }
}

/// Kinetic energy, J, of a body with principal moments `inertia`, kg m².
pub(crate) fn kinetic(state: &BodyState, mass: f64, inertia: &Vector3<f64>) -> f64 {
    let w = state.orientation.inverse() * state.spin;
    0.5 * mass * state.velocity.norm_squared() + 0.5 * w.component_mul(&w).dot(inertia)
}
