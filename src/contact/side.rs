//! One side of a contact, and what two sides do to the damping of all contacts between them.

use super::law::PairLaw;
use crate::world::Motion;
use nalgebra::Vector3;

/// A body, or a driven surface (inverse mass and inertia zero).
#[derive(Debug, Clone, Copy)]
pub(super) struct Side<'a> {
    pub motion: &'a Motion,
    /// 1/kg.
    pub inverse_mass: f64,
    /// Inverse principal moments, body axes, 1/(kg m²).
    pub inverse_inertia: Vector3<f64>,
    /// Largest response of a contact place to a force there, lever arms included, 1/kg.
    pub softness: f64,
    /// Share of its motion that the dashpots of the step before could take, at most, 1/s.
    pub drag: f64,
}

impl<'a> Side<'a> {
    /// A surface, which nothing moves.
    pub(super) fn surface(motion: &'a Motion) -> Self {
        Self { motion, inverse_mass: 0.0, inverse_inertia: Vector3::zeros(), softness: 0.0, drag: 0.0 }
    }

    /// Share of this side in the response of a contact pattern: |F|²/m + T·I⁻¹T.
    fn response(&self, force: &Vector3<f64>, torque: &Vector3<f64>) -> f64 {
        let t = self.motion.rotation.tr_mul(torque);
        force.norm_squared() * self.inverse_mass + t.component_mul(&t).dot(&self.inverse_inertia)
    }
}

/// Most that the dashpots of two bodies may take out of a motion in one step, and twice that with those of all they touch.
///
/// Explicit dashpots side by side overshoot where c dt/m sums up to 2 less (ω dt)²/2. The caps vanish with the step. At 12 to
/// 25 steps in a contact they let ten spheres that land at once rebound with 0.044 where 0.054 is right.
pub(super) const DAMPED: f64 = 1.5;
/// Fewer contacts than this cannot reach that at any step the guards let pass.
pub(super) const CROWD: usize = 4;

/// A contact as its bodies feel it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Felt {
    /// Unit normal from a to b.
    pub normal: Vector3<f64>,
    /// From a's centre of mass to the common contact point, m.
    pub arm_a: Vector3<f64>,
    /// From b's centre of mass to the same point, m.
    pub arm_b: Vector3<f64>,
    /// Speed of b against a along the normal, m/s.
    pub speed: f64,
    /// √(R* δ), m.
    pub contact_radius: f64,
}

/// Angular frequency, rad/s, of the normal motion the contacts are in: the Rayleigh quotient
/// ω² = (vᵀ S W S v)/(vᵀ S v) of the contact stiffnesses S and the response W of the two bodies, v the approach speeds.
///
/// Derived here. For one contact it is S/m with m the mass felt there, lever arms included; for n equal contacts in a
/// flat landing it is n S/m. Damping every contact in proportion to its stiffness at this frequency delivers the
/// asked restitution in both cases, which whole-body masses do not (Berry, Zhang & Haeri 2023, Powder Technol. 416,
/// 118209). `None` when nothing moves along the normals.
pub(super) fn frequency(
    contacts: impl Iterator<Item = Felt>,
    (a, b): &(Side<'_>, Side<'_>),
    law: &PairLaw,
) -> Option<f64> {
    let mut force = Vector3::zeros();
    let (mut torque_a, mut torque_b) = (Vector3::zeros(), Vector3::zeros());
    let mut work = 0.0;
    for Felt { normal, arm_a, arm_b, speed, contact_radius } in contacts {
        let stiffness = law.normal_stiffness(contact_radius);
        let f = normal * (stiffness * speed);
        force += f;
        torque_a += arm_a.cross(&f);
        torque_b += arm_b.cross(&f);
        work += stiffness * speed * speed;
    }
    let response = a.response(&force, &torque_a) + b.response(&force, &torque_b);
    (work > 0.0 && response > 0.0).then(|| (response / work).sqrt())
}
