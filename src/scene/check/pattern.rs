//! What the spray looks like.

use super::super::fault::FaultKind;
use super::super::path::KeyPath;
use super::super::pattern::{Cycle, Flux, Footprint, Pattern, Rays, Tilt};
use super::super::spec::{FluxSpec, FootprintSpec, RaysSpec, SpraySpec};
use super::{Allowed, Checker};
use std::f64::consts::PI;

/// Width of a Gaussian flux, in halves of the extents.
const SIGMA: Allowed = Allowed::from(0.01).to(100.0);

/// Lean of the spray, rad.
const LEAN: Allowed = Allowed::from(-80.0 / 180.0 * PI).to(80.0 / 180.0 * PI);

/// Farthest nozzle, m.
const FARTHEST: Allowed = Allowed::from(-10.0).to(10.0);

/// Longest spray and longest pause, s.
pub(super) const LONGEST_PHASE: f64 = 1e6;

/// The pattern of the spray at `at`.
pub(super) fn pattern(c: &mut Checker<'_>, at: &KeyPath, spec: &SpraySpec) -> Pattern {
    let default = Pattern::default();
    let tilt = spec.tilt.unwrap_or_default();
    let lean = at.field("tilt");
    let lean = Tilt {
        spanwise: c.number_or(&lean.field("spanwise"), tilt.spanwise, default.tilt.spanwise, LEAN),
        streamwise: c.number_or(&lean.field("streamwise"), tilt.streamwise, default.tilt.streamwise, LEAN),
    };
    let nozzles = at.field("nozzles");
    if spec.nozzles.as_ref().is_some_and(Vec::is_empty) {
        c.fault(&nozzles, FaultKind::Missing("at least one position, such as [Mm(0)]"));
    }
    let nozzles = spec.nozzles.as_ref().map_or(default.nozzles, |offsets| {
        let number = |(i, &offset)| c.number(&nozzles.index(i), Some(offset), FARTHEST);
        offsets.iter().enumerate().map(number).collect()
    });
    let cycle = at.field("cycle");
    Pattern {
        footprint: spec.footprint.map_or(default.footprint, |footprint| match footprint {
            FootprintSpec::Rectangle => Footprint::Rectangle,
            FootprintSpec::Ellipse => Footprint::Ellipse,
        }),
        flux: spec.flux.as_ref().map_or(default.flux, |flux| self::flux(c, &at.field("flux"), flux)),
        rays: spec.rays.map_or(default.rays, |rays| match rays {
            RaysSpec::Parallel => Rays::Parallel,
            RaysSpec::Diverging => Rays::Diverging,
        }),
        tilt: lean,
        nozzles,
        cycle: spec.cycle.map(|spec| Cycle {
            on: c.number(&cycle.field("on"), spec.on, Allowed::above(0.0).to(LONGEST_PHASE)),
            off: c.number(&cycle.field("off"), spec.off, Allowed::from(0.0).to(LONGEST_PHASE)),
        }),
    }
}

fn flux(c: &mut Checker<'_>, at: &KeyPath, spec: &FluxSpec) -> Flux {
    match spec {
        FluxSpec::Uniform => Flux::Uniform,
        FluxSpec::Gaussian { sigma } => Flux::Gaussian { sigma: c.number(&at.field("sigma"), *sigma, SIGMA) },
        FluxSpec::Annular { inner } => {
            Flux::Annular { inner: c.number(&at.field("inner"), *inner, Allowed::from(0.0).below(1.0)) }
        }
        FluxSpec::Dumbbell { offset, sigma } => Flux::Dumbbell {
            offset: c.number(&at.field("offset"), *offset, Allowed::from(0.0).to(1.0)),
            sigma: c.number(&at.field("sigma"), *sigma, SIGMA),
        },
        FluxSpec::Table { file } => Flux::Table { path: c.file(&at.field("file"), file.clone()) },
    }
}
