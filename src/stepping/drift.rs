//! First half of a step: kick and free motion, eight bodies side by side in loops that a compiler turns into vector
//! instructions. Each body is computed by the same operations whatever stands beside it.
//!
//! Translation: velocity Verlet. Rotation: torque-free turn of momentum L over the step. In body axes M = RᵀL obeys
//! Ṁ = M × ω with ω = I⁻¹M, and q̇ = ½ q ω. With ω(t) = ω + ω̇ t + ½ ω̈ t² the Magnus exponent of q (right
//! multiplication) is Ω = ω t + ω̇ t²/2 + ω̈ t³/6 + (ω × ω̇) t³/12 + O(t⁴).

use super::body::Body;
use crate::contact::Wrench;
use crate::world::Motion;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

/// Odometers run this much fast: what a step's chord leaves of the arc, rounding included.
const SAFETY: f64 = 1.01;

const LANES: usize = 8;
type Lanes = [f64; LANES];
type Lanes3 = [Lanes; 3];

/// Bodies that move in one step, and how far they go.
pub(super) struct Drift<'a> {
    pub bodies: &'a mut [Body],
    pub motions: &'a mut [Motion],
    /// Forces and torques of the last force evaluation; left behind is what gravity does.
    pub wrenches: &'a mut [Wrench],
    /// Distance that each body's farthest sphere centre can have moved against the carrier so far, m.
    pub odometers: &'a mut [f64],
    pub stride: Stride,
}

/// What is the same for all bodies in a step.
#[derive(Clone, Copy)]
pub(super) struct Stride {
    /// Step, s.
    pub dt: f64,
    /// How long the kick that ends the last step takes, if it is still to be made, s.
    pub owed: f64,
    /// m/s².
    pub gravity: Vector3<f64>,
    /// Angular velocity of the carrier, rad/s.
    pub carrier: Vector3<f64>,
}

/// Eight bodies; places left over hold the first one again.
#[derive(Default)]
struct Eight {
    inverse_mass: Lanes,
    inverse_inertia: Lanes3,
    orientation: [Lanes; 4],
    position: Lanes3,
    velocity: Lanes3,
    momentum: Lanes3,
    reach: Lanes,
    arms: Lanes3,
    inverse_travel: Lanes,
    force: Lanes3,
    torque: Lanes3,
    /// Columns of the rotation matrix.
    axes: [Lanes3; 3],
    /// Rotation vector of the step, body axes, rad.
    turn: Lanes3,
    /// The same as a quaternion.
    turned: [Lanes; 4],
    /// The same over the step, world axes, rad/s.
    spin: Lanes3,
    path: Lanes,
    /// How far the bodies of a lane went at most so far, of what they may; infinite if that is no number.
    haste: Lanes,
}

#[inline(always)]
fn get(lanes: &Lanes3, k: usize) -> Vector3<f64> {
    Vector3::new(lanes[0][k], lanes[1][k], lanes[2][k])
}

#[inline(always)]
fn set(lanes: &mut Lanes3, k: usize, v: &Vector3<f64>) {
    (lanes[0][k], lanes[1][k], lanes[2][k]) = (v.x, v.y, v.z);
}

#[inline(always)]
fn four(lanes: &[Lanes; 4], k: usize) -> (f64, f64, f64, f64) {
    (lanes[0][k], lanes[1][k], lanes[2][k], lanes[3][k])
}

#[inline(always)]
fn set_four(lanes: &mut [Lanes; 4], k: usize, q: (f64, f64, f64, f64)) {
    (lanes[0][k], lanes[1][k], lanes[2][k], lanes[3][k]) = q;
}

impl pulp::NullaryFnOnce for Drift<'_> {
    /// How far the body that moves most goes in the step, of what it may: above 1 one goes astray.
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let Self { bodies, motions, wrenches, odometers, stride } = self;
        let Stride { dt, owed, gravity, carrier } = stride;
        let bodies = bodies.chunks_mut(LANES).zip(motions.chunks_mut(LANES));
        let eights = bodies.zip(wrenches.chunks_mut(LANES)).zip(odometers.chunks_mut(LANES));
        let mut eight = Eight::default();
        for (((bodies, motions), wrenches), odometers) in eights {
            eight.read(bodies, motions, wrenches);
            for (wrench, body) in wrenches.iter_mut().zip(&*bodies) {
                *wrench = Wrench::weight(&gravity, body.mass);
            }
            eight.kick(owed);
            eight.kick(0.5 * dt);
            eight.find_turn(&carrier, dt);
            eight.mend_large_turns();
            eight.arrive();
            for (k, ((body, motion), odometer)) in bodies.iter_mut().zip(motions).zip(odometers).enumerate() {
                eight.write(k, body, motion);
                *odometer += SAFETY * eight.path[k];
            }
        }
        eight.haste.into_iter().fold(0.0, f64::max)
    }
}

impl Eight {
    #[inline(always)]
    fn read(&mut self, bodies: &[Body], motions: &[Motion], wrenches: &[Wrench]) {
        for k in 0..LANES {
            let from = if k < bodies.len() { k } else { 0 };
            let (body, motion, wrench) = (&bodies[from], &motions[from], &wrenches[from]);
            self.inverse_mass[k] = body.inverse_mass;
            set(&mut self.inverse_inertia, k, &body.inverse_inertia);
            let q = body.orientation.coords;
            set_four(&mut self.orientation, k, (q.x, q.y, q.z, q.w));
            set(&mut self.position, k, &motion.position);
            set(&mut self.velocity, k, &body.velocity);
            set(&mut self.momentum, k, &body.momentum);
            self.reach[k] = body.reach;
            set(&mut self.arms, k, &body.arms);
            self.inverse_travel[k] = body.inverse_travel;
            set(&mut self.force, k, &wrench.force);
            set(&mut self.torque, k, &wrench.torque);
        }
    }

    #[inline(always)]
    fn kick(&mut self, half_step: f64) {
        for k in 0..LANES {
            let velocity = get(&self.velocity, k) + get(&self.force, k) * (half_step * self.inverse_mass[k]);
            let momentum = get(&self.momentum, k) + get(&self.torque, k) * half_step;
            set(&mut self.velocity, k, &velocity);
            set(&mut self.momentum, k, &momentum);
        }
    }

    /// Moves the bodies and finds how they turn.
    #[inline(always)]
    fn find_turn(&mut self, carrier: &Vector3<f64>, dt: f64) {
        for k in 0..LANES {
            let (position, velocity) = (get(&self.position, k), get(&self.velocity, k));
            let moved = velocity * dt - carrier.cross(&(position + velocity * (0.5 * dt))) * dt;
            set(&mut self.position, k, &(position + velocity * dt));

            let axes = axes(four(&self.orientation, k));
            let (momentum, softness) = (get(&self.momentum, k), get(&self.inverse_inertia, k));
            let m = into_body(&axes, &momentum);
            let w = m.component_mul(&softness);
            let m1 = m.cross(&w);
            let w1 = m1.component_mul(&softness);
            let w2 = (m1.cross(&w) + m.cross(&w1)).component_mul(&softness);
            let turn = (w + (w1 + (w2 * (1.0 / 3.0) + w.cross(&w1) * (1.0 / 6.0)) * dt) * (0.5 * dt)) * dt;
            let spin = into_world(&axes, &turn) * (1.0 / dt);
            set(&mut self.spin, k, &spin);
            set(&mut self.turn, k, &turn);
            self.path[k] = moved.norm() + (spin - carrier).norm() * dt * self.reach[k];
            let travel = travel(&(velocity * dt), &turn, self.reach[k], &get(&self.arms, k));
            let haste = travel * self.inverse_travel[k];
            let haste = if haste.is_nan() { f64::INFINITY } else { haste };
            self.haste[k] = if haste > self.haste[k] { haste } else { self.haste[k] };

            // By series, so that no library sine enters: truncation below h¹⁰/10! < 3e-17 for half angles h < 0.1.
            let h2 = 0.25 * turn.norm_squared();
            let over = |n: f64| h2 * (1.0 / n);
            let cos = 1.0 - over(2.0) * (1.0 - over(12.0) * (1.0 - over(30.0) * (1.0 - over(56.0))));
            let sinc = 1.0 - over(6.0) * (1.0 - over(20.0) * (1.0 - over(42.0) * (1.0 - over(72.0))));
            let v = turn * (0.5 * sinc);
            set_four(&mut self.turned, k, (v.x, v.y, v.z, cos));
        }
    }

    /// Half angles for which the series is too short.
    #[inline(always)]
    fn mend_large_turns(&mut self) {
        for k in 0..LANES {
            let turn = get(&self.turn, k);
            let h2 = 0.25 * turn.norm_squared();
            if h2 >= 0.01 {
                let h = h2.sqrt();
                let v = turn * (0.5 * (h.sin() / h));
                set_four(&mut self.turned, k, (v.x, v.y, v.z, h.cos()));
            }
        }
    }

    /// Turns the bodies.
    #[inline(always)]
    fn arrive(&mut self) {
        for k in 0..LANES {
            let (ai, aj, ak, aw) = four(&self.orientation, k);
            let (bi, bj, bk, bw) = four(&self.turned, k);
            let w = aw * bw - ai * bi - aj * bj - ak * bk;
            let i = aw * bi + ai * bw + aj * bk - ak * bj;
            let j = aw * bj - ai * bk + aj * bw + ak * bi;
            let z = aw * bk + ai * bj - aj * bi + ak * bw;
            // One Newton step towards unit length: the error per step is of the order of rounding.
            let scale = 1.5 - 0.5 * (i * i + j * j + z * z + w * w);
            set_four(&mut self.orientation, k, (i * scale, j * scale, z * scale, w * scale));
            let axes = axes(four(&self.orientation, k));
            set(&mut self.axes[0], k, &axes[0]);
            set(&mut self.axes[1], k, &axes[1]);
            set(&mut self.axes[2], k, &axes[2]);
        }
    }

    #[inline(always)]
    fn write(&self, k: usize, body: &mut Body, motion: &mut Motion) {
        let (i, j, z, w) = four(&self.orientation, k);
        body.orientation = UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, z));
        body.velocity = get(&self.velocity, k);
        body.momentum = get(&self.momentum, k);
        *motion = Motion {
            position: get(&self.position, k),
            rotation: Matrix3::from_columns(&[
                get(&self.axes[0], k),
                get(&self.axes[1], k),
                get(&self.axes[2], k),
            ]),
            velocity: get(&self.velocity, k),
            spin: get(&self.spin, k),
        };
    }
}

/// Most that a point moves that is within `reach`, m, of the centre of mass and within `arms`, m, of the principal axes, m: its
/// body goes a `way`, m, and makes a `turn`, body axes, rad.
#[inline(always)]
pub(super) fn travel(way: &Vector3<f64>, turn: &Vector3<f64>, reach: f64, arms: &Vector3<f64>) -> f64 {
    way.norm() + (turn.norm() * reach).min(turn.abs().dot(arms))
}

/// Columns of the rotation matrix of a unit quaternion.
#[inline(always)]
fn axes((i, j, k, w): (f64, f64, f64, f64)) -> [Vector3<f64>; 3] {
    let (ww, ii, jj, kk) = (w * w, i * i, j * j, k * k);
    let (ij, wk, wj) = (i * j * 2.0, w * k * 2.0, w * j * 2.0);
    let (ik, jk, wi) = (i * k * 2.0, j * k * 2.0, w * i * 2.0);
    [
        Vector3::new(ww + ii - jj - kk, wk + ij, ik - wj),
        Vector3::new(ij - wk, ww - ii + jj - kk, wi + jk),
        Vector3::new(wj + ik, jk - wi, ww - ii - jj + kk),
    ]
}

#[inline(always)]
fn into_body([x, y, z]: &[Vector3<f64>; 3], v: &Vector3<f64>) -> Vector3<f64> {
    Vector3::new(x.dot(v), y.dot(v), z.dot(v))
}

#[inline(always)]
fn into_world([x, y, z]: &[Vector3<f64>; 3], v: &Vector3<f64>) -> Vector3<f64> {
    x * v.x + y * v.y + z * v.z
}
