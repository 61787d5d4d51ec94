//! From a run folder to what its report shows.

use super::vtp::{self, VtpError};
use super::{
    Coating, Limit, Quantity, ReportData, RunDir, RunDirError, RunRecord, ShapeCoating, Status, ThicknessMap,
};

/// Why a report cannot be made of a folder.
#[derive(Debug, thiserror::Error)]
pub enum GatherError {
    /// A file of the run.
    #[error(transparent)]
    Folder(#[from] RunDirError),
    /// The coated surfaces.
    #[error("coating.vtp: {0}")]
    Surface(#[from] VtpError),
}

/// Gathers the record, the series, the coated surfaces and the picture of a run. What the run did not make is left
/// out of the report.
///
/// # Errors
/// A file that is there and cannot be read.
pub fn gather(directory: &RunDir) -> Result<ReportData, GatherError> {
    let record = directory.record()?;
    let made = |name: &str| directory.path().join(name).exists();
    let series = if made("series.csv") { directory.table("series.csv")? } else { Vec::new() };
    let maps = if made("coating.vtp") { vtp::read(&directory.text("coating.vtp")?)? } else { Vec::new() };
    let picture = directory.path().join("bed.png");
    let picture = made("bed.png").then(|| std::fs::read(&picture)).transpose();
    let picture =
        picture.map_err(|source| RunDirError::Read { path: directory.path().join("bed.png"), source })?;
    Ok(ReportData {
        title: record.title.clone(),
        series,
        shapes: shapes(&record, maps),
        bed: bed(&record),
        picture,
        numerics: numerics(&record),
        phases: record.performance.phases.clone().into_iter().collect(),
        identity_residual: record.guards.identity_residual,
        warnings: warnings(&record),
        provenance: provenance(&record),
        scene_text: directory.text("scene.ron")?,
    })
}

/// Shapes in the order of the surfaces, which is that of [`super::Derived::panels`].
fn shapes(record: &RunRecord, maps: Vec<ThicknessMap>) -> Vec<ShapeCoating> {
    let names = record.derived.panels.keys();
    let shape = |(name, map): (&String, ThicknessMap)| {
        let coating: &Coating = record.results.shapes.get(name).unwrap_or(&record.results.coating);
        let limit = coating.cov_intra_asymptote.map(|estimate| Limit {
            value: estimate.value,
            low: estimate.low,
            high: estimate.high,
            noise_time_s: coating.cov_intra_noise_time_s,
        });
        ShapeCoating {
            name: name.clone(),
            limit,
            orientation_only: coating.cov_intra_orientation_only,
            map: Some(map),
        }
    };
    names.zip(maps).map(shape).collect()
}

fn bed(record: &RunRecord) -> Vec<Quantity> {
    let bed = &record.results.bed;
    let figures = [
        ("Dynamic angle of repose", bed.angle_of_repose_deg, "angle_of_repose_deg", "°"),
        ("Mean speed", bed.mean_speed_m_per_s, "mean_speed_m_per_s", "m/s"),
        ("Speed down the surface", bed.surface_speed_m_per_s, "surface_speed_m_per_s", "m/s"),
        ("Angle of the centre of mass", bed.center_angle_deg, "center_angle_deg", "°"),
        ("Translational kinetic energy", bed.kinetic_energy_j, "kinetic_energy_J", "J"),
        ("Rotational kinetic energy", bed.rotational_energy_j, "rotational_energy_J", "J"),
        ("Drum torque", bed.drum_torque_n_m, "drum_torque_N_m", "N m"),
    ];
    let mut list: Vec<Quantity> = figures
        .into_iter()
        .filter_map(|(name, value, key, unit)| {
            let error = record.results.standard_errors.get(key).copied();
            value.map(|value| Quantity { name: name.into(), value, error, unit: unit.into() })
        })
        .collect();
    if let Some(share) = record.results.spray_efficiency {
        list.push(plain("Spray that hits tablets", 100.0 * share, "%"));
    }
    list
}

fn numerics(record: &RunRecord) -> Vec<Quantity> {
    let derived = &record.derived;
    vec![
        plain("Bodies", derived.bodies as f64, ""),
        plain("Time step", 1e6 * derived.step_s, "µs"),
        plain("Steps per contact", derived.steps_per_contact, ""),
        plain("Step over the Rayleigh time", 100.0 * derived.rayleigh_fraction, "%"),
        plain("Largest overlap over a sphere's radius", 100.0 * record.guards.deepest_overlap, "%"),
        plain("Steps", record.performance.steps as f64, ""),
        plain("Simulated time", record.performance.simulated_s, "s"),
        plain("Wall time", record.performance.wall_s, "s"),
    ]
}

fn plain(name: &str, value: f64, unit: &str) -> Quantity {
    Quantity { name: name.into(), value, error: None, unit: unit.into() }
}

fn warnings(record: &RunRecord) -> Vec<String> {
    let ended = match record.status {
        Status::Done => None,
        Status::Running => Some("The run is still going on, or was killed."),
        Status::Stopped => Some("The run was stopped before its end."),
        Status::Failed => Some("The run could not go on to its end."),
    };
    ended.map(str::to_owned).into_iter().chain(record.warnings.iter().cloned()).collect()
}

fn provenance(record: &RunRecord) -> Vec<(String, String)> {
    let machine = &record.machine;
    let rows = [
        ("Version", record.program_version.clone()),
        ("Scene hash", record.scene_hash.clone()),
        ("Seed", record.seed.to_string()),
        ("State hash", record.state_hash.clone().unwrap_or_default()),
        ("Machine", format!("{} {}, {} processors", machine.os, machine.arch, machine.cpus)),
        ("Threads", machine.threads.to_string()),
        ("Raster", record.backend.clone()),
    ];
    rows.into_iter()
        .filter(|(_, value)| !value.is_empty())
        .map(|(name, value)| (name.into(), value))
        .collect()
}
