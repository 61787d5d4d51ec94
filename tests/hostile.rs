//! Files of a size or form that no honest program writes: each is refused with one clear line and exit code 2, within
//! seconds and, on Linux, within 3 GB of address space.

use assert_cmd::Command;
use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::time::Duration;

/// A gigabyte, sparse on the disk: one line of zeros.
const GIGABYTE: u64 = 1 << 30;

/// A ball in a drum, and the tables and meshes that `files` names in place of its parts.
fn scene(recipe: &str, bodies: &str, flux: &str, wall: &str) -> String {
    format!(
        r#"(
            format: 1,
            materials: {{"m": (shear_modulus: MPa(1), poisson: 0.25)}},
            pairs: [(between: ("m", "m"), friction: 0.5, restitution: 0.5)],
            shapes: {{"ball": (recipe: {recipe})}},
            bodies: [(shape: "ball", material: "m", mass: G(1), {bodies})],
            drum: (diameter: Mm(100), width: Mm(60), speed: Rpm(20), material: "m"{wall}),
            time: (settle: None, duration: Ms(40)),
            {flux}
        )"#
    )
}

const BALL: &str = "Sphere(diameter: Mm(10))";
const MIDDLE: &str = "position: Mm(0, -40, 0)";
const SPRAY: &str = "spray: (spanwise: Mm(20), streamwise: Mm(20), pixels: (32, 32), deposit: (rate: GPerMin(1), solids: 0.2), \
     aim: Fixed(target: Mm(0, -40, 0), normal: (0, 1, 0))";

/// What `pancoat` says when it refuses its input, within limits of time and memory.
fn told(folder: &Path, arguments: &[&str]) -> String {
    let limit = if cfg!(target_os = "linux") { "ulimit -v 3000000; " } else { "" };
    let line = format!("{limit}exec \"$0\" \"$@\"");
    let output = Command::new("bash")
        .args(["-c", &line, env!("CARGO_BIN_EXE_pancoat")])
        .args(arguments)
        .env("RAYON_NUM_THREADS", "1")
        .current_dir(folder)
        .timeout(Duration::from_secs(30))
        .output()
        .expect("ends in time");
    let message = String::from_utf8(output.stderr).expect("is text");
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message:.500}");
    assert!(message.lines().count() == 1 && message.len() < 500, "{arguments:?}: {message:.1000}");
    message
}

fn sparse(path: &Path, head: &[u8], length: u64) {
    let mut file = File::create(path).expect("can be made");
    file.write_all(head).expect("can be written");
    file.set_len(length).expect("can be made sparse");
}

#[test]
fn lines_of_a_gigabyte() {
    let folder = tempfile::tempdir().expect("can be made");
    let folder = folder.path();
    for name in ["scene.ron", "line.csv", "line.txt", "line.stl", "line.obj", "line.ply"] {
        sparse(&folder.join(name), b"", GIGABYTE);
    }
    assert!(told(folder, &["check", "scene.ron"]).contains("scene.ron: the file has 1073741824 bytes"));

    let check = |text: &str| {
        fs::write(folder.join("s.ron"), text).expect("can be written");
        told(folder, &["check", "s.ron"])
    };
    let long = "line 1 is longer than 1048576 bytes";
    let clump = "Clump(file: \"line.txt\", inertia_per_mass: Mm2(1, 1, 1))";
    let table = "flux: Table(file: \"line.csv\"))";
    for (text, what) in [
        (scene(BALL, "poses: \"line.csv\"", "", ""), long),
        (scene(clump, MIDDLE, "", ""), long),
        (scene("Mesh(file: \"line.stl\", unit: Mm(1)), spheres: 5", MIDDLE, "", ""), "longer than 536 MB"),
        (scene(BALL, MIDDLE, "", ", wall: Mesh(file: \"line.obj\", unit: Mm(1))"), "longer than 536 MB"),
        (scene(BALL, MIDDLE, "", ", wall: Mesh(file: \"line.ply\", unit: Mm(1))"), "longer than 536 MB"),
    ] {
        let message = check(&text);
        assert!(message.contains(what), "{message}");
    }

    let coated = |flux: &str| {
        let text = scene(&format!("{BALL}, panels: 80"), MIDDLE, &format!("{SPRAY}, {flux}"), "");
        fs::write(folder.join("s.ron"), text).expect("can be written");
    };
    coated(table);
    assert!(told(folder, &["run", "s.ron", "--quiet"]).contains(long));
    coated("), outputs: (series_interval: Ms(20))");
    assert!(told(folder, &["coat", "s.ron", "--poses", "line.csv"]).contains(long));
    Command::cargo_bin("pancoat")
        .expect("is built")
        .args(["run", "s.ron", "--quiet", "--out", "done"])
        .current_dir(folder)
        .assert()
        .success();
    let message = told(folder, &["compare", "done", "--thz", "line.csv"]);
    assert!(message.contains(long), "{message}");
}

/// Below the longest file, the number of facets is what counts, and words are shown cut.
#[test]
fn meshes_of_ten_million_facets_and_endless_words() {
    let folder = tempfile::tempdir().expect("can be made");
    let folder = folder.path();
    let check = |name: &str| {
        let wall = format!(", wall: Mesh(file: \"{name}\", unit: Mm(1))");
        fs::write(folder.join("s.ron"), scene(BALL, MIDDLE, "", &wall)).expect("can be written");
        told(folder, &["check", "s.ron"])
    };
    let head = [&[0; 80][..], &10_000_000_u32.to_le_bytes()].concat();
    sparse(&folder.join("many.stl"), &head, 84 + 50 * 10_000_000);
    assert!(
        check("many.stl").contains("10000000 facets are too many; export a coarser mesh of at most 1000000")
    );

    // One face with three million corners.
    let corners = "v 0 0 0\nv 100 0 0\nv 0 100 0\nf".to_owned() + &" 1 2 3".repeat(1_000_000);
    fs::write(folder.join("face.obj"), corners).expect("can be written");
    assert!(check("face.obj").contains("1000001 facets are too many"));
    let ply = "ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list uint uint vertex_indices\nend_header\n";
    sparse(&folder.join("face.ply"), &[ply.as_bytes(), &[255; 4]].concat(), 100_000_000);
    assert!(check("face.ply").contains("4294967295 facets are too many"));

    let word = "a".repeat(50_000_000);
    for (name, text, what) in [
        ("word.stl", format!("solid s\n{word}\n"), ":2: `aaaa"),
        ("word.obj", format!("v 0 0 {word}\n"), ":1: `aaaa"),
        ("word.ply", format!("ply\n{word}\n"), ":2: `aaaa"),
    ] {
        fs::write(folder.join(name), text).expect("can be written");
        let message = check(name);
        assert!(message.contains(what) && message.contains('…'), "{message}");
    }
}
