//! A built-in scene through the library: fill, settle, aim, spray, and print what came out.

use pancoat::models::{BatchStatistics, CoatMap};
use pancoat::observers::{BedSurface, Coater, Observer, film_volume_per_count};
use pancoat::scene::{Deposit, Scene};
use pancoat::stepping::{Frame, Simulation};
use std::error::Error;
use std::f64::consts::PI;

/// Where all bodies were.
struct Positions(Vec<nalgebra::Vector3<f64>>);

impl Observer for Positions {
    fn observe(&mut self, frame: &Frame<'_>) {
        self.0.extend(frame.bodies.iter().map(|body| body.position));
    }
}

/// Runs a built-in scene with as many seconds of spray as the first argument says (5 without one).
pub(crate) fn coat(scene: &str) -> Result<(), Box<dyn Error>> {
    let seconds: f64 = std::env::args().nth(1).map_or(Ok(5.0), |s| s.parse())?;
    let scene = Scene::embedded(scene)?;
    let spray = scene.spray.as_ref().ok_or("the scene sprays")?;
    let frames = |seconds: f64| (seconds / scene.time.frame_interval).round() as u64;

    let mut simulation = Simulation::new(&scene)?;
    simulation.fill(&mut |_| true)?;
    let settled = simulation.settle(&mut |_| true)?;
    println!("{} tablets settled in {settled:.1} s", simulation.body_shapes().len());

    let mut positions = Positions(Vec::new());
    simulation.run(0, frames(2.0), &mut [&mut positions], &mut |_| true)?;
    let radius = (simulation.shapes()[0].volume * 3.0 / (4.0 * PI)).cbrt(); // of a ball of the tablet's volume
    let bed = BedSurface::fit(&positions.0, radius)?;
    println!("angle of repose {:.1} degrees", bed.angle_of_repose_deg());

    let kinds = simulation.body_shapes().to_vec();
    let mut coater = Coater::new(simulation.shapes(), &kinds, spray, bed.zone(spray), simulation.drum())?;
    simulation.run(0, frames(seconds), &mut [&mut coater], &mut |_| true)?;

    let panels = simulation.shapes()[0].panels.as_ref().ok_or("a sprayed shape has panels")?;
    let counts: Vec<u64> = (0..kinds.len()).flat_map(|body| coater.counts(body).to_vec()).collect();
    let Deposit::Sprayed { rate, solids, film_density } = spray.deposit else {
        return Err("no spray rate".into());
    };
    let (interval, counts_per_frame) = (scene.time.frame_interval, coater.counts_per_frame());
    let unit = film_volume_per_count(rate, solids, film_density, interval, counts_per_frame);
    let batch = BatchStatistics::of(&CoatMap::new(&panels.areas, &counts, unit)?)?;
    println!("after {seconds} s of spray: mean thickness {:.3} um", batch.mean_thickness * 1e6);
    println!("CoV_intra {:.3}, CoV_inter {:.3}", batch.moments, batch.inter);
    println!("CoV_intra of the average tablet {:.3}", batch.average_tablet);
    Ok(())
}
