//! `pancoat coat`: sprays stored poses without simulating.

use super::args::CoatArgs;
use super::bed::{CoatedBed, aiming_frames, surface};
use super::coating::Coating;
use super::failure::Failure;
use super::print_line;
use super::run::blank_record;
use super::watch::Watch;
use crate::observers::{PoseError, PoseReader, RecordedAim, SprayZone, StoredFrame, read_pose_table};
use crate::report::{Coating as CoatingRecord, Performance, ReportData, RunDir, Status};
use crate::scene::{Aim, Scene, Spray};
use crate::shapes::{TabletShape, drum_mesh};
use crate::stepping::{Progress, Stage, TimeStep};
use std::path::Path;

/// Most frames coated side by side; their poses are in memory.
const SIDE_BY_SIDE: usize = 256;

pub(super) fn coat(args: &CoatArgs) -> Result<(), Failure> {
    let text = args.scene.read()?;
    let scene = text.scene()?;
    let spray = scene.spray.as_ref().ok_or(Failure::NoSpray)?;
    if let Some(threads) = args.threads {
        rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global()?;
    }
    let shapes = scene.shapes.iter().map(|shape| TabletShape::build(shape, true));
    let shapes: Vec<TabletShape> = shapes.collect::<Result<_, _>>()?;
    let mut poses = Poses::open(&args.poses, &scene)?;
    let masses = poses.masses(&scene, &args.poses)?;
    let zone = poses.zone(spray, &shapes)?;
    let drum = scene.drum.as_ref().map(drum_mesh);
    let bed = CoatedBed { shapes: &shapes, body_shapes: &poses.body_shapes, drum: drum.as_ref() };
    let mut coating = Coating::new(&scene, &bed, spray, zone, poses.frames, args.backend.into())?;

    let default = format!("runs/{}_coated", args.scene.name().display());
    let directory = RunDir::create(args.out.as_deref().unwrap_or(Path::new(&default)), text.text())?;
    let mut watch = Watch::new(None, args.quiet)?;
    let hash = blake3::hash(text.text().as_bytes()).to_hex().to_string();
    let mut record = blank_record(&scene, hash, &shapes, &TimeStep::choose(&scene, &shapes));
    record.derived.bodies = masses.len();
    record.derived.poses = Some(args.poses.display().to_string());
    coating.describe(&mut record);

    let interval = scene.time.frame_interval;
    watch.begin("coating", poses.frames as f64 * interval);
    let mut series = directory.series()?;
    let (mut done, mut last, mut stopped) = (0, None, false);
    while !stopped {
        let mut some = Vec::new();
        while some.len() < SIDE_BY_SIDE && (some.is_empty() || !coating.is_due(done + some.len() as u64)) {
            let Some(frame) = poses.stored.next() else { break };
            some.push(frame?);
        }
        let Some(end) = some.last() else { break };
        coating.observe_all(&some.iter().map(StoredFrame::as_frame).collect::<Vec<_>>());
        done += some.len() as u64;
        if let Some(cov_intra) = coating.note(done, &mut series)? {
            watch.cov_intra = Some(cov_intra);
        }
        let time = done as f64 * interval;
        let progress = Progress { stage: Stage::Running, time, of: interval, bodies: masses.len() };
        stopped = !watch.note(&progress);
        last = Some(end.clone());
    }
    if !stopped && done < poses.frames {
        watch.say(&format!("warning: only {done} of {} frames are whole", poses.frames));
    }
    let mut outcome = coating.outcome(done, &masses)?;
    for coating in outcome.shapes.values_mut().chain([&mut outcome.main]) {
        // Stored poses are at rest.
        *coating = CoatingRecord { passes: coating.passes.without_speed(), ..*coating };
    }
    record.status = if stopped { Status::Stopped } else { Status::Done };
    record.performance =
        Performance { wall_s: watch.wall_s(), coated_s: done as f64 * interval, ..Performance::default() };
    outcome.write(&directory, &mut record)?;
    if let (Some(drum), Some(last), true) = (&drum, &last, scene.outputs.picture) {
        outcome.picture(&directory, &bed, drum, &zone, &last.as_frame())?;
    }
    directory.write_record(&record)?;
    if stopped {
        return Err(Failure::Stopped(directory.path().to_owned()));
    }
    if scene.outputs.report {
        let page = crate::report::page(&ReportData::read(directory.path())?);
        directory.write("report.html", page.as_bytes())?;
    }
    drop(watch);
    print_line(&directory.path().display().to_string())
}

/// Stored poses.
struct Poses {
    stored: Box<dyn Iterator<Item = Result<StoredFrame, PoseError>>>,
    /// The frames of the first moments, which are among the stored ones.
    first: Vec<StoredFrame>,
    /// How many frames there are.
    frames: u64,
    body_shapes: Vec<usize>,
    aim: Option<RecordedAim>,
}

impl Poses {
    /// Opens a recording or, where it is none, a table.
    fn open(path: &Path, scene: &Scene) -> Result<Self, Failure> {
        let poses = match PoseReader::open(path) {
            Ok(reader) => {
                let recording = reader.recording().clone();
                Self {
                    frames: reader.frames_left()?,
                    stored: Box::new(reader),
                    first: Vec::new(),
                    body_shapes: recording.body_shapes,
                    aim: recording.aim,
                }
            }
            Err(PoseError::NotPoses { .. }) => {
                if scene.shapes.len() > 1 {
                    let what = "a table does not tell shapes, and the scene has several";
                    return Err(Failure::OtherPoses { path: path.to_owned(), what });
                }
                let speed = scene.drum.as_ref().map_or(0.0, |drum| drum.speed);
                let frames = read_pose_table(path, speed)?;
                Self {
                    frames: frames.len() as u64,
                    first: Vec::new(),
                    body_shapes: vec![0; frames.first().map_or(0, |frame| frame.bodies.len())],
                    stored: Box::new(frames.into_iter().map(Ok)),
                    aim: None,
                }
            }
            Err(other) => return Err(other.into()),
        };
        poses.with_first(path, scene.time.frame_interval, aiming_frames(scene) as usize)
    }

    /// Looks at the frames of the first moments, and at the time between them.
    fn with_first(mut self, path: &Path, interval: f64, moments: usize) -> Result<Self, Failure> {
        self.first = self.stored.by_ref().take(moments.max(2)).collect::<Result<_, _>>()?;
        if self.first.is_empty() {
            return Err(Failure::OtherPoses { path: path.to_owned(), what: "no whole frame" });
        }
        if let [one, two, ..] = &self.first[..] {
            let found = two.time - one.time;
            if (found / interval - 1.0).abs() > 0.01 {
                return Err(Failure::Interval { path: path.to_owned(), found, expected: interval });
            }
        }
        let again: Vec<_> = self.first.iter().cloned().map(Ok).collect();
        self.stored = Box::new(again.into_iter().chain(self.stored));
        Ok(self)
    }

    /// Mass of each body, kg.
    fn masses(&self, scene: &Scene, path: &Path) -> Result<Vec<f64>, Failure> {
        let batches = scene.batches.iter().map(|batch| (batch.shape, batch.tablet_mass));
        let known: Vec<_> = batches.chain(scene.bodies.iter().map(|body| (body.shape, body.mass))).collect();
        let mass = |shape: &usize| known.iter().find(|(of, _)| of == shape).map(|(_, mass)| *mass);
        let masses: Option<Vec<_>> = self.body_shapes.iter().map(mass).collect();
        let what = "it has bodies of a shape that the scene has not";
        masses.ok_or_else(|| Failure::OtherPoses { path: path.to_owned(), what })
    }

    /// The zone of the run that was recorded, unless the scene fixes it; else square to the bed of the first moments.
    fn zone(&self, spray: &Spray, shapes: &[TabletShape]) -> Result<SprayZone, Failure> {
        match (spray.aim, self.aim) {
            (Aim::Fixed { target, normal }, _) | (Aim::Bed, Some(RecordedAim { target, normal })) => {
                Ok(SprayZone::facing(target, normal, spray))
            }
            (Aim::Bed, None) => {
                let bodies = self.first.iter().flat_map(|frame| &frame.bodies);
                let positions: Vec<_> = bodies.map(|body| body.position).collect();
                Ok(surface(&positions, shapes, &self.body_shapes)?.zone(spray))
            }
        }
    }
}
