//! Panels of a sphere.

use super::{Panels, Region};
use nalgebra::Vector3;
use std::collections::BTreeMap;

/// A closed mesh of a sphere about the origin, all caps, from an icosahedron with each face cut into f² triangles: 20 f²
/// triangles, as near to `count` as that gets. Edges are cut into equal angles, which keeps the areas even.
pub(super) fn sphere_panels(radius: f64, count: usize) -> Panels {
    let cuts = ((count as f64 / 20.0).sqrt().round() as usize).max(1);
    let (corners, faces) = icosahedron();
    let edge = corners[faces[0][0]].angle(&corners[faces[0][1]]);
    let mut numbers: BTreeMap<[(usize, usize); 3], u32> = BTreeMap::new();
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for face in faces {
        let mut vertex = |steps: [usize; 3]| {
            // A vertex is named by the corners it lies between and its steps from each, whichever face asks for it.
            let mut name: [(usize, usize); 3] =
                std::array::from_fn(|c| if steps[c] > 0 { (face[c] + 1, steps[c]) } else { (0, 0) });
            name.sort_unstable();
            *numbers.entry(name).or_insert_with(|| {
                let weigh = |c: usize| corners[face[c]] * (edge * steps[c] as f64 / cuts as f64).sin();
                vertices.push((weigh(0) + weigh(1) + weigh(2)).normalize() * radius);
                vertices.len() as u32 - 1
            })
        };
        for i in 0..cuts {
            for j in 0..cuts - i {
                let at = |a: usize, b: usize| [a, b, cuts - a - b];
                triangles.push([vertex(at(i + 1, j)), vertex(at(i, j + 1)), vertex(at(i, j))]);
                if i + j + 2 <= cuts {
                    triangles.push([vertex(at(i + 1, j)), vertex(at(i + 1, j + 1)), vertex(at(i, j + 1))]);
                }
            }
        }
    }
    let regions = vec![Region::Cap; triangles.len()];
    Panels::new(vertices, triangles, regions)
}

/// Unit vectors to the corners and the faces, counter-clockwise seen from outside.
fn icosahedron() -> ([Vector3<f64>; 12], [[usize; 3]; 20]) {
    let g = f64::midpoint(1.0, 5f64.sqrt());
    let corners = [
        [-1., g, 0.],
        [1., g, 0.],
        [-1., -g, 0.],
        [1., -g, 0.],
        [0., -1., g],
        [0., 1., g],
        [0., -1., -g],
        [0., 1., -g],
        [g, 0., -1.],
        [g, 0., 1.],
        [-g, 0., -1.],
        [-g, 0., 1.],
    ]
    .map(|p| Vector3::from(p).normalize());
    let faces = [
        [0, 11, 5],
        [0, 5, 1],
        [0, 1, 7],
        [0, 7, 10],
        [0, 10, 11],
        [1, 5, 9],
        [5, 11, 4],
        [11, 10, 2],
        [10, 7, 6],
        [7, 1, 8],
        [3, 9, 4],
        [3, 4, 2],
        [3, 2, 6],
        [3, 6, 8],
        [3, 8, 9],
        [4, 9, 5],
        [2, 4, 11],
        [6, 2, 10],
        [8, 6, 7],
        [9, 8, 1],
    ];
    (corners, faces)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes::MassProperties;
    use approx::assert_relative_eq;
    use std::f64::consts::PI;

    #[test]
    fn panels_are_closed_even_and_outward() {
        let panels = sphere_panels(2.0, 1700);
        assert_eq!((panels.len(), panels.vertices.len()), (1620, 812));
        let solid = MassProperties::of_polyhedron(&panels.vertices, &panels.triangles);
        // Equilateral triangles of edge a lie a²/8R below the sphere on average, a² = 16 π R²/(√3 n).
        let missing = 1.0 - solid.volume / (4.0 / 3.0 * PI * 8.0);
        assert_relative_eq!(missing, 6.0 * PI / (3f64.sqrt() * 1620.0), max_relative = 0.03);
        assert!(panels.quality().area_ratio < 1.3, "{}", panels.quality().area_ratio);
        assert!(panels.quality().smallest_angle_deg > 50.0);
    }
}
