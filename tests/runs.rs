//! Every scene of `scenes/` as a user runs it: fills, settles and is sprayed for 2 s with all its tablets. Clumps are
//! coarse (12 spheres) to save time; what a scene leaves out is not built.

use assert_cmd::Command;
use pancoat::scene::Scene;
use pancoat::shapes::TabletShape;
use pancoat::stepping::{Frame, Observer, Progress, Simulation, SimulationError};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

fn scene_path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(format!("{name}.ron"))
}

/// Runs a scene for `seconds` of spray and returns its record.
fn run(name: &str, seconds: &str, overrides: &[&str]) -> Value {
    let folder = tempfile::tempdir().expect("can be made");
    run_into(&folder.path().join("out"), &scene_path(name), seconds, overrides)
}

/// The same, with what it writes left in `out`.
fn run_into(out: &Path, scene: &Path, seconds: &str, overrides: &[&str]) -> Value {
    let mut command = Command::cargo_bin("pancoat").expect("is built");
    command.arg("run").arg(scene).args(["--seconds", seconds, "--threads", "1", "--quiet", "--out"]);
    command.arg(out);
    for set in overrides {
        command.args(["--set", set]);
    }
    command.assert().success();
    let record = fs::read_to_string(out.join("run.json")).expect("has a record");
    serde_json::from_str(&record).expect("is JSON")
}

/// Fills, settles and coats; returns the results.
fn coats(name: &str, overrides: &[&str]) -> Value {
    coats_for("2", name, overrides)
}

fn coats_for(seconds: &str, name: &str, overrides: &[&str]) -> Value {
    let record = run(name, seconds, overrides);
    assert_eq!(record["status"], "done");
    let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
    let scene = Scene::load(&scene_path(name), &overrides).expect("is valid");
    let tablets: usize = scene.batches.iter().map(|batch| batch.count).sum();
    assert_eq!(record["derived"]["bodies"], tablets, "all tablets are in the pan");
    assert!(record["derived"]["settling_s"].as_f64().expect("settled") > 0.5);
    assert!(record["guards"]["largest_overlap_percent"].as_f64().expect("is watched") < 60.0);
    let results = record["results"].clone();
    let number = |key: &str| results[key].as_f64().unwrap_or_else(|| panic!("{key} is a number"));
    assert!(number("cov_identity_residual") < 1e-9);
    // Baffles lift a small batch in one piece; spheres roll.
    let steepest = if scene.batches[0].count > 500 { 55.0 } else { 75.0 };
    assert!((30.0..steepest).contains(&number("angle_of_repose_deg")) || name == "sphere");
    assert!((0.8..4.0).contains(&number("cov_intra")), "{}", number("cov_intra"));
    assert!((0.2..2.0).contains(&number("cov_inter")), "{}", number("cov_inter"));
    results
}

#[test]
fn round_tablets_get_more_on_their_caps() {
    // Four seeds of 2 s give 0.91, and 0.04 of scatter; 5 s leave 0.025 of it.
    let results = coats_for("5", "round", &["shapes.round.spheres=12"]);
    assert!(results["orientation_index"].as_f64().expect("has both regions") < 0.97);
    let shadowed = results["cov_intra_asymptote"]["high"].as_f64().expect("is estimated");
    assert!(results["cov_intra_orientation_only"].as_f64().expect("is known") > shadowed);
}

/// The variation in a single frame tells zone size, tablet number, panel area and weighting at once. With the zone's
/// area Z = 76.2 x 38.1 mm² and N tablets of area A, the mean exposure is μ = Z/(N A) = 0.00646 of a tablet.
///
/// - Eq 8 gives CoV_intra² = ⟨cos⟩/μ − CoV_inter² − 1 with ⟨cos⟩ the mean cosine of what is seen, 0.7 to 0.9: 7.8 to
///   10.9 with the CoV_inter below.
/// - CoV_inter² + 1 = a/(A μ) with a = Σaᵢ²/Σaᵢ, the visible projected area of tablet i weighted by itself. Whole and
///   unshadowed tablets at random have a = A/4 (Cauchy), hence 6.1; but of a width s in a window W a border leaves
///   s (1 − s/3W), here 0.82 of a in both directions, hence 5.5; with all caps up it would be 6.5. Tablets here lie between, and
///   shadows take from both: what is found has to stay below the 5.5 and above 4.2, half of a hidden.
#[test]
fn the_first_frame_has_the_variation_that_geometry_gives() {
    let record = run("round", "0.02", &["shapes.round.spheres=12"]);
    let number = |key: &str| record["results"][key].as_f64().expect("is a number");
    assert!((7.8..10.9).contains(&number("cov_intra")), "{}", number("cov_intra"));
    assert!((4.2..5.5).contains(&number("cov_inter")), "{}", number("cov_inter"));
}

#[test]
fn almond_tablets() {
    coats("almond", &["shapes.almond.spheres=12"]);
}

#[test]
fn oval_tablets() {
    coats("oval", &["shapes.oval.spheres=12"]);
}

#[test]
fn triangular_tablets() {
    coats("triangular", &["shapes.triangular.spheres=12"]);
}

/// A shape that the paper does not have, in a batch of 150 g to save time.
fn coats_a_few(name: &str) {
    coats(name, &["batches[0].mass=G(150)", &format!("shapes.{name}.spheres=12")]);
}

/// Beds of all tablets and spheres, at the step of the scene, until the first avalanche is over, after a second: it throws tablets so
/// hard that one of these beds of capsules asks for divided steps.
fn lasts(name: &str) {
    let record = run(name, "0.5", &["spray=None", "time.settle=For(S(1))", "seed=2"]);
    assert_eq!(record["status"], "done");
    let guards = |key: &str| record["guards"][key].as_f64().expect("is watched");
    assert!(
        guards("largest_overlap_percent") < 60.0 && guards("too_stiff_percent") < 0.1,
        "{}",
        record["guards"]
    );
}

#[test]
fn beds_of_round_and_almond_tablets_last() {
    lasts("round");
    lasts("almond");
}

#[test]
fn beds_of_oval_and_triangular_tablets_last() {
    lasts("oval");
    lasts("triangular");
}

#[test]
fn beds_of_capsules_and_bullets_last() {
    lasts("capsule");
    lasts("bullet");
}

#[test]
fn beds_of_half_moons_last() {
    lasts("half_moon");
}

#[test]
fn beds_of_shields_and_flat_tablets_last() {
    lasts("shield");
    lasts("flat");
}

#[test]
fn capsules() {
    coats_a_few("capsule");
}

#[test]
fn bullets() {
    coats_a_few("bullet");
}

#[test]
fn half_moons() {
    coats_a_few("half_moon");
}

#[test]
fn shields() {
    coats_a_few("shield");
}

#[test]
fn flat_faced_tablets() {
    coats_a_few("flat");
}

#[test]
fn spheres_have_no_limit_but_zero() {
    let results = coats("sphere", &[]);
    assert!(results["cov_intra_asymptote"]["low"].as_f64().expect("is estimated") < 0.02);
}

#[test]
fn free_bodies_run_without_drum_and_spray() {
    let record = run("free", "0.1", &[]);
    assert_eq!(record["status"], "done");
    assert_eq!(record["backend"], "none");
    assert_eq!(record["results"], serde_json::json!({}));
}

#[test]
fn without_a_spray_no_panels_are_built() {
    let text = fs::read_to_string(scene_path("round")).expect("is there");
    let spray = text.find("    spray: (").expect("sprays");
    let outputs = spray + text[spray..].find("\n    ),").expect("ends") + 7;
    let dry = format!("{}{}", &text[..spray], &text[outputs..]);
    let overrides = ["batches[0].mass=G(40)".to_owned(), "shapes.round.spheres=12".to_owned()];
    let folder = tempfile::tempdir().expect("can be made");
    let path = folder.path().join("dry.ron");
    fs::write(&path, &dry).expect("can be written");
    let scene = Scene::load(&path, &overrides).expect("is valid");
    assert!(scene.spray.is_none());
    let mut simulation = Simulation::new(&scene).expect("is built");
    assert!(simulation.shapes()[0].panels.is_none());
    simulation.fill(&mut |_| true).expect("is filled");
    simulation.run(0, 5, &mut [], &mut |_| true).expect("runs");
    assert_eq!(simulation.body_shapes().len(), 31);
}

#[test]
fn an_empty_drum_with_a_free_body_runs() {
    let text = r#"(
        format: 1,
        title: "one ball in a drum",
        materials: {"tablet": (shear_modulus: MPa(1), poisson: 0.25)},
        pairs: [(between: ("tablet", "tablet"), friction: 0.5, restitution: 0.5)],
        shapes: {"ball": (recipe: Sphere(diameter: Mm(10)))},
        bodies: [(shape: "ball", material: "tablet", mass: Mg(1300), position: Mm(0, -40, 0))],
        drum: (diameter: Mm(120), width: Mm(60), speed: Rpm(20), material: "tablet"),
        time: (duration: Ms(200), frame_interval: Ms(20)),
    )"#;
    let scene = Scene::parse(text, "drum.ron", Path::new(""), &[]).expect("is valid");
    let mut simulation = Simulation::new(&scene).expect("is built");
    simulation.fill(&mut |_| true).expect("nothing waits");
    simulation.run(0, 10, &mut [], &mut |_| true).expect("runs");
    assert!(simulation.states()[0].position.y < -45.0e-3, "it fell");
}

/// Observers look at a frame while the next one is computed, but miss none however the run ends.
#[test]
fn observers_have_seen_all_frames_of_a_run_that_is_stopped() {
    struct Seen(Vec<(u64, f64)>);
    impl Observer for Seen {
        fn observe(&mut self, frame: &Frame<'_>) {
            self.0.push((frame.index, frame.bodies[0].position.y));
        }
    }
    let text = r#"(
        format: 1,
        title: "a falling ball",
        materials: {"tablet": (shear_modulus: MPa(1), poisson: 0.25)},
        pairs: [(between: ("tablet", "tablet"), friction: 0.5, restitution: 0.5)],
        shapes: {"ball": (recipe: Sphere(diameter: Mm(10)))},
        bodies: [(shape: "ball", material: "tablet", mass: Mg(1300), position: Mm(0, 0, 0))],
        time: (duration: S(1), frame_interval: Ms(10)),
    )"#;
    let scene = Scene::parse(text, "ball.ron", Path::new(""), &[]).expect("is valid");
    let mut simulation = Simulation::new(&scene).expect("is built");
    let (mut seen, mut frames) = (Seen(Vec::new()), Vec::new());
    let mut stop_after_three = |_: &Progress| {
        frames.push(frames.len() as u64);
        frames.len() < 3
    };
    let ended = simulation.run(0, 10, &mut [&mut seen], &mut stop_after_three);
    assert!(matches!(ended, Err(SimulationError::Stopped { .. })));
    let numbers: Vec<u64> = seen.0.iter().map(|(number, _)| *number).collect();
    assert_eq!(numbers, frames);
    for (number, y) in seen.0 {
        let time = 0.01 * (number + 1) as f64;
        assert!((y + 0.5 * 9.81 * time * time).abs() < 1e-5, "frame {number} at {y} m");
    }
}

/// Rows of a table by the names of its columns.
fn rows(file: &Path) -> Vec<std::collections::HashMap<String, String>> {
    let mut reader = csv::Reader::from_path(file).expect("is a table");
    reader.deserialize().map(|row| row.expect("is a row")).collect()
}

/// Two shapes in one pan: both are filled and mixed, every tablet has its own id and panels, statistics are made of each
/// shape, no coat gets lost between them, and the report shows both.
#[test]
fn two_shapes_share_a_pan() {
    let folder = tempfile::tempdir().expect("can be made");
    let out = folder.path().join("out");
    let oval = "shapes.oval=(recipe: Oval(length: Mm(19.2), width: Mm(10.8), band: Mm(4.7), \
                cap: Spherical(height: Mm(1.6))), spheres: 12, panels: 900)";
    let batches = "batches=[(shape: \"round\", material: \"tablet\", tablet_mass: Mg(1300), count: 70), \
                   (shape: \"oval\", material: \"tablet\", tablet_mass: Mg(1200), count: 50)]";
    let record = run_into(&out, &scene_path("round"), "2", &["shapes.round.spheres=12", oval, batches]);
    let tablets = rows(&out.join("tablets.csv"));
    let ids: Vec<usize> = tablets.iter().map(|row| row["tablet"].parse().expect("a number")).collect();
    assert_eq!(ids, (0..120).collect::<Vec<_>>());
    let kinds: Vec<&str> = tablets.iter().map(|row| row["shape"].as_str()).collect();
    for (kind, count, mass) in [("round", 70, "1300"), ("oval", 50, "1200")] {
        assert_eq!(kinds.iter().filter(|k| **k == kind).count(), count);
        assert!(kinds[..60].contains(&kind) && kinds[60..].contains(&kind), "batches are mixed");
        let own = |row: &&std::collections::HashMap<String, String>| row["shape"] == kind;
        assert!(tablets.iter().filter(own).all(|row| row["mass_mg"].starts_with(mass)));
        let panels = rows(&out.join("panels.csv")).iter().filter(own).count();
        assert_eq!(record["derived"]["panels"][kind], panels);
        let results = &record["results"]["shapes"][kind];
        for key in ["cov_intra", "cov_inter", "mean_thickness_um", "cov_intra_orientation_only"] {
            assert!(results[key].as_f64().is_some_and(|x| x > 0.0), "{kind} {key}: {results}");
        }
    }
    let coat: f64 = tablets.iter().map(|row| row["coat_mass_mg"].parse::<f64>().expect("a mass")).sum();
    let efficiency = record["results"]["spray_efficiency"].as_f64().expect("is known");
    assert!((coat / (7.5 / 60.0 * 0.2 * 2.0 * 1e3 * efficiency) - 1.0).abs() < 1e-9, "{coat}");
    let report = fs::read_to_string(out.join("report.html")).expect("is there");
    assert!(report.contains("oval") && report.contains("round"));
}

/// Corners of a debossed tablet in a half plane, (distance from the axis, z), mm: bevelled flat faces, the upper one with a
/// ring 0.5 mm deep.
const DEBOSSED: [[f64; 2]; 10] = [
    [0.0, -2.2],
    [3.9, -2.2],
    [5.0, -1.5],
    [5.0, 1.5],
    [3.9, 2.2],
    [3.2, 2.2],
    [2.9, 1.7],
    [2.1, 1.7],
    [1.8, 2.2],
    [0.0, 2.2],
];
/// Facets around it, and how much narrower than long it is.
const AROUND: usize = 48;
const NARROWER: f64 = 0.7;

/// The tablet as an ASCII STL file in mm.
fn debossed() -> String {
    let corner = |[r, z]: [f64; 2], k: usize| {
        let (sin, cos) = (std::f64::consts::TAU * (k % AROUND) as f64 / AROUND as f64).sin_cos();
        format!("vertex {:.7} {:.7} {z:.7}\n", r * cos, NARROWER * r * sin)
    };
    let mut text = "solid debossed\n".to_owned();
    let mut facet = |corners: [String; 3]| {
        for line in ["facet normal 0 0 0\nouter loop\n", &corners.concat(), "endloop\nendfacet\n"] {
            text += line;
        }
    };
    for (k, pair) in (0..AROUND).flat_map(|k| DEBOSSED.windows(2).map(move |pair| (k, pair))) {
        let [low, high] = [pair[0], pair[1]];
        if low[0] > 0.0 {
            facet([corner(low, k), corner(low, k + 1), corner(high, k)]);
        }
        if high[0] > 0.0 {
            facet([corner(low, k + 1), corner(high, k + 1), corner(high, k)]);
        }
    }
    text + "endsolid debossed\n"
}

/// A concave solid from a file, all the way: clump, panels, run, coat.
#[test]
fn a_debossed_tablet_from_a_mesh_is_coated() {
    let folder = tempfile::tempdir().expect("can be made");
    fs::write(folder.path().join("debossed.stl"), debossed()).expect("can be written");
    let scene = folder.path().join("debossed.ron");
    let text = r#"(
        format: 1,
        title: "debossed tablets",
        materials: {"tablet": (shear_modulus: MPa(1), poisson: 0.25)},
        pairs: [(between: ("tablet", "tablet"), friction: 0.5, restitution: 0.5)],
        shapes: {"debossed": (recipe: Mesh(file: "debossed.stl", unit: Mm(1)), spheres: 60, panels: 1500)},
        batches: [(shape: "debossed", material: "tablet", tablet_mass: Mg(300), count: 90)],
        drum: (diameter: Mm(100), width: Mm(60), speed: Rpm(30), material: "tablet"),
        time: (settle: For(S(1)), duration: S(2), frame_interval: Ms(20)),
        spray: (spanwise: Mm(50), streamwise: Mm(40), pixels: (300, 240), deposit: (rate: GPerMin(7.5), solids: 0.2)),
    )"#;
    fs::write(&scene, text).expect("can be written");

    let shape = &Scene::load(&scene, &[]).expect("is valid").shapes[0];
    let tablet = TabletShape::build(shape, true).expect("is one solid");
    assert_eq!(tablet.repairs, []);
    // Truncated cones, squeezed; the facets' corners are on the solid.
    let cone = |p: &[[f64; 2]]| (p[1][1] - p[0][1]) * (p[0][0].powi(2) + p[0][0] * p[1][0] + p[1][0].powi(2));
    let angle = std::f64::consts::TAU / AROUND as f64;
    let volume = NARROWER * AROUND as f64 * angle.sin() / 6.0 * DEBOSSED.windows(2).map(cone).sum::<f64>();
    assert!((tablet.volume * 1e9 / volume - 1.0).abs() < 1e-6, "{} for {volume}", tablet.volume * 1e9);
    let panels = tablet.panels.as_ref().expect("is sprayed");
    let top = panels.vertices.iter().map(|v| v.z).fold(0.0, f64::max);
    let floor = |k: &usize| panels.normals[*k].z > 0.99 && panels.centroids[*k].z < top - 0.45e-3;
    let floor: Vec<usize> = (0..panels.len()).filter(floor).collect();
    let floor_area = floor.iter().map(|&k| panels.areas[k] * 1e6).sum::<f64>();
    let ring = NARROWER * AROUND as f64 * angle.sin() / 2.0 * (2.9 * 2.9 - 2.1 * 2.1);
    assert!((floor_area / ring - 1.0).abs() < 0.02, "{floor_area} mm2 of {ring}");
    let gap = |k: &usize| 1e3 * tablet.clump.distance(&panels.centroids[*k]);
    let (least, most) = floor.iter().map(gap).fold((f64::MAX, f64::MIN), |(l, m), g| (l.min(g), m.max(g)));
    assert!(least > -0.02 && most < 0.8, "spheres come to {least} to {most} mm below the ring, none into it");
    let quality = panels.quality();
    assert!(panels.len().abs_diff(1500) < 150 && quality.smallest_angle_deg > 15.0, "{quality:?}");

    let out = folder.path().join("out");
    let record = run_into(&out, &scene, "2", &[]);
    assert_eq!((&record["status"], &record["derived"]["bodies"]), (&"done".into(), &90.into()));
    let coated = rows(&out.join("panels.csv"));
    let mean = |of: &dyn Fn(usize) -> bool| {
        let of = (0..panels.len()).filter(|&k| of(k));
        let film =
            of.map(|k| (coated[k]["average_um"].parse::<f64>().expect("a thickness"), panels.areas[k]));
        let (sum, area) = film.fold((0.0, 0.0), |(s, a), (film, area)| (s + film * area, a + area));
        sum / area
    };
    let face = mean(&|k| panels.normals[k].z > 0.99 && panels.centroids[k].z > top - 0.05e-3);
    let floor = mean(&|k| floor.contains(&k));
    assert!(
        floor > 0.2 * face && floor < face,
        "the walls of the ring shade its floor: {floor} um, {face} um"
    );
}

/// A leaning drum with conical ends, and a drum from a file: tablets gather at the low end, and none gets out.
#[test]
fn drums_lean_and_come_from_meshes() {
    let pan = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/pan.stl").display().to_string();
    let mesh = format!("drum.wall=Mesh(file: \"{pan}\", unit: Mm(1))");
    let cones = "drum.wall=Profile([(Mm(-50), Mm(200)), (Mm(-30), Mm(250)), (Mm(50), Mm(250))])";
    let mean_z = |overrides: &[&str]| {
        let all = ["spray=None", "batches[0].count=80", "drum.speed=Rpm(22)"].iter().chain(overrides);
        let all: Vec<String> = all.map(ToString::to_string).collect();
        let scene = Scene::load(&scene_path("sphere"), &all).expect("is valid");
        let mut simulation = Simulation::new(&scene).expect("is built");
        simulation.fill(&mut |_| true).expect("is filled");
        simulation.run(0, 75, &mut [], &mut |_| true).expect("runs");
        let states = simulation.states();
        assert_eq!(states.len(), scene.batches[0].count);
        states.iter().map(|state| state.position.z).sum::<f64>() / states.len() as f64
    };
    let level = mean_z(&["drum.baffles=None", &mesh]);
    assert!(level.abs() < 4e-3, "{level}");
    let leaning = mean_z(&["drum.axis_tilt=Deg(15)", cones]);
    assert!(leaning < -10e-3, "{leaning}");
}
