//! `pancoat shape`: the measures of the tablet shapes of a scene, their panels and clumps, as text, JSON, page and meshes.

use super::args::ShapeArgs;
use super::failure::Failure;
use super::print_line;
use crate::report::{ThicknessMap, shape_page, vtp};
use crate::scene::{Shape, SphereBudget};
use crate::shapes::{
    Clump, PanelQuality, Panels, Part, Region, ShapeError, ShapeMeasures, Solid, SurfaceMesh, TabletShape,
    write_stl,
};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::time::Instant;

/// Sphere counts of the table of clump errors.
const COUNTS: [usize; 6] = [10, 20, 50, 100, 200, 400];

/// What is known of a shape. Keys carry their unit.
#[derive(Serialize)]
struct Sheet {
    shape: String,
    #[serde(flatten)]
    measures: Option<ShapeMeasures>,
    /// The row of Table 4, if it is one of the paper's tablets.
    #[serde(skip_serializing_if = "Option::is_none")]
    table_4: Option<ShapeMeasures>,
    /// What was put right in the file of the mesh.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    repairs: Vec<String>,
    /// Principal moments per mass of the true solid.
    inertia_per_mass_mm2: [f64; 3],
    #[serde(flatten)]
    panels: Option<PanelQuality>,
    clump: Option<ClumpError>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    clumps: Vec<ClumpError>,
}

/// How well a clump stands for its solid. Volume and inertia are those of the union of its spheres; a run uses the
/// solid's.
#[derive(Serialize)]
struct ClumpError {
    spheres: usize,
    #[serde(flatten)]
    surface: Option<SurfaceError>,
    volume_error_percent: f64,
    inertia_error_percent: f64,
    fit_s: f64,
}

/// Distances from the surface of the solid to that of the clump.
#[derive(Serialize)]
#[expect(clippy::struct_field_names, reason = "names are JSON keys, which carry their unit")]
struct SurfaceError {
    mean_deviation_um: f64,
    largest_deviation_um: f64,
    face_roughness_um: f64,
    band_roughness_um: f64,
}

pub(super) fn shape(args: &ShapeArgs) -> Result<(), Failure> {
    let scene = args.scene.read()?.scene()?;
    if let Some(folder) = &args.out {
        fs::create_dir_all(folder).map_err(Failure::Output)?;
    }
    for shape in &scene.shapes {
        let tablet = match TabletShape::build(shape, true) {
            // A clump recipe has no surface.
            Err(ShapeError::NoSurface { .. }) => TabletShape::build(shape, false)?,
            tablet => tablet?,
        };
        let sheet = sheet(shape, &tablet, args.clumps)?;
        if args.json {
            print_line(&serde_json::to_string(&sheet).map_err(|fault| Failure::Output(fault.into()))?)?;
        } else {
            print_line(&shape.name)?;
            for (name, value) in sheet.rows() {
                print_line(&format!("  {name:<36}{value}"))?;
            }
        }
        if let Some(folder) = &args.out {
            export(&tablet, &sheet, folder).map_err(Failure::Output)?;
            if let Some(mesh) = tablet.panels.as_ref().map(mesh) {
                write_stl(&mesh, &folder.join(format!("{}.stl", shape.name)), 1e-3)?;
            }
        }
    }
    Ok(())
}

fn sheet(shape: &Shape, tablet: &TabletShape, table: bool) -> Result<Sheet, Failure> {
    let solid = Solid::new(&shape.recipe)?;
    let error = |budget: SphereBudget| {
        let start = Instant::now();
        let clump = solid.clump(budget, shape.placement);
        clump.map(|clump| clump_error(&clump, tablet, start.elapsed().as_secs_f64()))
    };
    let measures = tablet.measures();
    let own = error(shape.spheres);
    Ok(Sheet {
        shape: shape.name.clone(),
        measures,
        table_4: measures.and_then(|m| m.in_table_4()),
        repairs: tablet.repairs.iter().map(ToString::to_string).collect(),
        inertia_per_mass_mm2: (tablet.inertia_per_mass * 1e6).into(),
        panels: tablet.panels.as_ref().map(Panels::quality),
        clump: own,
        clumps: if table {
            COUNTS.into_iter().filter_map(|n| error(SphereBudget::Count(n))).collect()
        } else {
            Vec::new()
        },
    })
}

fn clump_error(clump: &Clump, tablet: &TabletShape, fit_s: f64) -> ClumpError {
    let (union, _) = clump.union();
    let percent = |found: f64, wanted: f64| 100.0 * (found / wanted - 1.0);
    let inertia = union.inertia_per_mass.diagonal().component_div(&tablet.inertia_per_mass);
    let worst = inertia.iter().map(|ratio| percent(*ratio, 1.0)).max_by(|a, b| a.abs().total_cmp(&b.abs()));
    ClumpError {
        spheres: clump.spheres.len(),
        surface: tablet.panels.as_ref().map(|panels| {
            let deviation = clump.deviation(panels);
            SurfaceError {
                mean_deviation_um: 1e6 * deviation.mean,
                largest_deviation_um: 1e6 * deviation.largest,
                face_roughness_um: 1e6 * deviation.cap_roughness,
                band_roughness_um: 1e6 * deviation.band_roughness,
            }
        }),
        volume_error_percent: percent(union.volume, tablet.volume),
        inertia_error_percent: worst.unwrap_or_default(),
        fit_s,
    }
}

impl Sheet {
    /// The sheet in words.
    fn rows(&self) -> Vec<(String, String)> {
        let mut rows: Vec<(String, String)> = Vec::new();
        let mut row = |name: &str, value: String| rows.push((name.to_owned(), value));
        if let Some(m) = &self.measures {
            // Beside each figure what the paper prints, if it is a tablet of the paper.
            let printed = |of: fn(&ShapeMeasures) -> f64| {
                self.table_4.as_ref().map_or(String::new(), |row| format!(" (Table 4: {})", of(row)))
            };
            let extents = |m: &ShapeMeasures| {
                format!("{:.3}, {:.3}, {:.3} mm", m.length_mm, m.width_mm, m.thickness_mm)
            };
            row("length, width, thickness", extents(m));
            row("surface", format!("{:.1} mm2{}", m.area_mm2, printed(|m| m.area_mm2)));
            row("volume", format!("{:.1} mm3{}", m.volume_mm3, printed(|m| m.volume_mm3)));
            row("sphericity", format!("{:.4}{}", m.sphericity, printed(|m| m.sphericity)));
            row(
                "aspect ratio (L + W)/(2 T)",
                format!("{:.4}{}", m.aspect_ratio, printed(|m| m.aspect_ratio)),
            );
            row("band over face area", format!("{:.4}{}", m.band_to_face, printed(|m| m.band_to_face)));
            for note in self.table_4.iter().flat_map(ShapeMeasures::against_table_4) {
                row("note", note);
            }
        }
        for repair in &self.repairs {
            row("repaired", repair.clone());
        }
        let [x, y, z] = self.inertia_per_mass_mm2;
        row("moments of inertia per mass", format!("{x:.3}, {y:.3}, {z:.3} mm2"));
        if let Some(p) = &self.panels {
            let (angle, ratio) = (p.smallest_angle_deg, p.area_ratio);
            row(
                "panels",
                format!("{}, smallest angle {angle:.0} degrees, areas within {ratio:.2}", p.panels),
            );
        }
        for clump in self.clump.iter().chain(&self.clumps) {
            row(&format!("clump of {}", clump.spheres), clump.in_words());
        }
        rows
    }
}

impl ClumpError {
    fn in_words(&self) -> String {
        let surface = self.surface.as_ref().map_or(String::new(), |s| {
            let (mean, largest) = (s.mean_deviation_um, s.largest_deviation_um);
            let (face, band) = (s.face_roughness_um, s.band_roughness_um);
            format!("off by {mean:.0} um, at most {largest:.0}; roughness {face:.0} um on faces, {band:.0} on the band; ")
        });
        let (volume, inertia, fit) = (self.volume_error_percent, self.inertia_error_percent, self.fit_s);
        format!("{surface}volume {volume:+.1} %, inertia {inertia:+.1} %; fitted in {fit:.2} s")
    }
}

/// Clump, meshes and page of a shape; STL aside.
fn export(tablet: &TabletShape, sheet: &Sheet, folder: &Path) -> std::io::Result<()> {
    let file = |ending: &str| folder.join(format!("{}{ending}", tablet.name));
    let mut spheres = String::new();
    for sphere in &tablet.clump.spheres {
        let [x, y, z]: [f64; 3] = (sphere.center * 1e3).into();
        let _ = writeln!(spheres, "{x:.6} {y:.6} {z:.6} {:.6}", sphere.radius * 1e3);
    }
    fs::write(file("_clump.txt"), spheres)?;
    let Some(panels) = &tablet.panels else { return Ok(()) };
    let mut obj = String::from("# mm\n");
    for v in &panels.vertices {
        let [x, y, z]: [f64; 3] = (v * 1e3).into();
        let _ = writeln!(obj, "v {x:.6} {y:.6} {z:.6}");
    }
    for [a, b, c] in &panels.triangles {
        let _ = writeln!(obj, "f {} {} {}", a + 1, b + 1, c + 1);
    }
    fs::write(file(".obj"), obj)?;
    let gaps = panels.centroids.iter().map(|c| 1e6 * tablet.clump.distance(c)).collect::<Vec<f64>>();
    let map = ThicknessMap {
        vertices_mm: panels.vertices.iter().map(|v| (v * 1e3).into()).collect(),
        triangles: panels.triangles.clone(),
        areas_mm2: panels.areas.iter().map(|area| 1e6 * area).collect(),
        on_cap: panels.regions.iter().map(|&region| region == Region::Cap).collect(),
        average_um: vec![0.0; panels.len()],
        others: BTreeMap::from([("clump_distance".to_owned(), gaps.clone())]),
    };
    fs::write(file(".vtp"), vtp::write(std::slice::from_ref(&map)))?;
    let errors = sheet.clumps.iter().filter_map(|c| c.surface.as_ref().map(|s| (c.spheres, s)));
    let errors: Vec<_> =
        errors.map(|(n, s)| [n as f64, s.mean_deviation_um, s.largest_deviation_um]).collect();
    fs::write(file(".html"), shape_page(&tablet.name, &map, &gaps, &sheet.rows(), &errors))
}

fn mesh(panels: &Panels) -> SurfaceMesh {
    let (vertices, triangles) = (panels.vertices.clone(), panels.triangles.clone());
    SurfaceMesh { parts: vec![Part::Wall; triangles.len()], vertices, triangles }
}
