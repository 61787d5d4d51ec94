//! What the values of a scene become.

use approx::assert_relative_eq;
use pancoat::scene::{
    Aim, BoundarySurface, Cap, Cycle, DampingMass, Deposit, Flux, Footprint, Outline, Pattern, Placement,
    Rays, Recipe, Record, Scene, Settle, SphereBudget, StepChoice, TangentialLaw, Wall,
};
use std::f64::consts::PI;

#[test]
fn the_round_scene_is_the_papers_case() {
    let scene = Scene::embedded("round").expect("is embedded");
    assert_eq!(scene.batches[0].count, 769);
    assert_eq!(scene.batches[0].tablet_mass, 1.3e-3);
    assert_eq!(scene.materials[0].shear_modulus, 1e6);
    assert_eq!(scene.materials[1].shear_modulus, 3e6);
    let pair = scene.pairs.get(1, 0);
    assert_eq!((pair.friction, pair.restitution), (0.5, 0.5));
    assert_eq!(scene.gravity.y, -9.81);
    let Recipe::Round { diameter, band, cap: Cap::Compound { height, exponent } } = scene.shapes[0].recipe
    else {
        panic!("is a round tablet with a compound cap")
    };
    assert_eq!((diameter, exponent), (15.9e-3, 2.8823));
    assert_relative_eq!(band, 3.2452e-3, max_relative = 1e-15);
    assert_relative_eq!(height, 1.6973e-3, max_relative = 1e-15);
    let drum = scene.drum.expect("has a drum");
    assert_eq!((drum.diameter, drum.width, drum.facets), (0.25, 0.1, 90));
    assert_relative_eq!(drum.speed, 22.0 * 2.0 * PI / 60.0, max_relative = 1e-15);
    let baffles = drum.baffles.expect("has baffles");
    assert_eq!((baffles.count, baffles.height, baffles.thickness), (4, 0.012, 0.006));
    assert_relative_eq!(baffles.tilt, PI / 9.0, max_relative = 1e-15);
    assert_eq!(scene.time.step, StepChoice::PerContact(12.0));
    assert_eq!(scene.time.settle, Settle::Auto { at_most: 20.0 });
    assert_eq!((scene.time.duration, scene.time.frame_interval), (60.0, 0.02));
    let spray = scene.spray.expect("has a spray");
    assert_eq!((spray.spanwise, spray.streamwise, spray.distance), (0.0762, 0.0381, 0.05));
    assert_eq!((spray.aim, spray.pixels), (Aim::Bed, [512, 256]));
    let Deposit::Sprayed { rate, .. } = spray.deposit else { panic!("a spray of a known rate") };
    assert_relative_eq!(rate, 1.25e-4, max_relative = 1e-15); // 7.5 g/min = 0.125 g/s
    assert_eq!(scene.outputs.record, None);
}

#[test]
fn every_key_has_its_effect() {
    let scene = Scene::load(&super::folder("tests/scenes/good/everything.ron"), &[]).expect("loads");
    assert_eq!(scene.title, "all (\"keys\"), // not a comment");
    assert_eq!((scene.seed, scene.gravity.y), (42, -9.80665));
    assert_eq!(scene.materials[1].name, "steel, [x]");
    assert_eq!((scene.materials[1].shear_modulus, scene.materials[1].poisson), (8e10, -0.1));
    assert_eq!(scene.pairs.get(0, 1).restitution, 1e-6);
    assert_eq!(scene.pairs.get(0, 0).friction, 0.0);
    let Recipe::Round { diameter, band, .. } = scene.shapes[2].recipe else { panic!("is round") };
    assert_eq!((diameter, band), (0.0127, 0.003));
    let Recipe::Clump { path, inertia_per_mass } = &scene.shapes[3].recipe else { panic!("is a clump") };
    assert!(path.ends_with("good/clump.txt"));
    assert_relative_eq!(inertia_per_mass[2], 2.76e-5, max_relative = 1e-15);
    assert_eq!([0, 1, 3].map(|k| scene.shapes[k].spheres), [1, 50, 0].map(SphereBudget::Count));
    assert_eq!((scene.batches[0].count, scene.batches[1].count, scene.batches[1].shape), (100, 100, 2));
    assert_eq!(scene.drum.as_ref().map(|d| d.speed), Some(-2.3));
    let turned = scene.bodies[0].orientation;
    assert_relative_eq!(turned.angle(), PI / 6.0, max_relative = 1e-14);
    assert_relative_eq!(turned.axis().expect("is turned").x, 0.5_f64.sqrt(), max_relative = 1e-14);
    assert_relative_eq!(scene.bodies[0].spin.z, 2.0 * PI, max_relative = 1e-15);
    assert_eq!(scene.bodies[1].orientation.angle(), 0.0);
    assert_eq!(scene.bodies[1].position.x, 0.01);
    let BoundarySurface::Plane { normal, .. } = scene.boundaries[0].surface else { panic!("is a plane") };
    assert_eq!(normal.y, 1.0);
    assert_eq!(scene.boundaries[1].velocity.x, 1e-3);
    let BoundarySurface::Mesh { scale, .. } = scene.boundaries[2].surface else { panic!("is a mesh") };
    assert_eq!(scale, 1e-3);
    assert_eq!(scene.contact.tangential, TangentialLaw::Rescaled);
    assert_eq!(scene.contact.damping_mass, DampingMass::Contact);
    assert!(scene.contact.no_tension);
    assert_eq!(scene.time.step, StepChoice::Fixed(5e-5));
    assert_eq!(scene.time.settle, Settle::Auto { at_most: 5.0 });
    assert_eq!((scene.time.duration, scene.time.impact_speed), (6.0, 0.5));
    assert!(scene.spray.is_none());
    assert_eq!(scene.outputs.series_interval, 0.1);
    assert!(!scene.outputs.report && !scene.outputs.picture && scene.outputs.statistics);
    assert_eq!(scene.outputs.record, Some(Record::Compact));
}

#[test]
fn left_out_sections_have_the_documented_defaults() {
    let scene = Scene::load(&super::folder("scenes/free.ron"), &[]).expect("loads");
    assert!(scene.drum.is_none() && scene.spray.is_none() && scene.batches.is_empty());
    assert_eq!((scene.seed, scene.gravity.norm()), (1, 0.0));
    assert_eq!(scene.time.settle, Settle::For(0.0));
    assert_eq!(scene.contact, pancoat::scene::ContactSettings::default());
    assert_eq!(scene.outputs.series_interval, 0.5);
    assert!(scene.outputs.report && scene.outputs.picture && scene.outputs.statistics);
}

#[test]
fn every_solid_can_be_written() {
    let scene = Scene::load(&super::folder("tests/scenes/good/solids.ron"), &[]).expect("loads");
    let pressed = |name: &str| {
        let shape = scene.shapes.iter().find(|shape| shape.name == name).expect("is in the file");
        let Recipe::Pressed { outline, band, cap } = shape.recipe else { panic!("{name} is pressed") };
        (outline, band, cap)
    };
    let (length, width, fourth_harmonic, third_harmonic) = (20e-3, 12e-3, -0.125e-3, 0.125e-3);
    let flat = Cap::Spherical { height: 0.0 };
    let bevelled = Cap::Bevelled { height: 0.5e-3, width: 1e-3 };
    let compound = Cap::Compound { height: 1.5e-3, exponent: 3.0 };
    assert_eq!(pressed("oval"), (Outline::Oval { length, width, fourth_harmonic }, 4e-3, compound));
    let plain = Outline::Oval { length, width, fourth_harmonic: 0.0 };
    assert_eq!(pressed("plain oval"), (plain, 4e-3, flat));
    let almond = Outline::Almond { length, width, fourth_harmonic: 0.0, third_harmonic };
    assert_eq!(pressed("almond"), (almond, 4e-3, bevelled));
    let triangular = Outline::Triangular { length, width, fourth_harmonic, third_harmonic };
    assert_eq!(pressed("triangular").0, triangular);
    assert_eq!(pressed("capsule").0, Outline::Capsule { length, width });
    assert_eq!(pressed("bullet").0, Outline::Bullet { length, width });
    assert_eq!(pressed("half moon").0, Outline::HalfMoon { length, width: 8e-3 });
    assert_eq!(pressed("shield").0, Outline::Shield { length, width });
    let mesh = scene.shapes.last().expect("is in the file");
    let Recipe::Mesh { path, scale } = &mesh.recipe else { panic!("is a mesh") };
    assert!(path.ends_with("good/box.stl"));
    assert_eq!((*scale, mesh.spheres), (1e-3, SphereBudget::Count(50)));
}

fn round_with(overrides: &[&str]) -> Scene {
    let overrides: Vec<String> = overrides.iter().map(|&set| set.to_owned()).collect();
    Scene::load(&super::folder("scenes/round.ron"), &overrides).expect("loads")
}

#[test]
fn clumps_by_count_or_error_inside_or_balanced() {
    let clump = |set: &str| round_with(&[set]).shapes[0].spheres;
    assert_eq!(clump("shapes.round.spheres=20"), SphereBudget::Count(20));
    assert_eq!(clump("shapes.round.spheres=Count(20)"), SphereBudget::Count(20));
    assert_eq!(clump("shapes.round.spheres= Error( Mm(0.125) )"), SphereBudget::Error(0.125e-3));
    assert_eq!(round_with(&[]).shapes[0].placement, Placement::Inscribed);
    assert_eq!(round_with(&["shapes.round.placement=Balanced"]).shapes[0].placement, Placement::Balanced);
}

/// Lifting the front by 30 degrees turns gravity, seen from the drum, towards its back.
#[test]
fn a_drum_can_lean_and_have_any_wall() {
    let tilted = round_with(&["drum.axis_tilt=Deg(30)"]);
    let (down, back) = (9.81 * 0.75_f64.sqrt(), 9.81 * 0.5);
    assert_relative_eq!(tilted.gravity, nalgebra::Vector3::new(0.0, -down, -back), max_relative = 1e-12);
    let wall = |set: &str| round_with(&[set, "drum.baffles=None"]).drum.expect("has a drum").wall;
    assert_eq!(wall("drum.wall=Cylinder"), Wall::Cylinder);
    let cone = "drum.wall=Profile([(Mm(-50), Mm(200)), (Mm(0), Mm(250)), (Mm(50), Mm(250))])";
    assert_eq!(wall(cone), Wall::Profile(vec![[-0.05, 0.2], [0.0, 0.25], [0.05, 0.25]]));
    let Wall::Mesh { path, scale } = wall("drum.wall=Mesh(file: \"../meshes/pan.stl\", unit: Mm(1))") else {
        panic!("is a mesh")
    };
    assert!(path.ends_with("../meshes/pan.stl"));
    assert_eq!(scale, 1e-3);
}

#[test]
fn every_spray_can_be_written() {
    let pattern = |overrides: &[&str]| {
        let overrides: Vec<String> = overrides.iter().map(|&set| set.to_owned()).collect();
        let file = super::folder("tests/scenes/good/solids.ron");
        Scene::load(&file, &overrides).expect("loads").spray.expect("has a spray").pattern
    };
    let written = pattern(&[]);
    assert_eq!((written.footprint, written.rays), (Footprint::Ellipse, Rays::Diverging));
    assert_eq!(written.flux, Flux::Dumbbell { offset: 0.5, sigma: 0.25 });
    assert_relative_eq!(written.tilt.spanwise, -PI / 18.0, max_relative = 1e-15);
    assert_relative_eq!(written.tilt.streamwise, PI / 9.0, max_relative = 1e-15);
    assert_eq!(written.nozzles, [-0.02, 0.02]);
    assert_eq!(written.cycle, Some(Cycle { on: 2.0, off: 0.5 }));
    let flux = |set: &str| pattern(&[set]).flux;
    assert_eq!(flux("spray.flux=Gaussian(sigma: 0.5)"), Flux::Gaussian { sigma: 0.5 });
    assert_eq!(flux("spray.flux=Annular(inner: 0.5)"), Flux::Annular { inner: 0.5 });
    let Flux::Table { path } = flux("spray.flux=Table(file: \"patternator.csv\")") else {
        panic!("is a table")
    };
    assert!(path.ends_with("good/patternator.csv"));
    let round = Scene::embedded("round").expect("is embedded").spray.expect("has a spray");
    assert_eq!(round.pattern, Pattern::default());
}
