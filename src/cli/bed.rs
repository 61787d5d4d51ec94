//! The bed of a run: where the spray has to point, and the figures of the record.

use super::failure::Failure;
use super::watch::Watch;
use crate::observers::statistics::{BedFigures, BedStatistics, BodyInertia, Figure};
use crate::observers::{AimError, BedSurface, Observer, SprayZone};
use crate::report::{Bed, Results};
use crate::scene::{Aim, Drum, Scene, Spray};
use crate::shapes::{SurfaceMesh, TabletShape};
use crate::stepping::{Frame, Simulation};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Least and most time over which the bed's surface is taken for aiming, s. Its slope wavers: half a second of the paper's bed
/// gives it with a standard deviation of 1 degree, two seconds with 0.45, and a degree moves the limit by 2 to 3 %.
const AIMING: (f64, f64) = (2.0, 10.0);
/// Length of the blocks that standard errors come from, s: about a passage down the surface.
const BLOCK: f64 = 1.0;

/// Bodies that are coated.
pub(super) struct CoatedBed<'a> {
    pub(super) shapes: &'a [TabletShape],
    pub(super) body_shapes: &'a [usize],
    pub(super) drum: Option<&'a SurfaceMesh>,
}

/// The bodies of a run.
pub(super) fn of(simulation: &Simulation) -> CoatedBed<'_> {
    CoatedBed { shapes: simulation.shapes(), body_shapes: simulation.body_shapes(), drum: simulation.drum() }
}

/// Collects where the bodies are.
struct Positions(Vec<Vector3<f64>>);

impl Observer for Positions {
    fn observe(&mut self, frame: &Frame<'_>) {
        self.0.extend(frame.bodies.iter().map(|body| body.position));
    }
}

/// Frames over which the bed's surface is taken for aiming: whole passages of the baffles, with which the bed rises and falls,
/// unless one alone takes too long.
pub(super) fn aiming_frames(scene: &Scene) -> u64 {
    let passage = scene.drum.as_ref().and_then(Drum::baffle_passage);
    let (least, most) = AIMING;
    let time = passage.map_or(least, |passage| passage * (least / passage).ceil()).min(most);
    (time / scene.time.frame_interval).ceil() as u64
}

/// The zone that a spray covers. Aiming at the bed takes [`aiming_frames`] of its motion.
pub(super) fn aim(
    simulation: &mut Simulation,
    spray: &Spray,
    watch: &mut Watch,
) -> Result<SprayZone, Failure> {
    match spray.aim {
        Aim::Fixed { target, normal } => Ok(SprayZone::facing(target, normal, spray)),
        Aim::Bed => {
            let frames = aiming_frames(simulation.scene());
            let mut positions = Positions(Vec::new());
            watch.begin("aiming", frames as f64 * simulation.scene().time.frame_interval);
            simulation.run(0, frames, &mut [&mut positions], &mut |progress| watch.note(progress))?;
            Ok(surface(&positions.0, simulation.shapes(), simulation.body_shapes())?.zone(spray))
        }
    }
}

/// The surface of a bed whose bodies were at `positions`.
pub(super) fn surface(
    positions: &[Vector3<f64>],
    shapes: &[TabletShape],
    body_shapes: &[usize],
) -> Result<BedSurface, AimError> {
    let volume = body_shapes.iter().map(|&kind| shapes[kind].volume).sum::<f64>();
    let radius = (0.75 / PI * volume / body_shapes.len().max(1) as f64).cbrt();
    BedSurface::fit(positions, radius)
}

/// Statistics of the bed of a simulation.
pub(super) fn statistics(simulation: &Simulation, drum: &Drum) -> BedStatistics {
    let inertia = |(mass, &kind): (f64, &usize)| BodyInertia {
        mass,
        moments: simulation.shapes()[kind].inertia_per_mass * mass,
    };
    let bodies = simulation.masses().into_iter().zip(simulation.body_shapes()).map(inertia).collect();
    BedStatistics::new(bodies, drum.diameter / 2.0, BLOCK)
}

/// Puts the figures into the results under the record's keys and units.
pub(super) fn record(figures: &BedFigures, results: &mut Results) {
    let mut put = |key: &str, figure: Option<Figure>, unit: f64| {
        let error = figure.and_then(|f| f.standard_error);
        results.standard_errors.extend(error.map(|error| (key.to_owned(), error * unit)));
        figure.map(|figure| figure.mean * unit)
    };
    let degree = 1f64.to_degrees();
    results.bed = Bed {
        angle_of_repose_deg: put("angle_of_repose_deg", figures.repose_angle, degree).map(f64::abs),
        mean_speed_m_per_s: put("mean_speed_m_per_s", Some(figures.mean_speed), 1.0),
        kinetic_energy_j: put("kinetic_energy_J", Some(figures.kinetic_energy), 1.0),
        rotational_energy_j: put("rotational_energy_J", Some(figures.rotational_energy), 1.0),
        center_angle_deg: put("center_angle_deg", Some(figures.center_angle), degree),
        surface_speed_m_per_s: put("surface_speed_m_per_s", figures.surface_speed, 1.0),
        drum_torque_n_m: put("drum_torque_N_m", Some(figures.drum_torque), 1.0),
    };
}
