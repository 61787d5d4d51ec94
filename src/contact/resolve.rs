//! From the touching places of two bodies to the forces and torques between them.

use super::law::{ContactForce, PairLaw, Spring, Touch};
use crate::scene::DampingMass;
use crate::world::Motion;
use nalgebra::Vector3;

/// One side of a contact: a body, or a driven surface (inverse mass and inertia zero).
#[derive(Debug, Clone, Copy)]
pub(super) struct Partner<'a> {
    pub motion: &'a Motion,
    /// 1/kg.
    pub inverse_mass: f64,
    /// Inverse principal moments, body axes, 1/(kg m²).
    pub inverse_inertia: Vector3<f64>,
    /// Largest response of a contact place to a force there, lever arms included, 1/kg.
    pub softness: f64,
}

impl Partner<'_> {
    /// Share of this side in the response of a contact pattern: |F|²/m + T·I⁻¹T.
    fn response(&self, force: &Vector3<f64>, torque: &Vector3<f64>) -> f64 {
        let t = self.motion.rotation.tr_mul(torque);
        force.norm_squared() * self.inverse_mass + t.component_mul(&t).dot(&self.inverse_inertia)
    }
}

/// One touching place of two bodies.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    /// Which link of the list it belongs to.
    pub link: usize,
    /// Unit normal from a to b.
    pub normal: Vector3<f64>,
    /// Overlap, m.
    pub overlap: f64,
    /// √(R* δ), m.
    pub contact_radius: f64,
    /// From a's centre of mass to the common contact point, m.
    pub arm_a: Vector3<f64>,
    /// From b's centre of mass to the same point, m.
    pub arm_b: Vector3<f64>,
    /// Velocity of b against a there, m/s.
    pub velocity: Vector3<f64>,
}

/// What two bodies do to each other in a step.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Exchange {
    /// Force on b; a feels the opposite, N.
    pub force: Vector3<f64>,
    /// Torque on a about its centre of mass, N m.
    pub torque_a: Vector3<f64>,
    /// Torque on b about its centre of mass (a surface: about its origin), N m.
    pub torque_b: Vector3<f64>,
    /// Touching places.
    pub contacts: u32,
    /// Largest overlap over the smaller sphere's radius, dimensionless.
    pub deepest: f64,
}

/// Most that the dashpots of two bodies may take out of a motion in one step. Explicit dashpots side by side overshoot
/// where c dt/m sums up to 2, and a body may be held from two sides; the cap vanishes with the step.
const DAMPED: f64 = 0.7;
/// Fewer contacts than this cannot reach that at any step the guards let pass.
const CROWD: usize = 4;

/// Entries of a list that remember their spring.
pub(super) trait Remembers {
    fn spring(&mut self) -> &mut Spring;
}

/// Adds up the contacts of two bodies; `links` is the list that [`Place::link`] points into.
#[inline]
pub(super) fn resolve(
    places: &[Place],
    (a, b): (Partner<'_>, Partner<'_>),
    law: &PairLaw,
    damping: DampingMass,
    dt: f64,
    links: &mut [impl Remembers],
) -> Exchange {
    let mut exchange = Exchange::default();
    let mass = 1.0 / (a.inverse_mass + b.inverse_mass);
    let omega = match damping {
        DampingMass::Body => None,
        DampingMass::Contact => frequency(places, (a, b), law),
    };
    let dashpots = |place: &Place| match omega {
        None => law.dashpots(place.contact_radius, mass),
        Some(omega) => law.dashpots_at(place.contact_radius, omega),
    };
    let share = if places.len() < CROWD {
        1.0
    } else {
        let all: f64 = places.iter().map(|p| dashpots(p).normal).sum();
        (DAMPED / (dt * (a.softness + b.softness) * all)).min(1.0)
    };
    let spin = (a.motion.spin + b.motion.spin) * 0.5;
    for place in places {
        let touch = Touch {
            normal: place.normal,
            overlap: place.overlap,
            velocity: place.velocity,
            twirl: spin.dot(&place.normal),
        };
        let mut dashpots = dashpots(place);
        dashpots.normal *= share;
        dashpots.tangential *= share;
        let ContactForce { normal, tangential, .. } =
            law.force(&touch, place.contact_radius, dashpots, dt, links[place.link].spring());
        let force = place.normal * normal + tangential;
        exchange.force += force;
        exchange.torque_a -= place.arm_a.cross(&force);
        exchange.torque_b += place.arm_b.cross(&force);
    }
    exchange.contacts = places.len() as u32;
    exchange
}

/// Angular frequency, rad/s, of the normal motion the contacts are in: the Rayleigh quotient
/// ω² = (vᵀ S W S v)/(vᵀ S v) of the contact stiffnesses S and the response W of the two bodies, v the approach speeds.
///
/// Derived here. For one contact it is S/m with m the mass felt there, lever arms included; for n equal contacts in a
/// flat landing it is n S/m. Damping every contact in proportion to its stiffness at this frequency delivers the
/// asked restitution in both cases, which whole-body masses do not (Berry, Zhang & Haeri 2023, Powder Technol. 416,
/// 118209). `None` when nothing moves along the normals.
fn frequency(places: &[Place], (a, b): (Partner<'_>, Partner<'_>), law: &PairLaw) -> Option<f64> {
    let mut force = Vector3::zeros();
    let (mut torque_a, mut torque_b) = (Vector3::zeros(), Vector3::zeros());
    let mut work = 0.0;
    for place in places {
        let speed = place.velocity.dot(&place.normal);
        let stiffness = law.normal_stiffness(place.contact_radius);
        let f = place.normal * (stiffness * speed);
        force += f;
        torque_a += place.arm_a.cross(&f);
        torque_b += place.arm_b.cross(&f);
        work += stiffness * speed * speed;
    }
    let response = a.response(&force, &torque_a) + b.response(&force, &torque_b);
    (work > 0.0 && response > 0.0).then(|| (response / work).sqrt())
}
