//! How fast a run is: prints one JSON line for a case. See `docs/performance.md` for what the cases are.
//!
//! `cargo run --release --example throughput -- peers50 --seconds 1`

use nalgebra::{UnitQuaternion, Vector3};
use pancoat::scene::*;
use pancoat::stepping::{Progress, Simulation};
use std::path::{Path, PathBuf};

fn main() {
    let mut args = std::env::args().skip(1);
    let case = args.next().unwrap_or_else(|| "peers20".into());
    let (mut seconds, mut warm, mut threads, mut dt) = (1.0, 0.2, 1, None);
    while let Some(arg) = args.next() {
        let value = args.next().expect("a value");
        match arg.as_str() {
            "--seconds" => seconds = value.parse().expect("a number"),
            "--warm" => warm = value.parse().expect("a number"),
            "--threads" => threads = value.parse().expect("a number"),
            "--dt" => dt = Some(value.parse::<f64>().expect("a number")),
            other => panic!("unknown option {other}"),
        }
    }
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().expect("first pool");
    let scene = peers(&case, dt);
    let mut simulation = Simulation::new(&scene).expect("the peers' scene builds");
    let mut quiet = |_: &Progress| true;
    let frames = |s: f64| (s / scene.time.frame_interval).round() as u64;
    simulation.run(0, frames(warm), &mut [], &mut quiet).expect("runs");
    let cpu = cpu_seconds();
    let (start, before) = (std::time::Instant::now(), simulation.stopwatch().seconds());
    let steps = simulation.steps();
    let mut speed = 0.0;
    let mut ke = 0.0;
    let mut com = Vector3::zeros();
    let n = frames(seconds);
    let mut contacts = 0.0;
    for k in 0..n {
        simulation.run(k, 1, &mut [], &mut quiet).expect("runs");
        let states = simulation.states();
        let m = states.len() as f64;
        speed += states.iter().map(|s| s.velocity.norm()).sum::<f64>() / m / n as f64;
        ke += states.iter().map(|s| 0.5 * 1.3e-3 * s.velocity.norm_squared()).sum::<f64>() / n as f64;
        com += states.iter().map(|s| s.position).sum::<Vector3<f64>>() / m / n as f64;
        contacts += f64::from(simulation.tally().sphere_contacts) / n as f64;
    }
    let wall = start.elapsed().as_secs_f64();
    let cpu = cpu_seconds() - cpu;
    let phases: Vec<String> = simulation
        .stopwatch()
        .seconds()
        .iter()
        .zip(before)
        .map(|(a, b)| format!("\"{}\":{:.3}", a.0, (a.1 - b.1) / seconds))
        .collect();
    eprintln!(
        "speed {:.2} mm/s  ke {:.3} mJ  com ({:.3},{:.3}) angle {:.2}  contacts {contacts:.0} rebuilt {} deepest {:.3}",
        speed * 1e3,
        ke * 1e3,
        com.x * 1e3,
        com.y * 1e3,
        com.x.atan2(-com.y).to_degrees(),
        simulation.tally().rebuilt,
        simulation.deepest_overlap()
    );
    println!(
        "{{\"case\":\"{case}\",\"step_s\":{},\"threads\":{threads},\"simulated_s\":{seconds},\"cpu_s_per_simulated_s\":{:.3},\"wall_s_per_simulated_s\":{:.3},\"us_per_step\":{:.1},\"phases\":{{{}}}}}",
        simulation.time_step().step,
        cpu / seconds,
        wall / seconds,
        cpu / (simulation.steps() - steps) as f64 * 1e6,
        phases.join(",")
    );
    println!("{}", simulation.state_hash());
}

fn peers(case: &str, dt: Option<f64>) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/peers");
    let pair = PairProperties { friction: 0.5, restitution: 0.5 };
    let (recipe, spheres, step, start) = match case.strip_prefix("peers") {
        Some(n) => {
            let path: PathBuf = folder.join(format!("clump_{n}.txt"));
            let inertia = [2.13425e-8 / 1.3e-3, 2.13425e-8 / 1.3e-3, 3.58666e-8 / 1.3e-3];
            let recipe = Recipe::Clump { path, inertia_per_mass: inertia };
            let step = match n {
                "20" => 5e-5,
                "50" => 4e-5,
                _ => 2.5e-5,
            };
            (recipe, n.parse().expect("a count"), step, "start_tablets.csv")
        }
        None => (Recipe::Sphere { diameter: 2.0 * 6.558_744e-3 }, 1, 1.25e-4, "spheres_start.csv"),
    };
    let text = std::fs::read_to_string(folder.join(start)).expect("the start state");
    let bodies = text.lines().map(|line| {
        let v: Vec<f64> = line.split(',').map(|x| x.trim().parse().expect("a number")).collect();
        let axis = if v.len() > 5 { Vector3::new(v[3], v[4], v[5]) } else { Vector3::z() };
        FreeBody {
            shape: 0,
            material: 0,
            mass: 1.3e-3,
            position: Vector3::new(v[0], v[1], v[2] - 0.05),
            orientation: UnitQuaternion::rotation_between(&Vector3::z(), &axis).unwrap_or_default(),
            velocity: if v.len() > 8 { Vector3::new(v[6], v[7], v[8]) } else { Vector3::zeros() },
            spin: Vector3::zeros(),
        }
    });
    Scene {
        title: case.into(),
        seed: 1,
        gravity: Vector3::new(0.0, -9.81, 0.0),
        materials: vec![
            Material { name: "tablet".into(), shear_modulus: 1e6, poisson: 0.25 },
            Material { name: "steel".into(), shear_modulus: 3e6, poisson: 0.3 },
        ],
        pairs: PairTable::new(2, pair),
        shapes: vec![Shape { name: "tablet".into(), recipe, spheres, panels: 0 }],
        batches: vec![],
        drum: Some(Drum {
            diameter: 0.2,
            width: 0.1,
            speed: 22.0 * std::f64::consts::TAU / 60.0,
            material: 1,
            facets: 90,
            baffles: None,
        }),
        bodies: bodies.collect(),
        boundaries: vec![],
        contact: ContactSettings::default(),
        time: Time {
            step: StepChoice::Fixed(dt.unwrap_or(step)),
            impact_speed: 0.3,
            settle: Settle::For(0.0),
            duration: 1.0,
            frame_interval: 0.02,
        },
        spray: None,
        outputs: Outputs { series_interval: 1.0, report: false, picture: false, statistics: false },
    }
}

/// CPU time of this process so far, s, from the kernel's clock ticks (100 a second).
fn cpu_seconds() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let after_name = stat.rsplit(')').next().unwrap_or_default();
    let ticks =
        |k| after_name.split_whitespace().nth(k).and_then(|t| t.parse::<f64>().ok()).unwrap_or(f64::NAN);
    (ticks(11) + ticks(12)) / 100.0
}
