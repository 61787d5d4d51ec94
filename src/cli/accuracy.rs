//! `pancoat accuracy`: what each choice of the numerics costs, and what it does to the results.
//!
//! One choice at a time is varied about the scene. Every case fills, settles, and turns under the scene's spray, if it has
//! one, with several seeds, on one thread; CPU time is that of turning and spraying alone, energy is audited afterwards.
//! Runs that are done are kept in the folder and not repeated.

use super::args::AccuracyArgs;
use super::coating::Coating;
use super::failure::Failure;
use super::watch::{Watch, clock};
use super::{bed, guards, print_line};
use crate::models::{Run, work_precision};
use crate::observers::{Backend, Observer};
use crate::report::{AccuracyAxis, AccuracyCase, accuracy_page, accuracy_table};
use crate::scene::{ContactMode, Recipe, Scene, SceneText, Shape};
use crate::stepping::{Simulation, SimulationError};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Time over which energy is audited, s.
const AUDITED: f64 = 0.25;

/// Figures that are compared, with their units: of the bed, and of the coating where a scene has a spray.
const FIGURES: [&str; 6] = [
    "mean_speed_m_per_s",
    "kinetic_energy_J",
    "center_angle_deg",
    "angle_of_repose_deg",
    "cov_inter",
    "cov_intra",
];
/// How many of them are of the bed.
const OF_BED: usize = 4;

/// A choice that is varied.
struct Axis {
    name: &'static str,
    /// What the settings are compared with.
    against: &'static str,
    why: &'static str,
    /// Name and overrides of each setting.
    settings: Vec<(String, Vec<String>)>,
    /// The setting that is the scene as it is.
    default: usize,
    /// The setting that others are compared with.
    reference: usize,
}

impl Axis {
    /// Leaves the scene as it is out where one of the settings says the same.
    fn leave_out_repeated_default(&mut self, args: &AccuracyArgs, base: &Scene) -> Result<(), Failure> {
        for k in (0..self.settings.len()).filter(|k| *k != self.default) {
            if scene_with(args, &self.settings[k].1)?.scene()? == *base {
                // It keeps its name, and runs as the scene does.
                self.settings[k].1.clear();
                self.settings.remove(self.default);
                let moved = |k: usize| k - usize::from(k > self.default);
                (self.reference, self.default) = (moved(self.reference), moved(k));
                break;
            }
        }
        Ok(())
    }
}

/// The scene of a setting.
fn scene_with(args: &AccuracyArgs, sets: &[String]) -> Result<SceneText, Failure> {
    Ok(args.scene.read_with(sets)?)
}

/// What is kept of a run.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Done {
    figures: Vec<f64>,
    cost: f64,
    /// Energy residual over what was dissipated; `None` with impulses.
    residual: Option<f64>,
    wall_s: f64,
    failure: Option<String>,
}

pub(super) fn accuracy(args: &AccuracyArgs) -> Result<(), Failure> {
    let base = scene_with(args, &[])?.scene()?;
    if base.drum.is_none() || base.batches.is_empty() {
        return Err(Failure::NoDrum);
    }
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global()?;
    let wanted = |axis: &Axis| args.only.is_empty() || args.only.iter().any(|name| name == axis.name);
    let mut axes: Vec<Axis> = axes(&base).into_iter().filter(wanted).collect();
    for axis in &mut axes {
        axis.leave_out_repeated_default(args, &base)?;
    }
    let folder =
        args.out.clone().unwrap_or_else(|| Path::new("runs").join("accuracy").join(args.scene.name()));
    std::fs::create_dir_all(&folder).map_err(Failure::Output)?;
    let mut campaign = Campaign { args, folder, watch: Watch::new(None, args.quiet)?, done: BTreeMap::new() };
    campaign.run_all(&axes)?;
    let axes: Vec<AccuracyAxis> = axes.iter().map(|axis| campaign.compared(axis)).collect();
    campaign.write(&base.title, base.spray.is_some(), &axes)
}

/// Whether the clump of a shape can have any number of spheres.
fn is_fitted(shape: &Shape) -> bool {
    !matches!(shape.recipe, Recipe::Sphere { .. } | Recipe::Clump { .. })
}

/// The choices of a scene.
fn axes(scene: &Scene) -> Vec<Axis> {
    let one = |name: &str, set: String| (name.to_owned(), vec![set]);
    let scaled = |factor: f64| {
        let stiffer = scene
            .materials
            .iter()
            .map(|m| format!("materials[{:?}].shear_modulus=Pa({})", m.name, m.shear_modulus * factor));
        (format!("{factor} G"), stiffer.collect())
    };
    let spheres = |count: usize| {
        let fitted = scene.shapes.iter().filter(|shape| is_fitted(shape));
        let sets = fitted.map(|shape| format!("shapes[{:?}].spheres={count}", shape.name));
        (format!("{count} spheres"), sets.collect())
    };
    let as_is = || ("as in the scene".to_owned(), Vec::new());
    let steps = [8.0, 10.0, 12.0, 15.0, 20.0, 25.0, 40.0, 100.0];
    let mut axes = vec![
        Axis {
            name: "step",
            against: "the finest step",
            why: "The contact law fixes the result only in the limit of a fine step.",
            settings: steps
                .map(|n| one(&format!("{n} steps per contact"), format!("time.step=PerContact({n})")))
                .into_iter()
                .chain([as_is()])
                .collect(),
            default: steps.len(),
            reference: steps.len() - 1,
        },
        Axis {
            name: "modulus",
            against: "the stiffest material",
            why: "Softer tablets than real ones make larger steps possible; the scene's modulus is its source's.",
            settings: vec![scaled(0.1), scaled(0.3), as_is(), scaled(3.0), scaled(10.0)],
            default: 2,
            reference: 4,
        },
        Axis {
            name: "tangential",
            against: "the total law",
            why: "Total is the law of EDEM, LIGGGHTS, MUSEN and MFiX, whose results are to be met.",
            settings: ["Total", "Incremental", "Rescaled"]
                .map(|law| one(law, format!("contact.tangential={law}")))
                .into_iter()
                .chain([as_is()])
                .collect(),
            default: 3,
            reference: 0,
        },
        Axis {
            name: "mode",
            against: "Hertz-Mindlin contacts",
            why: "Impulses know neither overlap nor contact time: they are for a quick look.",
            settings: [one("Hertz-Mindlin", "contact.mode=HertzMindlin".to_owned()), as_is()]
                .into_iter()
                .chain([1, 2].map(|ms| {
                    one(&format!("Impulse, {ms} ms"), format!("contact.mode=Impulse(step: Ms({ms}))"))
                }))
                .collect(),
            default: 1,
            reference: 0,
        },
    ];
    if scene.shapes.iter().any(is_fitted) {
        axes.insert(
            2,
            Axis {
                name: "spheres",
                against: "the finest clump",
                why: "Spheres round off edges and roughen faces: more of them come nearer to the solid.",
                settings: vec![spheres(10), spheres(20), as_is(), spheres(100)],
                default: 2,
                reference: 3,
            },
        );
    }
    axes
}

struct Campaign<'a> {
    args: &'a AccuracyArgs,
    folder: PathBuf,
    watch: Watch,
    /// Runs by the hash of what they ran.
    done: BTreeMap<String, Done>,
}

impl Campaign<'_> {
    /// The scene of a setting with a seed, and the name under which its run is kept.
    fn case(&self, sets: &[String], seed: u64) -> Result<(String, SceneText), Failure> {
        let text = scene_with(self.args, &[&[format!("seed={seed}")], sets].concat())?;
        let said = format!("{} {} {}", env!("CARGO_PKG_VERSION"), self.args.seconds, text.text());
        Ok((blake3::hash(said.as_bytes()).to_hex()[..16].to_owned(), text))
    }

    fn run_all(&mut self, axes: &[Axis]) -> Result<(), Failure> {
        let mut waiting = Vec::new();
        for (axis, (setting, sets)) in axes.iter().flat_map(|a| a.settings.iter().map(move |s| (a.name, s))) {
            for seed in 1..=self.args.seeds {
                let (key, text) = self.case(sets, seed)?;
                let kept =
                    std::fs::read(self.kept(&key)).ok().and_then(|json| serde_json::from_slice(&json).ok());
                match kept {
                    Some(done) => drop(self.done.insert(key, done)),
                    None if waiting.iter().any(|(_, _, other)| *other == key) => {}
                    None => waiting.push((format!("{axis}: {setting}, seed {seed}"), text, key)),
                }
            }
        }
        let (start, all) = (Instant::now(), waiting.len());
        for (k, (name, text, key)) in waiting.into_iter().enumerate() {
            let left = start.elapsed().as_secs_f64() / k.max(1) as f64 * (all - k) as f64;
            let left = if k == 0 { String::new() } else { format!(", about {} left", clock(left)) };
            self.watch.say(&format!("run {} of {all}{left}: {name}", k + 1));
            let scene = text.scene()?;
            let began = Instant::now();
            let mut done = match self.run(&scene) {
                Err(Failure::Simulation(SimulationError::Stopped { .. })) => {
                    return Err(Failure::Stopped(self.folder.clone()));
                }
                Err(failure) => Done {
                    figures: Vec::new(),
                    cost: 0.0,
                    residual: None,
                    wall_s: 0.0,
                    failure: Some(failure.to_string()),
                },
                Ok(done) => done,
            };
            done.wall_s = began.elapsed().as_secs_f64();
            let json = serde_json::to_vec_pretty(&done).map_err(|fault| Failure::Output(fault.into()))?;
            std::fs::write(self.kept(&key), json).map_err(Failure::Output)?;
            self.done.insert(key, done);
        }
        Ok(())
    }

    fn kept(&self, key: &str) -> PathBuf {
        self.folder.join(format!("{key}.json"))
    }

    fn run(&mut self, scene: &Scene) -> Result<Done, Failure> {
        let mut simulation = Simulation::new(scene)?;
        guards::refuse(scene, simulation.shapes(), simulation.time_step())?;
        let mut watch = |progress: &_| self.watch.note(progress);
        simulation.fill(&mut watch)?;
        simulation.settle(&mut watch)?;
        let drum = scene.drum.as_ref().ok_or(Failure::NoDrum)?;
        let mut statistics = bed::statistics(&simulation, drum);
        let frames = |time: f64| (time / scene.time.frame_interval).round().max(1.0) as u64;
        let turning = frames(self.args.seconds);
        let mut coating = match &scene.spray {
            None => None,
            Some(spray) => {
                let zone = bed::aim(&mut simulation, spray, &mut self.watch)?;
                Some(Coating::new(scene, &bed::of(&simulation), spray, zone, turning, Backend::Cpu)?)
            }
        };
        self.watch.begin("turning", self.args.seconds);
        let before = cpu_time()?;
        let mut observers: Vec<&mut dyn Observer> = vec![&mut statistics];
        observers.extend(coating.iter_mut().map(|coating| &mut coating.coater as &mut dyn Observer));
        let mut watch = |progress: &_| self.watch.note(progress);
        simulation.run(0, turning, &mut observers, &mut watch)?;
        let spent = cpu_time()?.saturating_sub(before);
        let mut results = crate::report::Results::default();
        if let Some(figures) = statistics.figures() {
            bed::record(&figures, &mut results);
        }
        let of_bed = &results.bed;
        let mut figures = vec![
            of_bed.mean_speed_m_per_s,
            of_bed.kinetic_energy_j,
            of_bed.center_angle_deg,
            of_bed.angle_of_repose_deg,
        ];
        if let Some(coating) = &mut coating {
            let of_coating = coating.outcome(turning, &simulation.masses())?.main;
            figures.extend([of_coating.cov_inter, of_coating.cov_intra]);
        }
        if scene.contact.mode == ContactMode::HertzMindlin {
            simulation.audit_energy();
            simulation.run(0, frames(AUDITED), &mut [], &mut watch)?;
        }
        Ok(Done {
            figures: figures.into_iter().map(Option::unwrap_or_default).collect(),
            cost: spent.as_secs_f64() / self.args.seconds,
            residual: simulation.energy().map(|energy| energy.residual() / energy.dissipated()),
            wall_s: 0.0,
            failure: None,
        })
    }

    fn compared(&self, axis: &Axis) -> AccuracyAxis {
        let of = |sets: &[String]| -> Vec<&Done> {
            let keys = (1..=self.args.seeds).filter_map(|seed| self.case(sets, seed).ok());
            keys.filter_map(|(key, _)| self.done.get(&key)).collect()
        };
        let done: Vec<Vec<&Done>> = axis.settings.iter().map(|(_, sets)| of(sets)).collect();
        let runs: Vec<Vec<Run>> = done
            .iter()
            .map(|done| {
                let failed = done.iter().any(|d| d.failure.is_some());
                let run = |d: &&Done| Run { figures: d.figures.clone(), cost: d.cost };
                if failed { Vec::new() } else { done.iter().map(run).collect() }
            })
            .collect();
        let compared = work_precision(&runs, axis.reference);
        let cases = axis.settings.iter().zip(compared).zip(&done).enumerate();
        AccuracyAxis {
            name: axis.name.to_owned(),
            against: axis.against.to_owned(),
            why: axis.why.to_owned(),
            cases: cases
                .map(|(k, (((setting, _), precision), done))| AccuracyCase {
                    setting: setting.clone(),
                    is_default: k == axis.default,
                    precision,
                    residual: done
                        .iter()
                        .filter_map(|d| d.residual)
                        .max_by(|a, b| a.abs().total_cmp(&b.abs())),
                    failure: done.iter().find_map(|d| d.failure.clone()),
                })
                .collect(),
        }
    }

    fn write(&self, title: &str, sprays: bool, axes: &[AccuracyAxis]) -> Result<(), Failure> {
        let mut csv = csv::Writer::from_path(self.folder.join("accuracy.csv"))
            .map_err(|fault| Failure::Output(fault.into()))?;
        let figures = &FIGURES[..if sprays { FIGURES.len() } else { OF_BED }];
        let rows = axes.iter().flat_map(|axis| axis.rows(figures));
        let header = AccuracyAxis::header(figures);
        for row in std::iter::once(header).chain(rows) {
            csv.write_record(row).map_err(|fault| Failure::Output(fault.into()))?;
        }
        csv.flush().map_err(Failure::Output)?;
        let note = format!("{} seeds of {} s each", self.args.seeds, self.args.seconds);
        std::fs::write(self.folder.join("accuracy.md"), accuracy_table(axes)).map_err(Failure::Output)?;
        let page = self.folder.join("accuracy.html");
        std::fs::write(&page, accuracy_page(title, &note, axes)).map_err(Failure::Output)?;
        print_line(&page.display().to_string())
    }
}

/// CPU time of this process so far.
fn cpu_time() -> Result<Duration, Failure> {
    cpu_time::ProcessTime::try_now().map(|time| time.as_duration()).map_err(Failure::Output)
}
