//! Why a command did not do what it was asked for.

use super::coating::CoatingError;
use super::guards::Refusal;
use crate::models::ModelError;
use crate::models::thz::ThzError;
use crate::observers::{AimError, CoaterError, PoseError};
use crate::report::{ReportError, RunDirError};
use crate::scene::SceneFaults;
use crate::shapes::ShapeError;
use crate::stepping::SimulationError;
use std::path::PathBuf;
use std::process::ExitCode;

/// Exit code of a run that was asked to stop (`EX_TEMPFAIL` of sysexits.h: try again).
const STOPPED: u8 = 75;

#[derive(Debug, thiserror::Error)]
pub(super) enum Failure {
    #[error(transparent)]
    Scene(#[from] SceneFaults),
    #[error("{}: nothing is coated yet; the scene needs a spray and its run an output time", .0.display())]
    NothingCoated(PathBuf),
    #[error("{} and {} hold the same run: beds to take together differ in their seed, as by --set seed=2", .0[0].display(), .0[1].display())]
    SameRun([PathBuf; 2]),
    #[error("{}: {source}", path.display())]
    Scan { path: PathBuf, source: ThzError },
    #[error("cannot write {}: {source}", path.display())]
    NewScene { path: PathBuf, source: std::io::Error },
    #[error("the scene has no drum")]
    NoDrum,
    #[error("the scene has no spray")]
    NoSpray,
    #[error(transparent)]
    Poses(#[from] PoseError),
    #[error("{}: {what}", path.display())]
    OtherPoses { path: PathBuf, what: &'static str },
    #[error(
        "{}: frames are {found} s apart, in the scene {expected} s: set time.frame_interval",
        path.display()
    )]
    Interval { path: PathBuf, found: f64, expected: f64 },
    #[error("refused: {0}; --force runs it all the same")]
    Refused(#[from] Refusal),
    #[error(transparent)]
    Shape(#[from] ShapeError),
    #[error(transparent)]
    Folder(#[from] RunDirError),
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    #[error(transparent)]
    Aim(#[from] AimError),
    #[error(transparent)]
    Coater(#[from] CoaterError),
    #[error("coating statistics: {0}")]
    Model(#[from] ModelError),
    #[error(transparent)]
    Coating(#[from] CoatingError),
    #[error("cannot start threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    #[error("cannot watch for Ctrl-C: {0}")]
    Signals(#[from] ctrlc::Error),
    #[error("cannot write: {0}")]
    Output(std::io::Error),
    #[error("stopped on request; what was simulated is in {}", .0.display())]
    Stopped(PathBuf),
}

impl Failure {
    pub(super) fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Stopped(_) => STOPPED,
            Self::Folder(RunDirError::Write { .. }) => 1,
            Self::Scene(_)
            | Self::NoDrum
            | Self::NoSpray
            | Self::Poses(_)
            | Self::OtherPoses { .. }
            | Self::Interval { .. }
            | Self::Coater(_)
            | Self::NothingCoated(_)
            | Self::SameRun(_)
            | Self::NewScene { .. }
            | Self::Scan { .. }
            | Self::Refused(_)
            | Self::Shape(_)
            | Self::Folder(_)
            | Self::Report(_)
            | Self::Simulation(
                SimulationError::Shape(_)
                | SimulationError::Full { .. }
                | SimulationError::StartOverlap { .. },
            ) => 2,
            _ => 1,
        })
    }
}
