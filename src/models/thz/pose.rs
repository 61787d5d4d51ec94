//! How a scanned tablet lies in the scanner's axes.

use super::super::TabletSurface;
use nalgebra::{Matrix3, Matrix6, Rotation3, SymmetricEigen, UnitQuaternion, Vector3, Vector6};
use rayon::prelude::*;

/// A rigid motion from the scanner's axes to the tablet's body axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Turns scanner axes to body axes.
    pub rotation: UnitQuaternion<f64>,
    /// Added after turning, m.
    pub translation: Vector3<f64>,
    /// Root mean square distance of the points from the planes of their panels, m.
    pub residual: f64,
}

/// Points used while searching, and for the last fit.
const SEARCH_POINTS: usize = 500;
const FIT_POINTS: usize = 3000;

impl Pose {
    /// Body coordinates of a scanned point, m.
    pub fn apply(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.rotation * point + self.translation
    }

    /// The pose that lays `points` (m, at least six) best on a surface.
    ///
    /// Starts from the four ways to lay the principal axes of the points on those of the surface, and improves each by iterated
    /// closest points with distances to panel planes (Chen and Medioni 1992, Image Vis. Comput. 10, 145). What a shape's symmetry
    /// leaves open stays as it starts: the turn of a round tablet about its axis, or which cap of an oval one is up.
    pub fn fit(points: &[Vector3<f64>], surface: &TabletSurface<'_>) -> Self {
        let few = thin(points, SEARCH_POINTS);
        let [first, others @ ..] = starts(points, surface).map(|start| start.improved(&few, surface, 15));
        let best = others
            .into_iter()
            .fold(first, |best, other| if other.residual < best.residual { other } else { best });
        best.improved(&thin(points, FIT_POINTS), surface, 25)
    }

    /// Iterates closest panels and the small motion that brings the points onto their planes.
    fn improved(mut self, points: &[Vector3<f64>], surface: &TabletSurface<'_>, rounds: usize) -> Self {
        let scale = surface.centroids.iter().map(Vector3::norm).fold(0.0, f64::max);
        for _ in 0..rounds {
            let placed: Vec<Vector3<f64>> = points.iter().map(|p| self.apply(p)).collect();
            let near: Vec<usize> = placed.par_iter().map(|p| nearest(p, surface)).collect();
            let (mut normal, mut right, mut squares) = (Matrix6::zeros(), Vector6::zeros(), 0.0);
            for (p, &panel) in placed.iter().zip(&near) {
                let n = surface.normals[panel];
                let distance = n.dot(&(p - surface.centroids[panel]));
                // Unknowns: turn (rad) and shift in units of the tablet's size, so that both weigh alike.
                let turn = p.cross(&n) / scale;
                let row = Vector6::new(turn.x, turn.y, turn.z, n.x, n.y, n.z);
                normal += row * row.transpose();
                right -= row * (distance / scale);
                squares += distance * distance;
            }
            self.residual = (squares / points.len() as f64).sqrt();
            // A little damping holds what a symmetric shape leaves undetermined.
            let damping = 1e-6 * normal.trace();
            let Some(step) = (normal + Matrix6::identity() * damping).cholesky().map(|c| c.solve(&right))
            else {
                break;
            };
            let turn = UnitQuaternion::from_scaled_axis(step.fixed_rows::<3>(0).into_owned());
            self.rotation = turn * self.rotation;
            self.translation = turn * self.translation + step.fixed_rows::<3>(3) * scale;
            if step.norm() < 1e-9 {
                break;
            }
        }
        self
    }
}

/// The panel whose centroid is nearest to a point in body axes.
pub(super) fn nearest(point: &Vector3<f64>, surface: &TabletSurface<'_>) -> usize {
    let mut best = (f64::INFINITY, 0);
    for (panel, centroid) in surface.centroids.iter().enumerate() {
        let distance = (point - centroid).norm_squared();
        if distance < best.0 {
            best = (distance, panel);
        }
    }
    best.1
}

/// The four proper ways to lay principal axes on principal axes.
fn starts(points: &[Vector3<f64>], surface: &TabletSurface<'_>) -> [Pose; 4] {
    let weights = vec![1.0; points.len()];
    let (from, scan_axes) = principal(points, &weights);
    let (to, body_axes) = principal(surface.centroids, surface.areas);
    [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]].map(|[a, b]| {
        let signs = Matrix3::from_diagonal(&Vector3::new(a, b, a * b));
        let turn = body_axes * signs * scan_axes.transpose();
        let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turn));
        Pose { rotation, translation: to - rotation * from, residual: f64::INFINITY }
    })
}

/// Weighted mean and right-handed principal axes, in order of falling spread.
fn principal(points: &[Vector3<f64>], weights: &[f64]) -> (Vector3<f64>, Matrix3<f64>) {
    let total: f64 = weights.iter().sum();
    let mean = points.iter().zip(weights).map(|(p, w)| p * *w).sum::<Vector3<f64>>() / total;
    let spread = points
        .iter()
        .zip(weights)
        .map(|(p, w)| (p - mean) * (p - mean).transpose() * *w)
        .sum::<Matrix3<f64>>();
    let eigen = SymmetricEigen::new(spread);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let first = eigen.eigenvectors.column(order[0]).into_owned();
    let second = eigen.eigenvectors.column(order[1]).into_owned();
    (mean, Matrix3::from_columns(&[first, second, first.cross(&second)]))
}

/// About `wanted` points, evenly taken from the list.
fn thin(points: &[Vector3<f64>], wanted: usize) -> Vec<Vector3<f64>> {
    points.iter().step_by(points.len().div_ceil(wanted).max(1)).copied().collect()
}
