//! Volume, centre of mass and inertia of solids.

use nalgebra::{Matrix3, Vector3};

/// Integrals over a homogeneous solid, per unit density.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassProperties {
    /// Volume, m³; negative when the surface it came from is wound inside out.
    pub volume: f64,
    /// Centre of mass, m.
    pub center: Vector3<f64>,
    /// Inertia tensor about the centre of mass per unit mass, m², in the axes of the vertices.
    pub inertia_per_mass: Matrix3<f64>,
}

impl MassProperties {
    /// From the volume, the first moments ∫ x dV (m⁴) and the second moments ∫ x xᵀ dV (m⁵) about the origin.
    pub fn from_moments(volume: f64, first: Vector3<f64>, second: Matrix3<f64>) -> Self {
        let center = first / volume;
        let covariance = second / volume - center * center.transpose();
        let inertia_per_mass = Matrix3::identity() * covariance.trace() - covariance;
        Self { volume, center, inertia_per_mass }
    }

    /// Of the polyhedron bounded by `triangles` (counter-clockwise seen from outside), exact up to round-off.
    ///
    /// Each triangle and a common apex span a tetrahedron of signed volume v = a·(b×c)/6 with edges a, b, c from the
    /// apex; with s = a + b + c, ∫ x dV = v s/4 and ∫ x xᵀ dV = v (s sᵀ + a aᵀ + b bᵀ + c cᵀ)/20. The same integrals as
    /// B. Mirtich 1996, "Fast and accurate computation of polyhedral mass properties", J. Graphics Tools 1(2), and
    /// D. Eberly 2002, "Polyhedral mass properties (revisited)", in the tetrahedron form. The apex is the mean of the
    /// vertices, which keeps the digits of a mesh far from the origin.
    ///
    /// ```
    /// use nalgebra::Vector3;
    /// use pancoat::shapes::MassProperties;
    /// // The corner tetrahedron of the unit cube has volume 1/6 and its centre at 1/4.
    /// let vertices = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]].map(Vector3::from);
    /// let solid = MassProperties::of_polyhedron(&vertices, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
    /// assert!((solid.volume - 1.0 / 6.0).abs() < 1e-15);
    /// assert!((solid.center - Vector3::repeat(0.25)).norm() < 1e-15);
    /// ```
    pub fn of_polyhedron(vertices: &[Vector3<f64>], triangles: &[[u32; 3]]) -> Self {
        let apex = vertices.iter().sum::<Vector3<f64>>() / vertices.len() as f64;
        let mut volume = 0.0;
        let mut first = Vector3::zeros();
        let mut second = Matrix3::zeros();
        for triangle in triangles {
            let [a, b, c] = triangle.map(|v| vertices[v as usize] - apex);
            let (v, s) = (a.dot(&b.cross(&c)) / 6.0, a + b + c);
            volume += v;
            first += s * (v / 4.0);
            let products = [s, a, b, c].iter().map(|x| x * x.transpose()).sum::<Matrix3<f64>>();
            second += products * (v / 20.0);
        }
        let mut solid = Self::from_moments(volume, first, second);
        solid.center += apex;
        solid
    }

    /// Principal moments per unit mass, m², and the rotation whose columns are the principal axes, right-handed,
    /// each taken for the coordinate axis it is nearest to: a solid already along its axes is left as it lies.
    pub fn principal(&self) -> (Vector3<f64>, Matrix3<f64>) {
        let eigen = self.inertia_per_mass.symmetric_eigen();
        let orders = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
        let nearness = |o: &[usize; 3]| (0..3).map(|i| eigen.eigenvectors[(i, o[i])].abs()).sum::<f64>();
        let order = orders
            .into_iter()
            .fold(orders[0], |best, o| if nearness(&o) > nearness(&best) { o } else { best });
        let mut axes = Matrix3::from_columns(&order.map(|k| eigen.eigenvectors.column(k).into_owned()));
        for i in 0..3 {
            if axes[(i, i)] < 0.0 {
                axes.column_mut(i).neg_mut();
            }
        }
        if axes.determinant() < 0.0 {
            axes.column_mut(0).neg_mut();
        }
        (Vector3::from(order.map(|k| eigen.eigenvalues[k])), axes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use nalgebra::Rotation3;

    const BOX: [[u32; 3]; 12] = [
        [0, 2, 1],
        [0, 3, 2],
        [4, 5, 6],
        [4, 6, 7],
        [0, 1, 5],
        [0, 5, 4],
        [1, 2, 6],
        [1, 6, 5],
        [2, 3, 7],
        [2, 7, 6],
        [3, 0, 4],
        [3, 4, 7],
    ];

    fn box_of(sides: Vector3<f64>) -> Vec<Vector3<f64>> {
        [
            [0., 0., 0.],
            [1., 0., 0.],
            [1., 1., 0.],
            [0., 1., 0.],
            [0., 0., 1.],
            [1., 0., 1.],
            [1., 1., 1.],
            [0., 1., 1.],
        ]
        .map(|p| Vector3::from(p).component_mul(&sides))
        .to_vec()
    }

    #[test]
    fn shifted_and_turned_box_is_exact() {
        let sides = Vector3::new(1.0, 2.0, 3.0);
        let turn = Rotation3::from_euler_angles(0.3, -0.2, 0.25);
        let shift = Vector3::new(40.0, -7.0, 3.0);
        let vertices: Vec<_> = box_of(sides).iter().map(|p| turn * p + shift).collect();
        let solid = MassProperties::of_polyhedron(&vertices, &BOX);
        assert_relative_eq!(solid.volume, 6.0, max_relative = 1e-12);
        assert_relative_eq!(solid.center, turn * (sides / 2.0) + shift, max_relative = 1e-12);
        let (moments, axes) = solid.principal();
        let expected = Vector3::new(13.0, 10.0, 5.0) / 12.0;
        assert_relative_eq!(moments, expected, max_relative = 1e-12);
        assert_relative_eq!(axes, *turn.matrix(), epsilon = 1e-12);
    }

    #[test]
    fn tetrahedron_is_exact() {
        // Corner tetrahedron of edge 1: ∫ x² dV = 1/60, so about the centre x² is 1/10 − 1/16 = 3/80 per unit mass.
        let vertices = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]].map(Vector3::from);
        let solid = MassProperties::of_polyhedron(&vertices, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
        assert_relative_eq!(solid.inertia_per_mass[(0, 0)], 6.0 / 80.0, max_relative = 1e-12);
        // ∫ xy dV = 1/120: covariance 1/20 − 1/16 = −1/80, product of inertia +1/80.
        assert_relative_eq!(solid.inertia_per_mass[(0, 1)], 1.0 / 80.0, max_relative = 1e-12);
    }

    #[test]
    fn inverted_winding_gives_negative_volume_and_the_same_inertia() {
        let vertices = box_of(Vector3::new(1.0, 2.0, 3.0));
        let inverted: Vec<_> = BOX.iter().map(|&[a, b, c]| [a, c, b]).collect();
        let (right, wrong) = (
            MassProperties::of_polyhedron(&vertices, &BOX),
            MassProperties::of_polyhedron(&vertices, &inverted),
        );
        assert_relative_eq!(wrong.volume, -right.volume, max_relative = 1e-12);
        assert_relative_eq!(wrong.inertia_per_mass, right.inertia_per_mass, epsilon = 1e-12);
    }
}
