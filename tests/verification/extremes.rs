//! Stiff and extreme scenes: each runs correctly, or is refused with a message that says what to change.

use super::support::{attempt, close, clump_file, folder, near, run, scene, set, watch};
use assert_cmd::Command;
use pancoat::contact::damping_ratio;
use pancoat::scene::Scene;
use pancoat::stepping::Simulation;
use std::path::{Path, PathBuf};

fn pancoat(arguments: &[&str]) -> (i32, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_pancoat")).args(arguments).output().expect("starts");
    (output.status.code().unwrap_or(-1), String::from_utf8_lossy(&output.stderr).into_owned())
}

/// `pancoat run` of a scene into a folder that goes away, with values set.
fn of_run(name: &str, more: &[&str]) -> (i32, String, tempfile::TempDir) {
    let out = tempfile::tempdir().expect("can be made");
    let path = folder().join(name).with_extension("ron").display().to_string();
    let at = out.path().join("run").display().to_string();
    let (code, text) = pancoat(&[&["run", &path, "--quiet", "--out", &at], more].concat());
    (code, text, out)
}

fn refused(name: &str, more: &[&str], what: &[&str]) {
    let (code, message, _) = of_run(name, more);
    assert_eq!(code, 2, "{message}");
    for what in what {
        assert!(message.contains(what), "`{what}` is not in {message}");
    }
}

#[test]
fn real_moduli_deliver_restitution() {
    let set =
        set!["materials.oxide.shear_modulus=GPa(1)", "time.duration=Us(200)", "time.frame_interval=Us(0.5)"];
    close(run("restitution", &set)[0].velocity.y / 3.9, 0.5, 2.5e-3, "1e9 Pa");
}

#[test]
fn endless_runs_are_refused_with_their_length() {
    refused(
        "stack",
        &["--set", "time.step=Fixed(Us(0.000001))", "--set", "time.duration=S(1)"],
        &["steps", "hours", "raise time.step"],
    );
    let stiff = ["--set", "materials.m.shear_modulus=Pa(1e17)", "--set", "time.duration=S(1800)"];
    refused("bouncing_ball", &stiff, &["steps", "hours", "lower shear_modulus"]);
}

#[test]
fn tiny_steps_keep_the_time() {
    let set =
        set!["time.step=Fixed(Us(0.000001))", "time.frame_interval=Us(0.001)", "time.duration=Us(0.01)"];
    let history = watch("two_spheres", &set);
    near(history.last().expect("has an end").0, 1e-8, 1e-12, "time");
    near(history.last().expect("has an end").1[0].position.x, -0.01 + 1e-7, 1e-12, "way");
}

#[test]
fn friction_from_none_to_ten() {
    // None: no spin at all. Sticking does not depend on how much there is.
    assert_eq!(run("oblique_impact", &set!["pairs[0].friction=0"])[0].spin.norm(), 0.0);
    let sticking = |friction: f64| {
        let set = set!["pairs[0].friction={friction}", "pairs[0].restitution=1"];
        let end = run("tablet_impact", &set)[0];
        let energy = 0.5 * end.velocity.norm_squared() + 0.2 * 16e-6 * end.spin.norm_squared();
        assert!(energy < 0.5 * 0.09 * (1.0 + 1e-6), "gains energy at {friction}");
        end.velocity.x
    };
    near(sticking(10.0), sticking(1.5), 1e-3, "sticking");
}

#[test]
fn restitution_from_nearly_none_to_one() {
    assert_eq!(damping_ratio(1.0).to_bits(), 0, "no damping, not even -0");
    let of = |e: &str| run("restitution", &set!["pairs[0].restitution={e}"])[0].velocity.y / 3.9;
    // Slow to converge: 400 steps a contact leave 0.03.
    close(of("1e-6"), 1e-6, 0.05, "1e-6");
    near(of("1"), 1.0, 1e-4, "1");
    for e in ["0", "-0.1", "1.0001"] {
        refused(
            "restitution",
            &["--set", &format!("pairs[0].restitution={e}")],
            &["pairs[0].restitution", "out of range"],
        );
    }
    refused("restitution", &["--set", "pairs[0].restitution=NaN"], &["pairs[0].restitution"]);
}

/// At most 10 and 5 steps asked for in 731.66 us of contact, as a time and as a number.
#[test]
fn few_steps_are_warned_of_and_too_few_refused() {
    for [few, too_few] in [["Fixed(Us(73))", "Fixed(Us(146))"], ["PerContact(10)", "PerContact(5)"]] {
        let run = |step: &str, more: &[&str]| {
            let step = format!("time.step={step}");
            let set = ["--set", &step, "--set", "time.frame_interval=Us(146)"];
            of_run("hertz_impact", &[&set, more].concat())
        };
        let warned = |(code, message, out): (i32, String, tempfile::TempDir), steps: &str| {
            assert_eq!(code, 0, "{message}");
            let record = std::fs::read_to_string(out.path().join("run/run.json")).expect("has a record");
            assert!(record.contains(&format!("only {steps} steps in a contact")), "{record}");
        };
        warned(run(few, &[]), "10.0");
        let (code, message, _) = run(too_few, &[]);
        assert_eq!(code, 2, "{message}");
        assert!(
            message.contains("5.0 steps in a contact, at least 8 are needed: lower time.step"),
            "{message}"
        );
        warned(run(too_few, &["--force"]), "5.0");
    }
    refused(
        "hertz_impact",
        &["--set", "time.step=PerContact(0.5)", "--force"],
        &["time.step", "out of range"],
    );
}

#[test]
fn a_forced_run_that_blows_up_stops_with_its_last_good_state() {
    let set = [
        "--set",
        "time.step=Fixed(Us(265))",
        "--set",
        "time.frame_interval=Us(265)",
        "--set",
        "time.duration=S(2)",
    ];
    let (code, message, _) = of_run("elastic_gas", &set);
    assert_eq!(code, 2, "{message}");
    let (code, message, out) = of_run("elastic_gas", &[&set[..], &["--force"]].concat());
    assert_eq!(code, 1, "{message}");
    // Twice the Rayleigh time: it is over after three hundred of 7500 steps, for all that stiff bodies are slowed down and steps
    // divided.
    let step = message.split("in step ").nth(1).and_then(|rest| rest.split(',').next()?.parse::<u32>().ok());
    assert!(message.contains("body ") && step.is_some_and(|step| step <= 300), "{message}");
    let record = std::fs::read_to_string(out.path().join("run/run.json")).expect("has a record");
    assert!(record.contains("\"failed\""));
    // The last good state can be run on from.
    let bodies = out.path().join("run/bodies.csv").display().to_string();
    let again = scene("elastic_gas", &set!["bodies[0].poses={bodies:?}", "time.duration=Ms(20)"]);
    assert_eq!(again.bodies.len(), 216);
}

#[test]
fn deep_overlap_at_the_start_is_refused() {
    let at = |x: f64| format!("bodies[1].position=Mm({x}, 0, 0)");
    let deep = at(4.0);
    refused("two_spheres", &["--set", &deep], &["body 0", "body 1", "0.60", "move them apart"]);
    // Coincident centres and a sphere in another have no way out either.
    refused("two_spheres", &["--set", &at(-10.0)], &["move them apart"]);
    let inside = [
        "--set",
        "shapes.small.recipe=Sphere(diameter: Mm(20))",
        "--set",
        "bodies[0].position=Mm(300, 100, 0)",
    ];
    refused("unequal_spheres", &inside, &["move them apart"]);
    refused(
        "hertz_impact",
        &["--set", "bodies[0].position=Mm(0, -20, 0)"],
        &["surface 0", "move them apart"],
    );
    // A slight one is pushed out at no more than what its spring holds.
    let slight = at(9.0);
    let set =
        [slight, "bodies[0].velocity=MPerS(0, 0, 0)".into(), "bodies[1].velocity=MPerS(0, 0, 0)".into()];
    let end = run("two_spheres", &set);
    assert!(end.iter().all(|s| s.velocity.norm().is_finite()) && end[1].velocity.x > 0.0);
}

#[test]
fn a_body_too_fast_for_its_wall_is_stopped() {
    let fast = ["--set", "bodies[0].velocity=MPerS(300, 0, 0)", "--set", "time.step=Fixed(Us(50))"];
    refused("rolling_on_mesh", &fast, &["in a step", "lower time.step"]);
    let (code, message, _) = of_run("rolling_on_mesh", &[&fast[..], &["--force"]].concat());
    assert_eq!(code, 1, "{message}");
    assert!(message.contains("body 0 moves by") && message.contains("step 1"), "{message}");
}

/// A small sphere in the middle of a body, which touches nothing, lets it go 65 um a step: it comes by 59 and leaves as fast, in steps
/// of two pieces, and stops for a moment in between, in whole ones. It keeps its speed, and comes as far as without
/// the small one.
#[test]
fn steps_are_divided_while_a_body_is_fast() {
    let landing = |small: f64| {
        let (_file, path) = clump_file(&format!("0 0 0 0.002\n0 0 0 {small}\n"));
        let set = set![
            "shapes.ring.recipe=Clump(file: {path:?}, inertia_per_mass: Mm2(1, 1, 1))",
            "pairs[0].restitution=1",
            "bodies[0].position=Mm(0, 3, 0)",
            "time.step=Fixed(Us(200))",
            "time.frame_interval=Ms(10)",
        ];
        let scene = scene("flat_landing", &set);
        let mut simulation = Simulation::new(&scene).expect("is built");
        simulation.run(0, 1, &mut [], &mut |_| true).expect("runs");
        (simulation.states()[0], simulation.clock(), simulation.divided_share())
    };
    let (end, time, divided) = landing(131e-6);
    let (whole, _, none) = landing(1e-3);
    assert!((0.5..0.95).contains(&divided) && none == 0.0, "{divided}, {none}");
    near(time, 10e-3, 1e-12, "time");
    near(end.velocity.y, 0.3, 3e-3, "speed");
    near(end.position.y, whole.position.y, 3e-3, "way");
}

/// Elastic spheres whose energy grows, at a third of the steps that they need, until some frame fails in whole steps.
#[test]
fn a_frame_that_goes_wrong_is_repeated_in_finer_steps() {
    let set = set!["time.step=Fixed(Us(100))", "time.frame_interval=Us(100)"];
    let mut simulation = Simulation::new(&scene("elastic_gas", &set)).expect("is built");
    simulation.run(0, 5000, &mut [], &mut |_| true).expect("each frame at the second attempt at the latest");
    assert!((1..50).contains(&simulation.repeated_frames()), "{}", simulation.repeated_frames());
    near(simulation.clock(), 0.5, 1e-12, "time");
}

#[test]
fn nothing_and_one_tablet() {
    let (code, message, _) = of_run("small_bed", &["--set", "batches=[]"]);
    assert!(code == 2 && message.contains("give batches or bodies"), "{message}");
    let (code, message, _) =
        of_run("small_bed", &["--set", "batches[0].count=1", "--set", "time.duration=Ms(100)"]);
    assert_eq!(code, 0, "{message}");
}

#[test]
fn a_centrifuging_drum_loses_nothing() {
    for rpm in [120, 170] {
        let set =
            [format!("drum.speed=Rpm({rpm})"), "batches[0].count=20".into(), "time.duration=Ms(300)".into()];
        let mut simulation = Simulation::new(&scene("small_bed", &set)).expect("runs");
        simulation.fill(&mut |_| true).expect("fills");
        simulation.run(0, 15, &mut [], &mut |_| true).expect("loses no tablet");
        assert_eq!(simulation.states().len(), 20);
    }
}

#[test]
fn a_tablet_wedged_in_a_corner_stays_finite() {
    // Between two planes 1 % closer than the ball is wide: pressed from both sides.
    let set = ["boundaries=[(surface: Plane(normal: (0, 1, 0)), material: \"m\"), (surface: Plane(point: Mm(0, 3.96, 0), normal: (0, -1, 0)), material: \"m\")]",
        "pairs=[(between: (\"m\", \"m\"), friction: 0.5, restitution: 0.5), (between: (\"m\", \"rigid\"), friction: 0.5, restitution: 0.5)]",
        "bodies[0].position=Mm(0, 1.97, 0)"].map(String::from);
    let end = run("spin_to_roll", &set)[0];
    close(end.position.y, 1.98e-3, 2e-5, "in the middle");
    assert!(end.spin.norm() < 1e-3 && end.velocity.norm() < 1e-5, "held fast: {end:?}");
}

/// 10 000 tablets of 30 spheres each on a lattice: a few steps in less than 2 GB.
#[test]
fn ten_thousand_tablets_fit() {
    let folder = tempfile::tempdir().expect("can be made");
    let row = |k: u32| {
        let [x, y, z] = [k % 25, k / 25 % 20, k / 500].map(|n| 0.018 * f64::from(n));
        format!("{x},{y},{z}\n")
    };
    let rows: String = (0..10_000).map(row).collect();
    std::fs::write(folder.path().join("lattice.csv"), format!("x,y,z\n{rows}")).expect("can be written");
    let text = r#"(format: 1, title: "many", materials: {"m": (shear_modulus: MPa(1), poisson: 0.25)},
        pairs: [(between: ("m", "m"), friction: 0.5, restitution: 0.5)],
        shapes: {"round": (recipe: Round(diameter: Mm(15.9), band: Mm(3.2452), cap: Compound(height: Mm(1.6973), exponent: 2.8823)), spheres: 30)},
        bodies: [(shape: "round", material: "m", mass: G(1.3), poses: "lattice.csv")],
        time: (duration: Ms(1), frame_interval: Us(500)))"#;
    let path: PathBuf = folder.path().join("many.ron");
    std::fs::write(&path, text).expect("can be written");
    let (ended, history) = attempt(&Scene::load(&path, &[]).expect("is a scene"));
    ended.expect("runs");
    assert_eq!(history[1].1.len(), 10_000);
    if let Ok(status) = std::fs::read_to_string("/proc/self/status") {
        let peak = status.lines().find_map(|l| l.strip_prefix("VmHWM:")).expect("Linux tells it");
        let kib: f64 = peak.trim().trim_end_matches(" kB").parse().expect("a number");
        assert!(kib < 2.0 * 1024.0 * 1024.0, "{kib} KiB");
    }
}

#[test]
fn crooked_scenes_are_refused_with_their_place() {
    for (set, what) in [
        ("gravity=MPerS2(NaN, 0, 0)", "gravity"),
        ("bodies[0].mass=Kg(0)", "bodies[0].mass"),
        ("shapes.ball.recipe=Sphere(diameter: Mm(-1))", "shapes.ball.recipe.diameter"),
        (
            "shapes.ball.recipe=Clump(file: \"unit_ball.txt\", inertia_per_mass: Mm2(1e-9, 1, 1))",
            "shapes.ball",
        ),
        ("bodies[0].poses=\"no.csv\"", "there is no file"),
    ] {
        refused("hertz_impact", &["--set", set], &[what]);
    }
    let dressed = std::fs::read_to_string(folder().join("two_spheres.ron")).expect("is text");
    let dressed = format!("\u{feff}{}", dressed.replace('\n', "\r\n"));
    assert!(Scene::parse(&dressed, "dressed.ron", Path::new("."), &[]).is_ok(), "byte order mark and CRLF");
    let comma = Scene::parse(&dressed.replace("0.35", "0,35"), "comma.ron", Path::new("."), &[]);
    assert!(comma.expect_err("is refused").to_string().starts_with("comma.ron:1"), "decimal comma");
}

#[test]
fn tiny_speeds_cost_no_more() {
    let time = |speed: &str| {
        let set = set![
            "bodies[0].velocity=MPerS(0, {speed}, 0)",
            "bodies[0].spin=RadPerS({speed}, 0, 0)",
            "time.frame_interval=Us(5)",
            "time.duration=Ms(5)"
        ];
        let scene = scene("hertz_impact", &set);
        let once = || {
            let start = std::time::Instant::now();
            attempt(&scene).0.expect("runs");
            start.elapsed().as_secs_f64()
        };
        (0..7).map(|_| once()).fold(f64::INFINITY, f64::min)
    };
    let (tiny, plain) = (time("1e-300"), time("1e-3"));
    assert!(tiny < 2.0 * plain + 2e-3, "{tiny} s for {plain} s");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told() {
    // Files may have no byte: every write fails as on a full disk.
    let out = tempfile::tempdir().expect("can be made");
    let scene = folder().join("two_spheres.ron");
    let line = format!(
        "trap '' XFSZ; ulimit -f 0; exec {} run {} --out {}/run",
        env!("CARGO_BIN_EXE_pancoat"),
        scene.display(),
        out.path().display()
    );
    let output = std::process::Command::new("bash").args(["-c", &line]).output().expect("starts");
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("cannot write"), "{message}");
}
