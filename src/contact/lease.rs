//! How long a list of what is near stays complete.

use crate::world::Relative;
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
        let gone = now.place(&self.about()) - self.place.map(f64::from);
        f64::from(self.allowance) - gone.norm() - turned * f64::from(self.lever)
    }

    /// m.
    pub(super) fn about(&self) -> Vector3<f64> {
        self.about.map(f64::from)
    }

    /// m.
    pub(super) fn lever(&self) -> f64 {
        f64::from(self.lever)
    }

    /// Whether a list with `left` m of its allowance goes on.
    #[inline]
    pub(super) fn holds(&self, left: f64) -> bool {
        left > WORN * f64::from(self.allowance)
    }
}
