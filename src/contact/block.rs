//! Eight contacts side by side: every lane is computed by the same operations.
//!
//! What comes in and goes out lies in rows, contact by contact, four numbers together: so they are copied at once. In what
//! order contacts are in lanes depends on the machine: [`super::lanes::order`].

use super::energy::Press;
use super::lanes::{LANES, Lanes, Rows, lanes, rows};
use super::law::{Dashpots, PairLaw, Spring, Touch};
use super::side::Felt;
use crate::scene::TangentialLaw;
use nalgebra::Vector3;
use pulp::Simd;

type Lanes3 = [Lanes; 3];

/// Eight contacts as they are handed in. Velocities are those of b against a, m/s and rad/s, at this instant and as means of
/// the step.
#[derive(Debug, Clone)]
pub(super) struct Entries {
    /// From a's centre of mass to the centre of its sphere, m.
    pub arm: Rows,
    /// From there to the centre of b's sphere or the nearest place of the surface; distance at which they begin to touch, m.
    pub between: Rows,
    /// Curvature of the contact, curvature of the smaller sphere, 1/m, inverse of the reduced mass, 1/kg, radius of a's
    /// sphere, m.
    pub traits: Rows,
    /// From a's centre of mass to b's, m.
    pub offset: Rows,
    pub drift: Rows,
    pub turn: Rows,
    pub mean_drift: Rows,
    pub mean_turn: Rows,
    /// Spin of b.
    pub spin: Rows,
    pub mean_spin: Rows,
    /// Mean spin of both bodies.
    pub common_spin: Rows,
}

/// Eight contacts.
#[derive(Debug, Clone)]
pub(super) struct Block {
    arm: Lanes3,
    normal: Lanes3,
    overlap: Lanes,
    pub contact_radius: Lanes,
    sharpness: Lanes,
    velocity: Lanes3,
    mean_velocity: Lanes3,
    twirl: Lanes,
    /// Along the normal and in the tangent plane.
    pub dashpot: [Lanes; 2],
    /// The springs, before and after.
    pub spring: Rows,
    /// Force on b, N; overlap over the smaller sphere's radius.
    pub force: Rows,
    /// Torque of that force about a's centre of mass, N m.
    pub torque: Rows,
}

const ZERO: Lanes = [0.0; LANES];
const ZERO3: Lanes3 = [ZERO; 3];
const NONE: Rows = [[0.0; 4]; LANES];

impl Default for Entries {
    /// Contacts nobody asks for: each lane is worked out, so it must hold numbers.
    fn default() -> Self {
        Self {
            arm: NONE,
            between: [[1.0, 0.0, 0.0, 1.0]; LANES],
            traits: [[1.0; 4]; LANES],
            offset: NONE,
            drift: NONE,
            turn: NONE,
            mean_drift: NONE,
            mean_turn: NONE,
            spin: NONE,
            mean_spin: NONE,
            common_spin: NONE,
        }
    }
}

impl Default for Block {
    fn default() -> Self {
        Self {
            arm: ZERO3,
            normal: ZERO3,
            overlap: ZERO,
            contact_radius: ZERO,
            sharpness: ZERO,
            velocity: ZERO3,
            mean_velocity: ZERO3,
            twirl: ZERO,
            dashpot: [ZERO; 2],
            spring: NONE,
            force: NONE,
            torque: NONE,
        }
    }
}

#[inline(always)]
fn get(lanes: &Lanes3, k: usize) -> Vector3<f64> {
    Vector3::new(lanes[0][k], lanes[1][k], lanes[2][k])
}

#[inline(always)]
fn set(lanes: &mut Lanes3, k: usize, v: &Vector3<f64>) {
    (lanes[0][k], lanes[1][k], lanes[2][k]) = (v.x, v.y, v.z);
}

/// The first three of four numbers in a lane.
#[inline(always)]
fn three(lanes: &[Lanes; 4], k: usize) -> Vector3<f64> {
    Vector3::new(lanes[0][k], lanes[1][k], lanes[2][k])
}

impl Block {
    /// Where and how the contacts touch, and the dashpots of each by itself. The contact point lies `inside` overlaps
    /// inside a's sphere.
    #[inline(always)]
    pub(super) fn place<S: Simd>(&mut self, simd: S, entries: &Entries, law: &PairLaw, inside: f64) {
        let (arm, between) = (lanes(simd, &entries.arm), lanes(simd, &entries.between));
        let traits = lanes(simd, &entries.traits);
        for k in 0..LANES {
            // Centres in one place are pushed apart along y.
            let nowhere = three(&between, k) == Vector3::zeros();
            let from_center = if nowhere { Vector3::y() * f64::EPSILON } else { three(&between, k) };
            let distance = from_center.norm();
            let normal = from_center / distance;
            let overlap = between[3][k] - distance;
            let contact_radius = (overlap / traits[0][k]).sqrt();
            let arm = three(&arm, k) + normal * (traits[3][k] - inside * overlap);
            let dashpots = law.dashpots(contact_radius, 1.0 / traits[2][k]);
            set(&mut self.arm, k, &arm);
            set(&mut self.normal, k, &normal);
            self.overlap[k] = overlap;
            self.contact_radius[k] = contact_radius;
            self.dashpot[0][k] = dashpots.normal;
            self.dashpot[1][k] = dashpots.tangential;
        }
        self.sharpness = traits[1];
        let offset = lanes(simd, &entries.offset);
        self.velocity = self.at_points(simd, &offset, [&entries.drift, &entries.turn, &entries.spin]);
        let mean = [&entries.mean_drift, &entries.mean_turn, &entries.mean_spin];
        self.mean_velocity = self.at_points(simd, &offset, mean);
        let common_spin = lanes(simd, &entries.common_spin);
        for k in 0..LANES {
            self.twirl[k] = three(&common_spin, k).dot(&get(&self.normal, k));
        }
    }

    /// Velocities of b against a at the contact points.
    #[inline(always)]
    fn at_points<S: Simd>(&self, simd: S, offset: &[Lanes; 4], [drift, turn, spin]: [&Rows; 3]) -> Lanes3 {
        let (drift, turn, spin) = (lanes(simd, drift), lanes(simd, turn), lanes(simd, spin));
        let mut velocity = ZERO3;
        for k in 0..LANES {
            let drift = three(&drift, k) - three(&spin, k).cross(&three(offset, k));
            set(&mut velocity, k, &(drift + three(&turn, k).cross(&get(&self.arm, k))));
        }
        velocity
    }

    /// Forces; springs move on.
    #[inline(always)]
    pub(super) fn press<S: Simd>(&mut self, simd: S, law: &PairLaw, dt: f64) {
        // The laws apart, so that none is asked for in a lane.
        match law.tangential {
            TangentialLaw::Total => {
                self.press_by(simd, &PairLaw { tangential: TangentialLaw::Total, ..*law }, dt);
            }
            TangentialLaw::Incremental => {
                self.press_by(simd, &PairLaw { tangential: TangentialLaw::Incremental, ..*law }, dt);
            }
            TangentialLaw::Rescaled => {
                self.press_by(simd, &PairLaw { tangential: TangentialLaw::Rescaled, ..*law }, dt);
            }
        }
    }

    #[inline(always)]
    fn press_by<S: Simd>(&mut self, simd: S, law: &PairLaw, dt: f64) {
        let mut springs = lanes(simd, &self.spring);
        let (mut forces, mut torques) = ([ZERO; 4], [ZERO; 4]);
        for k in 0..LANES {
            let normal = get(&self.normal, k);
            let touch = Touch {
                normal,
                overlap: self.overlap[k],
                velocity: get(&self.velocity, k),
                mean_velocity: get(&self.mean_velocity, k),
                twirl: self.twirl[k],
            };
            let dashpots = Dashpots { normal: self.dashpot[0][k], tangential: self.dashpot[1][k] };
            let mut spring = Spring { stretch: three(&springs, k), radius: springs[3][k] };
            let pressed = law.force(&touch, self.contact_radius[k], dashpots, dt, &mut spring);
            let force = normal * pressed.normal + pressed.tangential;
            let torque = get(&self.arm, k).cross(&force);
            let Spring { stretch, radius } = spring;
            let deep = self.overlap[k] * self.sharpness[k];
            (forces[0][k], forces[1][k], forces[2][k], forces[3][k]) = (force.x, force.y, force.z, deep);
            (torques[0][k], torques[1][k], torques[2][k]) = (torque.x, torque.y, torque.z);
            (springs[0][k], springs[1][k], springs[2][k], springs[3][k]) =
                (stretch.x, stretch.y, stretch.z, radius);
        }
        self.force = rows(simd, &forces);
        self.torque = rows(simd, &torques);
        self.spring = rows(simd, &springs);
    }

    /// What the contact in a row and its lane came to; `number` is the index of the law.
    pub(super) fn pressed(
        &self,
        (row, lane): (usize, usize),
        number: usize,
        law: &PairLaw,
        dt: f64,
    ) -> Press {
        let (spring, normal) = (Spring::from_row(self.spring[row]), get(&self.normal, lane));
        let ([x, y, z, _], velocity) = (self.force[row], get(&self.mean_velocity, lane));
        let force = Vector3::new(x, y, z);
        let slip = (velocity - normal * velocity.dot(&normal)) * dt;
        let spring_force = law.spring_force(&spring);
        let across = normal * force.dot(&normal);
        let overlap = self.overlap[lane];
        let elastic = normal * (2.0 / 3.0 * law.normal_stiffness(spring.radius) * overlap);
        Press {
            law: number,
            normal,
            overlap,
            arm: get(&self.arm, lane),
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
