//! Files that are no scenes, and any text at all.

use pancoat::scene::{Scene, SceneText};
use proptest::prelude::*;
use std::fs;
use std::path::Path;

fn fault_of(bytes: &[u8]) -> String {
    let dir = tempfile::tempdir().expect("can be made");
    let file = dir.path().join("s.ron");
    fs::write(&file, bytes).expect("can be written");
    let message = Scene::load(&file, &[]).expect_err("is no scene").to_string();
    message.replace(&file.display().to_string(), "F")
}

#[test]
fn files_that_are_no_scenes_get_one_clear_line() {
    assert_eq!(fault_of(b"(format: \xff)"), "F: the file is not UTF-8 text");
    assert_eq!(fault_of(b""), "F:1:1: expected a value");
    assert_eq!(
        fault_of(&vec![b' '; 5_000_000]),
        "F: the file has 5000000 bytes; a scene has at most 4194304"
    );
    let absent = Scene::load(Path::new("absent.ron"), &[]).expect_err("is not there").to_string();
    assert!(absent.starts_with("absent.ron: cannot read the scene: "), "{absent}");
    let folder = Scene::load(Path::new("src"), &[]).expect_err("is a folder").to_string();
    assert!(folder.starts_with("src: cannot read the scene: "), "{folder}");
}

/// The round scene with pieces cut out and put in: closer to RON than any random text.
fn damaged() -> impl Strategy<Value = String> {
    let text = fs::read_to_string(super::folder("tests/scenes/good/everything.ron")).expect("is text");
    (any::<prop::sample::Index>(), 0..40usize, "[-()\\[\\]{}:,\"'#/*rb0-9a-zA-Z. \nß]{0,8}").prop_map(
        move |(at, length, new)| {
            let chars: Vec<char> = text.chars().collect();
            let start = at.index(chars.len());
            let end = (start + length).min(chars.len());
            chars[..start].iter().copied().chain(new.chars()).chain(chars[end..].iter().copied()).collect()
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_text_makes_the_reader_panic(text in "\\PC{0,200}", damaged in damaged(), set in "\\PC{0,30}") {
        let base_dir = super::folder("tests/scenes/good");
        for text in [&text, &damaged] {
            if let Err(faults) = Scene::parse(text, "f", &base_dir, &[]) {
                prop_assert!(!faults.faults.is_empty() && !faults.to_string().is_empty());
            }
            let _ = Scene::parse(text, "f", &base_dir, &[set.clone(), format!("drum.speed={set}")]);
        }
    }

    /// A text that reads is a whole scene: what is stored can be read again.
    #[test]
    fn overrides_leave_text_that_reads_the_same(facets in 8..500u32, seconds in 0.5..100.0f64) {
        let overrides = [format!("drum.facets={facets}"), format!("time.duration=S({seconds})")];
        let text = SceneText::embedded("sphere", &overrides).expect("is embedded");
        let scene = text.scene().expect("is whole");
        prop_assert_eq!(scene.drum.as_ref().map(|drum| drum.facets), Some(facets as usize));
        prop_assert_eq!(scene.time.duration, seconds);
        prop_assert_eq!(Scene::parse(text.text(), "f", Path::new(""), &[]).expect("is whole"), scene);
    }
}
