//! A tablet shape: recipe in, clump, panels and mass properties out.

use super::{Clump, Panels, Repair, ShapeError, Solid};
use crate::scene::{Shape, SphereBudget};
use nalgebra::Vector3;

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
    /// What had to be put right in the file of a mesh recipe.
    pub repairs: Vec<Repair>,
}

impl TabletShape {
    /// Builds a shape from its recipe, with panels only when they are asked for.
    ///
    /// The clump has as many spheres as `shape.spheres` says; a sphere is always one sphere, a clump recipe has the
    /// spheres of its file. The panels are about `shape.panels`, as near as whole rings (pressed tablets),
    /// icosahedron cuts (spheres) or sharp edges (meshes) let them come.
    ///
    /// # Errors
    /// [`ShapeError::Recipe`] for dimensions that make no solid, [`ShapeError::NoSurface`] when panels of a clump recipe
    /// are asked for, [`ShapeError::TooNear`] for an error bound that takes too many spheres, and those of the files of
    /// clump and mesh recipes.
    pub fn build(shape: &Shape, with_panels: bool) -> Result<Self, ShapeError> {
        let name = shape.name.clone();
        if let Some(fault) = shape.recipe.fault() {
            return Err(ShapeError::Recipe { name, fault });
        }
        let solid = Solid::new(&shape.recipe)?;
        let panels = if with_panels {
            Some(solid.panels(shape.panels).ok_or_else(|| ShapeError::NoSurface { name: name.clone() })?)
        } else {
            None
        };
        let clump = solid.clump(shape.spheres, shape.placement).ok_or_else(|| ShapeError::TooNear {
            name: name.clone(),
            error_mm: if let SphereBudget::Error(error) = shape.spheres { 1e3 * error } else { 0.0 },
        })?;
        Ok(Self {
            name,
            volume: solid.volume(),
            area: solid.area(),
            inertia_per_mass: solid.inertia_per_mass(),
            clump,
            panels,
            repairs: solid.repairs().to_vec(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Cap, Outline, Placement, Recipe};
    use crate::shapes::{MassProperties, Part, Region, Sphere, SurfaceMesh, write_stl};
    use approx::assert_relative_eq;
    use std::f64::consts::PI;

    const MM: f64 = 1e-3;

    fn round(diameter: f64, band: f64, cap: Cap, spheres: usize) -> Shape {
        shape("round", Recipe::Round { diameter, band, cap }, spheres, 1700)
    }

    fn shape(name: &str, recipe: Recipe, spheres: usize, panels: usize) -> Shape {
        let spheres = SphereBudget::Count(spheres);
        Shape { name: name.into(), recipe, spheres, placement: Placement::Inscribed, panels }
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
        assert_relative_eq!(inertia.x, 2.255_768_25e-12, max_relative = 1e-8);
        assert_relative_eq!(inertia.y, 2.255_768_25e-12, max_relative = 1e-8);
        assert_relative_eq!(inertia.z, 3.612_936_27e-12, max_relative = 1e-8);
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
            assert_good(&panels, 1700);
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

    /// The paper's tablets, Table 4: length, width, thickness, area, volume, sphericity, band/face. Cap heights, exponents and
    /// harmonics are fitted to these; the thickness of the almond follows from its volume and area.
    #[test]
    fn tablets_of_table_4() {
        let mm = |x: f64| x * MM;
        let cap = |height, exponent| Cap::Compound { height: mm(height), exponent };
        let almond = Outline::Almond {
            length: mm(20.6),
            width: mm(12.1),
            fourth_harmonic: mm(-0.0403),
            third_harmonic: mm(0.1807),
        };
        let oval = Outline::Oval { length: mm(19.2), width: mm(10.8), fourth_harmonic: mm(-0.2211) };
        let triangular = Outline::Triangular {
            length: mm(19.2),
            width: mm(12.5),
            fourth_harmonic: mm(-0.1336),
            third_harmonic: mm(0.35),
        };
        let pressed = |outline, band, cap| Recipe::Pressed { outline, band: mm(band), cap };
        for (name, recipe, expected) in [
            (
                "almond",
                pressed(almond, 4.8671, cap(1.4965, 1.6302)),
                [20.6, 12.1, 7.86, 644.7, 1182., 0.8383, 0.6385],
            ),
            (
                "oval",
                pressed(oval, 4.6971, cap(1.5814, 3.5728)),
                [19.2, 10.8, 7.86, 588.6, 1112., 0.8816, 0.6317],
            ),
            ("round", paper_round(1).recipe, [15.9, 15.9, 6.64, 584.5, 1042., 0.8502, 0.3842]),
            // The table prints a band/face of 0.1561, which no convex caps reach; with the digits swapped all else fits.
            (
                "triangular",
                pressed(triangular, 4.9048, cap(1.7776, 2.5124)),
                [19.2, 12.5, 8.46, 652.1, 1300., 0.8835, 0.6151],
            ),
        ] {
            let shape = shape(name, recipe, 1, 1800);
            let tablet = TabletShape::build(&shape, true).expect("a good recipe");
            let m = tablet.measures().expect("there are panels");
            let found = [m.length_mm, m.width_mm, m.thickness_mm, m.area_mm2, m.volume_mm3, m.sphericity];
            for (found, expected) in found.iter().zip(&expected) {
                assert_relative_eq!(found, expected, max_relative = 2e-3);
            }
            assert_relative_eq!(m.band_to_face, expected[6], max_relative = 1e-2);
            let printed = m.in_table_4().expect("is in Table 4");
            let notes = printed.against_table_4();
            let triangular = name == "triangular";
            assert_eq!(notes.len(), 1, "{notes:?}");
            assert!(notes[0].contains(if triangular { "0.1561" } else { "aspect ratio" }), "{notes:?}");
            // The misprints are the paper's: its own length, width and thickness give the ratio found here.
            let own = (printed.length_mm + printed.width_mm) / (2.0 * printed.thickness_mm);
            assert_relative_eq!(m.aspect_ratio, own, max_relative = 2e-3);
            assert_eq!((m.aspect_ratio / printed.aspect_ratio - 1.0).abs() < 0.01, triangular);
            // The panels themselves, whose vertices lie on the solid and whose faces just inside, come within 0.5 %.
            let panels = tablet.panels.expect("there are panels");
            let solid = MassProperties::of_polyhedron(&panels.vertices, &panels.triangles);
            let (area, volume) = (panels.areas.iter().sum::<f64>() * 1e6, solid.volume * 1e9);
            assert_relative_eq!(area, expected[3], max_relative = 5e-3);
            assert_relative_eq!(volume, expected[4], max_relative = 5e-3);
            assert_relative_eq!(
                (36.0 * PI * volume * volume).cbrt() / area,
                expected[5],
                max_relative = 5e-3
            );
            assert!(solid.center.norm() < 0.01 * MM, "{name} {}", solid.center);
            // Cauchy: a convex solid shows a quarter of its surface, averaged over all directions.
            let shown = mean_projected_area(&panels) * 1e6;
            assert_relative_eq!(shown, expected[3] / 4.0, max_relative = 5e-3);
            assert_good(&panels, 1800);
        }
    }

    /// With 0.1561 as the paper prints it, band height follows from the perimeter 2π p₀ of the outline, cap height from the
    /// thickness, and the exponent from the volume; the area that is left to come out misses the paper's by 3.6 % and more
    /// over all convex outlines of the family. With 0.6151 it comes out.
    #[test]
    fn the_printed_band_over_face_area_of_the_triangular_tablet_cannot_be() {
        let (length, width, thickness, area, volume) = (19.2e-3, 12.5e-3, 8.46e-3, 652.1e-6, 1300e-9);
        let misfit = |ratio: f64, fourth_harmonic: f64, third_harmonic: f64| {
            let outline = Outline::Triangular { length, width, fourth_harmonic, third_harmonic };
            let mean = (length + width) / 4.0 - fourth_harmonic;
            let band = area * ratio / (1.0 + ratio) / (2.0 * PI * mean);
            let height = (thickness - band) / 2.0;
            let flat = Cap::Spherical { height: 0.0 };
            let plan = Solid::new(&Recipe::Pressed { outline, band: 1.0, cap: flat }).ok()?.volume();
            let fill = (volume / plan - band) / (2.0 * height);
            let exponent = 2.0 * fill / (1.0 - fill);
            let recipe = Recipe::Pressed { outline, band, cap: Cap::Compound { height, exponent } };
            let sound = recipe.fault().is_none() && (1.0..50.0).contains(&exponent);
            sound.then(|| Solid::new(&recipe).expect("is sound").area() / area - 1.0)
        };
        let family = |ratio: f64| {
            let outlines = (-10..=10).flat_map(|c4| (0..=12).map(move |c3| (c4, c3)));
            let found = outlines
                .filter_map(|(c4, c3)| misfit(ratio, f64::from(c4) * 0.05 * MM, f64::from(c3) * 0.05 * MM));
            found.collect::<Vec<_>>()
        };
        let least = |found: &[f64]| found.iter().fold(f64::INFINITY, |l, misfit| l.min(misfit.abs()));
        let (printed, swapped) = (family(0.1561), family(0.6151));
        assert!(printed.len() > 20 && swapped.len() > 20, "{} {}", printed.len(), swapped.len());
        assert!(least(&printed) > 0.03 && least(&swapped) < 1e-3);
    }

    /// Over 200 even directions, m².
    fn mean_projected_area(panels: &Panels) -> f64 {
        let toward = |k: u32| {
            let z = 1.0 - f64::from(2 * k + 1) / 200.0;
            let (sin, cos) = (2.399_963_229_728_653 * f64::from(k)).sin_cos();
            Vector3::new(cos * (1.0 - z * z).sqrt(), sin * (1.0 - z * z).sqrt(), z)
        };
        let shown = |s: Vector3<f64>| -> f64 {
            panels.normals.iter().zip(&panels.areas).map(|(n, area)| n.dot(&s).max(0.0) * area).sum()
        };
        (0..200).map(|k| shown(toward(k))).sum::<f64>() / 200.0
    }

    /// Closed, of about the number asked for, without slivers and even.
    fn assert_good(panels: &Panels, count: usize) {
        let quality = panels.quality();
        assert!(panels.len().abs_diff(count) * 20 < count, "{quality:?}");
        assert!(quality.smallest_angle_deg > 20.0 && quality.area_ratio < 3.0, "{quality:?}");
        assert_eq!(panels.vertices.len(), panels.len() / 2 + 2);
        let closing: Vector3<f64> = panels.normals.iter().zip(&panels.areas).map(|(n, a)| n * *a).sum();
        assert!(closing.norm() < 1e-12 * panels.areas.iter().sum::<f64>());
    }

    fn other_shapes() -> Vec<Shape> {
        let (length, width) = (12.0 * MM, 8.0 * MM);
        let cup = Cap::Spherical { height: 1.2 * MM };
        let bevel = Cap::Bevelled { height: 0.5 * MM, width: 0.6 * MM };
        [
            ("capsule", Outline::Capsule { length: 19.0 * MM, width: 7.0 * MM }, cup),
            ("bullet", Outline::Bullet { length, width }, cup),
            ("half moon", Outline::HalfMoon { length: 14.0 * MM, width: 7.0 * MM }, cup),
            ("shield", Outline::Shield { length, width }, cup),
            ("flat-faced round", Outline::Capsule { length: 9.0 * MM, width: 9.0 * MM }, bevel),
            ("flat-faced capsule", Outline::Capsule { length: 19.0 * MM, width: 8.0 * MM }, bevel),
            ("long capsule", Outline::Capsule { length: 20.0 * MM, width: 5.0 * MM }, cup),
            ("low half moon", Outline::HalfMoon { length: 14.0 * MM, width: 4.0 * MM }, cup),
            (
                "flat oval",
                Outline::Oval { length, width, fourth_harmonic: 0.0 },
                Cap::Spherical { height: 0.0 },
            ),
        ]
        .into_iter()
        .map(|(name, outline, cap)| {
            let recipe = Recipe::Pressed { outline, band: 4.0 * MM, cap };
            shape(name, recipe, 50, 1750)
        })
        .collect()
    }

    #[test]
    fn every_outline_gives_good_panels_and_a_close_clump() {
        for shape in other_shapes() {
            let (tablet, panels) = build(&shape);
            let deviation = tablet.clump.deviation(&panels);
            assert_good(&panels, 1750);
            assert_eq!(tablet.clump.spheres.len(), 50);
            // Edges run along both rims: no panel reaches from the band over onto a cap.
            let Recipe::Pressed { band, .. } = shape.recipe else { unreachable!("all are pressed") };
            for (panel, region) in panels.corners().zip(&panels.regions) {
                let on_side = |p: &Vector3<f64>| match region {
                    Region::Band => p.z.abs() < band / 2.0 + 1e-12,
                    Region::Cap => p.z.abs() > band / 2.0 - 1e-12,
                };
                assert!(panel.iter().all(on_side), "{}", shape.name);
            }
            let fine = Solid::new(&shape.recipe).expect("good").panels(3500).expect("a surface");
            let inside = fine.centroids.iter().all(|c| tablet.clump.distance(c) > -0.02 * MM);
            assert!(inside, "{}", shape.name);
            assert!(
                deviation.mean < 0.25 * MM && deviation.largest < 0.8 * MM,
                "{} {deviation:?}",
                shape.name
            );
            let solid = MassProperties::of_polyhedron(&fine.vertices, &fine.triangles);
            assert_relative_eq!(solid.volume, tablet.volume, max_relative = 5e-3);
            let moments = solid.inertia_per_mass.diagonal();
            assert_relative_eq!(moments, tablet.inertia_per_mass, max_relative = 5e-3);
        }
    }

    /// A tablet of panels written to a file and read back is the same tablet.
    #[test]
    fn a_mesh_gives_what_the_recipe_gives() {
        let mut shape = other_shapes().swap_remove(1);
        let (tablet, panels) = build(&shape);
        let folder = tempfile::tempdir().expect("a folder for the test");
        let path = folder.path().join("bullet.stl");
        let shift = Vector3::new(3.0 * MM, -2.0 * MM, 5.0 * MM);
        let mesh = SurfaceMesh {
            vertices: panels.vertices.iter().map(|v| v + shift).collect(),
            triangles: panels.triangles.clone(),
            parts: vec![Part::Wall; panels.len()],
        };
        write_stl(&mesh, &path, MM).expect("written");
        shape.recipe = Recipe::Mesh { path, scale: MM };
        let (imported, new_panels) = build(&shape);
        assert_relative_eq!(imported.volume, tablet.volume, max_relative = 5e-3);
        assert_relative_eq!(imported.area, tablet.area, max_relative = 5e-3);
        assert_relative_eq!(imported.inertia_per_mass, tablet.inertia_per_mass, max_relative = 6e-3);
        assert_good(&new_panels, 1750);
        let band = |p: &Panels| -> f64 {
            p.areas.iter().zip(&p.regions).filter(|&(_, &r)| r == Region::Band).map(|(a, _)| a).sum()
        };
        assert_relative_eq!(band(&new_panels), band(&panels), max_relative = 5e-3);
        let deviation = imported.clump.deviation(&panels);
        assert_eq!(imported.clump.spheres.len(), 50);
        assert!(deviation.mean < 0.25 * MM, "{deviation:?}");
    }

    #[test]
    fn sphere_is_one_sphere() {
        let shape = shape("s", Recipe::Sphere { diameter: 2.0 }, 50, 1700);
        let (tablet, _) = build(&shape);
        assert_eq!(tablet.clump.spheres, [Sphere { center: Vector3::zeros(), radius: 1.0 }]);
    }

    #[test]
    fn clump_recipe_has_no_surface() {
        let file = tempfile::NamedTempFile::new().expect("a file for the test");
        std::fs::write(file.path(), "0 0 0 1e-3\n").expect("written");
        let recipe = Recipe::Clump { path: file.path().to_owned(), inertia_per_mass: [4e-7; 3] };
        let shape = shape("glued", recipe, 2, 1700);
        let tablet = TabletShape::build(&shape, false).expect("a good clump");
        assert_relative_eq!(tablet.volume, 4.0 / 3.0 * PI * 1e-9, max_relative = 1e-6);
        let fault = TabletShape::build(&shape, true).expect_err("no surface");
        assert!(fault.to_string().starts_with("shape `glued` is given sphere by sphere"));
    }
}
