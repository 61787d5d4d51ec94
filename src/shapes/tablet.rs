//! A tablet shape: recipe in, clump, panels and mass properties out.

use super::cap::CapProfile;
use super::clump_file::read_clump;
use super::clump_fit;
use super::outline::Outline;
use super::pressed::PressedSolid;
use super::sphere::sphere_panels;
use super::{Clump, Panels, Sphere};
use crate::scene::{Recipe, Shape};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Triangles of the surface to which clumps are fitted: edges of 0.5 mm on the tablets of the field, well below the
/// distance between the spheres of a 100-sphere clump. The time grows with its square.
const FIT_PANELS: usize = 5000;

/// A shape ready for a run.
#[derive(Debug, Clone, PartialEq)]
pub struct TabletShape {
    /// Name in the scene.
    pub name: String,
    /// Volume of the true solid, m³: in closed form for a sphere, by quadrature to 1e-9 for a pressed tablet; of the
    /// union of the spheres, to about 1e-3, for a clump recipe.
    pub volume: f64,
    /// Surface area of the true solid, m², as exact as the volume.
    pub area: f64,
    /// Principal moments of inertia of the homogeneous true solid, per unit mass, m².
    pub inertia_per_mass: Vector3<f64>,
    /// The spheres that contact sees.
    pub clump: Clump,
    /// The panels that the coater sees; `None` when the scene has no spray.
    pub panels: Option<Panels>,
}

/// Why a shape cannot be built or stored.
#[derive(Debug, thiserror::Error)]
pub enum ShapeError {
    /// A file could not be read.
    #[error("cannot read {path}: {source}")]
    Read {
        /// The file.
        path: std::path::PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file could not be written.
    #[error("cannot write {path}: {source}")]
    Write {
        /// The file.
        path: std::path::PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file's content is not what it should be.
    #[error("{path}:{line}: {fault}")]
    Content {
        /// The file.
        path: std::path::PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong and what is expected.
        fault: String,
    },
    /// Panels were asked of a clump recipe.
    #[error(
        "shape `{name}` is given sphere by sphere and has no surface to spray: \
         leave the spray out, or describe the solid by its dimensions"
    )]
    NoSurface {
        /// Name of the shape.
        name: String,
    },
}

impl TabletShape {
    /// Builds a shape from its recipe, with panels only when they are asked for.
    ///
    /// The clump of a pressed tablet has exactly `shape.spheres` spheres, all inside the solid and symmetric about its
    /// middle plane; a sphere is always one sphere; a clump recipe has the spheres of its file. The panels are about
    /// `shape.panels`, as near as whole rings (pressed tablets) or icosahedron cuts (spheres) come.
    ///
    /// # Errors
    /// [`ShapeError::Read`] and [`ShapeError::Content`] for the file of a clump recipe, [`ShapeError::NoSurface`] when
    /// panels of it are asked for.
    pub fn build(shape: &Shape, with_panels: bool) -> Result<Self, ShapeError> {
        match &shape.recipe {
            Recipe::Sphere { diameter } => Ok(Self::sphere(shape, diameter / 2.0, with_panels)),
            &Recipe::Round { diameter, band, cap } => {
                let outline = Outline::circle(diameter);
                let cap = CapProfile { cap, radius: diameter / 2.0 };
                Ok(Self::pressed(shape, &PressedSolid { outline, band, cap }, with_panels))
            }
            Recipe::Clump { path, inertia_per_mass } => {
                if with_panels {
                    return Err(ShapeError::NoSurface { name: shape.name.clone() });
                }
                let clump = read_clump(path)?;
                let (volume, area) = clump.volume_and_area();
                let inertia_per_mass = Vector3::from(*inertia_per_mass);
                Ok(Self { name: shape.name.clone(), volume, area, inertia_per_mass, clump, panels: None })
            }
        }
    }

    fn sphere(shape: &Shape, radius: f64, with_panels: bool) -> Self {
        Self {
            name: shape.name.clone(),
            volume: 4.0 / 3.0 * PI * radius.powi(3),
            area: 4.0 * PI * radius.powi(2),
            inertia_per_mass: Vector3::repeat(0.4 * radius * radius),
            clump: Clump { spheres: vec![Sphere { center: Vector3::zeros(), radius }] },
            panels: with_panels.then(|| sphere_panels(radius, shape.panels)),
        }
    }

    fn pressed(shape: &Shape, solid: &PressedSolid, with_panels: bool) -> Self {
        let mass = solid.mass();
        Self {
            name: shape.name.clone(),
            volume: mass.volume,
            area: solid.cap_area() + solid.band_area(),
            inertia_per_mass: mass.inertia_per_mass.diagonal(),
            clump: clump_fit::fit(&solid.mesh(FIT_PANELS, mass.center), shape.spheres, true),
            panels: with_panels.then(|| solid.mesh(shape.panels, mass.center)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Cap;
    use crate::shapes::{MassProperties, Region};
    use approx::assert_relative_eq;

    const MM: f64 = 1e-3;

    fn round(diameter: f64, band: f64, cap: Cap, spheres: usize) -> Shape {
        Shape { name: "round".into(), recipe: Recipe::Round { diameter, band, cap }, spheres, panels: 1700 }
    }

    /// The round tablet of Freireich et al. 2015, Table 4: area 584.5 mm², volume 1042 mm³.
    fn paper_round(spheres: usize) -> Shape {
        round(15.9 * MM, 3.2452 * MM, Cap::Compound { height: 1.6973 * MM, exponent: 2.8823 }, spheres)
    }

    fn build(shape: &Shape) -> (TabletShape, Panels) {
        let mut tablet = TabletShape::build(shape, true).expect("a good recipe");
        let panels = tablet.panels.take().expect("panels were asked for");
        (tablet, panels)
    }

    #[test]
    fn biconvex_tablet_of_spherical_caps() {
        // Radius 5, band 3, caps 1 mm high: closed forms for the spherical cap of radius 13 mm.
        let (tablet, _) = build(&round(10.0 * MM, 3.0 * MM, Cap::Spherical { height: MM }, 1));
        assert_relative_eq!(tablet.volume, 315.206_463e-9, max_relative = 1e-8);
        assert_relative_eq!(tablet.area, 257.610_598e-6, max_relative = 1e-8);
        let inertia = tablet.inertia_per_mass * tablet.volume;
        assert_relative_eq!(inertia.x, 2255.768_25e-15, max_relative = 1e-8);
        assert_relative_eq!(inertia.y, 2255.768_25e-15, max_relative = 1e-8);
        assert_relative_eq!(inertia.z, 3612.936_27e-15, max_relative = 1e-8);
    }

    #[test]
    fn half_spheres_without_a_band_are_a_sphere() {
        let (tablet, panels) = build(&round(2.0, 0.0, Cap::Spherical { height: 1.0 }, 1));
        assert_relative_eq!(tablet.volume, 4.0 / 3.0 * PI, max_relative = 1e-9);
        assert_relative_eq!(tablet.area, 4.0 * PI, max_relative = 1e-9);
        assert_relative_eq!(tablet.inertia_per_mass, Vector3::repeat(0.4), max_relative = 1e-9);
        assert!(panels.regions.iter().all(|&r| r == Region::Cap));
    }

    #[test]
    fn round_tablet_of_table_4() {
        let (tablet, panels) = build(&paper_round(1));
        assert_relative_eq!(tablet.area, 584.5e-6, max_relative = 5e-3);
        assert_relative_eq!(tablet.volume, 1042e-9, max_relative = 5e-3);
        let solid = MassProperties::of_polyhedron(&panels.vertices, &panels.triangles);
        assert_relative_eq!(panels.areas.iter().sum::<f64>(), tablet.area, max_relative = 2e-3);
        assert_relative_eq!(solid.volume, tablet.volume, max_relative = 5e-3);
        assert_relative_eq!(solid.inertia_per_mass.diagonal(), tablet.inertia_per_mass, max_relative = 5e-3);
        assert!(solid.center.norm() < 1e-6, "{}", solid.center);
    }

    #[test]
    fn panels_are_good_triangles_with_edges_on_the_rims() {
        for shape in [paper_round(1), round(10.0 * MM, 3.0 * MM, Cap::Spherical { height: MM }, 1)] {
            let (_, panels) = build(&shape);
            assert!(panels.len().abs_diff(1700) < 20, "{}", panels.len());
            assert!(panels.smallest_angle() > 20f64.to_radians(), "{}", panels.smallest_angle().to_degrees());
            assert!(panels.area_ratio() < 3.0, "{}", panels.area_ratio());
            let Recipe::Round { band, diameter, .. } = shape.recipe else { unreachable!("both are round") };
            for (t, region) in panels.triangles.iter().zip(&panels.regions) {
                for p in t.map(|v| panels.vertices[v as usize]) {
                    let (on_band, beyond) =
                        (p.xy().norm() > diameter / 2.0 - 1e-12, p.z.abs() > band / 2.0 - 1e-12);
                    assert!(if *region == Region::Band { on_band } else { beyond });
                }
            }
        }
    }

    #[test]
    fn clump_is_inside_symmetric_and_close() {
        let shape = paper_round(50);
        let (tablet, panels) = build(&shape);
        let clump = &tablet.clump;
        assert_eq!(clump.spheres.len(), 50);
        assert!(panels.centroids.iter().all(|c| clump.distance(c) > -0.02 * MM));
        for s in &clump.spheres {
            let image = |o: &&Sphere| {
                (o.center - s.center.component_mul(&Vector3::new(1.0, 1.0, -1.0))).norm() < 1e-12
            };
            assert!(clump.spheres.iter().any(|o| image(&o)));
        }
        let deviation = clump.deviation(&panels);
        assert!(deviation.mean < 0.2 * MM && deviation.largest < 0.6 * MM, "{deviation:?}");
    }

    #[test]
    fn every_count_is_reached_and_more_spheres_come_closer() {
        let (_, panels) = build(&paper_round(1));
        let mut last = f64::INFINITY;
        for count in [1, 2, 7, 20, 51, 100] {
            let clump = TabletShape::build(&paper_round(count), false).expect("a good recipe").clump;
            assert_eq!(clump.spheres.len(), count);
            let mean = clump.deviation(&panels).mean;
            assert!(mean < last);
            last = mean;
        }
    }

    #[test]
    fn sphere_is_one_sphere() {
        let shape =
            Shape { name: "s".into(), recipe: Recipe::Sphere { diameter: 2.0 }, spheres: 50, panels: 1700 };
        let (tablet, _) = build(&shape);
        assert_eq!(tablet.clump.spheres, [Sphere { center: Vector3::zeros(), radius: 1.0 }]);
    }

    #[test]
    fn clump_recipe_has_no_surface() {
        let recipe = Recipe::Clump { path: "none".into(), inertia_per_mass: [1.0; 3] };
        let shape = Shape { name: "glued".into(), recipe, spheres: 2, panels: 1700 };
        let fault = TabletShape::build(&shape, true).expect_err("no surface");
        assert!(fault.to_string().starts_with("shape `glued` is given sphere by sphere"));
    }
}
