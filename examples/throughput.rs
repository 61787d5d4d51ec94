//! How fast a run is: prints one JSON line for a case.
//!
//! `cargo run --release --example throughput -- peers50 --seconds 1`
//!
//! Cases: `round`, the embedded scene with its spray; `peers20`, `peers50`, `peers100`, 770 round tablets of so many spheres in a plain drum of 200 mm, and
//! `spheres`, 770 spheres in the same drum, from the start states in `scenes/peers`; `--dt` sets another step, s.
#![expect(clippy::print_stdout, reason = "an example prints its result")]

use nalgebra::{UnitQuaternion, Vector3};
use pancoat::observers::{BedSurface, Coater, Observer};
use pancoat::scene::{
    ContactSettings, Drum, FreeBody, Material, Outputs, PairProperties, PairTable, Placement, Recipe, Scene,
    Settle, Shape, SphereBudget, StepChoice, Time, Wall,
};
use pancoat::stepping::Simulation;
use std::path::{Path, PathBuf};

fn main() {
    let mut args = std::env::args().skip(1);
    let case = args.next().unwrap_or_else(|| "peers50".into());
    let (mut seconds, mut threads, mut dt) = (0.5, 1, None);
    while let Some(arg) = args.next() {
        let value: f64 = args.next().and_then(|v| v.parse().ok()).expect("an option has a number");
        match arg.as_str() {
            "--seconds" => seconds = value,
            "--threads" => threads = value as usize,
            "--dt" => dt = Some(value),
            other => panic!("unknown option {other}"),
        }
    }
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().expect("the first pool");
    let scene = if case == "round" { round(dt) } else { peers(&case, dt) };
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
        shapes: vec![Shape {
            name: "tablet".into(),
            recipe,
            spheres: SphereBudget::Count(spheres),
            placement: Placement::Inscribed,
            panels: 0,
        }],
        batches: vec![],
        drum: Some(Drum {
            diameter: 0.2,
            width: 0.1,
            speed: 22.0 * std::f64::consts::TAU / 60.0,
            material: 1,
            wall: Wall::Cylinder,
            facets: 90,
            axis_tilt: 0.0,
            baffles: None,
        }),
        bodies: bodies.collect(),
        boundaries: vec![],
        contact: ContactSettings::default(),
        time: Time {
            step: StepChoice::Fixed(dt.unwrap_or(step)),
            impact_speed: 0.3,
            settle: Settle::For(0.2),
            duration: 1.0,
            frame_interval: 0.02,
        },
        spray: None,
        outputs: Outputs {
            series_interval: 1.0,
            report: false,
            picture: false,
            statistics: false,
            record: None,
        },
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
