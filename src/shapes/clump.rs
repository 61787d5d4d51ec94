//! Sphere clumps: what contact feels of a tablet.

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

impl Clump {
    /// Radius of the smallest sphere about the centre of mass that holds the clump, m.
    pub fn bounding_radius(&self) -> f64 {
        self.spheres.iter().map(|s| s.center.norm() + s.radius).fold(0.0, f64::max)
    }

    /// Radius of the smallest sphere, m.
    pub fn smallest_radius(&self) -> f64 {
        self.spheres.iter().map(|s| s.radius).fold(f64::INFINITY, f64::min)
    }
}
