//! Scene files against what the program says of them: every file in `scenes/` and `good/` loads, every file in `bad/`
//! gives exactly the messages that its last lines expect (`//^ line:column: path: message`, without the file's name).
//! `//set path=value` lines at the head of a file are overrides. `BLESS=1` rewrites the expectations.

use pancoat::scene::{Scene, SceneFaults, SceneText};
use std::fs;
use std::path::{Path, PathBuf};

mod overrides;
mod text;
mod units;
mod values;

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn scenes_in(name: &str) -> Vec<PathBuf> {
    let files = fs::read_dir(folder(name)).expect("the folder is part of the repository");
    let mut files: Vec<_> = files.map(|file| file.expect("can be listed").path()).collect();
    files.retain(|file| file.extension().is_some_and(|e| e == "ron"));
    files.sort();
    assert!(!files.is_empty(), "no scenes in {name}");
    files
}

fn messages(faults: &SceneFaults) -> Vec<String> {
    faults.to_string().lines().map(str::to_owned).collect()
}

#[test]
fn shipped_scenes_load() {
    for file in scenes_in("scenes") {
        Scene::load(&file, &[]).unwrap_or_else(|faults| panic!("{faults}"));
    }
}

#[test]
fn good_scenes_load() {
    for file in scenes_in("tests/scenes/good") {
        Scene::load(&file, &[]).unwrap_or_else(|faults| panic!("{faults}"));
    }
}

#[test]
fn bad_scenes_get_the_messages_they_expect() {
    let mut wrong = Vec::new();
    for file in scenes_in("tests/scenes/bad") {
        let text = fs::read_to_string(&file).expect("is text");
        let expected: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("//^ ")).collect();
        let scene = text.split("//^").next().expect("has a first part");
        let overrides: Vec<String> =
            scene.lines().filter_map(|line| line.strip_prefix("//set ")).map(str::to_owned).collect();
        let base_dir = file.parent().expect("is in a folder");
        let faults = Scene::parse(scene, "F", base_dir, &overrides).expect_err("is a bad scene");
        let found: Vec<String> = messages(&faults)
            .iter()
            .map(|line| line.strip_prefix("F:").unwrap_or(line).trim_start().to_owned())
            .map(|line| line.replace(&format!("{}/", base_dir.display()), ""))
            .collect();
        if std::env::var_os("BLESS").is_some() {
            fs::write(&file, format!("{scene}//^ {}\n", found.join("\n//^ "))).expect("can be written");
        } else if found != expected {
            wrong.push(format!(
                "{}\nexpected\n{}\nfound\n{}",
                file.display(),
                expected.join("\n"),
                found.join("\n")
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn the_reference_names_every_key() {
    let spec = include_str!("../../src/scene/spec.rs");
    let reference = include_str!("../../docs/scene.md");
    let mut keys: Vec<&str> =
        spec.split(": Option<").filter_map(|before| before.rsplit([' ', '{']).next()).collect();
    keys.pop();
    keys.push("settle");
    assert!(keys.len() > 50, "{keys:?}");
    let lacking: Vec<_> = keys.iter().filter(|key| !reference.contains(&format!("`{key}`"))).collect();
    assert!(lacking.is_empty(), "docs/scene.md does not describe {lacking:?}");
}

#[test]
fn embedded_scenes_are_the_shipped_ones() {
    for name in ["round", "sphere", "almond", "flat"] {
        let shipped =
            fs::read_to_string(folder("scenes").join(name).with_extension("ron")).expect("is shipped");
        let embedded = SceneText::embedded(name, &[]).expect("is embedded");
        assert_eq!(embedded.text(), shipped);
        assert!(embedded.scene().is_ok());
    }
    let faults = Scene::embedded("heart").expect_err("is not embedded");
    assert_eq!(
        messages(&faults),
        [
            "heart: no scene of that name is built in; known: round, sphere, almond, oval, triangular, capsule, bullet, half_moon, shield, flat"
        ]
    );
}
