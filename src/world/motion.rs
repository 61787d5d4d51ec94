//! Pose and velocity of a body, as contact needs them.

use nalgebra::{Matrix3, Vector3};

/// Where a body is and how it moves, in f64. Rapier holds the same poses in f32 for its near-pair search only:
/// f32 near 0.2 m resolves 2e-8 m, which is 2 % of a 1 µm overlap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Centre of mass, m.
    pub position: Vector3<f64>,
    /// Turns body axes to world axes.
    pub rotation: Matrix3<f64>,
    /// Mean velocity of the centre of mass in the step that led here, m/s.
    pub velocity: Vector3<f64>,
    /// Mean angular velocity of that step, world axes, rad/s.
    pub spin: Vector3<f64>,
}

impl Motion {
    /// At rest at the origin with body axes along world axes.
    pub fn at_rest() -> Self {
        Self {
            position: Vector3::zeros(),
            rotation: Matrix3::identity(),
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
        }
    }

    /// Velocity of the body's point at `arm` from its centre of mass (world axes), m/s.
    #[inline]
    pub fn velocity_at(&self, arm: &Vector3<f64>) -> Vector3<f64> {
        self.velocity + self.spin.cross(arm)
    }

    /// This body's pose as another one sees it, in that one's axes.
    #[inline]
    pub fn seen_from(&self, other: &Self) -> Relative {
        Relative {
            position: other.rotation.tr_mul(&(self.position - other.position)),
            rotation: other.rotation.tr_mul(&self.rotation),
        }
    }

    /// How this body moves as another one sees it, in that one's axes.
    #[inline(always)]
    pub fn course_from(&self, other: &Self) -> Course {
        let velocity = self.velocity - other.velocity_at(&(self.position - other.position));
        Course {
            velocity: other.rotation.tr_mul(&velocity),
            spin: other.rotation.tr_mul(&(self.spin - other.spin)),
        }
    }
}

/// How one body moves in another's axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    /// Of the centre of mass, m/s.
    pub velocity: Vector3<f64>,
    /// rad/s.
    pub spin: Vector3<f64>,
}

impl Course {
    /// Most speed of a point within `lever` of the one `arm` from the centre of mass, the other's axes, m/s.
    #[inline(always)]
    pub fn speed(&self, arm: &Vector3<f64>, lever: f64) -> f64 {
        (self.velocity + self.spin.cross(arm)).norm() + self.spin.norm() * lever
    }
}

/// Share of the way allowed that a pose ahead lies off: what moves as foreseen can go on for 1.7 times the way from there.
const AHEAD: f64 = 0.7;
/// No pose lies farther ahead than this, s: tablets of an avalanche collide about as often.
const FORESIGHT: f64 = 0.01;

/// The pose of one body in another's axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relative {
    /// m.
    pub position: Vector3<f64>,
    /// Turns the one's axes to the other's.
    pub rotation: Matrix3<f64>,
}

impl Relative {
    /// No pose: infinitely far from every other.
    pub const NOWHERE: Self = Self {
        position: Vector3::new(f64::INFINITY, 0.0, 0.0),
        rotation: Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
    };

    /// Most that a point of the one body within `reach`, m, of its centre of mass can be away from where it was `then`, m.
    #[inline]
    pub fn moved_since(&self, then: &Self, reach: f64) -> f64 {
        // |Q s − Q₀ s| ≤ 2 sin(θ/2) |s|, and 3 − tr(Q₀ᵀ Q) = 4 sin²(θ/2).
        let turned = (3.0 - then.rotation.dot(&self.rotation)).max(0.0).sqrt();
        (self.position - then.position).norm() + turned * reach
    }

    /// Where the one body is likely to be half-way through the time in which it goes `far`, m, on its `course`, its fastest point
    /// at `speed`: what is known of the bodies there stays good for longer than what is known of them here.
    #[inline(always)]
    #[must_use]
    pub fn ahead(&self, course: &Course, speed: f64, far: f64) -> Self {
        self.after(course, (AHEAD * far / speed.max(f64::MIN_POSITIVE)).min(FORESIGHT))
    }

    /// Where the one body is when it has moved and turned by its `course` for `time`, s. How its turn bends its way is left out.
    #[inline(always)]
    fn after(&self, course: &Course, time: f64) -> Self {
        // Cayley's map, exactly a rotation: with q half the rotation vector, v becomes v + 2 (q × v + q × (q × v))/(1 + q²).
        let q = course.spin * (0.5 * time);
        let scale = 2.0 / (1.0 + q.norm_squared());
        let turned = |v: Vector3<f64>| {
            let across = q.cross(&v);
            v + (across + q.cross(&across)) * scale
        };
        let axes = [0, 1, 2].map(|k| turned(self.rotation.column(k).into()));
        Self { position: self.position + course.velocity * time, rotation: Matrix3::from_columns(&axes) }
    }

    /// Where a point of the one body (its own axes) is in the other's, m.
    #[inline]
    pub fn place(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.position + self.rotation * point
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use nalgebra::UnitQuaternion;

    fn rotation(turn: Vector3<f64>) -> Matrix3<f64> {
        UnitQuaternion::new(turn).to_rotation_matrix().into_inner()
    }

    /// Seen from a turning drum, a body that flies straight on comes by the pose ahead, half-way through what it may go.
    #[test]
    fn a_pose_ahead_is_where_the_body_comes_by() {
        let drum = Motion { spin: Vector3::new(0.0, 0.0, 2.3), ..Motion::at_rest() };
        let body = Motion {
            position: Vector3::new(0.08, -0.03, 0.01),
            rotation: rotation(Vector3::new(0.3, -1.0, 0.7)),
            velocity: Vector3::new(-0.4, -0.3, 0.1),
            spin: Vector3::new(5.0, -3.0, 20.0),
        };
        let (now, course) = (body.seen_from(&drum), body.course_from(&drum));
        let (reach, far) = (4e-3, 1e-3);
        let speed = course.speed(&Vector3::zeros(), reach);
        let ahead = now.ahead(&course, speed, far);
        let way = ahead.moved_since(&now, reach);
        assert!((0.99 * AHEAD * far..=AHEAD * far).contains(&way), "{way}");

        let time = AHEAD * far / speed;
        let later = |motion: &Motion| Motion {
            position: motion.position + motion.velocity * time,
            rotation: rotation(motion.spin * time) * motion.rotation,
            ..*motion
        };
        let there = later(&body).seen_from(&later(&drum));
        assert_relative_eq!(ahead.rotation.tr_mul(&ahead.rotation), Matrix3::identity(), epsilon = 1e-14);
        assert!(there.moved_since(&ahead, reach) < 0.01 * far);

        let slow = Course { velocity: course.velocity * 1e-6, spin: course.spin * 1e-6 };
        let way = now.ahead(&slow, 1e-6 * speed, far).moved_since(&now, reach);
        assert!(way < 1.01e-6 * speed * FORESIGHT, "{way}");
    }
}
