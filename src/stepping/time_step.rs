//! The time step and what it means.

use crate::contact::PairLaw;
use crate::scene::{ContactMode, Scene, StepChoice};
use crate::shapes::{Sphere, TabletShape};
use nalgebra::Vector3;

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
    /// Bound of the angular frequency of a body whose spheres land side by side at the impact speed, rad/s.
    pub stiffest: f64,
}

impl TimeStep {
    /// Chooses the step of a scene with the given shapes.
    pub fn choose(scene: &Scene, shapes: &[TabletShape]) -> Self {
        let mut contact_time = f64::INFINITY;
        let mut impact_overlap: f64 = 0.0;
        let mut rayleigh_time = f64::INFINITY;
        let mut stiffest: f64 = 0.0;
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
            let mut hardest = law(material);
            for wall in walls.chain(scene.boundaries.iter().map(|b| b.material)) {
                consider(law(wall), largest, mass, largest);
                hardest = hardest.max(law(wall));
            }
            stiffest =
                stiffest.max(landing_frequency(&shapes[shape], mass, hardest, scene.time.impact_speed));
        }
        let step = match (scene.contact.mode, scene.time.step) {
            (ContactMode::Impulse { step }, _) | (_, StepChoice::Fixed(step)) => step,
            (_, StepChoice::PerContact(steps)) => contact_time / steps,
        };
        // A whole number of steps per frame: the step is made shorter, never longer.
        let per_frame = (scene.time.frame_interval / step - 1e-9).ceil().max(1.0);
        Self {
            step: scene.time.frame_interval / per_frame,
            contact_time,
            rayleigh_time,
            impact_overlap,
            stiffest,
        }
    }

    /// Steps in the shortest contact, dimensionless.
    pub fn steps_per_contact(&self) -> f64 {
        self.contact_time / self.step
    }

    /// Angular frequency of the stiffest landing times the step, rad: velocity Verlet is stable below 2.
    pub fn stiffness_bound(&self) -> f64 {
        self.stiffest * self.step
    }

    /// Share of the Rayleigh time, dimensionless.
    pub fn rayleigh_fraction(&self) -> f64 {
        self.step / self.rayleigh_time
    }
}

/// Bound of the angular frequency, rad/s, that a body has on a plane when it has landed at `speed` m/s, in the stiffest
/// of 26 directions of fall.
///
/// Derived here. Falling along −n, sphere i at height h_i above the lowest gets the overlap δ − h_i, and the body stops
/// where Σ 8/15 E* √R_i (δ − h_i)^(5/2) = m v²/2. The stiffnesses k_i = 2 E* √(R_i δ_i) there give the body three modes
/// whose squared frequencies sum up to Σ k_i (1/m + (r_i × n)·I⁻¹(r_i × n)), so that none is above it.
fn landing_frequency(shape: &TabletShape, mass: f64, modulus: f64, speed: f64) -> f64 {
    let spheres = &shape.clump.spheres;
    let inverse_inertia = (shape.inertia_per_mass * mass).map(|i| 1.0 / i);
    let energy = 0.5 * mass * speed * speed;
    let steps = [-1.0, 0.0, 1.0];
    let directions = steps.iter().flat_map(|x| steps.iter().flat_map(move |y| steps.map(|z| [*x, *y, z])));
    let squared = directions.filter(|n| *n != [0.0; 3]).map(|n| {
        let n = Vector3::from(n).normalize();
        let depth = |s: &Sphere| s.center.dot(&n) + s.radius;
        let deepest = spheres.iter().map(depth).fold(f64::NEG_INFINITY, f64::max);
        let overlap = |s: &Sphere, d: f64| (d - (deepest - depth(s))).max(0.0);
        let stored = |d: f64| -> f64 {
            let one = |s: &Sphere| 8.0 / 15.0 * modulus * s.radius.sqrt() * overlap(s, d).powf(2.5);
            spheres.iter().map(one).sum()
        };
        // One sphere alone takes the most overlap.
        let (mut low, mut high) =
            (0.0, 2.0 * hertz_overlap(modulus, shape.clump.smallest_radius(), mass, speed));
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if stored(middle) < energy { low = middle } else { high = middle }
        }
        let mode = |s: &Sphere| {
            let turn = s.center.cross(&n);
            let softness = 1.0 / mass + turn.component_mul(&turn).dot(&inverse_inertia);
            2.0 * modulus * (s.radius * overlap(s, low)).sqrt() * softness
        };
        spheres.iter().map(mode).sum::<f64>()
    });
    squared.fold(0.0, f64::max).sqrt()
}

/// (shape, material, mass) of every kind of body, each once.
fn kinds(scene: &Scene) -> Vec<(usize, usize, f64)> {
    let batches = scene.batches.iter().map(|b| (b.shape, b.material, b.tablet_mass));
    let mut kinds: Vec<_> =
        batches.chain(scene.bodies.iter().map(|b| (b.shape, b.material, b.mass))).collect();
    kinds.sort_unstable_by_key(|(shape, material, mass)| (*shape, *material, mass.to_bits()));
    kinds.dedup();
    kinds
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::Clump;

    /// One sphere: √(S/m) at the largest overlap; four equal spheres at the corners of a square: the same energy in four
    /// contacts, and the sum of one sinking and two rocking modes.
    #[test]
    fn landings_side_by_side_are_stiffer() {
        let tablet = |clump: Vec<Sphere>, inertia: Vector3<f64>| TabletShape {
            name: String::new(),
            volume: 1.0,
            area: 1.0,
            inertia_per_mass: inertia,
            clump: Clump { spheres: clump },
            panels: None,
            repairs: Vec::new(),
        };
        let (radius, mass, modulus, speed) = (2e-3, 1.3e-3, 2e6, 0.3);
        let sphere = |x: f64, y: f64| Sphere { center: Vector3::new(x, y, 0.0), radius };
        let one = tablet(vec![sphere(0.0, 0.0)], Vector3::repeat(0.4 * radius * radius));
        let delta = hertz_overlap(modulus, radius, mass, speed);
        let expected = (2.0 * modulus * (radius * delta).sqrt() / mass).sqrt();
        assert!((landing_frequency(&one, mass, modulus, speed) / expected - 1.0).abs() < 1e-9);
        let a = 3e-3;
        let square = vec![sphere(a, a), sphere(-a, a), sphere(a, -a), sphere(-a, -a)];
        let four = tablet(square, Vector3::repeat(2.0 * a * a));
        let each = delta * 4.0_f64.powf(-0.4);
        let expected = (4.0 * 2.0 * modulus * (radius * each).sqrt() / mass * 2.0).sqrt();
        assert!((landing_frequency(&four, mass, modulus, speed) / expected - 1.0).abs() < 1e-9);
    }
}
