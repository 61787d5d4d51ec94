//! The house rules that a compiler does not check: which room may name which, which outside crate lives in which room,
//! and how long a file may get.

use std::fs;
use std::path::{Path, PathBuf};

/// Rooms in the order in which data flows, and the rooms each may name beside itself.
const ROOMS: [(&str, &[&str]); 10] = [
    ("units", &[]),
    ("scene", &["units"]),
    ("shapes", &["scene"]),
    ("world", &["scene", "shapes"]),
    ("contact", &["scene", "shapes", "world"]),
    ("stepping", &["scene", "shapes", "world", "contact"]),
    ("models", &[]),
    ("observers", &["scene", "shapes", "stepping", "models"]),
    ("report", &["models"]),
    ("cli", &["units", "scene", "shapes", "contact", "stepping", "models", "observers", "report"]),
];

/// Outside crates and the only room that may name them.
const CRATES: [(&str, &str); 5] =
    [("rapier3d", "world"), ("ron", "scene"), ("clap", "cli"), ("indicatif", "cli"), ("plotly", "report")];

/// Lines of code and comments a file may have before its tests.
const LONGEST: usize = 400;

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder of the source") {
        let path = entry.expect("an entry of the folder").path();
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// Every source file with the room it is in (`""` for lib.rs and main.rs) and its text without tests.
fn sources() -> Vec<(PathBuf, String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let sources = rust_files(&root).into_iter().map(|path| {
        let inside = path.strip_prefix(&root).expect("below src").to_owned();
        let first = inside.iter().next().expect("a name").to_string_lossy().into_owned();
        let room = first.strip_suffix(".rs").unwrap_or(&first).to_owned();
        let room = if room == "lib" || room == "main" { String::new() } else { room };
        let text = fs::read_to_string(&path).expect("a text file");
        let code = text.split("#[cfg(test)]\nmod tests").next().expect("a first part").to_owned();
        (inside, room, code)
    });
    sources.collect()
}

/// Whether `line` names the path `name` as a word of its own.
fn names(line: &str, name: &str) -> bool {
    let code = line.split("//").next().unwrap_or_default();
    code.match_indices(name).any(|(at, _)| {
        let word = |c: char| c.is_alphanumeric() || c == '_';
        let before = code[..at].chars().next_back().is_some_and(word);
        let after = code[at + name.len()..].starts_with("::");
        !before && after
    })
}

#[test]
fn rooms_name_only_what_they_may() {
    let mut faults = Vec::new();
    for (path, room, code) in sources().iter().filter(|(_, room, _)| !room.is_empty()) {
        let (_, allowed) = ROOMS.iter().find(|(name, _)| name == room).expect("every folder is a room");
        for (number, line) in code.lines().enumerate() {
            for (other, _) in ROOMS.iter().filter(|(other, _)| other != room && !allowed.contains(other)) {
                if names(line, &format!("crate::{other}")) {
                    faults.push(format!("{}:{}: {room} names {other}", path.display(), number + 1));
                }
            }
            if line.contains("use crate::{") {
                faults.push(format!("{}:{}: name rooms one by one", path.display(), number + 1));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn outside_crates_stay_in_their_rooms() {
    let mut faults = Vec::new();
    for (path, room, code) in sources() {
        for (number, line) in code.lines().enumerate() {
            for (name, home) in CRATES.iter().filter(|(_, home)| *home != room) {
                if names(line, name) {
                    faults.push(format!("{}:{}: {name} belongs to {home}", path.display(), number + 1));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn files_stay_short() {
    let long: Vec<_> = sources()
        .into_iter()
        .map(|(path, _, code)| (path, code.lines().count()))
        .filter(|(_, lines)| *lines > LONGEST)
        .collect();
    assert!(long.is_empty(), "longer than {LONGEST} lines: {long:?}");
}
