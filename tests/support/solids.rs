//! Solids in panels, made here so that tests and benches of the coater stand on nothing but its interface.

#![allow(dead_code, reason = "each test and bench takes the solids it needs")]

use nalgebra::Vector3;
use pancoat::shapes::{Clump, Panels, Region, Sphere, TabletShape};
use std::collections::HashMap;

/// A closed convex surface about the origin as a tablet shape.
pub(crate) fn solid(name: &str, vertices: Vec<Vector3<f64>>, triangles: Vec<[u32; 3]>) -> TabletShape {
    let corners = |t: &[u32; 3]| t.map(|v| vertices[v as usize]);
    let doubled = |t: &[u32; 3]| {
        let [a, b, c] = corners(t);
        (b - a).cross(&(c - a))
    };
    let areas: Vec<f64> = triangles.iter().map(|t| doubled(t).norm() / 2.0).collect();
    let radius = vertices.iter().map(Vector3::norm).fold(0.0, f64::max);
    let volume = triangles.iter().map(|t| corners(t)[0].dot(&doubled(t)) / 6.0).sum();
    TabletShape {
        name: name.into(),
        volume,
        area: areas.iter().sum(),
        inertia_per_mass: Vector3::repeat(0.4 * radius * radius),
        clump: Clump { spheres: vec![Sphere { center: Vector3::zeros(), radius }] },
        repairs: Vec::new(),
        panels: Some(Panels {
            regions: vec![Region::Cap; triangles.len()],
            normals: triangles.iter().map(|t| doubled(t).normalize()).collect(),
            centroids: triangles.iter().map(|t| corners(t).iter().sum::<Vector3<f64>>() / 3.0).collect(),
            areas,
            triangles,
            vertices,
        }),
    }
}

/// A box of the given sides in twelve panels.
pub(crate) fn block(sides: [f64; 3]) -> TabletShape {
    let corner = |k: usize| {
        let sign = |bit: usize| if k >> bit & 1 == 0 { -0.5 } else { 0.5 };
        Vector3::new(sides[0] * sign(0), sides[1] * sign(1), sides[2] * sign(2))
    };
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).collect();
    solid("block", (0..8).map(corner).collect(), triangles)
}

/// A sphere of 20 · 4^`splits` panels.
pub(crate) fn icosphere(radius: f64, splits: usize) -> TabletShape {
    let golden = f64::midpoint(1.0, 5.0_f64.sqrt());
    let mut vertices: Vec<Vector3<f64>> = (0..12)
        .map(|k| {
            let (s, t) = (if k & 1 == 0 { -1.0 } else { 1.0 }, if k & 2 == 0 { -golden } else { golden });
            [Vector3::new(s, t, 0.0), Vector3::new(0.0, s, t), Vector3::new(t, 0.0, s)][k >> 2].normalize()
        })
        .collect();
    // The faces are the triples of mutual neighbours, turned outwards.
    let near = |a: usize, b: usize, v: &[Vector3<f64>]| (v[a] - v[b]).norm() < 1.2;
    let mut triangles = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b, &vertices) && near(b, c, &vertices) && near(a, c, &vertices) {
                    let out =
                        (vertices[b] - vertices[a]).cross(&(vertices[c] - vertices[a])).dot(&vertices[a])
                            > 0.0;
                    triangles.push([a, if out { b } else { c }, if out { c } else { b }].map(|v| v as u32));
                }
            }
        }
    }
    for _ in 0..splits {
        let mut halves = HashMap::new();
        let mut half = |a: u32, b: u32| {
            *halves.entry((a.min(b), a.max(b))).or_insert_with(|| {
                vertices.push((vertices[a as usize] + vertices[b as usize]).normalize());
                vertices.len() as u32 - 1
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let [ab, bc, ca] = [half(a, b), half(b, c), half(c, a)];
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    solid("sphere", vertices.iter().map(|v| v * radius).collect(), triangles)
}

/// A round tablet: rings of `around` vertices on caps z(s) = `cap` (1 − s²) above a band, poles on the axis.
pub(crate) fn round_tablet(diameter: f64, band: f64, cap: f64, around: usize, rings: usize) -> TabletShape {
    let mut vertices = vec![Vector3::new(0.0, 0.0, band / 2.0 + cap)];
    let mut levels: Vec<(f64, f64)> = (1..=rings)
        .map(|k| k as f64 / rings as f64)
        .map(|s| (s * diameter / 2.0, band / 2.0 + cap * (1.0 - s * s)))
        .collect();
    levels.extend(levels.clone().iter().rev().map(|&(r, z)| (r, -z)));
    for (r, z) in &levels {
        vertices.extend((0..around).map(|k| {
            let (sin, cos) = (k as f64 / around as f64 * std::f64::consts::TAU).sin_cos();
            Vector3::new(r * cos, r * sin, *z)
        }));
    }
    vertices.push(Vector3::new(0.0, 0.0, -band / 2.0 - cap));
    let at = |level: usize, k: usize| (1 + level * around + k % around) as u32;
    let last = (vertices.len() - 1) as u32;
    let mut triangles = Vec::new();
    for k in 0..around {
        triangles.push([0, at(0, k), at(0, k + 1)]);
        for level in 1..levels.len() {
            triangles.push([at(level - 1, k), at(level, k), at(level, k + 1)]);
            triangles.push([at(level - 1, k), at(level, k + 1), at(level - 1, k + 1)]);
        }
        triangles.push([last, at(levels.len() - 1, k + 1), at(levels.len() - 1, k)]);
    }
    solid("round", vertices, triangles)
}
