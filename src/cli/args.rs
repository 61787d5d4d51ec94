//! What a user can type.

use super::scene_arg::SceneArg;
use crate::observers::Backend;
use clap::{Args as ClapArgs, Parser, Subcommand};
use std::path::PathBuf;
use std::time::Duration;

/// Tumbles tablets in a pan, sprays them, and predicts how uniform their coating gets.
#[derive(Debug, Parser)]
#[command(version, about)]
pub(super) struct Args {
    #[command(subcommand)]
    pub(super) command: Command,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Run a scene: fill, settle, spray, and report
    Run(RunArgs),
    /// Spray stored poses, of a run that recorded them or of another program, without simulating
    Coat(CoatArgs),
    /// Say what a scene would do, what it leaves out, its time step and its cost
    Check(CheckArgs),
    /// Say the measures of a scene's tablet shapes, how good their panels and clumps are, and write them as files
    Shape(ShapeArgs),
    /// Write a built-in scene as a file to begin with
    New(NewArgs),
    /// Write the drum of a scene as an STL mesh, in mm
    Drum(DrumArgs),
    /// Make report.html of a run's folder anew
    Report(ReportArgs),
    /// Say how uniform the tablets of a run can get, when, and how many to measure; also while it runs
    Predict(PredictArgs),
    /// Say what each choice of the numerics costs and changes: step, modulus, spheres, tangential law, contact mode
    Accuracy(AccuracyArgs),
    /// Put runs side by side, or a run against terahertz scans of real tablets
    Compare(CompareArgs),
}

#[derive(Debug, ClapArgs)]
pub(super) struct RunArgs {
    #[command(flatten)]
    pub(super) scene: SceneArg,
    /// Folder of the results [default: runs/NAME of the scene]
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Coated time in seconds, in place of the scene's
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub(super) seconds: Option<f64>,
    /// Threads [default: one per processor]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) threads: Option<u16>,
    /// What draws the spray; counts of a graphics card differ from the processor's in single pixels
    #[arg(long, value_name = "NAME", value_enum, default_value_t)]
    pub(super) backend: BackendArg,
    /// Stop after this wall time (90s, 30m, 2h) and keep what there is
    #[arg(long, value_name = "TIME", value_parser = wall_time)]
    pub(super) max_wall: Option<Duration>,
    /// Run what would be refused for its time step, its length or its memory
    #[arg(long)]
    pub(super) force: bool,
    /// No progress on stderr
    #[arg(long)]
    pub(super) quiet: bool,
}

/// What draws the spray.
#[derive(Debug, Clone, Copy, Default, clap::ValueEnum)]
pub(super) enum BackendArg {
    /// A graphics card where there is one, else the processor
    #[default]
    Auto,
    /// The processor
    Cpu,
    /// A graphics card
    Gpu,
    /// A program that acts as a graphics card, slower than the processor
    GpuSoftware,
}

impl From<BackendArg> for Backend {
    fn from(backend: BackendArg) -> Self {
        match backend {
            BackendArg::Auto => Self::Auto,
            BackendArg::Cpu => Self::Cpu,
            BackendArg::Gpu => Self::Gpu,
            BackendArg::GpuSoftware => Self::GpuSoftware,
        }
    }
}

#[derive(Debug, ClapArgs)]
pub(super) struct CoatArgs {
    #[command(flatten)]
    pub(super) scene: SceneArg,
    /// Recording of a run (poses.bin), or a CSV table with the columns time_s, id, x, y, z, qw, qx, qy, qz (m, body to
    /// world axes)
    #[arg(long, value_name = "FILE")]
    pub(super) poses: PathBuf,
    /// Folder of the results [default: runs/NAME of the scene with `_coated` added]
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Threads [default: one per processor]; results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(super) threads: Option<u16>,
    /// What draws the spray; counts of a graphics card differ from the processor's in single pixels
    #[arg(long, value_name = "NAME", value_enum, default_value_t)]
    pub(super) backend: BackendArg,
    /// No progress on stderr
    #[arg(long)]
    pub(super) quiet: bool,
}

#[derive(Debug, ClapArgs)]
pub(super) struct CheckArgs {
    #[command(flatten)]
    pub(super) scene: SceneArg,
}

#[derive(Debug, ClapArgs)]
pub(super) struct ShapeArgs {
    #[command(flatten)]
    pub(super) scene: SceneArg,
    /// One JSON line for each shape
    #[arg(long)]
    pub(super) json: bool,
    /// Also the error of clumps of 10 to 400 spheres, which takes a while
    #[arg(long)]
    pub(super) clumps: bool,
    /// Folder for each shape's page, its panels as STL, OBJ (mm) and VTP, and its clump as lines of x y z r (mm)
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
}

#[derive(Debug, ClapArgs)]
pub(super) struct NewArgs {
    /// Built-in scene
    #[arg(value_name = "NAME")]
    pub(super) name: String,
    /// File to write [default: NAME.ron]
    #[arg(long, value_name = "FILE")]
    pub(super) out: Option<PathBuf>,
}

#[derive(Debug, ClapArgs)]
pub(super) struct DrumArgs {
    #[command(flatten)]
    pub(super) scene: SceneArg,
    /// File to write
    #[arg(long, value_name = "FILE", default_value = "drum.stl")]
    pub(super) out: PathBuf,
}

#[derive(Debug, ClapArgs)]
pub(super) struct ReportArgs {
    /// Folder of a run
    #[arg(value_name = "DIR")]
    pub(super) directory: PathBuf,
}

#[derive(Debug, ClapArgs)]
pub(super) struct PredictArgs {
    /// Folder of a run; several, of beds that differ in their seed only, are taken together as well
    #[arg(value_name = "DIR", required = true)]
    pub(super) directories: Vec<PathBuf>,
    /// CoV to reach
    #[arg(long, value_name = "COV", default_value = "0.1", value_parser = share)]
    pub(super) target: f64,
    /// Relative error that measured tablets are to have, at 95 % confidence
    #[arg(long, value_name = "SHARE", default_value = "0.1", value_parser = share)]
    pub(super) error: f64,
}

#[derive(Debug, ClapArgs)]
pub(super) struct AccuracyArgs {
    #[command(flatten)]
    pub(super) scene: SceneArg,
    /// Folder of the results; runs that are done there are not repeated [default: runs/accuracy/NAME]
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Seeds of each case, for the confidence intervals
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u64).range(2..=1000))]
    pub(super) seeds: u64,
    /// Time that a settled bed turns in each run, in seconds
    #[arg(long, value_name = "S", default_value = "4", value_parser = seconds)]
    pub(super) seconds: f64,
    /// Only these choices
    #[arg(long, value_name = "CHOICE", value_delimiter = ',', value_parser = ["step", "modulus", "spheres", "tangential", "mode"])]
    pub(super) only: Vec<String>,
    /// No progress on stderr
    #[arg(long)]
    pub(super) quiet: bool,
}

#[derive(Debug, ClapArgs)]
pub(super) struct CompareArgs {
    /// Folders of runs
    #[arg(value_name = "DIR", required = true)]
    pub(super) directories: Vec<PathBuf>,
    /// Scan of a tablet, a CSV table with the columns x, y, z, thickness (each with _mm, _um or _m) and reflectivity;
    /// once for each tablet. The first run is compared
    #[arg(long, value_name = "FILE")]
    pub(super) thz: Vec<PathBuf>,
    /// Least reflectivity of a point that counts
    #[arg(long, value_name = "SHARE", default_value_t = crate::models::thz::ThzScan::CUT, requires = "thz", value_parser = share)]
    pub(super) cut: f64,
    /// Shape of the scanned tablets [default: the first of the run]
    #[arg(long, value_name = "NAME", requires = "thz")]
    pub(super) shape: Option<String>,
    /// Also all numbers of the runs' results as a CSV table, one row for each folder
    #[arg(long, value_name = "FILE")]
    pub(super) csv: Option<PathBuf>,
    /// Page to write
    #[arg(long, value_name = "FILE", default_value = "compare.html")]
    pub(super) out: PathBuf,
}

fn share(text: &str) -> Result<f64, String> {
    above_zero(text, "a number such as 0.1")
}

fn seconds(text: &str) -> Result<f64, String> {
    above_zero(text, "a number of seconds")
}

fn above_zero(text: &str, what: &str) -> Result<f64, String> {
    let value = text.parse().map_err(|_| format!("expected {what}"))?;
    if value > 0.0 && f64::is_finite(value) { Ok(value) } else { Err("must be above 0".to_owned()) }
}

/// `90s`, `30m`, `2h`, or a number of seconds.
fn wall_time(text: &str) -> Result<Duration, String> {
    let (number, unit) = match text.char_indices().next_back() {
        Some((end, 's')) => (&text[..end], 1.0),
        Some((end, 'm')) => (&text[..end], 60.0),
        Some((end, 'h')) => (&text[..end], 3600.0),
        _ => (text, 1.0),
    };
    let seconds = number.parse::<f64>().ok().and_then(|n| Duration::try_from_secs_f64(n * unit).ok());
    seconds.filter(|time| !time.is_zero()).ok_or_else(|| "expected a time such as 90s, 30m or 2h".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn arguments_are_consistent() {
        Args::command().debug_assert();
    }

    #[test]
    fn times_have_units() {
        assert_eq!(wall_time("2h"), Ok(Duration::from_hours(2)));
        assert_eq!(wall_time("1.5m"), Ok(Duration::from_secs(90)));
        assert_eq!(wall_time("90"), wall_time("90s"));
        for text in ["", "h", "-1s", "0s", "1d", "nan", "1e300h", "5µ"] {
            assert!(wall_time(text).is_err(), "{text}");
        }
        assert!(seconds("0").is_err() && seconds("inf").is_err() && seconds("0.5") == Ok(0.5));
    }
}
