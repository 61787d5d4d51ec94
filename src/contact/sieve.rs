//! Which of eight sphere pairs of two bodies may touch, told at once from little memory: places in grains, a unit of length
//! in which centres fit 16 bits.

use super::block::LANES;
use super::body::{Ball, Outline};
use crate::world::Motion;
use nalgebra::Vector3;
use wide::f32x8;

/// A grain as a share of the largest bounding radius: centres, and sums of two radii, fit 16 bits.
pub(super) const GRAIN: f64 = 1.0 / 32_000.0;

/// A sphere in whole grains, so large that what touches does so with these spheres as well.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Grains {
    /// Body axes.
    center: [i16; 3],
    /// A grain more than that of the sphere: the centres of two are off by up to √3 grains, and what f32 rounds off below comes
    /// to a tenth where bodies are near.
    radius: u16,
}

impl Grains {
    /// `grain` in m.
    pub(super) fn of(ball: &Ball, grain: f64) -> Self {
        let center = (ball.center / grain).map(|x| x.round() as i16);
        Self { center: center.into(), radius: (ball.radius / grain).ceil() as u16 + 1 }
    }
}

/// Where a body is, as far as sieves ask.
#[derive(Debug, Clone, Copy, Default)]
#[repr(align(64))]
pub(super) struct Pose {
    /// Grains.
    position: Vector3<f64>,
    /// Turns body axes to world axes.
    turn: [f32; 9],
}

impl Pose {
    /// Where a body with this motion is, `grain` in m. Changed where it lies: a copy would wait for what it was put together from.
    #[inline]
    pub(super) fn follow(&mut self, motion: &Motion, grain: f64) {
        self.position = motion.position * (1.0 / grain);
        for (to, from) in self.turn.iter_mut().zip(motion.rotation.as_slice()) {
            *to = *from as f32;
        }
    }
}

/// Up to eight sphere pairs of two bodies.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(super) struct Sieve {
    pub bodies: (u32, u32),
    /// How many pairs they are.
    pub len: u32,
    /// Distance at which they may touch, grains: 0 in lanes left over.
    reach: [u16; LANES],
    /// Centres of the spheres of the one and the other body, each in the axes of its body, grains.
    centers: [[[i16; LANES]; 3]; 2],
}

/// Some of eight lanes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Picked {
    /// Their numbers first, in order.
    pub numbers: [u8; LANES],
    pub count: usize,
}

/// What is picked by each number of eight bits.
const PICKED: [Picked; 256] = {
    let mut all = [Picked { numbers: [0; LANES], count: 0 }; 256];
    let mut bits = 0;
    while bits < all.len() {
        let mut k = 0;
        while k < LANES {
            if bits >> k & 1 == 1 {
                all[bits].numbers[all[bits].count] = k as u8;
                all[bits].count += 1;
            }
            k += 1;
        }
        bits += 1;
    }
    all
};

impl Sieve {
    /// A sieve that nothing passes.
    pub(super) fn closed(bodies: (u32, u32), len: usize) -> Self {
        Self { bodies, len: len as u32, reach: [0; LANES], centers: [[[0; LANES]; 3]; 2] }
    }

    /// The sieve of up to eight pairs of spheres, by their numbers.
    pub(super) fn of(bodies: (u32, u32), [a, b]: [&Outline; 2], spheres: &[(u16, u16)]) -> Self {
        let mut sieve = Self::closed(bodies, spheres.len());
        for (k, &(i, j)) in spheres.iter().enumerate() {
            let (a, b) = (&a.grains[usize::from(i)], &b.grains[usize::from(j)]);
            for x in 0..3 {
                (sieve.centers[0][x][k], sieve.centers[1][x][k]) = (a.center[x], b.center[x]);
            }
            sieve.reach[k] = a.radius + b.radius;
        }
        sieve
    }

    /// Those that may touch.
    #[inline(always)]
    pub(super) fn passed(&self, a: &Pose, b: &Pose) -> &'static Picked {
        let apart = b.position - a.position;
        let apart = Vector3::new(apart.x as f32, apart.y as f32, apart.z as f32);
        let [of_a, of_b] = &self.centers;
        let mut excess = [0.0; LANES];
        for k in 0..LANES {
            let mut square = 0.0;
            for x in 0..3 {
                let (mut to_a, mut to_b) = (0.0, 0.0);
                for y in 0..3 {
                    to_a += a.turn[3 * y + x] * f32::from(of_a[y][k]);
                    to_b += b.turn[3 * y + x] * f32::from(of_b[y][k]);
                }
                let between = apart[x] + to_b - to_a;
                square += between * between;
            }
            let reach = f32::from(self.reach[k]);
            excess[k] = square - reach * reach;
        }
        &PICKED[f32x8::new(excess).simd_lt(f32x8::ZERO).to_bitmask() as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{Clump, Sphere};
    use nalgebra::UnitQuaternion;
    use rand::{Rng, RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn clump(random: &mut impl Rng) -> Clump {
        let spheres = (0..8).map(|_| Sphere {
            center: Vector3::from_fn(|_, _| random.random_range(-5e-3..5e-3)),
            radius: random.random_range(1e-3..4e-3),
        });
        Clump { spheres: spheres.collect() }
    }

    /// Bodies as far apart that each of eight pairs in turn just touches or just does not.
    #[test]
    fn what_touches_passes_and_what_is_some_grains_apart_does_not() {
        let random = &mut ChaCha8Rng::seed_from_u64(1);
        let (mut passed, mut held) = (0, 0);
        for _ in 0..2000 {
            let clumps = [clump(random), clump(random)];
            let grain = GRAIN * clumps.iter().map(Clump::bounding_radius).fold(0.0, f64::max);
            let outlines = [0, 1].map(|k| Outline::new(&clumps[k], &Vector3::repeat(1.0), 0, grain));
            let pairs: Vec<_> = (0..8).map(|i| (i, random.random_range(0..8))).collect();
            let sieve = Sieve::of((0, 1), [&outlines[0], &outlines[1]], &pairs);
            let position = Vector3::from_fn(|_, _| random.random_range(-1.0..1.0));
            let mut motion = || Motion {
                position,
                rotation: UnitQuaternion::new(Vector3::from_fn(|_, _| random.random_range(-3.0..3.0)))
                    .to_rotation_matrix()
                    .into_inner(),
                ..Motion::at_rest()
            };
            let (a, mut b) = (motion(), motion());
            let between = |b: &Motion, (i, j): (u16, u16)| {
                let (i, j) = (&outlines[0].balls[usize::from(i)], &outlines[1].balls[usize::from(j)]);
                let between = b.position + b.rotation * j.center - a.position - a.rotation * i.center;
                (between, i.radius + j.radius)
            };
            for &pair in &pairs {
                let (way, reach) = between(&b, pair);
                b.position += way * ((reach + grain * random.random_range(-9.0..9.0)) / way.norm() - 1.0);
                let mut poses = [Pose::default(); 2];
                poses[0].follow(&a, grain);
                poses[1].follow(&b, grain);
                let picked = sieve.passed(&poses[0], &poses[1]);
                let picked = &picked.numbers[..picked.count];
                for (k, &pair) in pairs.iter().enumerate() {
                    let (way, reach) = between(&b, pair);
                    let passes = picked.contains(&(k as u8));
                    let gap = (way.norm() - reach) / grain;
                    assert!(gap > 0.0 || passes, "{gap} grains");
                    assert!(gap < 6.0 || !passes, "{gap} grains");
                    (passed, held) = (passed + u32::from(passes), held + u32::from(!passes));
                }
            }
        }
        assert!(passed > 10_000 && held > 10_000, "{passed} passed, {held} did not");
    }
}
