//! `pancoat run`: fill, settle, aim, spray, and write what came out.

use super::args::RunArgs;
use super::coating::Coating;
use super::failure::Failure;
use super::watch::Watch;
use super::{bed, guards, print_line};
use crate::observers::statistics::BedStatistics;
use crate::observers::{BedPicture, Observer};
use crate::report::{
    Derived, Guards, Machine, Performance, RECORD_FORMAT, ReportData, Results, RunDir, RunRecord, SprayAim,
    Status,
};
use crate::scene::Scene;
use crate::stepping::{Frame, Progress, Simulation, SimulationError};
use std::path::Path;

/// Width and height of the bed picture, pixels.
const PICTURE: u32 = 640;

pub(super) fn run(args: &RunArgs) -> Result<(), Failure> {
    let seconds = args.seconds.map(|seconds| format!("time.duration=S({seconds})"));
    let text = args.scene.read_with(&seconds.into_iter().collect::<Vec<_>>())?;
    let scene = text.scene()?;
    if let Some(threads) = args.threads {
        rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global()?;
    }
    let mut simulation = Simulation::new(&scene)?;
    guards::refuse(&scene, simulation.shapes(), simulation.time_step())?;

    let default = Path::new("runs").join(args.scene.name());
    let directory = RunDir::create(args.out.as_deref().unwrap_or(&default), text.text())?;
    let hash = blake3::hash(text.text().as_bytes()).to_hex().to_string();
    let watch = Watch::new(args.max_wall, args.quiet)?;
    let record = blank_record(&scene, hash, &simulation);
    let mut session = Session { directory, watch, record, coating: None, bed: None, done: 0 };
    session.directory.write_record(&session.record)?;
    let ended = session.stages(&mut simulation);
    session.finish(&simulation, ended)
}

/// A run under way.
struct Session {
    directory: RunDir,
    watch: Watch,
    record: RunRecord,
    coating: Option<Coating>,
    bed: Option<BedStatistics>,
    /// Frames handed to observers.
    done: u64,
}

impl Session {
    fn stages(&mut self, simulation: &mut Simulation) -> Result<(), Failure> {
        let mut watch = |progress: &Progress| self.watch.note(progress);
        simulation.fill(&mut watch)?;
        simulation.settle(&mut watch)?;
        let scene = simulation.scene().clone();
        let frames = (scene.time.duration / scene.time.frame_interval).round().max(1.0) as u64;
        if let Some(spray) = &scene.spray {
            let zone = bed::aim(simulation, spray, &mut self.watch)?;
            let coating = Coating::new(simulation, spray, zone, frames)?;
            let derived = &mut self.record.derived;
            derived.spray =
                Some(SprayAim { center_mm: (zone.center * 1e3).into(), normal: zone.normal.into() });
            derived.panels = coating.panels();
            derived.film_volume_per_count_m3 = Some(coating.volume_per_count);
            self.coating = Some(coating);
        }
        self.record.derived.settling_s = Some(simulation.clock());
        self.record.derived.bodies = simulation.body_shapes().len();
        if let (Some(drum), true) = (&scene.drum, scene.outputs.statistics) {
            self.bed = Some(bed::statistics(simulation, drum));
        }
        self.directory.write_record(&self.record)?;
        let purpose = if scene.spray.is_some() { "spraying" } else { "running" };
        self.watch.begin(purpose, scene.time.duration);
        self.frames(simulation, frames)
    }

    /// The coated time.
    fn frames(&mut self, simulation: &mut Simulation, frames: u64) -> Result<(), Failure> {
        let mut series = self.coating.is_some().then(|| self.directory.series()).transpose()?;
        while self.done < frames {
            let mut observers: Vec<&mut dyn Observer> = Vec::new();
            observers.extend(self.coating.as_mut().map(|c| c as &mut dyn Observer));
            observers.extend(self.bed.as_mut().map(|b| b as &mut dyn Observer));
            let mut go_on = true;
            let mut note = |progress: &Progress| {
                go_on = self.watch.note(progress);
                true
            };
            simulation.run(self.done, 1, &mut observers, &mut note)?;
            self.done += 1;
            if let (Some(coating), Some(file)) = (&mut self.coating, &mut series)
                && let Some(cov_intra) = coating.note(self.done, file)?
            {
                self.watch.cov_intra = Some(cov_intra);
            }
            if self.done < frames && self.coating.as_ref().is_some_and(|c| c.has_news(self.done)) {
                self.results(simulation)?;
                self.directory.write_record(&self.record)?;
                self.watch.limit = self.record.results.coating.cov_intra_asymptote;
            }
            // A frame that is begun is counted as a whole.
            if !go_on && self.done < frames {
                return Err(SimulationError::Stopped { time: simulation.clock() }.into());
            }
        }
        Ok(())
    }

    /// Writes all that is known, however the run ended.
    fn finish(mut self, simulation: &Simulation, ended: Result<(), Failure>) -> Result<(), Failure> {
        let stopped = matches!(&ended, Err(Failure::Simulation(SimulationError::Stopped { .. })));
        self.record.status = match &ended {
            Ok(()) => Status::Done,
            Err(_) if stopped => Status::Stopped,
            Err(_) => Status::Failed,
        };
        if ended.is_ok() || stopped {
            self.results(simulation)?;
        }
        let step = simulation.time_step();
        let overlap = simulation.deepest_overlap();
        self.record.guards.largest_overlap_percent = 100.0 * overlap;
        self.record.warnings =
            guards::warnings(simulation.shapes(), step, overlap).iter().map(ToString::to_string).collect();
        self.record
            .warnings
            .extend(simulation.repairs().iter().map(|repair| format!("mesh repaired: {repair}")));
        self.record.state_hash = Some(simulation.state_hash());
        self.record.performance = Performance {
            wall_s: self.watch.wall_s(),
            simulated_s: simulation.clock(),
            coated_s: self.done as f64 * simulation.scene().time.frame_interval,
            steps: simulation.steps(),
            phases: simulation.stopwatch().seconds().map(|(name, s)| (name.to_owned(), s)).into(),
        };
        self.directory.write_record(&self.record)?;
        for warning in &self.record.warnings {
            self.watch.say(&format!("warning: {warning}"));
        }
        if stopped {
            return Err(Failure::Stopped(self.directory.path().to_owned()));
        }
        ended?;
        if simulation.scene().outputs.report {
            let page = crate::report::page(&ReportData::read(self.directory.path())?);
            self.directory.write("report.html", page.as_bytes())?;
        }
        drop(self.watch);
        print_line(&self.directory.path().display().to_string())
    }

    fn results(&mut self, simulation: &Simulation) -> Result<(), Failure> {
        if let Some(figures) = self.bed.as_ref().and_then(BedStatistics::figures) {
            bed::record(&figures, &mut self.record.results);
        }
        let Some(coating) = self.coating.as_ref().filter(|_| self.done > 0) else { return Ok(()) };
        let outcome = coating.outcome(&simulation.masses())?;
        let results: &mut Results = &mut self.record.results;
        results.coating = outcome.main;
        results.shapes = outcome.shapes;
        results.spray_efficiency = Some(outcome.efficiency);
        results.cov_identity_residual = Some(outcome.identity_residual);
        self.directory.write_table("tablets.csv", &outcome.tablets)?;
        self.directory.write_table("panels.csv", &outcome.panels)?;
        self.directory.write("coating.vtp", outcome.surfaces.as_bytes())?;
        if let (Some(drum), true) = (simulation.drum(), simulation.scene().outputs.picture) {
            let mut picture = BedPicture::new(simulation.shapes(), simulation.body_shapes(), drum, PICTURE)?;
            let states = simulation.states();
            let frame = Frame {
                index: self.done,
                time: simulation.clock(),
                bodies: &states,
                drum_angle: simulation.drum_angle(),
                drum_torque: simulation.drum_torque(),
            };
            let image = picture.draw(&frame, &outcome.film, Some(&coating.coater.zones()[0]));
            image.write_png(&self.directory.path().join("bed.png")).map_err(Failure::Output)?;
        }
        Ok(())
    }
}

/// The record of a run that has not begun.
fn blank_record(scene: &Scene, scene_hash: String, simulation: &Simulation) -> RunRecord {
    let step = simulation.time_step();
    let spheres = simulation.shapes().iter().map(|s| (s.name.clone(), s.clump.spheres.len())).collect();
    RunRecord {
        format: RECORD_FORMAT,
        title: scene.title.clone(),
        status: Status::Running,
        scene_hash,
        seed: scene.seed,
        program_version: env!("CARGO_PKG_VERSION").to_owned(),
        machine: Machine {
            os: std::env::consts::OS.to_owned(),
            arch: std::env::consts::ARCH.to_owned(),
            cpus: std::thread::available_parallelism().map_or(1, usize::from),
            threads: rayon::current_num_threads(),
        },
        backend: if scene.spray.is_some() { "cpu" } else { "none" }.to_owned(),
        derived: Derived {
            spheres,
            time_step_s: step.step,
            contact_time_s: step.contact_time,
            steps_per_contact: step.steps_per_contact(),
            rayleigh_fraction: step.rayleigh_fraction(),
            ..Derived::default()
        },
        guards: Guards::default(),
        warnings: Vec::new(),
        results: Results::default(),
        performance: Performance::default(),
        state_hash: None,
    }
}
