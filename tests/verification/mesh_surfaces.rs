//! A ball rolls over a plane made of irregular triangles: edges and vertices that facets share are not felt, so it keeps speed
//! (1e-6), spin and height (1e-9 m), as on an analytic plane (the case of MercuryDPM's RollingOverTriangleWalls). Into a
//! corner of two patches it feels both. Degenerate meshes are repaired or refused with the facet.

use super::support::{folder, near, scene, watch};
use pancoat::scene::Scene;
use pancoat::stepping::Simulation;

#[test]
fn shared_edges_are_not_felt() {
    let history = watch("rolling_on_mesh", &[]);
    let first = history[0].1[0];
    for (time, bodies) in &history {
        let s = bodies[0];
        near(s.velocity.norm(), first.velocity.norm(), 1e-6, &format!("speed at {time}"));
        near(s.spin.norm(), first.spin.norm(), 1e-6, "spin");
        assert!((s.position.y - first.position.y).abs() < 1e-9, "kick at {time}: {}", s.position.y);
    }
    assert!(history.last().expect("has an end").1[0].position.x > 0.11, "it rolled over eight cells");
}

#[test]
fn a_tessellated_plane_is_a_plane() {
    let plane = "boundaries[0].surface=Plane(normal: (0, 1, 0))".to_owned();
    let drop =
        ["bodies[0].position=Mm(20, 5, 13)".to_owned(), "bodies[0].spin=RadPerS(0, 30, -20)".to_owned()];
    let on_plane = watch("rolling_on_mesh", &[drop.to_vec(), vec![plane]].concat());
    let on_mesh = watch("rolling_on_mesh", &drop);
    for ((_, a), (_, b)) in on_plane.iter().zip(&on_mesh) {
        assert!((a[0].position - b[0].position).norm() < 1e-9 && (a[0].spin - b[0].spin).norm() < 1e-5);
    }
}

/// The scene with another mesh, or why not.
fn with_mesh(text: &str) -> Result<Simulation, String> {
    let file = tempfile::Builder::new().suffix(".stl").tempfile().expect("can be made");
    std::fs::write(file.path(), text).expect("can be written");
    let path = file.path().display().to_string();
    let set = [format!("boundaries[0].surface=Mesh(file: {path:?}, unit: Mm(1))")];
    let scene = Scene::load(&folder().join("rolling_on_mesh.ron"), &set).map_err(|f| f.to_string())?;
    Simulation::new(&scene).map_err(|fault| fault.to_string())
}

fn stl(facets: &[[[f64; 3]; 3]]) -> String {
    let vertex = |[x, y, z]: &[f64; 3]| format!("vertex {x} {y} {z}\n");
    let facet = |f: &[[f64; 3]; 3]| {
        format!(
            "facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n",
            f.iter().map(vertex).collect::<String>()
        )
    };
    format!("solid s\n{}endsolid s\n", facets.iter().map(facet).collect::<String>())
}

const A: [f64; 3] = [-50.0, 0.0, -50.0];
const B: [f64; 3] = [50.0, 0.0, -50.0];
const C: [f64; 3] = [50.0, 0.0, 50.0];
const D: [f64; 3] = [-50.0, 0.0, 50.0];

#[test]
fn degenerate_meshes_run_or_are_refused() {
    let up = [[A, C, B], [A, D, C]];
    let good = |facets: &[[[f64; 3]; 3]]| {
        let mut simulation = with_mesh(&stl(facets)).expect("runs");
        simulation.run(0, 100, &mut [], &mut |_| true).expect("runs");
        assert!(simulation.states()[0].position.iter().all(|x| x.is_finite()));
        near(simulation.states()[0].velocity.x, 0.2, 1e-6, "rolls on");
    };
    good(&up);
    // A facet without area, one that touches itself, an open hole elsewhere.
    good(&[up[0], up[1], [A, A, C]]);
    good(&[up[0], up[1], [A, [0.0, 0.0, 0.0], C]]);
    let refused = |text: &str, what: &str| {
        let message = with_mesh(text).map(|_| ()).expect_err("is refused");
        assert!(message.contains(what), "{message}");
    };
    refused(&stl(&[up[0], [A, C, D]]), "facet 2");
    refused(&stl(&[]), "no facet");
    refused(
        "solid s\nfacet normal 0 0 0\nouter loop\nvertex nan 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\nendsolid",
        "facet 1",
    );
    let large = up.map(|f| f.map(|v| v.map(|x| x * 1e3)));
    refused(&stl(&large), "is the unit right?");
    let small = up.map(|f| f.map(|v| v.map(|x| x * 1e-6)));
    refused(&stl(&small), "is the unit right?");
}

#[test]
fn both_walls_of_a_corner_push() {
    // A V of two planes at 45 degrees: at rest each carries m g/√2.
    let right = [
        [[0.0, 0.0, -50.0], [0.0, 0.0, 50.0], [50.0, 50.0, -50.0]],
        [[50.0, 50.0, -50.0], [0.0, 0.0, 50.0], [50.0, 50.0, 50.0]],
    ];
    let left = right.map(|[a, b, c]| [a, c, b].map(|[x, y, z]| [-x, y, z]));
    let file = tempfile::Builder::new().suffix(".stl").tempfile().expect("can be made");
    std::fs::write(file.path(), stl(&[left[0], left[1], right[0], right[1]])).expect("can be written");
    let path = file.path().display().to_string();
    let set = [
        format!("boundaries[0].surface=Mesh(file: {path:?}, unit: Mm(1))"),
        "bodies[0].position=Mm(0.1, 5.8, 3)".into(),
        "bodies[0].velocity=MPerS(0, 0, 0)".into(),
        "bodies[0].spin=RadPerS(0, 0, 0)".into(),
        "pairs[0].friction=0".into(),
    ];
    let end = watch("rolling_on_mesh", &set).pop().expect("has an end").1[0];
    let mass = scene("rolling_on_mesh", &[]).bodies[0].mass;
    let force = mass * 9.81 / 2.0_f64.sqrt();
    let overlap = (3.0 * force / (4.0 * 2e6 / 0.75 * 4e-3_f64.sqrt())).powf(2.0 / 3.0);
    near(end.position.y, (4e-3 - overlap) * 2.0_f64.sqrt(), 1e-5, "height");
    assert!(end.position.x.abs() < 1e-6);
}
