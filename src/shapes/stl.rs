//! Surface meshes as STL files.

use super::{ShapeError, SurfaceMesh};
use nalgebra::Vector3;
use std::fs::File;
use std::path::Path;

/// Writes a mesh as binary STL, in units of `scale` metres (0.001: the file is in mm). STL keeps single precision and
/// no parts.
///
/// # Errors
/// [`ShapeError::Write`] when the file cannot be written.
pub fn write_stl(mesh: &SurfaceMesh, path: &Path, scale: f64) -> Result<(), ShapeError> {
    let vertex = |v: Vector3<f64>| {
        // Adding 0 turns −0 to 0: readers weld vertices by their bits.
        stl_io::Vertex::new((v / scale).add_scalar(0.0).map(|x| x as f32).into())
    };
    let triangles: Vec<stl_io::Triangle> = mesh
        .triangles
        .iter()
        .enumerate()
        .map(|(t, corners)| stl_io::Triangle {
            normal: stl_io::Normal::new(mesh.normal(t).add_scalar(0.0).map(|x| x as f32).into()),
            vertices: corners.map(|v| vertex(mesh.vertices[v as usize])),
        })
        .collect();
    let fault = |source| ShapeError::Write { path: path.to_owned(), source };
    let mut file = File::create(path).map_err(fault)?;
    stl_io::write_stl(&mut file, triangles.iter()).map_err(fault)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::{default_pan, drum_mesh, read_surface};

    #[test]
    fn written_and_read_back() {
        let mesh = drum_mesh(&default_pan());
        let folder = tempfile::tempdir().expect("a folder for the test");
        let path = folder.path().join("pan.stl");
        write_stl(&mesh, &path, 0.001).expect("written");
        let back = read_surface(&path, 0.001).expect("read").mesh;
        assert_eq!(back.vertices.len(), mesh.vertices.len());
        for (a, b) in back.triangles.iter().zip(&mesh.triangles) {
            for (&u, &v) in a.iter().zip(b) {
                assert!((back.vertices[u as usize] - mesh.vertices[v as usize]).norm() < 1e-8);
            }
        }
    }

    /// `meshes/pan.stl` is what the present code makes of the default pan.
    #[test]
    fn the_stored_pan_is_up_to_date() {
        let folder = tempfile::tempdir().expect("a folder for the test");
        let path = folder.path().join("pan.stl");
        write_stl(&drum_mesh(&default_pan()), &path, 0.001).expect("written");
        let stored = read_surface(&Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/pan.stl"), 0.001);
        let fresh = read_surface(&path, 0.001).expect("read").mesh;
        let stored = stored.expect("meshes/pan.stl").mesh;
        assert_eq!(fresh.triangles, stored.triangles);
        for (a, b) in fresh.vertices.iter().zip(&stored.vertices) {
            assert!((a - b).norm() < 1e-7, "{a} {b}");
        }
    }

    #[test]
    fn a_missing_file_is_named() {
        let fault = read_surface(Path::new("no/such/pan.stl"), 1.0).expect_err("there is no such file");
        assert!(fault.to_string().starts_with("cannot read no/such/pan.stl"));
    }
}
