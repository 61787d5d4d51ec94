//! Solids given by a mesh file, in body axes.

use super::remesh::Patchwork;
use super::{ClosedMesh, MassProperties, Panels, Region, Repair};
use nalgebra::Vector3;

/// Patches whose mean |n·z| is above the first are caps, below the second bands; in between, or on a solid without
/// sharp edges, each panel is judged alone, a cap from 30 degrees above the plane of the band.
const CAP_AND_BAND: [f64; 2] = [0.75, 0.25];

/// A solid of flat facets.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ImportedSolid {
    surface: Patchwork,
    /// Mean |n·z| of each patch.
    uprightness: Vec<f64>,
    /// Volume, and inertia about the axes the surface is in.
    pub(super) mass: MassProperties,
    /// What had to be put right in the file.
    pub(super) repairs: Vec<Repair>,
}

impl ImportedSolid {
    /// Turns and shifts a mesh to its principal axes; the axis nearest to z of the file becomes z.
    pub(super) fn new(mesh: &ClosedMesh) -> Self {
        let found = MassProperties::of_polyhedron(&mesh.vertices, &mesh.triangles);
        let (_, axes) = found.principal();
        let vertices: Vec<Vector3<f64>> =
            mesh.vertices.iter().map(|v| axes.tr_mul(&(v - found.center))).collect();
        let mass = MassProperties::of_polyhedron(&vertices, &mesh.triangles);
        let surface = Patchwork::new(vertices, mesh.triangles.clone(), |_, _| true);
        let count = surface.patches.iter().max().map_or(0, |&last| last as usize + 1);
        let (mut upright, mut areas) = (vec![0.0; count], vec![0.0; count]);
        for (triangle, &patch) in surface.triangles.iter().zip(&surface.patches) {
            let [a, b, c] = triangle.map(|v| surface.vertices[v as usize]);
            let normal = (b - a).cross(&(c - a));
            upright[patch as usize] += normal.z.abs();
            areas[patch as usize] += normal.norm();
        }
        let uprightness = upright.iter().zip(&areas).map(|(u, a)| u / a).collect();
        Self { surface, uprightness, mass, repairs: mesh.repairs.clone() }
    }

    /// Area of the facets, m².
    pub(super) fn area(&self) -> f64 {
        self.surface.area()
    }

    /// A closed mesh of about `count` panels.
    pub(super) fn panels(&self, count: usize) -> Panels {
        let mesh = self.surface.remesh(count);
        let mut panels = Panels::new(mesh.vertices, mesh.triangles, vec![Region::Cap; mesh.patches.len()]);
        let [cap, band] = CAP_AND_BAND;
        for (k, &patch) in mesh.patches.iter().enumerate() {
            let upright = self.uprightness[patch as usize];
            let in_between = (band..=cap).contains(&upright);
            let upright = if in_between { panels.normals[k].z.abs() } else { upright };
            if upright < 0.5 {
                panels.regions[k] = Region::Band;
            }
        }
        panels
    }
}
