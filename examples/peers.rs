//! The bed of other codes' runs: figures of pancoat beside those of LIGGGHTS, LAMMPS and Yade.
//!
//! `cargo run --release --example peers -- CASE` with CASE `spheres_mu0.1`, `spheres_mu0.5` or `pan20_mu0.5` runs the drum
//! from the decks' start state and prints a table. `--csv FILE` adds a line to a table: name, window, s, and each figure with
//! its standard error. `--dt` sets another step, s, `--until` another end of the window than the reference's, s, and
//! `--threads` more than one thread.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "an example prints its result")]

#[path = "common/peers_figures.rs"]
mod peers_figures;
#[path = "common/peers_scene.rs"]
mod peers_scene;

use pancoat::stepping::Simulation;
use peers_figures::{NAMES, Watch, reference};
use std::io::Write as _;

fn main() {
    let mut args = std::env::args().skip(1);
    let name = args.next().unwrap_or_else(|| "spheres_mu0.5".into());
    let (mut dt, mut until, mut csv, mut threads) = (None, None, None, 1);
    while let Some(arg) = args.next() {
        let value = args.next().expect("an option has a value");
        match arg.as_str() {
            "--dt" => dt = Some(value.parse().expect("a step in s")),
            "--until" => until = Some(value.parse().expect("a time in s")),
            "--threads" => threads = value.parse().expect("a number"),
            "--csv" => csv = Some(value),
            other => panic!("unknown option {other}"),
        }
    }
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().expect("the first pool");
    let (bodies, friction) = name.split_once("_mu").expect("a case such as spheres_mu0.5");
    let friction: f64 = friction.parse().expect("a coefficient of friction");
    // The windows of the reference, from its start states.
    let (case, mut window) =
        if bodies == "spheres" { ("spheres", [5.0, 15.0]) } else { ("peers20", [1.0, 4.0]) };

    window[1] = until.unwrap_or(window[1]);
    let scene = peers_scene::peers_scene(case, friction, dt);
    let mut simulation = Simulation::new(&scene).expect("the scene is built");
    let tablets = peers_scene::spheres_per_tablet(case).is_some();
    let mut watch = Watch::new(window, tablets);
    let frames = (window[1] / scene.time.frame_interval).round() as u64;
    for frame in 0..frames {
        simulation.run(frame, 1, &mut [&mut watch], &mut |_| true).expect("it runs");
        if frame % 50 == 49 {
            eprintln!("{:.0} of {:.0} s", (frame + 1) as f64 * scene.time.frame_interval, window[1]);
        }
    }
    let figures = watch.figures();

    let reference = reference(&name);
    let codes = reference.iter().map(|(code, _)| format!(" {code} |"));
    println!(
        "| {name} | pancoat |{}\n|---|---|{}",
        codes.collect::<String>(),
        "---|".repeat(reference.len())
    );
    let shown = |(value, error): (f64, f64)| {
        if value.is_finite() { format!(" {value:.3} ± {error:.3} |") } else { " |".to_owned() }
    };
    for (k, figure) in NAMES.iter().enumerate().filter(|(k, _)| figures[*k].0.is_finite()) {
        let others = reference.iter().map(|(_, values)| shown(values[k]));
        println!("| {figure} |{}{}", shown(figures[k]), others.collect::<String>());
    }
    if let Some(path) = csv {
        let mut file = std::fs::File::options().create(true).append(true).open(path).expect("a file");
        let values: Vec<String> = figures.iter().map(|(v, e)| format!("{v:.5},{e:.3}")).collect();
        writeln!(file, "pancoat_{name},{},{},{}", window[0], window[1], values.join(","))
            .expect("is written");
    }
}
