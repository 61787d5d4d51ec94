//! Lists are only a way to leave pairs out that cannot touch: a turning bed of clumps comes out the same, bit by bit,
//! whether one thread works or two, and again when it is run again.

use pancoat::scene::Scene;
use pancoat::stepping::Simulation;

fn bed(threads: usize) -> String {
    let overrides = [
        "batches[0].mass=G(52)",
        "shapes.round.spheres=20",
        "drum.diameter=Mm(120)",
        "drum.width=Mm(60)",
        "drum.baffles.height=Mm(8)",
        "time.settle=For(Ms(200))",
        "spray=None",
    ]
    .map(String::from);
    let text = include_str!("../../scenes/round.ron");
    let scene = Scene::parse(text, "round.ron", std::path::Path::new("."), &overrides)
        .expect("the scene of the test runs");
    let pool =
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("the scene of the test runs");
    pool.install(|| {
        let mut simulation = Simulation::new(&scene).expect("the scene of the test runs");
        simulation.fill(&mut |_| true).expect("the scene of the test runs");
        simulation.settle(&mut |_| true).expect("the scene of the test runs");
        assert_eq!(simulation.body_shapes().len(), 40);
        simulation.state_hash()
    })
}

#[test]
fn threads_do_not_change_a_bit() {
    let one = bed(1);
    assert_eq!(one, bed(2));
    assert_eq!(one, bed(1));
}
