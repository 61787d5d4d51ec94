//! The command line: arguments in, exit code out. Results go to stdout, progress and warnings to stderr.
//!
//! Exit codes: 0 done, 1 the run failed, 2 the input is at fault, 75 stopped on request.

mod accuracy;
mod args;
mod bed;
mod bodies;
mod check;
mod coat;
mod coating;
mod compare;
mod depth;
mod failure;
mod guards;
mod memory;
mod new;
mod outcome;
mod pace;
mod predict;
mod run;
mod scene_arg;
mod shape;
mod watch;

use args::{Args, Command};
use clap::Parser;
use failure::Failure;
use std::io::Write as _;
use std::process::ExitCode;

/// Runs the program.
pub fn main() -> ExitCode {
    let done = match Args::parse().command {
        Command::Run(args) => run::run(&args),
        Command::Coat(args) => coat::coat(&args),
        Command::Check(args) => check::check(&args),
        Command::Drum(args) => drum(&args),
        Command::Report(args) => report(&args),
        Command::Shape(args) => shape::shape(&args),
        Command::New(args) => new::new(&args),
        Command::Predict(args) => predict::predict(&args),
        Command::Accuracy(args) => accuracy::accuracy(&args),
        Command::Compare(args) => compare::compare(&args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("{failure}");
            failure.exit_code()
        }
    }
}

/// Writes the drum's mesh as STL in mm.
fn drum(args: &args::DrumArgs) -> Result<(), Failure> {
    let scene = args.scene.read()?.scene()?;
    let drum = scene.drum.as_ref().ok_or(Failure::NoDrum)?;
    crate::shapes::write_stl(&crate::shapes::drum_surface(drum)?.mesh, &args.out, 1e-3)?;
    print_line(&args.out.display().to_string())
}

/// Makes `report.html` of a run folder anew.
fn report(args: &args::ReportArgs) -> Result<(), Failure> {
    let directory = crate::report::RunDir::open(&args.directory)?;
    let page = crate::report::page(&crate::report::ReportData::read(directory.path())?);
    directory.write("report.html", page.as_bytes())?;
    print_line(&args.directory.join("report.html").display().to_string())
}

/// Prints a result. A reader that has gone away (`| head`) is no fault.
fn print_line(line: &str) -> Result<(), Failure> {
    match writeln!(std::io::stdout(), "{line}") {
        Err(fault) if fault.kind() != std::io::ErrorKind::BrokenPipe => Err(Failure::Output(fault)),
        _ => Ok(()),
    }
}
