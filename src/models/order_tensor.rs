//! How tablets lie while they are sprayed.

use nalgebra::{Matrix3, SymmetricEigen, Vector3};
use serde::{Deserialize, Serialize};

/// First two moments of the spray direction in the tablet's own axes: unit vectors from the tablet to the nozzle.
///
/// Q = ⟨(3 s sᵀ − I)/2⟩ is the order tensor of liquid crystals (de Gennes and Prost 1993, The Physics of Liquid Crystals,
/// section 2.1.2): zero for random orientations, and Q_zz = 1 when the spray always meets a cap head-on.
///
/// ```
/// use nalgebra::Vector3;
/// use pancoat::models::OrderTensor;
/// let mut order = OrderTensor::default();
/// order.add(&Vector3::z());
/// order.add(&Vector3::x());
/// assert!((order.s2() - 0.25).abs() < 1e-12); // (1 − 1/2)/2
/// assert!((order.along(&Vector3::y()) + 0.5).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct OrderTensor {
    count: u64,
    sum: Vector3<f64>,
    /// Σ s sᵀ
    products: Matrix3<f64>,
}

impl OrderTensor {
    /// The moments of a list of unit vectors.
    pub fn of(directions: &[Vector3<f64>]) -> Self {
        let mut order = Self::default();
        for direction in directions {
            order.add(direction);
        }
        order
    }

    /// Takes one more direction, a unit vector in body axes.
    pub fn add(&mut self, direction: &Vector3<f64>) {
        self.count += 1;
        self.sum += direction;
        self.products += direction * direction.transpose();
    }

    /// How many directions were taken.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// ⟨s⟩; zero when both caps are met equally.
    pub fn mean(&self) -> Vector3<f64> {
        self.sum / self.count.max(1) as f64
    }

    /// Q; zero without directions.
    pub fn q(&self) -> Matrix3<f64> {
        if self.count == 0 {
            return Matrix3::zeros();
        }
        1.5 * self.products / self.count as f64 - 0.5 * Matrix3::identity()
    }

    /// Mean of P₂ of the cosine between the spray and a unit vector: 1 along it, −1/2 square to it, 0 at random.
    pub fn along(&self, axis: &Vector3<f64>) -> f64 {
        axis.dot(&(self.q() * axis))
    }

    /// S₂ = Q_zz, the order of the tablet's own axis: 1 for caps always up.
    pub fn s2(&self) -> f64 {
        self.along(&Vector3::z())
    }

    /// Eigenvalues of Q, ascending. They add up to 0; unequal lower two tell that the tablet rolls about one axis rather than
    /// about the other.
    pub fn principal(&self) -> [f64; 3] {
        let mut values: [f64; 3] = SymmetricEigen::new(self.q()).eigenvalues.into();
        values.sort_by(f64::total_cmp);
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_signs_of_all_axes_have_no_order() {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let order = OrderTensor::of(&axes.iter().flat_map(|a| [*a, -a]).collect::<Vec<_>>());
        assert!(order.q().norm() < 1e-15 && order.mean().norm() < 1e-15);
        assert_eq!(OrderTensor::default().q(), Matrix3::zeros());
    }

    #[test]
    fn rolling_shows_in_the_lower_eigenvalues() {
        // The spray meets caps and sides but never the ends along x.
        let order = OrderTensor::of(&[Vector3::z(), Vector3::z(), Vector3::y()]);
        let [low, middle, high] = order.principal();
        assert!((low + 0.5).abs() < 1e-12 && middle.abs() < 1e-12 && (high - 0.5).abs() < 1e-12);
    }
}
