//! `run.json`: what was run, on what, with which settings, and what came out. One file says it all for other tools.
//!
//! Keys carry their units. A figure that a run does not have (no spray, stopped too early) is left out, never 0.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Version of the record's layout.
pub const RECORD_FORMAT: u32 = 1;

/// The record of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunRecord {
    /// [`RECORD_FORMAT`].
    pub format: u32,
    /// Title of the scene.
    pub title: String,
    /// How the run ended.
    pub status: Status,
    /// BLAKE3 of `scene.ron`, hexadecimal.
    pub scene_hash: String,
    /// Seed of the scene.
    pub seed: u64,
    /// Version of the program.
    pub program_version: String,
    /// Where it ran.
    pub machine: Machine,
    /// What rastered the spray.
    pub backend: String,
    /// What follows from the scene.
    pub derived: Derived,
    /// What says whether the numbers can be trusted.
    pub guards: Guards,
    /// What the run warned of, each with advice.
    pub warnings: Vec<String>,
    /// What came out.
    pub results: Results,
    /// What it cost.
    pub performance: Performance,
    /// Fingerprint of the bodies' final state, bit by bit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub state_hash: Option<String>,
}

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// It is still going on, or was killed.
    Running,
    /// It did all that the scene asks for.
    Done,
    /// It was asked to stop before the end; what it has is here.
    Stopped,
    /// It could not go on.
    Failed,
}

/// A machine.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// Operating system.
    pub os: String,
    /// Processor architecture.
    pub arch: String,
    /// Processors it offers.
    pub cpus: usize,
    /// Threads used.
    pub threads: usize,
}

/// What follows from a scene.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Derived {
    /// Bodies in motion.
    pub bodies: usize,
    /// Spheres of each shape's clump.
    pub spheres: BTreeMap<String, usize>,
    /// Panels of each shape; empty without a spray.
    pub panels: BTreeMap<String, usize>,
    /// Time step, s.
    pub time_step_s: f64,
    /// Shortest elastic contact at the scene's impact speed, s.
    pub contact_time_s: f64,
    /// Steps in that contact.
    pub steps_per_contact: f64,
    /// Step over the Rayleigh time of the smallest sphere.
    pub rayleigh_fraction: f64,
    /// Filling and settling before the coated time, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub settling_s: Option<f64>,
    /// Where the spray points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spray: Option<SprayAim>,
    /// File of the poses that were coated in place of a simulation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub poses: Option<String>,
    /// Film volume that a pixel of a frame stands for, m³ (k_V of the paper's Eq 4).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub film_volume_per_count_m3: Option<f64>,
}

/// Where a spray points.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SprayAim {
    /// Middle of the zone, mm.
    pub center_mm: [f64; 3],
    /// Unit vector from the zone to the nozzle.
    pub normal: [f64; 3],
}

/// What says whether the numbers can be trusted.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Guards {
    /// Largest overlap of the run over the smaller sphere's radius, %.
    pub largest_overlap_percent: f64,
    /// Share of bodies and steps in which a body was held stiffer than the step bears, so that its forces were lowered, %.
    #[serde(default)]
    pub too_stiff_percent: f64,
    /// Share of the steps that were taken in pieces, because a body was too fast for a whole one, %.
    #[serde(default)]
    pub divided_steps_percent: f64,
    /// Frames that went wrong and were repeated in finer steps.
    #[serde(default)]
    pub repeated_frames: u64,
    /// Where energy is and where it went over the coated time, if the scene asks for the audit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy: Option<EnergyAudit>,
}

/// Energies at the end of a run and what went where since coating began, J.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct EnergyAudit {
    /// Kinetic energy.
    #[serde(rename = "kinetic_J")]
    pub kinetic_j: f64,
    /// Potential energy in gravity.
    #[serde(rename = "potential_J")]
    pub potential_j: f64,
    /// Elastic energy of overlaps.
    #[serde(rename = "elastic_normal_J")]
    pub elastic_normal_j: f64,
    /// Elastic energy of tangential springs.
    #[serde(rename = "elastic_tangential_J")]
    pub elastic_tangential_j: f64,
    /// Dissipated by normal dashpots.
    #[serde(rename = "normal_dashpots_J")]
    pub normal_dashpots_j: f64,
    /// Dissipated by tangential dashpots.
    #[serde(rename = "tangential_dashpots_J")]
    pub tangential_dashpots_j: f64,
    /// Dissipated by sliding.
    #[serde(rename = "sliding_J")]
    pub sliding_j: f64,
    /// Lost from springs whose stiffness changed; negative where the tangential law creates energy.
    #[serde(rename = "stiffness_change_J")]
    pub stiffness_change_j: f64,
    /// Work of the walls on the bodies.
    #[serde(rename = "wall_work_J")]
    pub wall_work_j: f64,
    /// What does not sum up: the error of the motion.
    #[serde(rename = "residual_J")]
    pub residual_j: f64,
    /// The same over what was dissipated.
    pub residual_over_dissipated: f64,
}

/// What came out.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Results {
    /// Coating of the shape with the most tablets.
    #[serde(flatten)]
    pub coating: Coating,
    /// Largest residual of the averaging identities, round-off when all is well.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cov_identity_residual: Option<f64>,
    /// Share of the sprayed counts that hit tablets.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spray_efficiency: Option<f64>,
    /// Figures of the bed, absent without statistics.
    #[serde(flatten)]
    pub bed: Bed,
    /// Standard errors of figures of the bed, by their keys.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub standard_errors: BTreeMap<String, f64>,
    /// Coating of each shape, when there are several.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub shapes: BTreeMap<String, Coating>,
}

/// Coating of one shape.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Coating {
    /// CoV_intra by averaging moments (Eq 8).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cov_intra: Option<f64>,
    /// CoV of the mean thickness between tablets.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cov_inter: Option<f64>,
    /// The limit of CoV_intra.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cov_intra_asymptote: Option<Estimate>,
    /// Limit of the orientation-only model.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cov_intra_orientation_only: Option<f64>,
    /// The same by the Monte Carlo of Freireich et al. 2011, 400 trials of 100 tablets.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cov_intra_orientation_monte_carlo: Option<f64>,
    /// The same from the order tensor alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cov_intra_order_tensor: Option<f64>,
    /// Mean thickness, µm.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_thickness_um: Option<f64>,
    /// Power of time with which CoV_inter falls after 10 s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cov_inter_exponent: Option<Exponent>,
    /// Power of time with which the standard deviation of CoV_intra,i over tablets falls, once all are coated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sd_cov_intra_exponent: Option<Exponent>,
    /// Band over cap, each per area: 1 is even, below 1 caps are favoured (Kalbag and Wassgren 2008).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub orientation_index: Option<f64>,
    /// How tablets meet the spray.
    #[serde(flatten)]
    pub passes: Passes,
}

/// A fitted power of time with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Exponent {
    /// The value.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// How tablets of a shape meet the spray.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Passes {
    /// Tablets in the spray at a time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tablets_in_spray: Option<f64>,
    /// Passes of a tablet through the spray per minute.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub passes_per_min: Option<f64>,
    /// Mean duration of a pass, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pass_duration_s: Option<f64>,
    /// CoV over tablets of the time in the spray.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cov_residence_time: Option<f64>,
    /// Mean speed in the spray, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_in_spray_m_per_s: Option<f64>,
    /// Order of the tablets' axes to the spray: 1 for caps always up, 0 for random, −1/2 for always on edge.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub order_to_spray: Option<f64>,
}

impl Passes {
    /// The same but for the speed, which is not known.
    #[must_use]
    pub fn without_speed(self) -> Self {
        Self { speed_in_spray_m_per_s: None, ..self }
    }
}

/// The limit of CoV_intra with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// K of CoV_intra² = CoV_∞² + K/t, s.
    pub noise_time_s: f64,
}

/// Figures of the bed, means over the coated time.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Bed {
    /// Dynamic angle of repose, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub angle_of_repose_deg: Option<f64>,
    /// Mean speed of the tablets, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_speed_m_per_s: Option<f64>,
    /// Translational kinetic energy, J.
    #[serde(rename = "kinetic_energy_J", skip_serializing_if = "Option::is_none")]
    pub kinetic_energy_j: Option<f64>,
    /// Rotational kinetic energy, J.
    #[serde(rename = "rotational_energy_J", skip_serializing_if = "Option::is_none")]
    pub rotational_energy_j: Option<f64>,
    /// Angle of the bed's centre of mass from straight down, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub center_angle_deg: Option<f64>,
    /// Speed down the slope in the surface, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub surface_speed_m_per_s: Option<f64>,
    /// Torque that the drive puts on the drum, N m.
    #[serde(rename = "drum_torque_N_m", skip_serializing_if = "Option::is_none")]
    pub drum_torque_n_m: Option<f64>,
}

/// What a run cost.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Performance {
    /// Wall time of the run, s.
    pub wall_s: f64,
    /// Simulated time, filling and settling included, s.
    pub simulated_s: f64,
    /// Coated time (run time without a spray), s.
    pub coated_s: f64,
    /// Time steps taken.
    pub steps: u64,
    /// Wall time of each phase, s.
    pub phases: BTreeMap<String, f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_that_other_tools_rely_on_are_where_they_look() {
        let record = RunRecord {
            format: RECORD_FORMAT,
            title: "t".into(),
            status: Status::Done,
            scene_hash: "00".into(),
            seed: 1,
            program_version: "0".into(),
            machine: Machine { os: "o".into(), arch: "a".into(), cpus: 1, threads: 1 },
            backend: "cpu".into(),
            derived: Derived::default(),
            guards: Guards::default(),
            warnings: Vec::new(),
            results: Results {
                coating: Coating {
                    cov_intra: Some(0.3),
                    cov_inter: Some(0.1),
                    cov_intra_asymptote: Some(Estimate {
                        value: 0.2,
                        low: 0.1,
                        high: 0.25,
                        noise_time_s: 7.0,
                    }),
                    ..Coating::default()
                },
                bed: Bed { kinetic_energy_j: Some(0.027), ..Bed::default() },
                ..Results::default()
            },
            performance: Performance { wall_s: 2.0, steps: 7, ..Performance::default() },
            state_hash: Some("ff".into()),
        };
        let json = serde_json::to_value(&record).unwrap();
        assert_eq!(json["results"]["cov_intra"], 0.3);
        assert_eq!(json["results"]["cov_intra_asymptote"]["high"], 0.25);
        assert_eq!(json["results"]["kinetic_energy_J"], 0.027);
        assert_eq!(json["results"].get("mean_speed_m_per_s"), None);
        assert_eq!(json["performance"]["steps"], 7);
        assert_eq!((&json["status"], &json["state_hash"]), (&"done".into(), &"ff".into()));
        assert_eq!(serde_json::from_value::<RunRecord>(json).unwrap(), record);
    }
}
