//! V44: how the error of one Hertz contact falls with the step (root mean square over the phase of touch-down). Derived
//! with separate integrators: velocity Verlet, elastic, 3.1e-4, 3.0e-5, 5.2e-6 at 20, 50 and 100 steps per contact (order
//! 2.5); damped to e = 0.5 by velocities half a step late, dashpots corrected for that, for the swing of a step, and for where in a step a
//! contact begins and ends, 1.4e-3, 1.1e-3, 5.7e-4, 2.5e-4, 6.7e-5 at 12, 15, 20, 50 and 100. Tolerance: a factor of 1.5. And what collisions of whole tablets of 50
//! spheres, of which several touch at once, leave of the energy at the default step: its root, which is what restitution is,
//! within 1 % of that of fine steps.

use super::peers::peers_scene::{MASS, MOMENTS, peers_scene};
use super::support::{kinetic, run, set};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use pancoat::scene::{FreeBody, StepChoice};
use pancoat::stepping::{BodyState, Simulation};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn error(e: f64, steps: f64) -> f64 {
    let phases = 24;
    let dt = 6.104_51 / steps;
    let squares = (0..phases).map(|k| {
        let above = 2.5 + 3.9e-3 * dt * f64::from(k) / f64::from(phases);
        let set = set![
            "pairs[0].restitution={e}",
            "bodies[0].position=Mm(0, {above}, 0)",
            "time.frame_interval=Us({dt})",
            "time.step=PerContact(8)",
            "time.duration=Us(14)",
        ];
        (run("restitution", &set)[0].velocity.y / 3.9 - e).powi(2)
    });
    (squares.sum::<f64>() / f64::from(phases)).sqrt()
}

#[test]
fn errors_fall_as_derived() {
    for (e, steps, expected) in [
        (1.0, 20.0, 3.1e-4),
        (1.0, 50.0, 3.0e-5),
        (1.0, 100.0, 5.2e-6),
        (0.5, 12.0, 1.4e-3),
        (0.5, 15.0, 1.1e-3),
        (0.5, 20.0, 5.7e-4),
        (0.5, 50.0, 2.5e-4),
        (0.5, 100.0, 6.7e-5),
    ] {
        let found = error(e, steps);
        assert!(
            (expected / 1.5..expected * 1.5).contains(&found),
            "e {e}, {steps} steps: {found:e} for {expected:e}"
        );
    }
}

/// Share of their energy that two tablets keep when they meet at 0.2 to 0.8 m/s, turned and offset at random: mean over
/// `count` collisions for each of the `steps` in a contact, and the standard deviation of what each differs by from the first.
fn kept(count: usize, steps: &[f64]) -> Vec<(f64, f64)> {
    let mut scene = peers_scene("peers50", 0.5, None);
    (scene.drum, scene.gravity) = (None, Vector3::zeros());
    scene.time.frame_interval = 0.1;
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut vector = |size: f64| Vector3::from_fn(|_, _| size * random.random_range(-0.5..0.5));
    let each: Vec<Vec<f64>> = (0..count)
        .map(|_| {
            let speed = 0.25 + vector(0.3).x;
            let bodies = [-1.0, 1.0].map(|side| FreeBody {
                position: Vector3::x() * (side * 9.5e-3) + vector(3e-3),
                velocity: Vector3::x() * (-side * speed),
                orientation: UnitQuaternion::from_quaternion(Quaternion::from_parts(
                    vector(1.0).x,
                    vector(2.0),
                )),
                spin: vector(20.0),
                ..scene.bodies[0].clone()
            });
            let kept = steps.iter().map(|steps| {
                let mut scene = scene.clone();
                scene.bodies = bodies.to_vec();
                scene.time.step = StepChoice::PerContact(*steps);
                let mut simulation = Simulation::new(&scene).expect("is built");
                let energy = |body: &BodyState| kinetic(body, MASS, &Vector3::from(MOMENTS));
                let energies = |s: &Simulation| s.states().iter().map(energy).sum::<f64>();
                let before = energies(&simulation);
                simulation.run(0, 1, &mut [], &mut |_| true).expect("runs");
                energies(&simulation) / before
            });
            kept.collect()
        })
        .collect();
    let mean = |of: &dyn Fn(&Vec<f64>) -> f64| each.iter().map(of).sum::<f64>() / count as f64;
    let figures = (0..steps.len()).map(|k| (mean(&|e| e[k]), mean(&|e| (e[k] - e[0]).powi(2)).sqrt()));
    figures.collect()
}

#[test]
fn colliding_tablets_keep_as_much_energy_as_with_fine_steps() {
    let [(fine, _), (mean, scatter)] = kept(200, &[100.0, 12.0])[..] else { unreachable!("two steps") };
    assert!(((mean / fine).sqrt() - 1.0).abs() < 0.01, "{mean} for {fine}");
    assert!(scatter < 0.02, "{scatter}");
}
