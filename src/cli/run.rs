//! `pancoat run`: fill, settle, aim, spray, and write what came out.

use super::args::RunArgs;
use super::coating::Coating;
use super::failure::Failure;
use super::watch::Watch;
use super::{bed, bodies, guards, print_line};
use crate::observers::statistics::BedStatistics;
use crate::observers::{Backend, Observer, Packing, RecordedAim, Recorder, Recording};
use crate::report::{
    Derived, EnergyAudit, Guards, Machine, Performance, RECORD_FORMAT, ReportData, Results, RunDir,
    RunRecord, Status,
};
use crate::scene::{Drum, Record, Scene};
use crate::shapes::TabletShape;
use crate::stepping::{Energy, Frame, Progress, Simulation, SimulationError, TimeStep};
use nalgebra::Vector3;
use std::path::Path;

/// Frames after which a recording is brought to the disk.
const FLUSH_EVERY: u64 = 50;

pub(super) fn run(args: &RunArgs) -> Result<(), Failure> {
    let seconds = args.seconds.map(|seconds| format!("time.duration=S({seconds})"));
    let text = args.scene.read_with(&seconds.into_iter().collect::<Vec<_>>())?;
    let scene = text.scene()?;
    if let Some(threads) = args.threads {
        rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global()?;
    }
    let mut simulation = Simulation::new(&scene)?;
    let refusal = guards::refuse(&scene, simulation.shapes(), simulation.time_step());
    match refusal {
        Err(refusal) if args.force => eprintln!("warning: forced: {refusal}"),
        refusal => refusal?,
    }

    let default = Path::new("runs").join(args.scene.name());
    let directory = RunDir::create(args.out.as_deref().unwrap_or(&default), text.text())?;
    let hash = blake3::hash(text.text().as_bytes()).to_hex().to_string();
    let watch = Watch::new(args.max_wall, args.quiet)?;
    let record = blank_record(&scene, hash, simulation.shapes(), simulation.time_step());
    let backend = args.backend.into();
    let mut session =
        Session { directory, watch, record, backend, coating: None, bed: None, recorder: None, done: 0 };
    session.directory.write_record(&session.record)?;
    let ended = session.stages(&mut simulation);
    session.finish(&simulation, ended)
}

/// A run under way.
struct Session {
    directory: RunDir,
    watch: Watch,
    record: RunRecord,
    /// What is to draw the spray.
    backend: Backend,
    coating: Option<Coating>,
    bed: Option<BedStatistics>,
    recorder: Option<Recorder>,
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
        let mut aim = None;
        if let Some(spray) = &scene.spray {
            let zone = bed::aim(simulation, spray, &mut self.watch)?;
            let coating = Coating::new(&scene, &bed::of(simulation), spray, zone, frames, self.backend)?;
            coating.describe(&mut self.record);
            if self.record.backend != "cpu" {
                self.watch.say(&format!("spray drawn by {}", self.record.backend));
            }
            aim = Some(RecordedAim { target: zone.center, normal: zone.normal });
            self.coating = Some(coating);
        }
        if let Some(record) = scene.outputs.record {
            let packing = packing(record, scene.drum.as_ref());
            let recording = Recording { packing, body_shapes: simulation.body_shapes().to_vec(), aim };
            self.recorder = Some(Recorder::create(&self.directory.path().join("poses.bin"), recording)?);
        }
        self.record.derived.settling_s = Some(simulation.clock());
        self.record.derived.bodies = simulation.body_shapes().len();
        if let (Some(drum), true) = (&scene.drum, scene.outputs.statistics) {
            self.bed = Some(bed::statistics(simulation, drum));
        }
        if scene.outputs.energy {
            simulation.audit_energy();
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
            let coating = self.coating.as_ref();
            let is_due =
                |done: &u64| done.is_multiple_of(FLUSH_EVERY) || coating.is_some_and(|c| c.is_due(*done));
            let until = (self.done + 1..frames).find(is_due).unwrap_or(frames);
            let mut observers: Vec<&mut dyn Observer> = Vec::new();
            observers.extend(self.coating.as_mut().map(|c| c as &mut dyn Observer));
            observers.extend(self.bed.as_mut().map(|b| b as &mut dyn Observer));
            observers.extend(self.recorder.as_mut().map(|r| r as &mut dyn Observer));
            let (first, mut go_on) = (self.done, true);
            let mut note = |progress: &Progress| {
                self.done += 1;
                go_on = self.watch.note(progress);
                go_on || self.done == until
            };
            simulation.run(first, until - first, &mut observers, &mut note)?;
            if let (Some(coating), Some(file)) = (&mut self.coating, &mut series)
                && let Some(cov_intra) = coating.note(self.done, file)?
            {
                self.watch.cov_intra = Some(cov_intra);
            }
            if let Some(recorder) = self.recorder.as_mut().filter(|_| self.done.is_multiple_of(FLUSH_EVERY)) {
                recorder.flush()?;
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
        let recorded = self.recorder.take().map_or(Ok(()), |mut recorder| recorder.flush());
        let ended = ended.and(recorded.map_err(Failure::from));
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
        let stiff = simulation.stiff_share();
        self.record.guards.largest_overlap_percent = 100.0 * overlap;
        self.record.guards.too_stiff_percent = 100.0 * stiff;
        self.record.guards.divided_steps_percent = 100.0 * simulation.divided_share();
        let repeated = simulation.repeated_frames();
        self.record.guards.repeated_frames = repeated;
        self.record.guards.energy = simulation.energy().as_ref().map(audit);
        self.record.warnings =
            guards::warnings(simulation.scene().contact.mode, step, overlap, stiff, repeated)
                .iter()
                .map(ToString::to_string)
                .collect();
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
        self.directory.write_table("bodies.csv", bodies::rows(simulation))?;
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
        let Some(coating) = self.coating.as_mut().filter(|_| self.done > 0) else { return Ok(()) };
        let outcome = coating.outcome(self.done, &simulation.masses())?;
        outcome.write(&self.directory, &mut self.record)?;
        if let (Some(drum), true) = (simulation.drum(), simulation.scene().outputs.picture) {
            let states = simulation.states();
            let frame = Frame {
                index: self.done,
                time: simulation.clock(),
                bodies: &states,
                drum_angle: simulation.drum_angle(),
                drum_torque: simulation.drum_torque(),
            };
            let zone = &coating.coater.zones()[0];
            outcome.picture(&self.directory, &bed::of(simulation), drum, zone, &frame)?;
        }
        Ok(())
    }
}

/// How poses in a drum are stored.
fn packing(record: Record, drum: Option<&Drum>) -> Packing {
    match (record, drum) {
        (Record::Compact, Some(drum)) => {
            let half = Vector3::new(drum.diameter, drum.diameter, drum.width) / 2.0;
            Packing::Compact { min: -half, max: half }
        }
        _ => Packing::Exact,
    }
}

/// The energies of a run as its record keeps them.
pub(super) fn audit(energy: &Energy) -> EnergyAudit {
    EnergyAudit {
        kinetic_j: energy.kinetic,
        potential_j: energy.potential,
        elastic_normal_j: energy.elastic_normal,
        elastic_tangential_j: energy.elastic_tangential,
        normal_dashpots_j: energy.normal_dashpots,
        tangential_dashpots_j: energy.tangential_dashpots,
        sliding_j: energy.sliding,
        stiffness_change_j: energy.stiffness_change,
        wall_work_j: energy.wall_work,
        residual_j: energy.residual(),
        residual_over_dissipated: energy.residual() / energy.dissipated().max(f64::MIN_POSITIVE),
    }
}

/// The record of a run that has not begun.
pub(super) fn blank_record(
    scene: &Scene,
    scene_hash: String,
    shapes: &[TabletShape],
    step: &TimeStep,
) -> RunRecord {
    let spheres = shapes.iter().map(|s| (s.name.clone(), s.clump.spheres.len())).collect();
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
