//! What each phase of a run costs, one thread: 770 round tablets of 50 spheres as they lie in a turning drum.
//!
//! `cargo bench --bench phases`

#[path = "../examples/common/peers_scene.rs"]
mod peers_scene;

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use nalgebra::Vector3;
use pancoat::contact::{ContactField, Wrench};
use pancoat::models::{BatchStatistics, CoatMap};
use pancoat::scene::{Scene, Settle};
use pancoat::shapes::TabletShape;
use pancoat::stepping::Simulation;
use pancoat::world::{Motion, NearChanges, World};
use std::hint::black_box;

/// A bed at one instant.
struct Bed {
    scene: Scene,
    simulation: Simulation,
    motions: Vec<Motion>,
    drum: Motion,
}

impl Bed {
    fn flowing() -> Self {
        let mut scene = peers_scene::peers_scene("peers50", 0.5, Some(9e-5));
        scene.time.settle = Settle::For(0.5);
        let mut simulation = Simulation::new(&scene).expect("the scene is built");
        simulation.settle(&mut |_| true).expect("it runs");
        let motions = simulation.states().into_iter().map(|state| {
            let rotation = state.orientation.to_rotation_matrix().into_inner();
            Motion { position: state.position, rotation, velocity: state.velocity, spin: state.spin }
        });
        let drum = Motion { spin: Vector3::z() * 2.303_835, ..Motion::at_rest() };
        Self { motions: motions.collect(), drum, simulation, scene }
    }

    /// World and contacts of the bodies, with the drum or without it, before the first search.
    fn field(&self, walls: bool) -> (World, ContactField) {
        let shapes = self.simulation.shapes();
        let (mut world, mut field) = (World::new(), ContactField::new(&self.scene, shapes));
        if let (true, Some(drum)) = (walls, self.simulation.drum()) {
            field.add_mesh(drum, world.add_surface(drum), 1, true);
        }
        let inertia = Vector3::from(peers_scene::MOMENTS);
        for motion in &self.motions {
            world.add_tablet(&shapes[0].clump, peers_scene::MASS, &inertia, motion);
            field.add_body(0, 0, peers_scene::MASS, &inertia);
        }
        (world, field)
    }

    fn search(&self, world: &mut World) -> NearChanges {
        world.search(&self.motions, &[], &Motion::at_rest(), &vec![0.0; self.motions.len()])
    }

    fn feel(&self, field: &mut ContactField, near: &NearChanges) {
        let mut wrenches =
            vec![Wrench { force: Vector3::zeros(), torque: Vector3::zeros() }; self.motions.len()];
        let odometers = vec![0.0; self.motions.len()];
        field.add_forces(&self.motions, &[self.drum], &odometers, || near.clone(), 1e-9, &mut wrenches);
        black_box(wrenches);
    }
}

fn phases(criterion: &mut Criterion) {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("the first pool");
    let bed = Bed::flowing();
    let none = NearChanges::default();

    let (mut world, mut pairs) = bed.field(false);
    let near = bed.search(&mut world);
    criterion.bench_function("near-pair search, all bodies anew", |bencher| {
        let fresh = || bed.field(false).0;
        bencher.iter_batched_ref(fresh, |world| bed.search(world), BatchSize::LargeInput);
    });
    criterion.bench_function("lists of all near pairs, with their contacts", |bencher| {
        bencher.iter_batched_ref(|| pairs.clone(), |field| bed.feel(field, &near), BatchSize::LargeInput);
    });
    bed.feel(&mut pairs, &near);
    criterion.bench_function("sphere-sphere contacts, lists as they are", |bencher| {
        bencher.iter(|| bed.feel(&mut pairs, &none));
    });

    let (_, mut walls) = bed.field(true);
    bed.feel(&mut walls, &none);
    criterion.bench_function("sphere-triangle contacts, lists as they are", |bencher| {
        bencher.iter(|| bed.feel(&mut walls, &none));
    });

    criterion.bench_function("a step of bodies that touch nothing", |bencher| {
        let mut simulation = Simulation::new(&apart(&bed.scene)).expect("the scene is built");
        let steps = 20.0_f64;
        bencher.iter_custom(|times| {
            let start = std::time::Instant::now();
            for _ in 0..times {
                simulation.run(0, 1, &mut [], &mut |_| true).expect("it runs");
            }
            start.elapsed().div_f64(steps)
        });
    });

    let shape = round_tablet();
    let panels = shape.panels.as_ref().expect("it has panels");
    let counts: Vec<u64> = (0..770 * panels.len() as u64).map(|k| k * k % 97).collect();
    criterion.bench_function("statistics of a batch", |bencher| {
        bencher.iter(|| {
            let map = CoatMap::new(&panels.areas, &counts, 1e-15).expect("counts fit the panels");
            BatchStatistics::of(&map).expect("they are coated")
        });
    });
}

/// The bodies on a grid, without drum and weight; a frame is twenty steps.
fn apart(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.drum = None;
    scene.gravity = Vector3::zeros();
    scene.time.frame_interval = 20.0 * 9e-5;
    for (k, body) in scene.bodies.iter_mut().enumerate() {
        body.position = Vector3::new((k % 10) as f64, (k / 10 % 10) as f64, (k / 100) as f64) * 0.05;
        body.velocity = Vector3::new(0.1, 0.0, 0.0);
        body.spin = Vector3::new(1.0, 2.0, 3.0);
    }
    scene
}

fn round_tablet() -> TabletShape {
    let scene = Scene::embedded("round").expect("the embedded scene");
    TabletShape::build(&scene.shapes[0], true).expect("the shape is built")
}

criterion_group!(benches, phases);
criterion_main!(benches);
