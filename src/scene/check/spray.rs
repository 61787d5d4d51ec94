//! The spray.

use super::super::fault::FaultKind;
use super::super::model::{Aim, Deposit, Spray};
use super::super::path::KeyPath;
use super::super::spec::{AimSpec, DepositSpec, SpraySpec};
use super::{Allowed, Checker, pattern};
use crate::units::{Number, Whole};
use nalgebra::Vector3;

/// Extents of the spray zone and distance of the nozzle, m.
const EXTENT: Allowed = Allowed::from(1e-3).to(10.0);

/// Measured mean thickness of a film, m.
const THICKNESS: Allowed = Allowed::from(1e-9).to(1e-2);

/// Nozzle to bed unless the scene says otherwise, m.
const DISTANCE: f64 = 0.05;

/// Pixels along the spanwise and streamwise extents unless the scene says otherwise.
const PIXELS: [f64; 2] = [512.0, 256.0];

/// Density of a dry film unless the scene says otherwise, kg/m³; polymer films have 1200 to 1450.
const FILM_DENSITY: f64 = 1300.0;

pub(super) fn spray(c: &mut Checker<'_>, spec: SpraySpec) -> Spray {
    let at = KeyPath::default().field("spray");
    let pattern = pattern::pattern(c, &at, &spec);
    let path = at.field("pixels");
    let (across, along) = spec.pixels.unzip();
    let mut pixels = |i: usize, value: Option<Whole>| {
        c.number_or(&path.index(i), value, PIXELS[i], Allowed::from(1.0).to(4096.0)) as u32
    };
    let pixels = [pixels(0, across), pixels(1, along)];
    let aim = match spec.aim.unwrap_or(AimSpec::Bed) {
        AimSpec::Bed => Aim::Bed,
        AimSpec::Fixed { target, normal } => {
            let at = at.field("aim");
            let target = c.need(&at.field("target"), target, "a position such as Mm(x, y, z)");
            Aim::Fixed {
                target: target.map_or_else(Vector3::zeros, |t| c.triple(&at.field("target"), t, 10.0)),
                normal: c.direction(&at.field("normal"), normal),
            }
        }
    };
    let deposit = c.need(&at.field("deposit"), spec.deposit, "(rate: .., solids: ..)");
    Spray {
        spanwise: c.number(&at.field("spanwise"), spec.spanwise, EXTENT),
        streamwise: c.number(&at.field("streamwise"), spec.streamwise, EXTENT),
        distance: c.number_or(&at.field("distance"), spec.distance, DISTANCE, EXTENT),
        aim,
        pixels,
        deposit: self::deposit(c, &at.field("deposit"), deposit),
        pattern,
    }
}

fn deposit(c: &mut Checker<'_>, at: &KeyPath, spec: Option<DepositSpec>) -> Deposit {
    let Some(spec) = spec else {
        return Deposit::Measured { mean_thickness: f64::NAN, film_density: f64::NAN };
    };
    let path = at.field("film_density");
    let film_density = c.number_or(&path, spec.film_density, FILM_DENSITY, Allowed::from(100.0).to(25_000.0));
    if let Some(thickness) = spec.mean_thickness {
        if spec.rate.is_some() || spec.solids.is_some() {
            c.fault(at, FaultKind::EitherOr("rate", "mean_thickness"));
        }
        let mean_thickness = c.number(&at.field("mean_thickness"), Some(thickness), THICKNESS);
        return Deposit::Measured { mean_thickness, film_density };
    }
    Deposit::Sprayed {
        rate: c.number(&at.field("rate"), spec.rate, Allowed::above(0.0).to(10.0)),
        solids: c.number::<Number>(&at.field("solids"), spec.solids, Allowed::above(0.0).to(1.0)),
        film_density,
    }
}
