//! The spray gun: where its nozzles are, what they see and what a pixel of each is worth.

use super::CoaterError;
use super::flux::weights;
use super::view::{View, jitter};
use crate::observers::SprayZone;
use crate::scene::{Cycle, Flux, Footprint, Rays, Spray, Tilt};
use nalgebra::{Rotation3, Unit};

/// One nozzle or several, side by side.
#[derive(Debug, Clone)]
pub(super) struct SprayGun {
    zones: Vec<SprayZone>,
    pixels: [u32; 2],
    rays: Rays,
    /// What each pixel counts; `None`: one.
    weights: Option<Vec<u32>>,
    cycle: Option<Cycle>,
}

impl SprayGun {
    /// The gun of `spray`, aimed at `zone`.
    pub(super) fn new(zone: &SprayZone, spray: &Spray) -> Result<Self, CoaterError> {
        let pattern = &spray.pattern;
        let even = pattern.footprint == Footprint::Rectangle && pattern.flux == Flux::Uniform;
        let zones = pattern.nozzles.iter().map(|offset| {
            let center = zone.center + zone.spanwise * *offset;
            SprayZone { center, ..tilted(zone, pattern.tilt) }
        });
        Ok(Self {
            zones: zones.collect(),
            pixels: spray.pixels,
            rays: pattern.rays,
            weights: if even { None } else { Some(weights(pattern, spray.pixels)?) },
            cycle: pattern.cycle,
        })
    }

    pub(super) fn pixels(&self) -> [u32; 2] {
        self.pixels
    }

    pub(super) fn zones(&self) -> &[SprayZone] {
        &self.zones
    }

    /// What each pixel counts, row by row; `None`: one.
    pub(super) fn weights(&self) -> Option<&[u32]> {
        self.weights.as_deref()
    }

    /// Whether it sprays at a time (s).
    pub(super) fn is_on(&self, time: f64) -> bool {
        self.cycle.is_none_or(|Cycle { on, off }| time.rem_euclid(on + off) < on)
    }

    /// What each nozzle sees in frame `index`.
    pub(super) fn views(&self, index: u64) -> impl Iterator<Item = View> {
        self.zones.iter().map(move |zone| View::new(zone, self.rays, self.pixels, jitter(index)))
    }

    /// What a frame adds up to.
    pub(super) fn counts_per_frame(&self) -> u64 {
        let nozzle: u64 = match &self.weights {
            None => self.pixels.map(u64::from).iter().product(),
            Some(weights) => weights.iter().map(|&weight| u64::from(weight)).sum(),
        };
        nozzle * self.zones.len() as u64
    }
}

/// The zone turned about its middle.
fn tilted(zone: &SprayZone, tilt: Tilt) -> SprayZone {
    // −streamwise × normal = spanwise, spanwise × normal = streamwise.
    let spanwise = Rotation3::from_axis_angle(&Unit::new_unchecked(-zone.streamwise), tilt.spanwise);
    let streamwise = Rotation3::from_axis_angle(&Unit::new_unchecked(zone.spanwise), tilt.streamwise);
    let turn = spanwise * streamwise;
    SprayZone {
        spanwise: turn * zone.spanwise,
        streamwise: turn * zone.streamwise,
        normal: turn * zone.normal,
        ..*zone
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Aim, Deposit, Pattern};
    use nalgebra::Vector3;

    fn gun(pattern: Pattern) -> SprayGun {
        let spray = Spray {
            spanwise: 0.08,
            streamwise: 0.04,
            distance: 0.05,
            aim: Aim::Bed,
            pixels: [80, 40],
            deposit: Deposit::Sprayed { rate: 1.0, solids: 1.0, film_density: 1.0 },
            pattern,
        };
        SprayGun::new(&SprayZone::facing(Vector3::zeros(), Vector3::y(), &spray), &spray).unwrap()
    }

    #[test]
    fn a_tilt_moves_the_nozzle_the_way_it_says() {
        let upright = gun(Pattern::default()).zones[0];
        let tilt = |spanwise: f64, streamwise: f64| {
            gun(Pattern { tilt: Tilt { spanwise, streamwise }, ..Pattern::default() }).zones[0]
        };
        let (s, c) = 0.3_f64.sin_cos();
        assert!((tilt(0.3, 0.0).normal - upright.normal * c - upright.spanwise * s).norm() < 1e-12);
        assert!((tilt(0.0, 0.3).normal - upright.normal * c - upright.streamwise * s).norm() < 1e-12);
        let both = tilt(0.3, -0.2);
        assert!((both.spanwise.cross(&both.streamwise) + both.normal).norm() < 1e-12);
    }

    #[test]
    fn nozzles_stand_side_by_side_and_pause_together() {
        let two = gun(Pattern {
            nozzles: vec![-0.03, 0.03],
            cycle: Some(Cycle { on: 2.0, off: 1.0 }),
            ..Pattern::default()
        });
        assert_eq!(two.counts_per_frame(), 2 * 3200);
        assert!(((two.zones[1].center - two.zones[0].center).z.abs() - 0.06).abs() < 1e-12);
        assert_eq!(
            [0.0, 1.99, 2.0, 2.99, 3.0, 4.5].map(|t| two.is_on(t)),
            [true, true, false, false, true, true]
        );
    }
}
