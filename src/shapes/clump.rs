//! Sphere clumps: what contact feels of a tablet.

use super::Panels;
use nalgebra::Vector3;

/// One sphere of a clump, in body axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// Centre, m.
    pub center: Vector3<f64>,
    /// Radius, m.
    pub radius: f64,
}

/// The spheres of one tablet shape.
#[derive(Debug, Clone, PartialEq)]
pub struct Clump {
    /// The spheres; never empty.
    pub spheres: Vec<Sphere>,
}

/// How far the surface of a clump is from the surface it stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// Mean over the area of the distance from the surface to the clump, m.
    pub mean: f64,
    /// Largest distance, m.
    pub largest: f64,
}

impl Clump {
    /// Radius of the smallest sphere about the centre of mass that holds the clump, m.
    pub fn bounding_radius(&self) -> f64 {
        self.spheres.iter().map(|s| s.center.norm() + s.radius).fold(0.0, f64::max)
    }

    /// Radius of the smallest sphere, m.
    pub fn smallest_radius(&self) -> f64 {
        self.spheres.iter().map(|s| s.radius).fold(f64::INFINITY, f64::min)
    }

    /// Distance of a point to the surface of the clump, m; negative inside.
    pub fn distance(&self, point: &Vector3<f64>) -> f64 {
        self.spheres.iter().map(|s| (point - s.center).norm() - s.radius).fold(f64::INFINITY, f64::min)
    }

    /// Deviation from a surface, taken at the panels' centroids.
    pub fn deviation(&self, surface: &Panels) -> Deviation {
        let (mut sum, mut largest) = (0.0, 0.0_f64);
        for (centroid, area) in surface.centroids.iter().zip(&surface.areas) {
            let distance = self.distance(centroid).abs();
            sum += distance * area;
            largest = largest.max(distance);
        }
        Deviation { mean: sum / surface.areas.iter().sum::<f64>(), largest }
    }

    /// Volume (m³) and surface area (m²) of the union of the spheres: the visible part of each sphere's surface, seen
    /// on 20 000 points, gives the area and by Gauss's theorem the volume. Exact for one sphere; relative error about
    /// 1e-3 for overlapping ones.
    pub fn volume_and_area(&self) -> (f64, f64) {
        const POINTS: usize = 20_000;
        let golden_angle = std::f64::consts::PI * (3.0 - 5f64.sqrt());
        let direction = |k: usize| {
            let z = 1.0 - (2 * k + 1) as f64 / POINTS as f64;
            let (sin, cos) = (golden_angle * k as f64).sin_cos();
            let r = (1.0 - z * z).sqrt();
            Vector3::new(r * cos, r * sin, z)
        };
        let (mut volume, mut area) = (0.0, 0.0);
        for (i, sphere) in self.spheres.iter().enumerate() {
            let others: Vec<&Sphere> = (0..self.spheres.len())
                .filter(|&j| j != i)
                .map(|j| &self.spheres[j])
                .filter(|s| (s.center - sphere.center).norm() < s.radius + sphere.radius)
                .collect();
            let patch = 4.0 * std::f64::consts::PI * sphere.radius.powi(2) / POINTS as f64;
            for normal in (0..POINTS).map(direction) {
                let point = sphere.center + normal * sphere.radius;
                let hidden = |s: &&Sphere| (point - s.center).norm_squared() < s.radius * s.radius;
                if !others.iter().any(hidden) {
                    area += patch;
                    volume += patch * point.dot(&normal) / 3.0;
                }
            }
        }
        (volume, area)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::PI;

    fn pair(distance: f64) -> Clump {
        let at = |x: f64| Sphere { center: Vector3::new(x, 0.0, 0.0), radius: 1.0 };
        Clump { spheres: vec![at(-distance / 2.0), at(distance / 2.0)] }
    }

    #[test]
    fn volume_of_overlapping_spheres() {
        // 2 (4/3) π R³ − π (4R + d)(2R − d)²/12, R = 1.
        for (distance, volume) in [(1.0, 7.068_583_470_577), (1.5, 8.017_606_251_349)] {
            let (v, a) = pair(distance).volume_and_area();
            assert_relative_eq!(v, volume, max_relative = 1e-3);
            assert_relative_eq!(a, 4.0 * PI * (1.0 + distance / 2.0), max_relative = 1e-3);
        }
    }

    #[test]
    fn distances_and_radii() {
        let clump = pair(1.0);
        assert_relative_eq!(clump.distance(&Vector3::new(2.5, 0.0, 0.0)), 1.0);
        assert_relative_eq!(clump.bounding_radius(), 1.5);
        assert_relative_eq!(clump.smallest_radius(), 1.0);
    }
}
