//! V45, V46: the same scene gives the same bits: for any number of threads and again, and going on from a saved state, springs
//! included. The fingerprint takes positions, orientations, velocities, momenta and springs bit by bit.

use super::support::{scene, set};
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
