//! `pancoat predict` and `pancoat compare` on a run of a few almond tablets, with a scan of known truth.

#[path = "support/browser.rs"]
mod browser;

use assert_cmd::Command;
use nalgebra::{UnitQuaternion, Vector3};
use pancoat::report::PanelRow;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::time::{Duration, Instant};

fn pancoat() -> Command {
    Command::cargo_bin("pancoat").expect("is built")
}

fn arguments(out: &Path, seconds: &str) -> Vec<String> {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/almond.ron");
    let mut arguments = vec!["run".to_owned(), scene.display().to_string()];
    arguments
        .extend(["--out", &out.display().to_string(), "--seconds", seconds, "--quiet"].map(String::from));
    let few = [
        "batches[0].mass=G(120)",
        "time.settle=For(Ms(300))",
        "shapes.almond.spheres=12",
        "shapes.almond.panels=600",
    ];
    arguments.extend(few.iter().flat_map(|set| ["--set".to_owned(), (*set).to_owned()]));
    arguments
}

/// A finished run of two blocks of time.
static RUN: LazyLock<(tempfile::TempDir, PathBuf)> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("can be made");
    let out = folder.path().join("almond");
    pancoat().args(arguments(&out, "4")).assert().success();
    (folder, out)
});

fn stdout(command: &mut Command) -> String {
    String::from_utf8(command.assert().success().get_output().stdout.clone()).expect("is text")
}

#[test]
fn a_run_predicts_its_limit_its_times_and_how_many_to_measure() {
    let text = stdout(pancoat().arg("predict").arg(&RUN.1).args(["--target", "0.3", "--error", "0.05"]));
    for part in ["limit of CoV_intra", "noise K", "CoV_intra                 0.3 ", "for +-5 %"] {
        assert!(text.contains(part), "{part} in\n{text}");
    }
}

#[test]
fn beds_are_taken_together() {
    let folder = tempfile::tempdir().expect("can be made");
    let other = folder.path().join("other");
    pancoat().args(arguments(&other, "4")).args(["--set", "seed=2"]).assert().success();
    let text = stdout(pancoat().arg("predict").args([&RUN.1, &other]));
    let limit = |part: &str| {
        let line = part.lines().find(|line| line.contains("limit of CoV_intra")).expect("has a limit");
        let numbers =
            line.split(|c: char| !c.is_ascii_digit() && c != '.').filter_map(|word| word.parse::<f64>().ok());
        numbers.collect::<Vec<_>>()
    };
    let (each, together) = text.split_once("all 2 beds").expect("takes them together");
    let (first, second) = each.rsplit_once("limit of CoV_intra").expect("has two beds");
    let (first, second) = (limit(first)[0], limit(&format!("limit of CoV_intra{second}"))[0]);
    let [value, low, high] = limit(together)[..] else { panic!("no interval in {together}") };
    assert!((value - 0.5 * (first + second)).abs() < 1e-4, "{text}");
    // Student's t of two values: 12.706 times half their distance.
    let half = 6.353 * (first - second).abs();
    assert!((high - value - half).abs() < 2e-3 && (low - (value - half).max(0.0)).abs() < 2e-3, "{text}");

    let same = pancoat().arg("predict").args([&RUN.1, &RUN.1]).assert().code(2);
    let error = String::from_utf8_lossy(&same.get_output().stderr).into_owned();
    assert!(error.contains("the same run") && error.contains("--set seed=2"), "{error}");
}

#[test]
fn a_run_predicts_while_it_runs() {
    let folder = tempfile::tempdir().expect("can be made");
    let out = folder.path().join("almond");
    let mut run = std::process::Command::new(assert_cmd::cargo::cargo_bin!("pancoat"))
        .args(arguments(&out, "600"))
        .spawn()
        .expect("starts");
    let start = Instant::now();
    let told = loop {
        let output = pancoat().arg("predict").arg(&out).output().expect("runs");
        let known = String::from_utf8_lossy(&output.stdout).contains("noise K");
        let ended = run.try_wait().expect("is watched").is_some();
        if known || ended || start.elapsed() > Duration::from_mins(4) {
            break output;
        }
        std::thread::sleep(Duration::from_millis(200));
    };
    assert!(run.try_wait().expect("is watched").is_none(), "it still runs");
    run.kill().expect("stops");
    run.wait().expect("ended");
    assert!(told.status.success(), "{}", String::from_utf8_lossy(&told.stderr));
    assert!(String::from_utf8_lossy(&told.stdout).contains("noise K"));
}

#[test]
fn runs_side_by_side_make_a_page() {
    let page = RUN.0.path().join("compare.html");
    let table = RUN.0.path().join("runs.csv");
    let mut command = pancoat();
    command.arg("compare").args([&RUN.1, &RUN.1, &RUN.1]).arg("--out").arg(&page).arg("--csv").arg(&table);
    let text = stdout(&mut command);
    let rows = csv::Reader::from_path(&table).expect("is a table").records().count();
    assert_eq!(rows, 3);
    assert_eq!(text.lines().filter(|line| line.starts_with("almond")).count(), 3, "{text}");
    if let Some(dom) = browser::dump_dom(&page) {
        let head = &dom[..300];
        assert!(head.contains("data-charts=\"3\"") && !head.contains("data-fault"), "{head}");
    }
}

/// The run's average tablet, three times as thick, as a scanner has it: turned, shifted, with rubbish at places that
/// hardly reflect.
fn scan() -> String {
    let mut reader = csv::Reader::from_path(RUN.1.join("panels.csv")).expect("is there");
    let turn = UnitQuaternion::from_euler_angles(0.4, -0.3, 1.1);
    let mut table = String::from("x_mm,y_mm,z_mm,thickness_um,reflectivity_percent\n");
    for (k, row) in reader.deserialize::<PanelRow>().enumerate() {
        let row = row.expect("is a panel");
        let place = turn * Vector3::new(row.x_mm, row.y_mm, row.z_mm) + Vector3::new(30.0, -4.0, 7.0);
        let (thickness, reflectivity) = if k % 9 == 0 { (99.0, 5.0) } else { (3.0 * row.average_um, 25.0) };
        let _ = writeln!(table, "{},{},{},{thickness},{reflectivity}", place.x, place.y, place.z);
    }
    table
}

#[test]
fn a_scan_is_compared_with_the_average_tablet() {
    let (file, page) = (RUN.0.path().join("scan.csv"), RUN.0.path().join("thz.html"));
    fs::write(&file, scan()).expect("can be written");
    let text = stdout(pancoat().arg("compare").arg(&RUN.1).arg("--thz").arg(&file).arg("--out").arg(&page));
    let figure = |name: &str| -> f64 {
        let line =
            text.lines().find(|line| line.starts_with(name)).unwrap_or_else(|| panic!("{name} in\n{text}"));
        line.trim_end_matches(" %").rsplit(' ').next().and_then(|x| x.parse().ok()).expect("is a number")
    };
    assert!((figure("Factor on the simulated") - 3.0).abs() < 0.03);
    assert!(figure("Correlation") > 0.99);
    assert!((figure("Surface covered") - 100.0 * 8.0 / 9.0).abs() < 3.0);
    assert!((figure("CoV, measured") / figure("CoV, simulated") - 1.0).abs() < 0.02);
    if let Some(dom) = browser::dump_dom(&page) {
        let head = &dom[..300];
        assert!(head.contains("data-charts=\"6\"") && !head.contains("data-fault"), "{head}");
    }
}

#[test]
fn faults_say_which_file_and_exit_with_2() {
    let file = RUN.0.path().join("unitless.csv");
    fs::write(&file, "x,y,z,thickness,reflectivity\n1,2,3,4,5\n").expect("can be written");
    let assert = pancoat().arg("compare").arg(&RUN.1).arg("--thz").arg(&file).assert().code(2);
    let stderr = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
    assert!(stderr.contains("unitless.csv") && stderr.contains("x_mm"), "{stderr}");
    pancoat().args(["predict", "nowhere"]).assert().code(2);
    pancoat().arg("compare").assert().code(2);
}
