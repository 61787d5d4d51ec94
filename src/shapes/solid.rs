//! What a recipe describes, before it is made of spheres and panels.

use super::cap::CapProfile;
use super::clump_file::read_clump;
use super::clump_fit::fit_clump;
use super::imported::ImportedSolid;
use super::outline::OutlineCurve;
use super::pressed::PressedSolid;
use super::sphere::sphere_panels;
use super::{Clump, Panels, Repair, ShapeError, Sphere, read_closed_mesh};
use crate::scene::{Placement, Recipe, SphereBudget};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Triangles of the surface to which clumps are fitted, of a solid that is symmetric about its middle plane, so that half
/// of them count, and of any solid: edges of 0.5 to 0.7 mm on the tablets of the field, well below the distance between
/// the spheres of a 100-sphere clump. The time grows with its square.
const FIT_PANELS: [usize; 2] = [5000, 3000];

/// A solid in body axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid(Kind);

#[derive(Debug, Clone, PartialEq)]
enum Kind {
    /// By its radius, m.
    Sphere(f64),
    Pressed(PressedSolid),
    Imported(Box<ImportedSolid>),
    /// Spheres as they are, with their volume (m³), area (m²) and moments per unit mass (m²).
    Glued {
        clump: Clump,
        volume: f64,
        area: f64,
        inertia_per_mass: Vector3<f64>,
    },
}

impl Solid {
    /// The solid of a recipe without a [`Recipe::fault`].
    ///
    /// # Errors
    /// Those of the file of a mesh or clump recipe.
    pub fn new(recipe: &Recipe) -> Result<Self, ShapeError> {
        let pressed = |outline, band, cap, radius| {
            Kind::Pressed(PressedSolid::new(outline, band, CapProfile { cap, radius }))
        };
        Ok(Self(match recipe {
            Recipe::Sphere { diameter } => Kind::Sphere(diameter / 2.0),
            Recipe::Round { diameter, band, cap } => {
                pressed(OutlineCurve::circle(*diameter), *band, *cap, diameter / 2.0)
            }
            Recipe::Pressed { outline, band, cap } => {
                pressed(OutlineCurve::new(outline), *band, *cap, outline.mean_radius())
            }
            Recipe::Mesh { path, scale } => {
                Kind::Imported(Box::new(ImportedSolid::new(&read_closed_mesh(path, *scale)?)))
            }
            Recipe::Clump { path, inertia_per_mass } => {
                let clump = read_clump(path)?;
                let (union, area) = clump.union();
                Kind::Glued {
                    clump,
                    volume: union.volume,
                    area,
                    inertia_per_mass: Vector3::from(*inertia_per_mass),
                }
            }
        }))
    }

    /// Volume, m³: in closed form for a sphere, by quadrature to 1e-9 for pressed tablets, exact for the facets of a
    /// mesh, to about 1e-3 for glued spheres (overlaps counted once).
    pub fn volume(&self) -> f64 {
        match &self.0 {
            Kind::Sphere(radius) => 4.0 / 3.0 * PI * radius.powi(3),
            Kind::Pressed(solid) => solid.mass.volume,
            Kind::Imported(solid) => solid.mass.volume,
            Kind::Glued { volume, .. } => *volume,
        }
    }

    /// Surface area, m², as exact as the volume.
    pub fn area(&self) -> f64 {
        match &self.0 {
            Kind::Sphere(radius) => 4.0 * PI * radius.powi(2),
            Kind::Pressed(solid) => solid.cap_area() + solid.band_area(),
            Kind::Imported(solid) => solid.area(),
            Kind::Glued { area, .. } => *area,
        }
    }

    /// Principal moments of inertia of the homogeneous solid, per unit mass, m².
    pub fn inertia_per_mass(&self) -> Vector3<f64> {
        match &self.0 {
            Kind::Sphere(radius) => Vector3::repeat(0.4 * radius * radius),
            Kind::Pressed(solid) => solid.mass.inertia_per_mass.diagonal(),
            Kind::Imported(solid) => solid.mass.inertia_per_mass.diagonal(),
            Kind::Glued { inertia_per_mass, .. } => *inertia_per_mass,
        }
    }

    /// What had to be put right in the file of a mesh.
    pub fn repairs(&self) -> &[Repair] {
        if let Kind::Imported(solid) = &self.0 { &solid.repairs } else { &[] }
    }

    /// A clump for contact; a sphere is always one sphere, and glued spheres are taken as they are. Clumps of pressed
    /// tablets are symmetric about the middle plane. `None` when an error bound takes more than 1000 spheres.
    pub fn clump(&self, budget: SphereBudget, placement: Placement) -> Option<Clump> {
        match &self.0 {
            &Kind::Sphere(radius) => {
                Some(Clump { spheres: vec![Sphere { center: Vector3::zeros(), radius }] })
            }
            Kind::Pressed(solid) => fit_clump(&solid.rings(FIT_PANELS[0]), budget, placement, true),
            Kind::Imported(solid) => fit_clump(&solid.panels(FIT_PANELS[1]), budget, placement, false),
            Kind::Glued { clump, .. } => Some(clump.clone()),
        }
    }

    /// About `count` panels for the coating; `None` for glued spheres, which have no surface of their own.
    pub fn panels(&self, count: usize) -> Option<Panels> {
        match &self.0 {
            Kind::Sphere(radius) => Some(sphere_panels(*radius, count)),
            Kind::Pressed(solid) => Some(solid.panels(count)),
            Kind::Imported(solid) => Some(solid.panels(count)),
            Kind::Glued { .. } => None,
        }
    }
}
