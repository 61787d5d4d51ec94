//! Our lists against Rapier's narrow phase: on random configurations, and after random moves from them, both find the same
//! sphere contacts with the same overlaps.
//!
//! Rapier computes in f32: positions of 0.1 m are known to 4e-9 m, and a few roundings add up. Tolerance 1e-7 m; a contact
//! that overlaps by less may be missing on either side.

use super::{ContactField, Partner, Wrench};
use crate::scene::Scene;
use crate::shapes::{PATCH_ANGLE, SurfaceMesh, TabletShape, drum_mesh};
use crate::world::harvest::harvest;
use crate::world::{Motion, World};
use nalgebra::{UnitQuaternion, Vector3};
use proptest::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::LazyLock;

const EXACT: f64 = 1e-7;

/// A drum for two sorts of bodies: tablets of 30 spheres, and balls.
const SCENE: &str = r#"(format: 1,
    materials: {"m": (shear_modulus: MPa(1), poisson: 0.25)},
    pairs: [(between: ("m", "m"), friction: 0.5, restitution: 0.5)],
    shapes: {
        "tablet": (recipe: Round(diameter: Mm(16), band: Mm(3), cap: Spherical(height: Mm(2))), spheres: 30),
        "ball": (recipe: Sphere(diameter: Mm(9))),
    },
    batches: [(shape: "ball", material: "m", tablet_mass: G(1), count: 1)],
    drum: (diameter: Mm(40), width: Mm(30), speed: Rpm(0), material: "m"),
    time: (duration: S(1)))"#;

struct Stage {
    scene: Scene,
    shapes: Vec<TabletShape>,
    drum: SurfaceMesh,
    patches: Vec<u32>,
}

static STAGE: LazyLock<Stage> = LazyLock::new(|| {
    let scene = Scene::parse(SCENE, "test.ron", Path::new("."), &[]).expect("is a scene");
    let shapes: Vec<_> =
        scene.shapes.iter().map(|s| TabletShape::build(s, false).expect("is a shape")).collect();
    let drum = drum_mesh(scene.drum.as_ref().expect("has a drum"));
    let patches = drum.patches(PATCH_ANGLE);
    Stage { scene, shapes, drum, patches }
});

/// What touches what, by body, partner (`None`: the drum) and parts (sphere; sphere or patch): overlap, m.
type Contacts = BTreeMap<(usize, Option<usize>, (u32, u32)), f64>;

fn of_rapier(kinds: &[usize], motions: &[Motion]) -> Contacts {
    let clumps: Vec<_> =
        kinds.iter().zip(motions).map(|(&kind, motion)| (&STAGE.shapes[kind].clump, *motion)).collect();
    let mut contacts = Contacts::new();
    for found in harvest(&clumps, &STAGE.drum) {
        let (sphere, part) = found.parts;
        let part = if found.b.is_none() { STAGE.patches[part as usize] } else { part };
        let deepest = contacts.entry((found.a, found.b, (sphere, part))).or_insert(found.overlap);
        *deepest = deepest.max(found.overlap);
    }
    contacts
}

fn of_lists(field: &ContactField) -> Contacts {
    let contacts = field.contacts().map(|contact| {
        let partner = match contact.partner {
            Partner::Body(k) => Some(k),
            Partner::Surface(_) => None,
        };
        ((contact.body, partner, contact.parts), contact.press.overlap)
    });
    contacts.collect()
}

fn compare(ours: &Contacts, theirs: &Contacts) -> Result<(), TestCaseError> {
    for key in ours.keys().chain(theirs.keys()) {
        let [ours, theirs] = [ours, theirs].map(|contacts| contacts.get(key).copied().unwrap_or(0.0));
        prop_assert!((ours - theirs).abs() < EXACT, "{key:?}: {ours:e} in our lists, {theirs:e} in Rapier");
    }
    Ok(())
}

fn vector(half: f64) -> impl Strategy<Value = Vector3<f64>> {
    [-half..half, -half..half, -half..half].prop_map(Vector3::from)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn lists_find_what_rapier_finds(
        placed in prop::collection::vec((0..2_usize, vector(9e-3), vector(3.0)), 2..6),
        moves in prop::collection::vec((vector(2e-4), vector(0.03)), 6),
    ) {
        let Stage { scene, shapes, drum, .. } = &*STAGE;
        let mut world = World::new();
        let mut field = ContactField::new(scene, shapes);
        field.keep_contacts();
        field.add_mesh(drum, world.add_surface(drum), 0, true);
        let (mut kinds, mut motions) = (Vec::new(), Vec::new());
        for (kind, position, turn) in &placed {
            let rotation = UnitQuaternion::new(*turn).to_rotation_matrix().into_inner();
            let motion = Motion { position: *position, rotation, ..Motion::at_rest() };
            let inertia = shapes[*kind].inertia_per_mass * 1e-3;
            world.add_tablet(&shapes[*kind].clump, 1e-3, &inertia, &motion);
            field.add_body(*kind, 0, 1e-3, &inertia);
            kinds.push(*kind);
            motions.push(motion);
        }
        let rest = Motion::at_rest();
        let mut odometers = vec![0.0; kinds.len()];
        let mut wrenches = vec![Wrench { force: Vector3::zeros(), torque: Vector3::zeros() }; kinds.len()];
        let first = (Vector3::zeros(), Vector3::zeros());
        for (step, turn) in std::iter::once(first).chain(moves) {
            // Bodies move apart, together and past each other: each by a multiple of its own.
            let shares = [1.0, -0.7, 0.4, -0.2, 0.9];
            for (motion, share) in motions.iter_mut().zip(shares) {
                motion.position += step * share;
                motion.rotation = UnitQuaternion::new(turn * share).to_rotation_matrix().into_inner() * motion.rotation;
            }
            let paths = kinds.iter().zip(shares).map(|(kind, share)| {
                (step * share).norm() + (turn * share).norm() * shapes[*kind].clump.reach()
            });
            odometers.iter_mut().zip(paths).for_each(|(odometer, path)| *odometer += path);
            let search = || world.search(&motions, &[rest], &rest, &odometers);
            field.add_forces(&motions, &[rest], &odometers, search, 0.0, &mut wrenches);
            compare(&of_lists(&field), &of_rapier(&kinds, &motions))?;
        }
    }
}

/// The comparison is not one of nothing with nothing.
#[test]
fn the_configurations_have_contacts() {
    let motion = |x: f64| Motion { position: Vector3::new(x, 0.0, 12e-3), ..Motion::at_rest() };
    let contacts = of_rapier(&[0, 0], &[motion(-7e-3), motion(7e-3)]);
    let walls = contacts.keys().filter(|(_, partner, _)| partner.is_none()).count();
    assert!(contacts.len() > walls + 1 && walls > 10, "{} contacts, {walls} at walls", contacts.len());
}
