//! The drum and its baffles, in SI units.

use std::path::PathBuf;

/// The pan: axis z through the origin, from z = −width/2 to +width/2.
#[derive(Debug, Clone, PartialEq)]
pub struct Drum {
    /// Inner diameter, m.
    pub diameter: f64,
    /// Inner width, m.
    pub width: f64,
    /// Angular speed about +z, rad/s.
    pub speed: f64,
    /// Index into `Scene::materials`.
    pub material: usize,
    /// What the wall is.
    pub wall: Wall,
    /// Flat facets around the wall, if it is not a mesh.
    pub facets: usize,
    /// Baffles, if any.
    pub baffles: Option<Baffles>,
    /// How far the front end (+z) is lifted, rad. All coordinates are those of the drum; `Scene::gravity` has it in.
    pub axis_tilt: f64,
}

/// The wall of a drum with its end walls.
#[derive(Debug, Clone, PartialEq)]
pub enum Wall {
    /// A cylinder with flat end walls.
    Cylinder,
    /// A surface of revolution with flat end walls, by its diameter at places along the axis, straight in between:
    /// (z, diameter), m, from z = −width/2 to +width/2.
    Profile(Vec<[f64; 2]>),
    /// A triangle mesh about the axis z, with its end walls and baffles.
    Mesh {
        /// STL, OBJ or PLY file, as resolved from the scene file's folder.
        path: PathBuf,
        /// Metres per unit of the file.
        scale: f64,
    },
}

impl Drum {
    /// Places along the axis and inner radius there, m, straight in between; for a mesh the cylinder around it.
    pub fn profile(&self) -> Vec<[f64; 2]> {
        match &self.wall {
            Wall::Profile(points) => points.iter().map(|[z, diameter]| [*z, diameter / 2.0]).collect(),
            Wall::Cylinder | Wall::Mesh { .. } => {
                [-0.5, 0.5].map(|end| [end * self.width, self.diameter / 2.0]).to_vec()
            }
        }
    }

    /// Time from one baffle's passage to the next one's, s; `None` without baffles or at rest.
    pub fn baffle_passage(&self) -> Option<f64> {
        let baffles = self.baffles.as_ref().filter(|_| self.speed != 0.0)?;
        Some(std::f64::consts::TAU / (self.speed.abs() * baffles.count as f64))
    }

    /// Inner radius at a place along the axis, m.
    pub fn radius_at(&self, z: f64) -> f64 {
        let profile = self.profile();
        let k = profile.partition_point(|point| point[0] < z).clamp(1, profile.len() - 1);
        let ([a, r], [b, s]) = (profile[k - 1], profile[k]);
        r + (s - r) * ((z - a) / (b - a)).clamp(0.0, 1.0)
    }

    /// Inner volume without baffles, m³: truncated cones, π/3 h (r² + r s + s²).
    pub fn volume(&self) -> f64 {
        let cone =
            |[[z, r], [w, s]]: [[f64; 2]; 2]| std::f64::consts::PI / 3.0 * (w - z) * (r * r + r * s + s * s);
        self.profile().windows(2).map(|pair| cone([pair[0], pair[1]])).sum()
    }
}

/// Equal baffles across the width of the drum, tilted ± in turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Baffles {
    /// How many, evenly spaced.
    pub count: usize,
    /// Height above the wall, m.
    pub height: f64,
    /// Thickness, m.
    pub thickness: f64,
    /// Angle between the baffle's run and the drum's axis, rad; the sign alternates from baffle to baffle.
    pub tilt: f64,
}
