//! How fast a run is: prints one JSON line for a case.
//!
//! `cargo run --release --example throughput -- peers50 --seconds 1`
//!
//! Cases: `round`, the embedded scene with its spray; `peers20`, `peers50`, `peers100`, 770 round tablets of so many spheres in a plain drum of 200 mm, and
//! `spheres`, 770 spheres in the same drum, from the start states in `scenes/peers`; `--dt` sets another step, s. `--times 10`
//! makes that drum and its bed ten times as wide, the bodies numbered at random: what the size of a bed costs.
#![expect(clippy::print_stdout, reason = "an example prints its result")]

#[path = "common/peers_scene.rs"]
mod peers_scene;

use pancoat::observers::{BedSurface, Coater, Observer};
use pancoat::scene::{FreeBody, Scene, Settle, StepChoice};
use pancoat::stepping::{BodyState, Simulation};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

/// By how much the drum of `peers100` and the distances in it are larger.
const ROOM: f64 = 1.02;

fn main() {
    let mut args = std::env::args().skip(1);
    let case = args.next().unwrap_or_else(|| "peers50".into());
    let (mut seconds, mut threads, mut dt, mut times) = (0.5, 1, None, 1);
    while let Some(arg) = args.next() {
        let value: f64 = args.next().and_then(|v| v.parse().ok()).expect("an option has a number");
        match arg.as_str() {
            "--seconds" => seconds = value,
            "--threads" => threads = value as usize,
            "--dt" => dt = Some(value),
            "--times" => times = value as usize,
            other => panic!("unknown option {other}"),
        }
    }
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().expect("the first pool");
    let mut scene = if case == "round" { round(dt) } else { peers_scene::peers_scene(&case, 0.5, dt) };
    if case != "round" {
        scene.time.settle = Settle::For(0.2);
        // The start state holds tablets of 20 spheres, which are smaller: finer ones begin deep in each other.
        if case == "peers50" || case == "peers100" {
            scene.bodies = settled(peers_scene::peers_scene("peers50", 0.5, None));
        }
        if case == "peers100" {
            scene.bodies.iter_mut().for_each(|body| body.position *= ROOM);
            scene
                .drum
                .iter_mut()
                .for_each(|drum| (drum.diameter, drum.width) = (drum.diameter * ROOM, drum.width * ROOM));
        }
        widen(&mut scene, times);
    }
    let mut simulation = Simulation::new(&scene).expect("the scene is built");
    simulation.fill(&mut |_| true).expect("the pan is filled");
    simulation.settle(&mut |_| true).expect("the bed settles");
    let mut coater = scene.spray.as_ref().map(|spray| {
        let positions: Vec<_> = simulation.states().iter().map(|state| state.position).collect();
        let bed = BedSurface::fit(&positions, 6.3e-3).expect("a bed");
        let (shapes, kinds) = (simulation.shapes(), simulation.body_shapes());
        Coater::new(shapes, kinds, spray, bed.zone(spray), simulation.drum()).expect("a coater")
    });
    let frames = (seconds / scene.time.frame_interval).round() as u64;
    let (cpu, wall, before) = (cpu_seconds(), std::time::Instant::now(), simulation.stopwatch().seconds());
    let mut observers: Vec<&mut dyn Observer> =
        coater.iter_mut().map(|coater| coater as &mut dyn Observer).collect();
    simulation.run(0, frames, &mut observers, &mut |_| true).expect("it runs");
    let phases = simulation.stopwatch().seconds().into_iter().zip(before);
    let phases: serde_json::Map<_, _> =
        phases.map(|((name, s), (_, b))| (name.to_owned(), ((s - b) / seconds).into())).collect();
    let line = serde_json::json!({
        "case": case,
        "tablets": simulation.body_shapes().len(),
        "spheres_per_tablet": simulation.shapes()[0].clump.spheres.len(),
        "step_s": simulation.time_step().step,
        "threads": threads,
        "simulated_s": seconds,
        "cpu_s_per_simulated_s": (cpu_seconds() - cpu) / seconds,
        "wall_s_per_simulated_s": wall.elapsed().as_secs_f64() / seconds,
        "cpu_ns_per_body_step": (cpu_seconds() - cpu) / seconds * simulation.time_step().step
            / simulation.body_shapes().len() as f64 * 1e9,
        "peak_kB_per_body": peak_kb() / simulation.body_shapes().len() as f64,
        "phases": phases,
        "state_hash": simulation.state_hash(),
    });
    println!("{line}");
}

fn round(dt: Option<f64>) -> Scene {
    let mut scene = Scene::embedded("round").expect("the embedded scene");
    if let Some(dt) = dt {
        scene.time.step = StepChoice::Fixed(dt);
    }
    scene
}

/// The bodies of a scene after 0.2 s.
fn settled(mut scene: Scene) -> Vec<FreeBody> {
    scene.time.settle = Settle::For(0.2);
    let mut simulation = Simulation::new(&scene).expect("the scene is built");
    simulation.settle(&mut |_| true).expect("the bed settles");
    let bodies = scene.bodies.into_iter().zip(simulation.states());
    let moved = |(body, state): (FreeBody, BodyState)| FreeBody {
        position: state.position,
        orientation: state.orientation,
        velocity: state.velocity,
        spin: state.spin,
        ..body
    };
    bodies.map(moved).collect()
}

/// Puts `times` beds of bodies on end, in a drum as much wider.
fn widen(scene: &mut Scene, times: usize) {
    let width = peers_scene::WIDTH;
    let bed = std::mem::take(&mut scene.bodies);
    let shift = |k: usize| (k as f64 - 0.5 * (times as f64 - 1.0)) * width;
    let mut bodies: Vec<_> = (0..times)
        .flat_map(|k| {
            bed.iter().cloned().map(move |mut body| {
                body.position.z += shift(k);
                body
            })
        })
        .collect();
    if times > 1 {
        bodies.shuffle(&mut ChaCha8Rng::seed_from_u64(1));
    }
    scene.bodies = bodies;
    scene.drum.iter_mut().for_each(|drum| drum.width *= times as f64);
}

/// Largest memory of this process so far, kB.
fn peak_kb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.split_whitespace().next()?.parse().ok()).unwrap_or(f64::NAN)
}

/// CPU time of this process so far, s, from the kernel's clock ticks (100 a second).
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let after_name = stat.rsplit(')').next().unwrap_or_default();
    let ticks =
        |k| after_name.split_whitespace().nth(k).and_then(|t| t.parse::<f64>().ok()).unwrap_or(f64::NAN);
    (ticks(11) + ticks(12)) / 100.0
}
