//! The program as a user runs it: exit codes, messages, and what lies in the run folder.

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

/// A few coarse spheres in a small drum, sprayed from above: a second of work.
const SMALL: &str = r#"(
    format: 1,
    title: "a few balls",
    materials: {"tablet": (shear_modulus: MPa(1), poisson: 0.25)},
    pairs: [(between: ("tablet", "tablet"), friction: 0.5, restitution: 0.5)],
    shapes: {"ball": (recipe: Sphere(diameter: Mm(20)), panels: 80)},
    batches: [(shape: "ball", material: "tablet", tablet_mass: G(4), count: 12)],
    drum: (diameter: Mm(120), width: Mm(60), speed: Rpm(40), material: "tablet", facets: 24),
    time: (step: PerContact(20), settle: For(Ms(100)), duration: Ms(400), frame_interval: Ms(20)),
    spray: (
        spanwise: Mm(50), streamwise: Mm(60), pixels: (64, 64),
        aim: Fixed(target: Mm(10, -40, 0), normal: (0, 1, 0)), deposit: (rate: GPerMin(7.5), solids: 0.2),
    ),
    outputs: (series_interval: Ms(100)),
)"#;

fn pancoat(arguments: &[&str]) -> Assert {
    Command::cargo_bin("pancoat").expect("is built").args(arguments).assert()
}

fn stdout(assert: &Assert) -> String {
    String::from_utf8(assert.get_output().stdout.clone()).expect("is text")
}

fn stderr(assert: &Assert) -> String {
    String::from_utf8(assert.get_output().stderr.clone()).expect("is text")
}

fn record(folder: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(folder.join("run.json")).expect("has a record"))
        .expect("is JSON")
}

/// A temporary folder with the small scene, its path, and the path of a run folder in it.
fn small() -> (tempfile::TempDir, String, String) {
    let folder = tempfile::tempdir().expect("can be made");
    let scene = folder.path().join("small.ron");
    fs::write(&scene, SMALL).expect("can be written");
    let out = folder.path().join("out").display().to_string();
    let scene = scene.display().to_string();
    (folder, scene, out)
}

#[test]
fn a_run_leaves_a_whole_folder() {
    let (_folder, scene, out) = small();
    let assert = pancoat(&["run", &scene, "--out", &out, "--set", "seed=7"]).success();
    assert_eq!(stdout(&assert).trim(), out);
    assert!(stderr(&assert).contains("spraying: "), "{}", stderr(&assert));
    let out = Path::new(&out);

    let text = fs::read_to_string(out.join("scene.ron")).expect("has its scene");
    assert!(text.contains("seed: 7") && text.starts_with(SMALL.split(',').next().expect("has a start")));
    let record = record(out);
    assert_eq!((&record["status"], &record["seed"]), (&"done".into(), &7.into()));
    assert_eq!(record["scene_hash"], blake3::hash(text.as_bytes()).to_hex().to_string());
    assert_eq!(record["derived"]["bodies"], 12);
    for key in ["cov_intra", "cov_inter", "mean_speed_m_per_s", "kinetic_energy_J", "spray_efficiency"] {
        assert!(record["results"][key].as_f64().is_some_and(|x| x > 0.0), "{key}: {}", record["results"]);
    }
    for key in ["wall_s", "simulated_s", "steps"] {
        assert!(record["performance"][key].as_f64().is_some_and(|x| x > 0.0), "{key}");
    }

    let rows = |name: &str| {
        let mut reader = csv::Reader::from_path(out.join(name)).expect("is a table");
        let columns = reader.headers().expect("has columns").iter().collect::<Vec<_>>().join(",");
        let rows = reader.records().map(|row| row.expect("is a row")).collect::<Vec<_>>();
        (columns, rows)
    };
    let (columns, series) = rows("series.csv");
    assert_eq!(
        columns,
        "time_s,cov_intra,cov_intra_each,cov_intra_average_tablet,cov_total,cov_inter,sd_cov_intra,mean_thickness_um"
    );
    assert_eq!(
        series.iter().map(|row| row[0].parse().expect("a time")).collect::<Vec<f64>>(),
        [0.1, 0.2, 0.3, 0.4]
    );
    assert_eq!(series[3][1].parse::<f64>().ok(), record["results"]["cov_intra"].as_f64());
    assert_eq!(rows("tablets.csv").1.len(), 12);
    let (columns, panels) = rows("panels.csv");
    assert_eq!(columns, "panel,shape,region,x_mm,y_mm,z_mm,nx,ny,nz,area_mm2,average_um,representative_um");
    assert_eq!(record["derived"]["panels"]["ball"], panels.len());

    // All solids that hit tablets are on them: 7.5 g/min × 20 % × 0.4 s × efficiency.
    let coat: f64 = rows("tablets.csv").1.iter().map(|row| row[3].parse::<f64>().expect("a mass")).sum();
    let sprayed_mg =
        7.5 / 60.0 * 0.2 * 0.4 * 1e3 * record["results"]["spray_efficiency"].as_f64().expect("is given");
    assert!((coat / sprayed_mg - 1.0).abs() < 1e-9, "{coat} mg on tablets, {sprayed_mg} mg sprayed on them");

    // The report can be made anew from what is stored, and comes out the same.
    let first = fs::read(out.join("report.html")).expect("has a report");
    fs::remove_file(out.join("report.html")).expect("can be removed");
    pancoat(&["report", &out.display().to_string()]).success();
    assert_eq!(fs::read(out.join("report.html")).expect("has a report"), first);
}

#[test]
fn the_same_scene_gives_the_same_bits_on_any_number_of_threads() {
    let (folder, scene, _) = small();
    let hashes = ["1", "2"].map(|threads| {
        let out = folder.path().join(threads);
        pancoat(&["run", &scene, "--threads", threads, "--out", &out.display().to_string(), "--quiet"])
            .success();
        let record = record(&out);
        (record["state_hash"].clone(), record["results"].clone())
    });
    assert!(hashes[0].0.is_string());
    assert_eq!(hashes[0], hashes[1]);
}

/// One tablet has no spread over tablets, and nothing is divided by none; without any there is no scene.
#[test]
fn a_single_tablet_is_coated() {
    let (folder, scene, out) = small();
    pancoat(&["run", &scene, "--quiet", "--set", "batches[0].count=1", "--out", &out]).success();
    let results = &record(Path::new(&out))["results"];
    assert!(results["cov_intra"].as_f64().is_some_and(|cov| cov > 0.0), "{results}");
    assert_eq!(results["cov_inter"], 0.0);
    assert!(results.as_object().expect("is a table").values().all(|value| !value.is_null()), "{results}");
    let series = fs::read_to_string(Path::new(&out).join("series.csv")).expect("is there");
    assert!(!series.contains("NaN") && !series.contains("inf,"), "{series}");
    for command in ["predict", "compare", "report"] {
        Command::cargo_bin("pancoat")
            .expect("is built")
            .args([command, &out])
            .current_dir(&folder)
            .assert()
            .success();
    }
    pancoat(&["run", &scene, "--set", "batches[0].count=0"]).code(2);
}

#[test]
fn a_folder_of_another_scene_is_left_alone() {
    let (_folder, scene, out) = small();
    let run = |seconds: &str| {
        pancoat(&["run", &scene, "--set", "spray=None", "--seconds", seconds, "--out", &out, "--quiet"])
    };
    assert_eq!(stderr(&run("0.05").success()), "");
    let before = record(Path::new(&out));
    let refused = run("0.1").code(2);
    assert!(stderr(&refused).contains("holds the run of another scene"), "{}", stderr(&refused));
    assert_eq!(record(Path::new(&out)), before);
    run("0.05").success();
}

#[test]
fn faults_of_the_input_exit_with_2() {
    let (folder, scene, out) = small();
    let wrong = |arguments: &[&str], message: &str| {
        let assert = pancoat(arguments).code(2);
        assert!(stderr(&assert).contains(message), "{arguments:?}: {}", stderr(&assert));
        assert_eq!(stdout(&assert), "");
    };
    wrong(&["run", &scene, "--out", &out, "--set", "drum.sped=Rpm(3)"], "(did you mean `speed`?)");
    wrong(&["check", "absent.ron"], "absent.ron: cannot read the scene");
    wrong(&["check", "heart"], "no scene of that name is built in; known: round, sphere");
    wrong(&["run", &scene, "--seconds", "0"], "must be above 0");
    wrong(&["run", &scene, "--max-wall", "soon"], "expected a time such as 90s, 30m or 2h");
    wrong(
        &["run", &scene, "--out", &out, "--set", "time.step=Fixed(Ms(20))"],
        "refused: the time step leaves",
    );
    if cfg!(target_os = "linux") {
        let many =
            ["--set", "batches[0].count=10000000", "--set", "shapes.ball.recipe=Sphere(diameter: Mm(0.2))"];
        let arguments =
            [&["run", &scene, "--out", &out, "--set", "shapes.ball.panels=400"], &many[..]].concat();
        wrong(&arguments, "refused: the run needs about ");
    }
    wrong(&["drum", &scene, "--set", "drum=None", "--set", "batches=[]"], "nothing that moves");
    wrong(&["report", &folder.path().display().to_string()], "cannot read");
    assert!(!Path::new(&out).exists(), "a refused run leaves no folder");
}

#[test]
fn check_says_what_is_on_and_what_is_left_out() {
    let on = stdout(&pancoat(&["check", "round"]).success());
    for line in [
        "batch               769 tablets \"round\" of 1300 mg, 50 spheres",
        "drum                250 mm across, 100 mm wide, 22.0 rpm, 4 baffles",
        "spray               76.2 x 38.1 mm, 512 x 256 pixels, square to the bed",
        "steps per contact   12.",
        "steps               at most",
        "run time            ",
        "Rayleigh fraction",
        "static overlap",
        "memory              about",
    ] {
        assert!(on.contains(line), "{line} is not in\n{on}");
    }
    let left_out: Vec<_> = on.lines().filter(|line| line.starts_with("left out")).collect();
    assert_eq!(left_out, ["left out            energy audit: not asked for"]);
    let off =
        stdout(&pancoat(&["check", "sphere", "--set", "spray=None", "--set", "drum.baffles=None"]).success());
    for line in
        ["left out            panels, coater", "left out            baffles", "left out            clump"]
    {
        assert!(off.contains(line), "{line} is not in\n{off}");
    }
}

/// The paper's round tablet: Table 4 within 0.5 %, band over face area within 1 %.
#[test]
fn shapes_are_measured_and_written() {
    let folder = tempfile::tempdir().expect("can be made");
    let out = folder.path().display().to_string();
    let text = stdout(&pancoat(&["shape", "round", "--json", "--out", &out]).success());
    let sheet: Value = serde_json::from_str(text.trim()).expect("is JSON");
    let close = |key: &str, wanted: f64, within: f64| {
        let found = sheet[key].as_f64().expect("is a number");
        assert!((found / wanted - 1.0).abs() < within, "{key}: {found}");
    };
    close("length_mm", 15.9, 0.005);
    close("width_mm", 15.9, 0.005);
    close("thickness_mm", 6.64, 0.005);
    close("area_mm2", 584.5, 0.005);
    close("volume_mm3", 1042.0, 0.005);
    close("sphericity", 0.8502, 0.005);
    close("band_to_face", 0.3844, 0.01);
    assert_eq!(sheet["table_4"]["aspect_ratio"], 2.556);
    let words = stdout(&pancoat(&["shape", "triangular"]).success());
    for line in
        ["aspect ratio (L + W)/(2 T)          1.8735 (Table 4: 1.886)", "0.6151, its digits in another order"]
    {
        assert!(words.contains(line), "{line} is not in\n{words}");
    }
    assert_eq!(sheet["clump"]["spheres"], 50);
    let largest = sheet["clump"]["largest_deviation_um"].as_f64().expect("is known");
    assert!((50.0..2000.0).contains(&largest), "{largest}");
    for file in ["round.stl", "round.obj", "round.vtp", "round.html", "round_clump.txt"] {
        assert!(folder.path().join(file).exists(), "{file}");
    }
    let clump = fs::read_to_string(folder.path().join("round_clump.txt")).expect("is there");
    assert_eq!(clump.lines().filter(|line| line.split(' ').count() == 4).count(), 50);
    assert!(stdout(&pancoat(&["shape", "sphere"]).success()).contains("clump of 1 "));
}

/// Files of a tetrahedron, 8 mm long: one facet short, and one facet turned.
#[test]
fn mesh_faults_get_one_line_and_repairs_are_told() {
    let corners = ["0 0 0", "8 0 0", "0 8 0", "0 0 8"];
    let facet = |[a, b, c]: [usize; 3]| {
        let [a, b, c] = [a, b, c].map(|k| format!("vertex {}\n", corners[k]));
        format!("facet normal 0 0 0\nouter loop\n{a}{b}{c}endloop\nendfacet\n")
    };
    let stl = |facets: &[[usize; 3]]| {
        format!("solid t\n{}endsolid t\n", facets.iter().map(|f| facet(*f)).collect::<String>())
    };
    let (folder, scene, out) = small();
    let set = "shapes.ball=(recipe: Mesh(file: \"t.stl\", unit: Mm(1)), spheres: 5, panels: 80)";
    let with = |facets: &[[usize; 3]], arguments: &[&str]| {
        fs::write(folder.path().join("t.stl"), stl(facets)).expect("can be written");
        pancoat(&[arguments, &["--set", set]].concat())
    };
    let good = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    for command in ["check", "run", "shape"] {
        let out = if command == "run" { ["--out", &out].to_vec() } else { Vec::new() };
        let assert = with(&good[..3], &[&[command, &scene], &out[..]].concat()).code(2);
        let told = stderr(&assert);
        assert_eq!(told.lines().count(), 1, "{told}");
        assert!(told.contains("t.stl: the surface is open: 3 edges have a facet on one side only"), "{told}");
    }
    let turned = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 2, 3]];
    let repair = "turned 1 facets that were wound against the others, the first is facet 4";
    let told = stdout(&with(&turned, &["check", &scene]).success());
    assert!(told.contains(repair), "{told}");
    assert!(stdout(&with(&turned, &["shape", &scene]).success()).contains(repair));
    with(&turned, &["run", &scene, "--out", &out, "--quiet", "--set", "spray=None"]).success();
    let warnings = record(Path::new(&out))["warnings"].to_string();
    assert!(warnings.contains(repair), "{warnings}");
}

#[test]
fn a_new_scene_is_one_that_runs_and_nothing_is_written_over() {
    let folder = tempfile::tempdir().expect("can be made");
    let file = folder.path().join("mine.ron").display().to_string();
    pancoat(&["new", "half_moon", "--out", &file]).success();
    pancoat(&["check", &file]).success();
    let assert = pancoat(&["new", "oval", "--out", &file]).code(2);
    assert!(stderr(&assert).contains("mine.ron"), "{}", stderr(&assert));
    assert!(fs::read_to_string(&file).expect("is there").contains("half_moon"));
    pancoat(&["new", "heart"]).code(2);
}

#[test]
fn the_drum_is_written_as_a_mesh() {
    let (folder, scene, _) = small();
    let file = folder.path().join("drum.stl");
    pancoat(&["drum", &scene, "--out", &file.display().to_string()]).success();
    let mesh = pancoat::shapes::read_surface(&file, 1e-3).expect("is STL").mesh;
    let widest = mesh.vertices.iter().map(|v| v.x.hypot(v.y)).fold(0.0, f64::max);
    assert!((widest - 0.06).abs() < 1e-3, "{widest}");
}

#[test]
fn a_deadline_stops_with_75_and_keeps_what_there_is() {
    let (_folder, scene, out) = small();
    pancoat(&["run", &scene, "--seconds", "1000", "--max-wall", "1s", "--out", &out]).code(75);
    let record = record(Path::new(&out));
    assert_eq!(record["status"], "stopped");
    let coated = record["performance"]["coated_s"].as_f64().expect("is given");
    assert!(coated > 0.0 && coated < 1000.0, "{coated}");
    assert!(record["results"]["cov_intra"].is_f64());
}

/// Exactly recorded poses, and the same as a table, are coated to the very files of the run.
#[test]
fn stored_poses_are_coated_to_the_files_of_the_run() {
    let (folder, scene, out) = small();
    pancoat(&["run", &scene, "--set", "outputs.record=Exact", "--out", &out, "--backend", "cpu"]).success();
    let recording = Path::new(&out).join("poses.bin");
    let mut table = "time_s,id,x,y,z,qw,qx,qy,qz\n".to_owned();
    for frame in pancoat::observers::PoseReader::open(&recording).expect("a recording") {
        let frame = frame.expect("a whole frame");
        for (id, b) in frame.bodies.iter().enumerate() {
            let (p, q) = (b.position, b.orientation);
            writeln!(table, "{},{id},{},{},{},{},{},{},{}", frame.time, p.x, p.y, p.z, q.w, q.i, q.j, q.k)
                .expect("a string takes all");
        }
    }
    let file = folder.path().join("poses.csv");
    fs::write(&file, table).expect("can be written");
    for (poses, name) in [(recording, "coated"), (file, "from_table")] {
        let again = folder.path().join(name).display().to_string();
        let poses = poses.display().to_string();
        let arguments = ["coat", &scene, "--poses", &poses, "--out", &again, "--threads", "2"];
        let assert = pancoat(&[&arguments[..], &["--backend", "cpu"]].concat()).success();
        assert_eq!(stdout(&assert).trim(), again);
        for product in ["series.csv", "panels.csv", "tablets.csv", "coating.vtp"] {
            let read = |folder: &str| fs::read(Path::new(folder).join(product)).expect("is there");
            assert!(read(&again) == read(&out), "{name}: {product}");
        }
        let (coated, ran) = (record(Path::new(&again)), record(Path::new(&out)));
        assert_eq!(coated["derived"]["poses"], poses);
        assert_eq!(coated["results"]["cov_intra"], ran["results"]["cov_intra"]);
        assert!(coated["results"].get("speed_in_spray_m_per_s").is_none());
        assert!(Path::new(&again).join("report.html").exists() && Path::new(&again).join("bed.png").exists());
    }
}

#[test]
fn poses_that_do_not_fit_exit_with_2() {
    let (folder, scene, out) = small();
    let table = folder.path().join("poses.csv");
    let coat = |rows: &str, more: &[&str]| {
        fs::write(&table, format!("time_s,id,x,y,z,qw,qx,qy,qz\n{rows}")).expect("can be written");
        let poses = table.display().to_string();
        let arguments = [&["coat", &scene, "--poses", &poses, "--out", &out], more].concat();
        stderr(&pancoat(&arguments).code(2))
    };
    let apart = "0,0,0,-0.04,0,1,0,0,0\n0.5,0,0,-0.04,0,1,0,0,0\n";
    assert!(
        coat(apart, &[]).contains("frames are 0.5 s apart, in the scene 0.02 s: set time.frame_interval")
    );
    assert!(coat("0,0,0,0,0,1,1,0,0\n", &[]).contains("poses.csv:2: the quaternion is not of length 1"));
    assert!(coat("", &[]).contains("no whole frame"));
    assert!(coat(apart, &["--set", "spray=None"]).contains("the scene has no spray"));
    assert!(stderr(&pancoat(&["coat", &scene, "--poses", "nowhere.bin"]).code(2)).contains("nowhere.bin"));
    assert!(!Path::new(&out).exists());
}

/// Whatever draws the spray, the run is done and the record says what it was.
#[test]
fn every_backend_ends_well_and_is_recorded() {
    for backend in ["auto", "cpu", "gpu", "gpu-software"] {
        let (_folder, scene, out) = small();
        let set = "spray.deposit=(mean_thickness: Um(40))";
        pancoat(&["run", &scene, "--backend", backend, "--out", &out, "--set", set]).success();
        let record = record(Path::new(&out));
        let drawn = record["backend"].as_str().expect("is given");
        match backend {
            "cpu" => assert_eq!(drawn, "cpu"),
            _ if cfg!(not(feature = "gpu")) => {
                assert_eq!(drawn, "cpu: this program was built without support for graphics cards");
            }
            "gpu-software" => {
                assert!(drawn.starts_with("gpu: ") || drawn.starts_with("cpu: no graphics card"));
            }
            _ => assert!(drawn.starts_with("gpu: ") || drawn.starts_with("cpu: "), "{drawn}"),
        }
        // A measured thickness is what comes out.
        let mean = record["results"]["mean_thickness_um"].as_f64().expect("is given");
        assert!((mean - 40.0).abs() < 1e-9, "{mean}");
    }
    let (_folder, scene, out) = small();
    pancoat(&["run", &scene, "--backend", "abacus", "--out", &out]).code(2);
}

/// While it sprays and, without a row of results yet, while it settles.
#[cfg(unix)]
#[test]
fn signals_stop_with_75_and_keep_what_there_is() {
    for (signal, settle, sign) in [
        ("-TERM", "time.settle=For(Ms(100))", "series.csv"),
        ("-INT", "time.settle=For(Ms(100))", "series.csv"),
        ("-TERM", "time.settle=For(S(1000))", "run.json"),
    ] {
        let (_folder, scene, out) = small();
        let out = Path::new(&out);
        let child = std::process::Command::new(assert_cmd::cargo::cargo_bin("pancoat"))
            .args(["run", &scene, "--seconds", "1000", "--set", settle, "--quiet", "--out"])
            .arg(out)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("starts");
        let begun = Instant::now();
        while !out.join(sign).exists() && begun.elapsed() < Duration::from_mins(1) {
            std::thread::sleep(Duration::from_millis(20));
        }
        let kill = std::process::Command::new("kill").args([signal, &child.id().to_string()]).status();
        assert!(kill.is_ok_and(|status| status.success()));
        let ended = child.wait_with_output().expect("ends");
        assert_eq!(ended.status.code(), Some(75), "{signal} {settle}");
        let message = String::from_utf8_lossy(&ended.stderr);
        assert!(message.contains("stopped on request; what was simulated is in"), "{message}");
        let record = record(out);
        assert_eq!(record["status"], "stopped");
        assert!(record["state_hash"].is_string());
        let bodies =
            csv::Reader::from_path(out.join("bodies.csv")).expect("is a table").into_records().count();
        assert!(bodies == 12 || sign == "run.json" && bodies < 12, "{bodies}");
        let coated = record["performance"]["coated_s"].as_f64().expect("is known");
        assert_eq!(coated > 0.0, sign == "series.csv", "{coated}");
    }
}

#[test]
fn an_audited_run_tells_where_its_energy_went() {
    let (_folder, scene, out) = small();
    pancoat(&["run", &scene, "--out", &out, "--quiet", "--set", "outputs.energy=true"]).success();
    let energy = &record(Path::new(&out))["guards"]["energy"];
    for key in ["kinetic_J", "normal_dashpots_J", "sliding_J", "wall_work_J"] {
        assert!(energy[key].as_f64().is_some_and(|x| x > 0.0), "{key}: {energy}");
    }
    assert!(energy["residual_over_dissipated"].as_f64().is_some_and(|x| x.abs() < 0.05), "{energy}");
    let sets = ["--set", "outputs.energy=true", "--set", "contact.mode=Impulse(step: Ms(1))"];
    let refused = pancoat(&[&["check", &scene][..], &sets].concat()).code(2);
    assert!(stderr(&refused).contains("needs contact.mode: HertzMindlin"), "{}", stderr(&refused));
}

#[test]
fn accuracy_compares_settings_and_goes_on_where_it_stopped() {
    let (folder, scene, _) = small();
    let out = folder.path().join("accuracy").display().to_string();
    let arguments = ["accuracy", &scene, "--out", &out, "--seeds", "2", "--seconds", "0.2"];
    let run = |only: &str| pancoat(&[&arguments[..], &["--only", only]].concat()).success();
    let first = run("tangential,mode");
    assert!(stderr(&first).contains("run 10 of 10, about 0:0"), "{}", stderr(&first));
    let page = fs::read_to_string(stdout(&first).trim()).expect("has a page");
    assert!(page.contains("Impulse, 2 ms") && page.contains("Rescaled"));
    let mut table = csv::Reader::from_path(Path::new(&out).join("accuracy.csv")).expect("is a table");
    let columns = table.headers().expect("has columns").clone();
    let rows: Vec<csv::StringRecord> = table.records().map(|row| row.expect("is a row")).collect();
    assert_eq!(rows.len(), 6);
    let at = |name: &str| columns.iter().position(|column| column == name).expect("is a column");
    for row in &rows {
        assert!(row[at("mean_speed_m_per_s")].parse::<f64>().is_ok_and(|speed| speed > 0.0), "{row:?}");
        assert!(row[at("failure")].is_empty(), "{row:?}");
    }
    assert_eq!(rows.iter().filter(|row| &row[at("default")] == "1").count(), 2);

    let told = || fs::read_to_string(Path::new(&out).join("accuracy.md")).expect("has its tables");
    let before = told();
    let again = run("tangential,mode");
    assert!(!stderr(&again).contains("run 1 of"), "{}", stderr(&again));
    assert_eq!(told(), before);
    pancoat(&["accuracy", &scene, "--seeds", "1"]).code(2);
}
