//! How long a list of what is near stays complete.

use crate::world::{Course, Relative};
use nalgebra::{Matrix3, Vector3};

/// What a list is good for: while the one body, seen from the other, is less than `allowance` away from the pose that the list
/// was made for, nothing unlisted touches. In f32, so that it takes little memory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lease {
    /// Two columns of the rotation in that pose.
    axes: [Vector3<f32>; 2],
    /// Where the point `about` is in that pose, the other's axes, m.
    place: Vector3<f32>,
    /// The body's point whose way counts, its own axes, m.
    about: Vector3<f32>,
    /// Way of points that far from it, when the body turns, counts too, m.
    lever: f32,
    /// m.
    allowance: f32,
}

/// A list is made anew when less than this share of its allowance is left: a little left would call for a look at
/// every step.
const WORN: f64 = 0.1;
/// How much less a lever may tell in f32, for each metre: six numbers of a rotation are off by up to 2⁻²⁵, three by four times
/// that, in all by 2.2e-7 (Frobenius), and the lever by up to 2⁻²⁴ of itself.
const ROUNDED: f64 = 5e-7;

impl Lease {
    /// No list.
    pub(super) const NONE: Self = Self {
        axes: [Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.0, 1.0, 0.0)],
        place: Vector3::new(f32::INFINITY, 0.0, 0.0),
        about: Vector3::new(0.0, 0.0, 0.0),
        lever: 0.0,
        allowance: 0.0,
    };

    /// The lease of a list made for the pose `at`, which holds for `allowance`, m.
    #[inline(always)]
    pub(super) fn new(at: &Relative, about: &Vector3<f32>, lever: f64, allowance: f64) -> Self {
        let exact = at.place(&about.map(f64::from));
        let place = exact.map(|x| x as f32);
        let lost = (exact - place.map(f64::from)).norm() + ROUNDED * lever;
        Self {
            axes: [0, 1].map(|k| at.rotation.column(k).map(|x| x as f32)),
            place,
            about: *about,
            lever: lever as f32,
            allowance: (allowance - lost) as f32 * (1.0 - f32::EPSILON),
        }
    }

    /// Allowance that is left, m.
    #[inline(always)]
    pub(super) fn left(&self, now: &Relative) -> f64 {
        let [x, y] = self.axes.map(|axis| axis.map(f64::from));
        let turn = now.rotation - Matrix3::from_columns(&[x, y, x.cross(&y)]);
        // A turn by θ changes the rotation by 2√2 sin(θ/2), and no point at s from the axis goes farther than 2 sin(θ/2) s.
        let turned = (0.5 * turn.norm_squared()).sqrt();
        let gone = now.place(&self.about.map(f64::from)) - self.place.map(f64::from);
        f64::from(self.allowance) - gone.norm() - turned * f64::from(self.lever)
    }

    /// Most speed, m/s, at which the allowance is used up by a body that is at `now` on its `course`.
    #[inline(always)]
    pub(super) fn speed(&self, now: &Relative, course: &Course) -> f64 {
        course.speed(&(now.rotation * self.about.map(f64::from)), f64::from(self.lever))
    }

    /// Whether a list with `left` m of its allowance goes on.
    #[inline]
    pub(super) fn holds(&self, left: f64) -> bool {
        left > WORN * f64::from(self.allowance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::UnitQuaternion;
    use rand::{Rng, RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn within(random: &mut impl Rng, most: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| random.random_range(-1.0..1.0)) * (most / 3.0_f64.sqrt())
    }

    /// No point goes farther than the lease says, and the farthest may: a point about which nothing turns.
    #[test]
    fn what_is_left_covers_the_way_of_every_point() {
        let random = &mut ChaCha8Rng::seed_from_u64(1);
        let (lever, allowance) = (5e-3, 1e-3);
        for k in 0..2000 {
            let turn = UnitQuaternion::new(within(random, 3.0));
            let at =
                Relative { position: within(random, 0.3), rotation: turn.to_rotation_matrix().into_inner() };
            let about = within(random, 5e-3).map(|x| x as f32);
            let lease = Lease::new(&at, &about, lever, allowance);
            // Every fourth turns not at all.
            let turned = within(random, if k % 4 == 0 { 0.0 } else { 10f64.powi(-k % 7) });
            let rotation = at.rotation * UnitQuaternion::new(turned).to_rotation_matrix().into_inner();
            let about = about.map(f64::from);
            let position = at.place(&about) - rotation * about + within(random, 10f64.powi(-3 - k % 5));
            let now = Relative { position, rotation };
            let gone = allowance - lease.left(&now);
            for _ in 0..50 {
                let point = about + within(random, lever);
                let way = (now.place(&point) - at.place(&point)).norm();
                assert!(way <= gone, "{way} of {gone}");
            }
            let way = (now.place(&about) - at.place(&about)).norm();
            let turned = 2.0 * (0.5 * turned.norm()).sin().abs();
            assert!(gone < way + turned * lever + 1e-7, "{gone} instead of {way}");
        }
    }
}
