use super::Patchwork;
use crate::shapes::sphere::sphere_panels;
use crate::shapes::{MassProperties, Panels, Region};
use nalgebra::Vector3;

fn panels(mesh: Patchwork) -> Panels {
    let regions = vec![Region::Cap; mesh.triangles.len()];
    Panels::new(mesh.vertices, mesh.triangles, regions)
}

/// A 10 × 6 × 4 box of twelve triangles, every face a patch.
fn block() -> Patchwork {
    let vertices = (0..8u8)
        .map(|k| Vector3::new(f64::from(k & 1) * 10.0, f64::from(k >> 1 & 1) * 6.0, f64::from(k >> 2) * 4.0))
        .collect();
    let quads: [[u32; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Patchwork { vertices, triangles, patches: (0..12).map(|t| t / 2).collect() }
}

#[test]
fn a_block_keeps_its_volume_edges_and_corners() {
    for count in [300, 1700] {
        let mesh = panels(block().remesh(count));
        assert!(mesh.len().abs_diff(count) * 100 < count, "{}", mesh.len());
        let solid = MassProperties::of_polyhedron(&mesh.vertices, &mesh.triangles);
        assert!((solid.volume - 240.0).abs() < 1e-9, "{}", solid.volume);
        assert!((mesh.areas.iter().sum::<f64>() - 248.0).abs() < 1e-9);
        assert!(mesh.quality().smallest_angle_deg > 25.0, "{}", mesh.quality().smallest_angle_deg);
        assert!(mesh.quality().area_ratio < 3.0, "{}", mesh.quality().area_ratio);
        for corner in block().vertices {
            assert!(mesh.vertices.contains(&corner));
        }
    }
}

#[test]
fn a_fine_sphere_becomes_a_coarse_one() {
    let fine = sphere_panels(1.0, 8000);
    let patches = vec![0; fine.len()];
    let mesh = panels(Patchwork { vertices: fine.vertices, triangles: fine.triangles, patches }.remesh(1000));
    assert!(mesh.len().abs_diff(1000) < 10, "{}", mesh.len());
    assert_eq!(mesh.vertices.len(), mesh.len() / 2 + 2);
    assert!(mesh.vertices.iter().all(|v| (v.norm() - 1.0).abs() < 2e-3));
    assert!(mesh.quality().smallest_angle_deg > 30.0, "{}", mesh.quality().smallest_angle_deg);
    assert!(mesh.quality().area_ratio < 3.0, "{}", mesh.quality().area_ratio);
}

#[test]
fn the_same_surface_gives_the_same_mesh() {
    assert_eq!(block().remesh(400), block().remesh(400));
}
