//! Step, duration, outputs and the choices of the contact law.

use super::super::model::{
    ContactMode, ContactSettings, DampingMass, Outputs, Record, Settle, StepChoice, TangentialLaw, Time,
};
use super::super::path::KeyPath;
use super::super::spec::{
    ContactModeSpec, ContactSpec, DampingMassSpec, OutputsSpec, RecordSpec, SettleSpec, StepSpec,
    TangentialSpec, TimeSpec,
};
use super::{Allowed, Checker};

/// Steps per contact unless the scene says otherwise.
const STEPS_PER_CONTACT: f64 = 12.0;

/// Steps per contact that can be asked for. Below one no contact is met; how few are worth a run is judged before it.
const STEPS: Allowed = Allowed::from(1.0).to(1e5);

/// Expected approach speed unless the scene says otherwise, m/s: that of tablets landing in a lab-scale pan.
const IMPACT_SPEED: f64 = 0.3;

/// Longest settling of `Auto`, s.
const SETTLE_AT_MOST: f64 = 20.0;

/// Time between frames unless the scene says otherwise, s: the paper's sampling interval.
const FRAME_INTERVAL: f64 = 0.02;

/// Step of impulses unless the scene says otherwise, s.
const IMPULSE_STEP: f64 = 1e-3;

/// Time between rows of the series unless the scene says otherwise, s.
const SERIES_INTERVAL: f64 = 0.5;

const SETTLE: Allowed = Allowed::from(0.0).to(1e4);

/// `with_drum`: without one there is nothing to settle.
pub(super) fn time(c: &mut Checker<'_>, spec: TimeSpec, with_drum: bool) -> Time {
    let at = KeyPath::default().field("time");
    let duration = c.number(&at.field("duration"), spec.duration, Allowed::above(0.0).to(1e6));
    let longest = if duration.is_nan() { 1e6 } else { duration };
    let default = FRAME_INTERVAL.min(longest);
    let frames = Allowed::from(1e-12).to(longest);
    let frame_interval = c.number_or(&at.field("frame_interval"), spec.frame_interval, default, frames);
    let longest = if frame_interval.is_nan() { longest } else { frame_interval };
    let path = at.field("step");
    let step = match spec.step {
        None => StepChoice::PerContact(STEPS_PER_CONTACT),
        Some(StepSpec::PerContact(steps)) => StepChoice::PerContact(c.number(&path, Some(steps), STEPS)),
        Some(StepSpec::Fixed(step)) => {
            StepChoice::Fixed(c.number(&path, Some(step), Allowed::from(1e-12).to(longest)))
        }
    };
    let path = at.field("settle");
    let settle = match spec.settle {
        SettleSpec::LeftOut if !with_drum => Settle::For(0.0),
        SettleSpec::LeftOut | SettleSpec::Auto => Settle::Auto { at_most: SETTLE_AT_MOST },
        SettleSpec::AutoWithin(time) => Settle::Auto { at_most: c.number(&path, Some(time), SETTLE) },
        SettleSpec::For(time) => Settle::For(c.number(&path, Some(time), SETTLE)),
        SettleSpec::None => Settle::For(0.0),
    };
    let path = at.field("impact_speed");
    let impact_speed = c.number_or(&path, spec.impact_speed, IMPACT_SPEED, Allowed::from(1e-6).to(1e3));
    Time { step, impact_speed, settle, duration, frame_interval }
}

/// Impulses may not step over a frame, whose interval is given, s.
pub(super) fn contact(
    c: &mut Checker<'_>,
    spec: Option<ContactSpec>,
    frame_interval: f64,
) -> ContactSettings {
    let default = ContactSettings::default();
    let Some(spec) = spec else { return default };
    let longest = if frame_interval.is_nan() { 1.0 } else { frame_interval };
    let path = KeyPath::default().field("contact").field("mode").field("step");
    ContactSettings {
        mode: match spec.mode {
            None | Some(ContactModeSpec::HertzMindlin) => ContactMode::HertzMindlin,
            Some(ContactModeSpec::Impulse { step }) => {
                let default = IMPULSE_STEP.min(longest);
                let step = c.number_or(&path, step, default, Allowed::from(1e-6).to(longest));
                ContactMode::Impulse { step }
            }
        },
        no_tension: spec.no_tension.unwrap_or(default.no_tension),
        tangential: spec.tangential.map_or(default.tangential, |law| match law {
            TangentialSpec::Total => TangentialLaw::Total,
            TangentialSpec::Incremental => TangentialLaw::Incremental,
            TangentialSpec::Rescaled => TangentialLaw::Rescaled,
        }),
        damping_mass: spec.damping_mass.map_or(default.damping_mass, |mass| match mass {
            DampingMassSpec::Body => DampingMass::Body,
            DampingMassSpec::Contact => DampingMass::Contact,
        }),
    }
}

/// Rows are written at frames, so no more often than those.
pub(super) fn outputs(c: &mut Checker<'_>, spec: OutputsSpec, frame_interval: f64) -> Outputs {
    let at = KeyPath::default().field("outputs").field("series_interval");
    let shortest = if frame_interval.is_nan() { 0.0 } else { frame_interval };
    let default = SERIES_INTERVAL.max(shortest);
    Outputs {
        series_interval: c.number_or(&at, spec.series_interval, default, Allowed::from(shortest).to(1e6)),
        report: spec.report.unwrap_or(true),
        picture: spec.picture.unwrap_or(true),
        statistics: spec.statistics.unwrap_or(true),
        energy: spec.energy.unwrap_or(false),
        record: spec.record.map(|record| match record {
            RecordSpec::Compact => Record::Compact,
            RecordSpec::Exact => Record::Exact,
        }),
    }
}
