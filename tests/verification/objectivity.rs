//! V36, V37: the frame of reference changes nothing. A one-sphere clump moves bit by bit as a sphere; a clump with its
//! spheres in another order to round-off; everything 10 m/s faster: velocities to 1e-10 (Galilei). A loaded spring that
//! turns with its contact by 90 degrees about x, y and the normal: length to 1e-9, direction to 1e-4 (first order in the angle of a step).

use super::support::{clump_file, law, run, set, watch};
use nalgebra::{Rotation3, Vector3};
use pancoat::contact::{Dashpots, Spring, Touch};
use pancoat::scene::ContactSettings;

#[test]
fn one_sphere_clump_is_a_sphere() {
    let clump =
        "shapes.ball.recipe=Clump(file: \"one_ball.txt\", inertia_per_mass: Mm2(6.4, 6.4, 6.4))".to_owned();
    let (plain, one) = (run("tablet_impact", &[]), run("tablet_impact", &[clump]));
    assert_eq!((plain[0].position, plain[0].velocity), (one[0].position, one[0].velocity));
    assert_eq!((plain[0].spin, plain[0].orientation), (one[0].spin, one[0].orientation));
}

#[test]
fn order_of_spheres_is_round_off() {
    let (_file, path) = clump_file("0.003 0 0 0.002\n-0.003 0 0 0.002\n");
    let other = set!["shapes.dumbbell.recipe=Clump(file: {path:?}, inertia_per_mass: Mm2(1.6, 10.6, 10.6))"];
    let (first, second) = (run("off_centre_pair", &[]), run("off_centre_pair", &other));
    for (a, b) in first.iter().zip(&second) {
        assert!((a.velocity - b.velocity).norm() < 1e-10 && (a.spin - b.spin).norm() < 1e-7);
    }
}

#[test]
fn a_moving_frame_changes_nothing() {
    let still = set!["bodies[0].velocity=MPerS(0.2, -0.2, 0)", "boundaries[0].velocity=MPerS(0, 0, 0)"];
    let (moving, rest) = (watch("moving_plane", &[]), watch("moving_plane", &still));
    for ((_, a), (_, b)) in moving.iter().zip(&rest) {
        let difference = a[0].velocity - b[0].velocity - Vector3::new(10.0, 3.0, 0.0);
        assert!(difference.norm() < 1e-10, "{difference}");
        assert!((a[0].spin - b[0].spin).norm() < 1e-7);
    }
    assert!(rest.last().expect("has an end").1[0].velocity.y > 0.05, "it rebounds");
}

#[test]
fn a_turning_contact_keeps_its_force() {
    let law = law((1e6, 0.25), (3e6, 0.3), 100.0, 1.0, ContactSettings::default());
    let none = Dashpots { normal: 0.0, tangential: 0.0 };
    let (steps, dt) = (20_000, 1e-5);
    let angle = std::f64::consts::FRAC_PI_2 / f64::from(steps);
    let start = Vector3::new(2e-6, 0.0, 1e-6);
    for axis in [Vector3::x(), Vector3::z(), Vector3::y()] {
        let mut spring = Spring { stretch: start, radius: 1e-4 };
        for k in 1..=steps {
            let turned = Rotation3::new(axis * (angle * f64::from(k)));
            let normal = turned * Vector3::y();
            let twirl = axis.dot(&normal) * angle / dt;
            let touch = Touch { normal, overlap: 1e-5, velocity: Vector3::zeros(), twirl };
            law.force(&touch, 1e-4, none, dt, &mut spring);
        }
        let expected = Rotation3::new(axis * std::f64::consts::FRAC_PI_2) * start;
        assert!((spring.stretch.norm() / start.norm() - 1.0).abs() < 1e-9);
        assert!((spring.stretch - expected).norm() < 1e-4 * start.norm(), "{axis}: {}", spring.stretch);
    }
}
