//! V45, V46: the same scene gives the same bits: for any number of threads and again, and going on from a saved state, springs
//! included. The fingerprint takes positions, orientations, velocities, momenta and springs bit by bit. `tests/all.sh` holds builds with
//! and without optimisation together.

use super::peers::peers_scene::peers_scene;
use super::support::{scene, set};
use pancoat::scene::{PairProperties, PairTable, Scene};
use pancoat::stepping::Simulation;

fn settled(threads: usize) -> Simulation {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("starts");
    pool.install(|| {
        let mut simulation = Simulation::new(&scene("small_bed", &set!["seed=5"])).expect("runs");
        simulation.fill(&mut |_| true).expect("fills");
        simulation.settle(&mut |_| true).expect("settles");
        assert_eq!(simulation.body_shapes().len(), 40);
        simulation
    })
}

#[test]
fn threads_do_not_change_a_bit() {
    let one = settled(1).state_hash();
    for threads in [2, 3, 4, 8, 16, 1] {
        assert_eq!(one, settled(threads).state_hash(), "{threads} threads");
    }
}

/// 770 tablets of 20 spheres for 0.2 s, 4000 steps: all lists are made and remade many times.
#[test]
fn threads_do_not_change_a_bit_of_a_full_bed() {
    let scene = peers_scene("peers20", 0.5, None);
    let hash = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("starts");
        pool.install(|| {
            let mut simulation = Simulation::new(&scene).expect("is built");
            simulation.run(0, 10, &mut [], &mut |_| true).expect("runs");
            assert_eq!((simulation.states().len(), simulation.steps()), (770, 4000));
            simulation.state_hash()
        })
    };
    let one = hash(1);
    for threads in [2, 3, 4, 8, 16, 1] {
        assert_eq!(one, hash(threads), "{threads} threads");
    }
}

/// Contacts are worked out side by side, those of one law together: what stands beside a contact changes nothing.
#[test]
fn a_material_by_two_names_does_not_change_a_bit() {
    let one = peers_scene("peers20", 0.5, Some(1.5e-4));
    let mut two = one.clone();
    two.materials.push(one.materials[0].clone());
    two.pairs = PairTable::new(3, PairProperties { friction: 0.5, restitution: 0.5 });
    two.bodies.iter_mut().step_by(2).for_each(|body| body.material = 2);
    let hash = |scene: &Scene| {
        let mut simulation = Simulation::new(scene).expect("is built");
        simulation.run(0, 10, &mut [], &mut |_| true).expect("runs");
        simulation.state_hash()
    };
    assert_eq!(hash(&one), hash(&two));
}

#[test]
fn a_saved_state_goes_on_as_if_nothing_was_saved() {
    let mut whole = settled(2);
    let go_on = |simulation: &mut Simulation, frames: u64| {
        simulation.run(0, frames, &mut [], &mut |_| true).expect("goes on");
    };
    go_on(&mut whole, 3);
    let saved = whole.clone();
    assert!(whole.tally().sphere_contacts > 10, "springs are loaded");
    go_on(&mut whole, 5);
    for _ in 0..2 {
        let mut resumed = saved.clone();
        go_on(&mut resumed, 5);
        assert_eq!(resumed.state_hash(), whole.state_hash());
        assert_eq!(resumed.steps(), whole.steps());
    }
    assert_ne!(saved.state_hash(), whole.state_hash());
}
