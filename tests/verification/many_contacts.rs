//! V34: n spheres of one body land flat at once. With damping by the body's mass (EDEM) β' = √n β, so that e = 0.5 leaves
//! the e of the table (derived; checked by integration to 1e-8), and 22 contacts leave no rebound; with damping by the
//! contacts e is delivered. Tolerance 1 % and 0.002 of the table, 0.5 % of `Contact`. Deviation known: dashpots that together
//! would overshoot in a step are cut, which vanishes with the step. So are those of a sphere that twelve others hold.

use super::support::{attempt, close, clump_file, run, scene, set};
use nalgebra::Vector3;
use pancoat::contact::PairLaw;
use pancoat::scene::{FreeBody, PairProperties, PairTable, StepChoice};
use std::f64::consts::{SQRT_2, TAU};

/// Restitution of n spheres on a ring.
fn landing(n: u32, e: f64, mode: &str) -> f64 {
    let row = |k: u32| {
        let angle = TAU * f64::from(k) / f64::from(n);
        format!("{} 0 {} 0.002\n", 8e-3 * angle.cos(), 8e-3 * angle.sin())
    };
    let (_file, path) = clump_file(&(0..n).map(row).collect::<String>());
    let set = set![
        "shapes.ring.recipe=Clump(file: {path:?}, inertia_per_mass: Mm2(33.6, 65.6, 33.6))",
        "pairs[0].restitution={e}",
        "contact={mode}",
        "time.duration=Ms(40)",
        "time.step=PerContact(4000)",
    ];
    run("flat_landing", &set)[0].velocity.y / 0.3
}

#[test]
fn damping_by_the_body_is_shared_by_all_contacts() {
    let body = "(damping_mass: Body)";
    let half =
        [(2, 0.36604), (3, 0.28262), (4, 0.22310), (5, 0.17779), (7, 0.11308), (10, 0.05371), (12, 0.02951)];
    for (n, expected) in half {
        close(landing(n, 0.5, body), expected, 2e-3, &format!("{n} contacts"));
    }
    assert!(landing(22, 0.5, body) < 1e-3);
    for (n, expected) in [(2, 0.72879), (4, 0.63782), (12, 0.45141), (19, 0.36057)] {
        close(landing(n, 0.8, body), expected, 2e-3, &format!("{n} contacts"));
    }
    for (n, expected) in [(3, 0.38443), (4, 0.34140)] {
        close(landing(n, 0.5, "(no_tension: true)"), expected, 2e-3, &format!("{n} contacts, no tension"));
    }
}

#[test]
fn damping_by_the_contact_delivers_what_is_asked() {
    for n in [2, 3, 4, 7, 12, 22] {
        for e in [0.3, 0.5, 0.8] {
            close(landing(n, e, "(damping_mass: Contact)"), e, 5e-3, &format!("{n} contacts"));
        }
    }
}

/// A sphere between twelve heavy ones, as in a close packing, each by √(S/m) Δt = 0.4. Along any direction their dashpots of
/// e = 0.01 add up to four, c Δt/m = 2.1, which alone makes explicit steps unstable.
#[test]
fn a_sphere_held_from_all_sides_comes_to_rest() {
    let mut scene = scene("static_overlap", &[]);
    let pair = PairProperties { friction: 0.0, restitution: 0.01 };
    scene.pairs = PairTable::new(scene.materials.len(), pair);
    let law = PairLaw::new(&scene.materials[0], &scene.materials[0], pair, scene.contact);
    scene.gravity = Vector3::zeros();
    scene.boundaries.clear();
    let held = scene.bodies[0].clone();
    let (radius, overlap) = (2e-3_f64, 1e-4);
    let stiffness = law.normal_stiffness((0.5 * radius * overlap).sqrt());
    let step = 0.4 * (held.mass / stiffness).sqrt();
    scene.time.step = StepChoice::Fixed(step);
    (scene.time.frame_interval, scene.time.duration) = (step, 200.0 * step);
    let at = |position: Vector3<f64>, mass: f64, velocity: Vector3<f64>| FreeBody {
        position,
        mass,
        velocity,
        ..held.clone()
    };
    let signs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let around = signs
        .iter()
        .flat_map(|[s, t]| [Vector3::new(*s, *t, 0.0), Vector3::new(*s, 0.0, *t), Vector3::new(0.0, *s, *t)]);
    let heavy =
        around.map(|way| at(way / SQRT_2 * (2.0 * radius - overlap), 1e9 * held.mass, Vector3::zeros()));
    let light = at(Vector3::zeros(), held.mass, Vector3::new(0.01, 0.005, 0.0));
    scene.bodies = std::iter::once(light).chain(heavy).collect();
    let (ended, frames) = attempt(&scene);
    ended.unwrap_or_else(|fault| panic!("{fault}"));
    let end = frames.last().expect("has a start").1[0];
    assert!(end.position.norm() < 1e-8 && end.velocity.norm() < 1e-5, "{end:?}");
}
