//! A ball rolls over a plane made of irregular triangles: edges and vertices that facets share are not felt, so it keeps speed
//! (1e-6), spin and height (1e-9 m), as on an analytic plane (the case of MercuryDPM's RollingOverTriangleWalls), however many
//! there are, wherever they face, and whatever hangs below. In a corner of patches it feels both, whether they share vertices,
//! go on behind or cross. Degenerate meshes are repaired or refused with the facet.

use super::support::{folder, near, scene, watch};
use pancoat::scene::Scene;
use pancoat::stepping::{BodyState, Simulation};

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

type Facet = [[f64; 3]; 3];

/// The scene with another mesh, mm, and other values, or why not.
fn with_mesh(text: &[u8], more: &[&str]) -> Result<Simulation, String> {
    let file = tempfile::Builder::new().suffix(".stl").tempfile().expect("can be made");
    std::fs::write(file.path(), text).expect("can be written");
    let path = file.path().display().to_string();
    let mesh = format!("boundaries[0].surface=Mesh(file: {path:?}, unit: Mm(1))");
    let set: Vec<String> = more.iter().map(|set| (*set).to_owned()).chain([mesh]).collect();
    let scene = Scene::load(&folder().join("rolling_on_mesh.ron"), &set).map_err(|f| f.to_string())?;
    Simulation::new(&scene).map_err(|fault| fault.to_string())
}

/// The same with facets, after `frames` of 1 ms.
fn after(frames: u64, facets: &[Facet], more: &[&str]) -> (BodyState, Vec<String>) {
    let mut simulation = with_mesh(&stl(facets), more).expect("is a surface");
    simulation.run(0, frames, &mut [], &mut |_| true).expect("runs");
    (simulation.states()[0], simulation.repairs().iter().map(ToString::to_string).collect())
}

/// As a binary file.
fn stl(facets: &[Facet]) -> Vec<u8> {
    let mut bytes = [&[0; 80][..], &(facets.len() as u32).to_le_bytes()].concat();
    for facet in facets {
        bytes.extend([0; 12]);
        bytes.extend(facet.as_flattened().iter().flat_map(|x| (*x as f32).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

const A: [f64; 3] = [-50.0, 0.0, -50.0];
const B: [f64; 3] = [50.0, 0.0, -50.0];
const C: [f64; 3] = [50.0, 0.0, 50.0];
const D: [f64; 3] = [-50.0, 0.0, 50.0];
/// The floor.
const UP: [Facet; 2] = [[A, C, B], [A, D, C]];

/// Rolls on as if the floor were two facets: from x = 0, z = 3 mm at 200 mm/s.
fn rolls_on(facets: &[Facet]) -> Vec<String> {
    let (plain, _) = after(100, &UP, &[]);
    let (state, repairs) = after(100, facets, &[]);
    assert!((state.position - plain.position).norm() < 1e-9, "{} for {}", state.position, plain.position);
    assert!((state.velocity - plain.velocity).norm() < 1e-6 && (state.spin - plain.spin).norm() < 1e-5);
    repairs
}

#[test]
fn degenerate_facets_are_dropped_and_told() {
    let told = |more: &[Facet], what: &str| {
        let repairs = rolls_on(&[&UP, more].concat());
        assert!(repairs.iter().any(|repair| repair.ends_with(what)), "{repairs:?}");
    };
    // Without area; with the corners of another, wound alike and against it.
    told(&[[A, A, C]], "dropped 1 facets without area, the first is facet 3");
    told(&[[C, B, A], UP[1], [A, C, D]], "dropped 3 facets that lie on another, the first is facet 3");
    // Corners on a line: it has no side.
    assert!(rolls_on(&[UP[0], UP[1], [A, [0.0, 0.0, 0.0], C]]).is_empty());
}

#[test]
fn walls_may_face_away_and_have_others_below() {
    let down = UP.map(|[a, b, c]| [a, c, b]);
    assert!(rolls_on(&down).is_empty());
    // A plate hangs below the floor at x = 10 mm, where it rolls: three facets meet in its upper edge.
    let [n, s] = [[10.0, 0.0, -50.0], [10.0, 0.0, 50.0]];
    let [under_n, under_s] = [[10.0, -50.0, -50.0], [10.0, -50.0, 50.0]];
    let floor = [[A, s, n], [A, D, s], [n, C, B], [n, s, C]];
    let plate = [[n, s, under_s], [n, under_s, under_n]];
    assert!(rolls_on(&[&floor[..], &plate].concat()).is_empty());
    // It does not excuse a facet that is wound against its only neighbour.
    let wrong = with_mesh(&stl(&[&floor[..3], &plate, &[[n, C, s]]].concat()), &[]);
    assert!(wrong.err().expect("is refused").contains("facet 6 is wound against its neighbour"));
    // A plate of its own that ends below the floor, deeper than the ball sinks in (7 um).
    let [low, high] = [-50.0, -0.01].map(|y| [[10.0, y, -40.0], [10.0, y, 40.0]]);
    assert!(
        rolls_on(&[&UP[..], &[[low[0], high[0], low[1]], [high[0], high[1], low[1]]]].concat()).is_empty()
    );
}

/// The floor as n × n cells of two facets.
fn fine_floor(n: usize) -> Vec<Facet> {
    let at = |i: usize| -50.0 + 100.0 * i as f64 / n as f64;
    let corner = |i: usize, j: usize| [at(i), 0.0, at(j)];
    let cell = |k: usize| {
        let (i, j) = (k / n, k % n);
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        [[a, c, b], [a, d, c]]
    };
    (0..n * n).flat_map(cell).collect()
}

/// A tenth of the most that is read.
#[test]
fn a_floor_of_a_hundred_thousand_facets_is_a_floor() {
    rolls_on(&fine_floor(223));
}

#[test]
#[ignore = "tells how the time to take a wall in grows with its facets"]
fn floors_of_up_to_a_million_facets() {
    for n in [70, 223, 707] {
        let facets = fine_floor(n);
        let start = std::time::Instant::now();
        rolls_on(&facets);
        eprintln!("{} facets: {:.2} s", facets.len(), start.elapsed().as_secs_f64());
    }
}

#[test]
fn what_cannot_be_a_wall_is_refused() {
    let refused = |text: &[u8], what: &str| {
        let message = with_mesh(text, &[]).map(|_| ()).expect_err("is refused");
        assert!(message.contains(what), "{message}");
    };
    refused(&stl(&[UP[0], [A, C, D]]), "facet 2");
    refused(&stl(&[]), "no facet");
    refused(
        &stl(&[UP[0], [A, [f64::NAN, 0.0, 0.0], C]]),
        "facet 2 has a coordinate that is not a finite number",
    );
    let scaled = |by: f64| stl(&UP.map(|f| f.map(|v| v.map(|x| x * by))));
    refused(&scaled(1e3), "is the unit right?");
    refused(&scaled(1e-6), "is the unit right?");
    refused(&stl(&vec![UP[0]; 1_000_001]), "1000001 facets are too many");
}

/// Two plates at 45 degrees, from (x, y) to (x, y) each, mm.
fn plates(ends: &[[[f64; 2]; 2]]) -> Vec<Facet> {
    let plate = |[[x, y], [u, v]]: &[[f64; 2]; 2]| {
        let [a, b, c, d] = [[*x, *y, -50.0], [*u, *v, -50.0], [*u, *v, 50.0], [*x, *y, 50.0]];
        [[a, c, b], [a, d, c]]
    };
    ends.iter().flat_map(plate).collect()
}

/// At rest each plate of a V carries m g/√2.
#[test]
fn both_walls_of_a_corner_push() {
    let set = [
        "bodies[0].position=Mm(0.1, 5.8, 3)",
        "bodies[0].velocity=MPerS(0, 0, 0)",
        "bodies[0].spin=RadPerS(0, 0, 0)",
        "pairs[0].friction=0",
    ];
    let mass = scene("rolling_on_mesh", &[]).bodies[0].mass;
    let force = mass * 9.81 / 2.0_f64.sqrt();
    let overlap = (3.0 * force / (4.0 * 2e6 / 0.75 * 4e-3_f64.sqrt())).powf(2.0 / 3.0);
    let (left, right) = ([[-50.0, 50.0], [0.0, 0.0]], [[0.0, 0.0], [50.0, 50.0]]);
    let behind = [[-50.0, -50.0], [0.0, 0.0]];
    // Sharing vertices; one going on behind, three facets in an edge; crossing without a common vertex.
    let crossing = [[[-50.0, 50.0], [40.0, -40.0]], [[-40.0, -40.0], [50.0, 50.0]]];
    for walls in [&[left, right][..], &[left, right, behind], &crossing] {
        let (end, _) = after(600, &plates(walls), &set);
        near(end.position.y, (4e-3 - overlap) * 2.0_f64.sqrt(), 1e-5, "height");
        assert!(end.position.x.abs() < 1e-6);
    }
}
