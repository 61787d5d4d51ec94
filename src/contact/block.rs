//! Eight contacts side by side: every lane is computed by the same operations.

use super::batch::{Place, Rule};
use super::energy::Press;
use super::law::{Dashpots, PairLaw, Spring, Touch, brevity};
use super::side::{DAMPED, Felt};
use crate::scene::TangentialLaw;
use nalgebra::Vector3;

/// Contacts in a block.
pub(super) const LANES: usize = 8;
type Lanes = [f64; LANES];
type Lanes3 = [Lanes; 3];

/// Springs of eight contacts.
#[derive(Debug, Clone, Copy)]
pub(super) struct Springs {
    stretch: Lanes3,
    radius: Lanes,
}

impl Springs {
    /// Eight springs of what does not touch.
    pub(super) const AT_REST: Self = Self { stretch: ZERO3, radius: ZERO };

    #[inline(always)]
    pub(super) fn get(&self, k: usize) -> Spring {
        Spring { stretch: get(&self.stretch, k), radius: self.radius[k] }
    }

    #[inline(always)]
    pub(super) fn set(&mut self, k: usize, spring: &Spring) {
        set(&mut self.stretch, k, &spring.stretch);
        self.radius[k] = spring.radius;
    }
}

#[derive(Debug, Clone)]
pub(super) struct Block {
    pub law: usize,
    pub arm: Lanes3,
    pub between: Lanes3,
    /// Radius of a's sphere, m.
    pub radius: Lanes,
    /// Radius of b's sphere; 0 for a surface, m.
    pub other: Lanes,
    /// Sum of both bodies', 1/kg.
    pub inverse_mass: Lanes,
    /// See [`Side`](super::side::Side), sum of both bodies', 1/s.
    pub drag: Lanes,
    pub drift: Lanes3,
    pub turn: Lanes3,
    pub spin: Lanes3,
    pub springs: Springs,
    pub normal: Lanes3,
    pub overlap: Lanes,
    /// Overlap over the smaller sphere's radius.
    pub depth: Lanes,
    pub contact_radius: Lanes,
    pub velocity: Lanes3,
    pub dashpot: [Lanes; 2],
    pub force: Lanes3,
    pub torque: Lanes3,
}

const ZERO: Lanes = [0.0; LANES];
const ONE: Lanes = [1.0; LANES];
const ZERO3: Lanes3 = [ZERO; 3];

/// A block of contacts nobody asks for. Lanes left over are worked out as well, whatever comes of it.
pub(super) const EMPTY: Block = Block {
    law: 0,
    arm: ZERO3,
    between: [ONE, ZERO, ZERO],
    radius: ONE,
    other: ONE,
    inverse_mass: ONE,
    drag: ONE,
    drift: ZERO3,
    turn: ZERO3,
    spin: ZERO3,
    springs: Springs::AT_REST,
    normal: ZERO3,
    overlap: ZERO,
    depth: ZERO,
    contact_radius: ZERO,
    velocity: ZERO3,
    dashpot: [ZERO; 2],
    force: ZERO3,
    torque: ZERO3,
};

#[inline(always)]
pub(super) fn get(lanes: &Lanes3, k: usize) -> Vector3<f64> {
    Vector3::new(lanes[0][k], lanes[1][k], lanes[2][k])
}

#[inline(always)]
pub(super) fn set(lanes: &mut Lanes3, k: usize, v: &Vector3<f64>) {
    (lanes[0][k], lanes[1][k], lanes[2][k]) = (v.x, v.y, v.z);
}

impl Block {
    /// Puts a contact into a lane.
    #[inline(always)]
    pub(super) fn put(&mut self, k: usize, place: &Place) {
        set(&mut self.arm, k, &place.arm);
        set(&mut self.between, k, &place.between);
        self.radius[k] = place.radius;
        self.other[k] = place.other;
    }

    /// Where and how the contacts touch, and the dashpots of each by itself. Law and rule come by value, and nothing branches: only so
    /// does the compiler work out all lanes at once.
    #[inline(always)]
    pub(super) fn place(&mut self, law: PairLaw, rule: Rule) {
        for k in 0..LANES {
            let mut between = get(&self.between, k);
            // One of two centres in one place is above the other.
            between.y += if between.norm_squared() == 0.0 { f64::EPSILON } else { 0.0 };
            let distance = between.norm();
            let normal = between * (1.0 / distance);
            let overlap = self.radius[k] + self.other[k] - distance;
            let curvature = 1.0 / self.radius[k];
            // Without a branch: none for a surface.
            let flat = f64::from(u8::from(self.other[k] == 0.0));
            let other_curvature = (1.0 - flat) / (self.other[k] + flat);
            let contact_radius = (overlap / (curvature + other_curvature)).sqrt();
            let arm = get(&self.arm, k) + normal * (self.radius[k] - rule.inside * overlap);
            let velocity = get(&self.drift, k) + get(&self.turn, k).cross(&arm);
            let brief = brevity(overlap, velocity.dot(&normal).abs() * rule.dt);
            let Dashpots { normal: across, tangential: along } =
                law.dashpots_in_steps(contact_radius, self.inverse_mass[k], rule.dt);
            set(&mut self.arm, k, &arm);
            set(&mut self.normal, k, &normal);
            set(&mut self.velocity, k, &velocity);
            self.overlap[k] = overlap;
            self.depth[k] = overlap * curvature.max(other_curvature);
            self.contact_radius[k] = contact_radius;
            self.dashpot[0][k] = across * brief;
            self.dashpot[1][k] = along * brief;
        }
    }

    /// Forces; springs move on.
    #[inline(always)]
    pub(super) fn press(&mut self, law: &PairLaw, dt: f64) {
        match law.tangential {
            TangentialLaw::Total => self.press_by(&PairLaw { tangential: TangentialLaw::Total, ..*law }, dt),
            TangentialLaw::Incremental => {
                self.press_by(&PairLaw { tangential: TangentialLaw::Incremental, ..*law }, dt);
            }
            TangentialLaw::Rescaled => {
                self.press_by(&PairLaw { tangential: TangentialLaw::Rescaled, ..*law }, dt);
            }
        }
    }

    #[inline(always)]
    fn press_by(&mut self, law: &PairLaw, dt: f64) {
        for k in 0..LANES {
            let normal = get(&self.normal, k);
            let touch = Touch {
                normal,
                overlap: self.overlap[k],
                velocity: get(&self.velocity, k),
                twirl: get(&self.spin, k).dot(&normal),
            };
            // What is left of the dashpots beside those of the bodies' other contacts.
            let left = (2.0 * DAMPED / (dt * self.drag[k])).min(1.0);
            let dashpots =
                Dashpots { normal: self.dashpot[0][k] * left, tangential: self.dashpot[1][k] * left };
            let mut spring = self.springs.get(k);
            let pressed = law.force(&touch, self.contact_radius[k], dashpots, dt, &mut spring);
            let force = normal * pressed.normal + pressed.tangential;
            set(&mut self.force, k, &force);
            set(&mut self.torque, k, &get(&self.arm, k).cross(&force));
            self.springs.set(k, &spring);
        }
    }

    pub(super) fn pressed(&self, k: usize, laws: &[PairLaw], dt: f64) -> Press {
        let (law, spring, normal) = (&laws[self.law], self.springs.get(k), get(&self.normal, k));
        let (force, velocity) = (get(&self.force, k), get(&self.velocity, k));
        let slip = (velocity - normal * velocity.dot(&normal)) * dt;
        let spring_force = law.spring_force(&spring);
        let across = normal * force.dot(&normal);
        let elastic = normal * (2.0 / 3.0 * law.normal_stiffness(spring.radius) * self.overlap[k]);
        Press {
            law: self.law,
            normal,
            overlap: self.overlap[k],
            arm: get(&self.arm, k),
            slip,
            spring,
            spring_force,
            dashpot_forces: [across - elastic, force - across - spring_force],
            force,
        }
    }

    pub(super) fn felt(&self, k: usize, offset: &Vector3<f64>) -> Felt {
        let normal = get(&self.normal, k);
        let arm = get(&self.arm, k);
        Felt {
            normal,
            arm_a: arm,
            arm_b: arm - offset,
            speed: get(&self.velocity, k).dot(&normal),
            contact_radius: self.contact_radius[k],
        }
    }
}
