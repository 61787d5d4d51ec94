//! Error of the coater against its run time: resolution, frame interval, panel count and the ratio estimator, on the
//! recorded poses of a run.
//!
//! `pancoat run round --set outputs.record=Compact --set 'time.frame_interval=Ms(5)' --seconds 4 --out runs/recorded`
//!
//! `cargo run --release --example coater_accuracy -- runs/recorded docs/data/coater`
//!
//! writes `docs/data/coater.csv` and `docs/data/coater.svg`. One thread; times are CPU times of it.
#![expect(clippy::print_stdout, reason = "an example prints its result")]

#[path = "../../tests/support/clipper.rs"]
mod clipper;
mod plot;
mod ratio;
mod study;

use pancoat::observers::{PoseReader, StoredFrame};
use pancoat::scene::Scene;
use std::path::PathBuf;
use study::{Bed, PIXELS, Row};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut args = std::env::args().skip(1).map(PathBuf::from);
    let (Some(run), Some(out)) = (args.next(), args.next()) else {
        return Err("give the folder of a run that recorded poses, and a file name for the results".into());
    };
    let scene = Scene::load(&run.join("scene.ron"), &[])?;
    let reader = PoseReader::open(&run.join("poses.bin"))?;
    let recording = reader.recording().clone();
    let frames: Vec<StoredFrame> = reader.collect::<Result<_, _>>()?;
    let bed = Bed::new(&scene, &recording, frames)?;

    let mut rows = bed.resolutions()?;
    rows.extend(bed.intervals()?);
    rows.extend(bed.panel_counts()?);
    rows.extend(ratio::rows(&bed)?);

    let mut table = csv::Writer::from_path(out.with_extension("csv"))?;
    println!("{}", Row::HEAD);
    for row in &rows {
        table.serialize(row)?;
        println!("{row}");
    }
    table.flush()?;
    std::fs::write(out.with_extension("svg"), plot::page(&rows, PIXELS))?;
    Ok(())
}
