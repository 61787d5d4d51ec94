//! What is refused before a run, and what is warned of before and after it.

use super::{memory, pace};
use crate::scene::{ContactMode, Scene, Settle};
use crate::shapes::TabletShape;
use crate::stepping::TimeStep;

/// Fewest steps in a contact. Velocity Verlet is stable down to π; at 8 colliding tablets rebound 2 % too fast (`convergence.rs`).
const FEWEST_STEPS: f64 = 8.0;
/// Steps in a contact below which tablets that collide rebound by a percent and more too fast (`convergence.rs`).
const FEW_STEPS: f64 = 12.0;
/// Step times the frequency of the stiffest landing above which velocity Verlet is unstable.
const UNSTABLE: f64 = 2.0;
/// Steps of a run that nobody asks for by intention.
const MOST_STEPS: f64 = 1e9;
/// Farthest that a body may move in a step, of its smallest sphere's radius.
const FARTHEST_TRAVEL: f64 = 0.1;
/// Share of bodies and steps in which forces may be lowered because a body is stiffer than the step bears. The paper's bed
/// with 10 steps in a contact stays below it (docs/accuracy.md).
const OFTEN_STIFF: f64 = 1e-3;
/// Overlap over radius above which a contact is no longer small, as Hertz theory takes it.
const LARGE_OVERLAP: f64 = 0.05;

/// A scene that cannot give results.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub(super) enum Refusal {
    #[error(
        "the time step leaves {0:.1} steps in a contact, at least {FEWEST_STEPS} are needed: lower time.step"
    )]
    StepsPerContact(f64),
    #[error(
        "a body moves by {0:.2} of a sphere's radius in a step, at most {FARTHEST_TRAVEL} is safe: lower time.step"
    )]
    Travel(f64),
    #[error(
        "several spheres of a clump that land at once swing by {0:.2} rad in a step, above {UNSTABLE} nothing is stable: \
         lower time.step or give the clump fewer spheres"
    )]
    Stiffness(f64),
    #[error(
        "the run would take {steps:.1e} steps, about {hours:.0} hours: shorten time.duration, raise time.step, or lower \
         shear_modulus"
    )]
    Steps { steps: f64, hours: f64 },
    #[error(
        "the run needs about {needed_gb:.0} GB of memory, {free_gb:.0} GB are free: give it fewer tablets or panels"
    )]
    Memory { needed_gb: f64, free_gb: f64 },
}

/// Something that limits confidence in a result, with advice.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub(super) enum Warning {
    #[error(
        "only {0:.1} steps in a contact: tablets rebound by a percent too fast; give time.step at least PerContact({FEW_STEPS})"
    )]
    FewSteps(f64),
    #[error(
        "overlaps reach {:.0} % of a sphere's radius: contacts are softer than those of real tablets; raise \
         shear_modulus to see whether results change",
        100.0 * .0
    )]
    LargeOverlap(f64),
    #[error(
        "in {:.1} % of all steps of all bodies a body was stiffer than the step bears and gave way more slowly: lower \
         time.step",
        100.0 * .0
    )]
    OftenStiff(f64),
    #[error(
        "{0} frames went wrong and were repeated in finer steps: lower time.step to see whether results change"
    )]
    Repeated(u64),
}

/// Refuses what memory cannot hold, and a step that cannot be stable. Impulses have no contacts to resolve.
pub(super) fn refuse(scene: &Scene, shapes: &[TabletShape], step: &TimeStep) -> Result<(), Refusal> {
    let needed = memory::needed(scene, shapes);
    if let Some(free) = memory::free().filter(|free| needed > *free) {
        return Err(Refusal::Memory { needed_gb: needed / 1e9, free_gb: free / 1e9 });
    }
    if scene.contact.mode != ContactMode::HertzMindlin {
        return Ok(());
    }
    if step.steps_per_contact() < FEWEST_STEPS {
        return Err(Refusal::StepsPerContact(step.steps_per_contact()));
    }
    if step.stiffness_bound() > UNSTABLE {
        return Err(Refusal::Stiffness(step.stiffness_bound()));
    }
    let smallest = shapes.iter().map(|s| s.clump.smallest_radius()).fold(f64::INFINITY, f64::min);
    let fastest = scene.bodies.iter().map(|b| b.velocity.norm()).fold(scene.time.impact_speed, f64::max);
    let travel = fastest * step.step / smallest;
    if travel > FARTHEST_TRAVEL {
        return Err(Refusal::Travel(travel));
    }
    let steps = simulated_time(scene) / step.step;
    if steps > MOST_STEPS {
        let hours = pace::seconds_per_second(scene, shapes, step.step) * simulated_time(scene) / 3600.0;
        return Err(Refusal::Steps { steps, hours });
    }
    Ok(())
}

/// Longest time that a run simulates, settling included, s.
fn simulated_time(scene: &Scene) -> f64 {
    let settle = match scene.time.settle {
        Settle::Auto { at_most } => at_most,
        Settle::For(time) => time,
    };
    settle + scene.time.duration
}

/// Warnings of a step, of the largest overlap over radius, expected or met, of the share of bodies and steps in which a body was
/// stiffer than the step bears, and of how many frames were repeated; none with impulses.
pub(super) fn warnings(
    mode: ContactMode,
    step: &TimeStep,
    overlap: f64,
    stiff: f64,
    repeated: u64,
) -> Vec<Warning> {
    if mode != ContactMode::HertzMindlin {
        return Vec::new();
    }
    let steps = step.steps_per_contact();
    let few = (steps < FEW_STEPS).then_some(Warning::FewSteps(steps));
    let large = (overlap > LARGE_OVERLAP).then_some(Warning::LargeOverlap(overlap));
    let stiff = (stiff > OFTEN_STIFF).then_some(Warning::OftenStiff(stiff));
    let repeated = (repeated > 0).then_some(Warning::Repeated(repeated));
    [few, large, stiff, repeated].into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_and_overlaps_are_judged() {
        let step = |n: f64| TimeStep {
            step: 1e-4,
            contact_time: 1e-4 * n,
            rayleigh_time: 1e-3,
            impact_overlap: 0.0,
            stiffest: 0.0,
        };
        assert!(warnings(ContactMode::HertzMindlin, &step(30.0), 0.02, 0.0, 0).is_empty());
        assert!(matches!(
            warnings(ContactMode::HertzMindlin, &step(11.0), 0.02, 0.0, 0)[..],
            [Warning::FewSteps(_)]
        ));
        let told = warnings(ContactMode::HertzMindlin, &step(30.0), 0.21, 0.0, 0)[0].to_string();
        assert!(told.starts_with("overlaps reach 21 % of a sphere's radius"), "{told}");
        let told = warnings(ContactMode::HertzMindlin, &step(30.0), 0.02, 0.0, 2)[0].to_string();
        assert!(told.starts_with("2 frames went wrong"), "{told}");
        let told = warnings(ContactMode::HertzMindlin, &step(30.0), 0.02, 0.012, 0)[0].to_string();
        assert!(told.starts_with("in 1.2 % of all steps"), "{told}");

        let text = crate::scene::SceneText::embedded("sphere", &[]).unwrap();
        let scene = text.scene().unwrap();
        let shapes: Vec<_> = scene.shapes.iter().map(|s| TabletShape::build(s, false).unwrap()).collect();
        assert_eq!(refuse(&scene, &shapes, &step(30.0)), Ok(()));
        assert!(matches!(refuse(&scene, &shapes, &step(7.9)), Err(Refusal::StepsPerContact(_))));
        let stiff = TimeStep { stiffest: 2.1e4, ..step(30.0) };
        assert_eq!(refuse(&scene, &shapes, &stiff), Err(Refusal::Stiffness(2.1)));
        let tiny = TimeStep { step: 1e-9, ..step(30.0) };
        assert!(matches!(refuse(&scene, &shapes, &tiny), Err(Refusal::Steps { steps, .. }) if steps > 1e10));
        let long = TimeStep { step: 1e-2, contact_time: 1.0, ..step(1.0) };
        assert!(
            matches!(refuse(&scene, &shapes, &long), Err(Refusal::Travel(t)) if (t - 0.457).abs() < 1e-3)
        );
    }
}
