//! Values set on the command line.

use pancoat::scene::{Scene, SceneText, SphereBudget};

fn round(overrides: &[&str]) -> SceneText {
    let overrides: Vec<String> = overrides.iter().map(|&set| set.to_owned()).collect();
    SceneText::embedded("round", &overrides).expect("is embedded")
}

#[test]
fn values_are_replaced_added_and_taken_out() {
    let text = round(&[
        "drum.speed=RadPerS(3)",
        "batches[0]=(shape: \"round\", material: \"tablet\", tablet_mass: Mg(1300), count: 1)",
        "batches[0].count=100",
        "shapes.round.spheres=20",
        "drum.baffles=None",
        "drum.facets=40",
        "contact.damping_mass=Contact",
        "spray=None",
    ]);
    let scene = text.scene().expect("is whole");
    let drum = scene.drum.expect("has a drum");
    assert_eq!((drum.speed, drum.facets, drum.baffles), (3.0, 40, None));
    assert_eq!((scene.batches[0].count, scene.shapes[0].spheres), (100, SphereBudget::Count(20)));
    assert_eq!(scene.contact.damping_mass, pancoat::scene::DampingMass::Contact);
    assert!(scene.spray.is_none());
}

/// What is stored beside a run's results is what was run.
#[test]
fn the_text_with_overrides_in_it_is_the_same_scene() {
    let text = round(&["time.duration=S(3)", "outputs.report=false", "drum.facets=40"]);
    let again = Scene::parse(text.text(), "again", std::path::Path::new(""), &[]).expect("is whole");
    assert_eq!(text.scene().expect("is whole"), again);
    assert_eq!((again.time.duration, again.outputs.report), (3.0, false));
}
