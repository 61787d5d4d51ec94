//! The time step and what it means.

use crate::contact::PairLaw;
use crate::scene::{ContactMode, Scene, StepChoice};
use crate::shapes::TabletShape;

/// 4 √π Γ(2/5) / (5 Γ(9/10)) · (15/16)^(2/5), dimensionless: the constant of the Hertz contact time.
const CONTACT_TIME: f64 = 2.868_265_699;

/// A time step with the figures by which it is judged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeStep {
    /// Step, s.
    pub step: f64,
    /// Shortest elastic contact time of two bodies at the scene's impact speed, s.
    pub contact_time: f64,
    /// Smallest Rayleigh time of a sphere of any clump, s.
    pub rayleigh_time: f64,
    /// Overlap of that contact over the sphere's radius, dimensionless.
    pub impact_overlap: f64,
}

impl TimeStep {
    /// Chooses the step of a scene with the given shapes.
    pub fn choose(scene: &Scene, shapes: &[TabletShape]) -> Self {
        let mut contact_time = f64::INFINITY;
        let mut impact_overlap: f64 = 0.0;
        let mut rayleigh_time = f64::INFINITY;
        for (shape, material, mass) in kinds(scene) {
            let spheres = &shapes[shape].clump.spheres;
            let largest = spheres.iter().map(|s| s.radius).fold(0.0, f64::max);
            let smallest = shapes[shape].clump.smallest_radius();
            let own = &scene.materials[material];
            let density = mass / shapes[shape].volume;
            let shear_wave = (density / own.shear_modulus).sqrt();
            let rayleigh = std::f64::consts::PI * smallest * shear_wave / (0.1631 * own.poisson + 0.8766);
            rayleigh_time = rayleigh_time.min(rayleigh);
            let law = |other: usize| {
                let pair = scene.pairs.get(material, other);
                PairLaw::new(own, &scene.materials[other], pair, scene.contact).effective_modulus
            };
            let mut consider = |modulus: f64, radius: f64, mass: f64, sphere: f64| {
                contact_time = contact_time.min(hertz_time(modulus, radius, mass, scene.time.impact_speed));
                let overlap = hertz_overlap(modulus, radius, mass, scene.time.impact_speed);
                impact_overlap = impact_overlap.max(overlap / sphere);
            };
            consider(law(material), 0.5 * largest, 0.5 * mass, largest);
            let walls = scene.drum.iter().map(|d| d.material);
            for wall in walls.chain(scene.boundaries.iter().map(|b| b.material)) {
                consider(law(wall), largest, mass, largest);
            }
        }
        let step = match (scene.contact.mode, scene.time.step) {
            (ContactMode::Impulse { step }, _) | (_, StepChoice::Fixed(step)) => step,
            (_, StepChoice::PerContact(steps)) => contact_time / steps,
        };
        // A whole number of steps per frame: the step is made shorter, never longer.
        let per_frame = (scene.time.frame_interval / step - 1e-9).ceil().max(1.0);
        Self { step: scene.time.frame_interval / per_frame, contact_time, rayleigh_time, impact_overlap }
    }

    /// Steps in the shortest contact, dimensionless.
    pub fn steps_per_contact(&self) -> f64 {
        self.contact_time / self.step
    }

    /// Share of the Rayleigh time, dimensionless.
    pub fn rayleigh_fraction(&self) -> f64 {
        self.step / self.rayleigh_time
    }
}

/// (shape, material, mass) of every kind of body.
fn kinds(scene: &Scene) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
    let batches = scene.batches.iter().map(|b| (b.shape, b.material, b.tablet_mass));
    batches.chain(scene.bodies.iter().map(|b| (b.shape, b.material, b.mass)))
}

/// Duration of an elastic Hertz contact, s: T = 2.868 (m*²/(R* E*² v))^(1/5).
///
/// Source: Johnson 1985, Contact Mechanics, section 11.4; the constant is 4 √π Γ(2/5)/(5 Γ(9/10)) (15/16)^(2/5).
///
/// ```
/// // Glass spheres of 10 mm at ±10 m/s (Chung & Ooi 2011, case 1): 40.34 µs.
/// let modulus = 25e9; // E* = E/(2(1 − ν²)), E = 48 GPa, ν = 0.2
/// let mass = 0.5 * 2800.0 * 4.0 / 3.0 * std::f64::consts::PI * 1e-6;
/// let time = pancoat::stepping::hertz_time(modulus, 5e-3, mass, 20.0);
/// assert!((time - 40.3395e-6).abs() < 1e-10);
/// ```
pub fn hertz_time(modulus: f64, radius: f64, mass: f64, speed: f64) -> f64 {
    CONTACT_TIME * (mass * mass / (radius * modulus * modulus * speed)).powf(0.2)
}

/// Largest overlap of an elastic Hertz contact, m: δ = (15 m* v²/(16 E* √R*))^(2/5). Source: as [`hertz_time`].
pub fn hertz_overlap(modulus: f64, radius: f64, mass: f64, speed: f64) -> f64 {
    (15.0 * mass * speed * speed / (16.0 * modulus * radius.sqrt())).powf(0.4)
}
