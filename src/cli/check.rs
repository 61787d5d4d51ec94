//! `pancoat check`: what a run would do, before it does it.

use super::args::CheckArgs;
use super::depth::{PACKING, bed_depth, column_mass, static_overlap};
use super::failure::Failure;
use super::watch::clock;
use super::{guards, memory, pace, print_line};
use crate::contact::PairLaw;
use crate::scene::{Aim, Record, Scene, Settle, Wall};
use crate::shapes::TabletShape;
use crate::stepping::{Simulation, TimeStep};
use std::f64::consts::PI;

pub(super) fn check(args: &CheckArgs) -> Result<(), Failure> {
    let scene = args.scene.read()?.scene()?;
    let simulation = Simulation::new(&scene)?;
    let (shapes, step) = (simulation.shapes(), simulation.time_step());
    print_line(&scene.title)?;
    for (name, text) in [parts(&scene, shapes), left_out(&scene), numbers(&scene, shapes, step)].concat() {
        print_line(&format!("{name:<20}{text}"))?;
    }
    guards::refuse(&scene, shapes, step)?;
    for warning in guards::warnings(scene.contact.mode, step, step.impact_overlap, 0.0, 0) {
        print_line(&format!("{:<20}{warning}", "warning"))?;
    }
    for repair in simulation.repairs() {
        print_line(&format!("{:<20}{repair}", "repaired"))?;
    }
    Ok(())
}

type Line = (&'static str, String);

fn parts(scene: &Scene, shapes: &[TabletShape]) -> Vec<Line> {
    let mut lines = Vec::new();
    for batch in &scene.batches {
        let shape = &shapes[batch.shape];
        let panels = shape.panels.as_ref().map_or(String::new(), |p| format!(", {} panels", p.len()));
        let (count, spheres, mg) = (batch.count, shape.clump.spheres.len(), 1e6 * batch.tablet_mass);
        lines.push((
            "batch",
            format!("{count} tablets \"{}\" of {mg:.0} mg, {spheres} spheres{panels}", shape.name),
        ));
    }
    if !scene.bodies.is_empty() {
        lines.push(("bodies", format!("{} placed one by one", scene.bodies.len())));
    }
    if let Some(drum) = &scene.drum {
        let baffles = drum.baffles.map_or(String::new(), |b| format!(", {} baffles", b.count));
        let (across, wide, rpm) = (1e3 * drum.diameter, 1e3 * drum.width, drum.speed * 30.0 / PI);
        let tilt = match drum.axis_tilt.to_degrees() {
            0.0 => String::new(),
            tilt => format!(", front lifted by {tilt:.1} degrees"),
        };
        lines
            .push(("drum", format!("{across:.0} mm across, {wide:.0} mm wide, {rpm:.1} rpm{baffles}{tilt}")));
    }
    if !scene.boundaries.is_empty() {
        lines.push(("boundaries", scene.boundaries.len().to_string()));
    }
    match scene.time.settle {
        Settle::Auto { at_most } => {
            lines.push(("settling", format!("until the bed is stationary, at most {at_most} s")));
        }
        Settle::For(time) if time > 0.0 => lines.push(("settling", format!("{time} s"))),
        Settle::For(_) => {}
    }
    if let Some(spray) = &scene.spray {
        let aim = match spray.aim {
            Aim::Bed => "square to the bed",
            Aim::Fixed { .. } => "fixed in space",
        };
        let [across, along] = spray.pixels;
        let (span, stream) = (1e3 * spray.spanwise, 1e3 * spray.streamwise);
        lines.push(("spray", format!("{span:.1} x {stream:.1} mm, {across} x {along} pixels, {aim}")));
    }
    if let Some(record) = scene.outputs.record {
        let bytes = match record {
            Record::Compact => 9,
            Record::Exact => 56,
        };
        lines.push(("recording", format!("{bytes} bytes a pose, every frame")));
    }
    lines
}

/// Parts that are not built, each with the reason.
fn left_out(scene: &Scene) -> Vec<Line> {
    let outputs = &scene.outputs;
    let no_spray = scene.spray.is_none();
    let spheres_only = scene.shapes.iter().all(|s| matches!(s.recipe, crate::scene::Recipe::Sphere { .. }));
    let list = [
        (no_spray, "panels, coater, coating statistics: no spray"),
        (scene.drum.is_none(), "drum, filling: no drum"),
        (
            scene.drum.as_ref().is_some_and(|d| d.baffles.is_none() && !matches!(d.wall, Wall::Mesh { .. })),
            "baffles: none in the drum",
        ),
        (spheres_only, "clump fitting: all shapes are spheres"),
        (scene.time.settle == Settle::For(0.0), "settling: none asked for"),
        (!outputs.statistics || scene.drum.is_none(), "bed statistics: switched off, or no drum"),
        (!outputs.picture || no_spray, "bed picture: switched off, or no spray"),
        (!outputs.report, "report: switched off"),
        (!outputs.energy, "energy audit: not asked for"),
    ];
    list.into_iter().filter(|(out, _)| *out).map(|(_, why)| ("left out", why.to_owned())).collect()
}

fn numbers(scene: &Scene, shapes: &[TabletShape], step: &TimeStep) -> Vec<Line> {
    let settling = match scene.time.settle {
        Settle::Auto { at_most } => at_most,
        Settle::For(time) => time,
    };
    let steps = (scene.time.duration + settling) / step.step;
    let mut lines = vec![
        ("time step", format!("{:.2} us", 1e6 * step.step)),
        ("steps per contact", format!("{:.1} at {} m/s", step.steps_per_contact(), scene.time.impact_speed)),
        ("Rayleigh fraction", format!("{:.1} %", 100.0 * step.rayleigh_fraction())),
        ("impact overlap", format!("{:.1} % of a sphere's radius", 100.0 * step.impact_overlap)),
    ];
    if let Some(overlap) = expected_static_overlap(scene, shapes) {
        lines.push(("static overlap", format!("{:.1} % of a sphere's radius", 100.0 * overlap)));
    }
    lines.push(("steps", format!("at most {steps:.2e}")));
    let pace = pace::seconds_per_second(scene, shapes, step.step);
    let coated = pace * scene.time.duration;
    lines.push((
        "run time",
        format!("{pace:.2} s of work a simulated second, {} for the spray on one core", clock(coated)),
    ));
    lines.push(("memory", format!("about {:.0} MB", memory::needed(scene, shapes) / 1e6)));
    lines
}

/// Overlap over radius of the lowest tablets under the bed's depth; `None` without a batch in a drum.
fn expected_static_overlap(scene: &Scene, shapes: &[TabletShape]) -> Option<f64> {
    let drum = scene.drum.as_ref()?;
    let solid: f64 = scene.batches.iter().map(|b| b.count as f64 * shapes[b.shape].volume).sum();
    let fill = solid / PACKING / drum.volume();
    let depth = bed_depth(fill.min(1.0), drum.diameter);
    let overlap = |batch: &crate::scene::Batch| {
        let shape = &shapes[batch.shape];
        let radius = shape.clump.spheres.iter().map(|s| s.radius).fold(0.0, f64::max);
        let material = &scene.materials[batch.material];
        let pair = scene.pairs.get(batch.material, batch.material);
        let modulus = PairLaw::new(material, material, pair, scene.contact).effective_modulus;
        let mass = column_mass(depth, batch.tablet_mass, shape.volume);
        static_overlap(mass, scene.gravity.norm(), radius, modulus) / radius
    };
    scene.batches.iter().map(overlap).reduce(f64::max)
}
