//! Passes of tablets through the spray.

use crate::models::OrderTensor;
use crate::observers::{Exposure, SprayZone};
use crate::stepping::Frame;
use nalgebra::Vector3;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// How often, how long and how turned tablets meet the spray. A tablet is in the spray in a frame when a pixel of it is hit.
#[derive(Debug, Clone, PartialEq)]
pub struct PassFigures {
    /// Tablets in the spray at a time, mean.
    pub tablets_in_spray: f64,
    /// Passes of a tablet per minute, mean over all tablets: the appearance frequency of Kalbag et al. 2008 (Chem. Eng. Sci. 63,
    /// 2881).
    pub passes_per_min: f64,
    /// Mean duration of a pass, s.
    pub pass_duration: f64,
    /// Standard deviation over mean, over tablets, of the time spent in the spray: the residence-time CoV, which does not know of
    /// partial shadows as CoV_inter does.
    pub residence_cov: f64,
    /// Mean speed in the spray, weighted with what is hit, m/s.
    pub speed: f64,
    /// Mean velocity down the slope in the spray, weighted alike, m/s.
    pub streamwise_speed: f64,
    /// Order of the spray direction in the tablets' axes, each tablet in the spray counting once a frame.
    pub order: OrderTensor,
}

/// Watches which tablets of one shape are in the spray, and how they lie there.
#[derive(Debug, Clone)]
pub struct SprayPasses {
    tablets: Vec<Tablet>,
    /// Place of each body among the tablets; bodies of other shapes have none.
    place: Vec<Option<usize>>,
    /// A pass ends when a tablet has been out of the spray for so many frames.
    gap: u64,
    frames: u64,
    duration: f64,
    last_time: Option<f64>,
    appearances: u64,
    counts: f64,
    speed: f64,
    streamwise_speed: f64,
    order: OrderTensor,
    sample: Vec<Vector3<f64>>,
    rng: ChaCha8Rng,
}

#[derive(Debug, Clone, Copy, Default)]
struct Tablet {
    /// Frames in the spray.
    seen: u64,
    passes: u64,
    /// Number of the last frame in the spray, from 1; 0 for none.
    last: u64,
}

/// Directions kept for the orientation-only model. Its limit is then uncertain by less than 0.1 % of a CoV of 0.2.
const SAMPLE: usize = 20_000;

impl SprayPasses {
    /// Watches the tablets that are these `bodies` of the frames. Shadows that hide a tablet for at most `gap` frames do not end
    /// its pass; `seed` chooses which directions are kept.
    pub fn new(bodies: &[usize], gap: u64, seed: u64) -> Self {
        let mut place = vec![None; bodies.iter().max().map_or(0, |last| last + 1)];
        for (tablet, &body) in bodies.iter().enumerate() {
            place[body] = Some(tablet);
        }
        Self {
            tablets: vec![Tablet::default(); bodies.len()],
            place,
            gap,
            frames: 0,
            duration: 0.0,
            last_time: None,
            appearances: 0,
            counts: 0.0,
            speed: 0.0,
            streamwise_speed: 0.0,
            order: OrderTensor::default(),
            sample: Vec::new(),
            rng: ChaCha8Rng::seed_from_u64(seed),
        }
    }

    /// Takes note of a frame and of what the spray hit in it; bodies that are not its tablets are passed over.
    pub fn observe(&mut self, frame: &Frame<'_>, zone: &SprayZone, exposed: &[Exposure]) {
        self.frames += 1;
        if let Some(last) = self.last_time.replace(frame.time) {
            self.duration += frame.time - last;
        }
        for &Exposure { body, counts } in exposed {
            let Some(place) = self.place.get(body).copied().flatten() else { continue };
            let tablet = &mut self.tablets[place];
            if tablet.last == 0 || self.frames - tablet.last > self.gap + 1 {
                tablet.passes += 1;
            }
            tablet.seen += 1;
            tablet.last = self.frames;
            self.appearances += 1;

            let state = &frame.bodies[body];
            let weight = counts as f64;
            self.counts += weight;
            self.speed += weight * state.velocity.norm();
            self.streamwise_speed += weight * state.velocity.dot(&zone.streamwise);
            let direction = state.orientation.inverse() * zone.normal;
            self.order.add(&direction);
            self.keep(direction);
        }
    }

    /// Reservoir sampling (Vitter 1985, ACM Trans. Math. Softw. 11, 37, algorithm R): every direction has the same chance.
    fn keep(&mut self, direction: Vector3<f64>) {
        if self.sample.len() < SAMPLE {
            self.sample.push(direction);
        } else {
            let place = self.rng.random_range(0..self.appearances);
            if let Some(kept) = self.sample.get_mut(place as usize) {
                *kept = direction;
            }
        }
    }

    /// The figures so far; `None` before two frames, or when nothing was hit.
    pub fn figures(&self) -> Option<PassFigures> {
        let interval = self.duration / self.frames.saturating_sub(1) as f64;
        if self.frames < 2 || self.appearances == 0 {
            return None;
        }
        let n = self.tablets.len() as f64;
        let passes: u64 = self.tablets.iter().map(|t| t.passes).sum();
        let mean_seen = self.appearances as f64 / n;
        let variance = self.tablets.iter().map(|t| (t.seen as f64 - mean_seen).powi(2)).sum::<f64>() / n;
        Some(PassFigures {
            tablets_in_spray: self.appearances as f64 / self.frames as f64,
            passes_per_min: passes as f64 / n / (self.frames as f64 * interval / 60.0),
            pass_duration: self.appearances as f64 * interval / passes as f64,
            residence_cov: variance.sqrt() / mean_seen,
            speed: self.speed / self.counts,
            streamwise_speed: self.streamwise_speed / self.counts,
            order: self.order,
        })
    }

    /// Unit vectors to the nozzle in the axes of the tablets that were hit: at most 20 000, each appearance as likely to be among
    /// them. For [`crate::models::TabletSurface::orientation_limit`].
    pub fn directions(&self) -> &[Vector3<f64>] {
        &self.sample
    }

    /// Frames in the spray and passes of each tablet.
    pub fn per_tablet(&self) -> impl Iterator<Item = (u64, u64)> {
        self.tablets.iter().map(|t| (t.seen, t.passes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stepping::BodyState;
    use nalgebra::UnitQuaternion;

    const ZONE: SprayZone = SprayZone {
        center: Vector3::new(0.0, 0.0, 0.0),
        spanwise: Vector3::new(0.0, 0.0, 1.0),
        streamwise: Vector3::new(-1.0, 0.0, 0.0),
        normal: Vector3::new(0.0, 1.0, 0.0),
        extent: [0.1, 0.1],
        distance: 0.05,
    };

    #[test]
    fn two_tablets_one_passing_twice_one_lying_there() {
        let mut passes = SprayPasses::new(&[0, 1, 2], 1, 1);
        // Lies with its axis to the nozzle; moves down the slope at 0.2 m/s.
        let flat = UnitQuaternion::rotation_between(&Vector3::z(), &Vector3::y()).unwrap();
        let body = |speed: f64| BodyState {
            position: Vector3::zeros(),
            orientation: flat,
            velocity: Vector3::new(-speed, 0.0, 0.0),
            spin: Vector3::zeros(),
        };
        let bodies = [body(0.2), body(0.0), body(0.0), body(9.0)];
        for index in 0..20_u64 {
            let time = index as f64 * 0.1;
            let frame = Frame { index, time, bodies: &bodies, drum_angle: 0.0, drum_torque: 0.0 };
            let mut exposed = vec![Exposure { body: 1, counts: 30 }, Exposure { body: 3, counts: 99 }];
            // In frames 0 to 4 with a shadow in 2, and again from 10 to 14.
            if [0, 1, 3, 4, 10, 11, 12, 13, 14].contains(&index) {
                exposed.insert(0, Exposure { body: 0, counts: 10 });
            }
            passes.observe(&frame, &ZONE, &exposed);
        }
        assert_eq!(passes.per_tablet().collect::<Vec<_>>(), [(9, 2), (20, 1), (0, 0)]);
        let figures = passes.figures().unwrap();
        assert!((figures.tablets_in_spray - 29.0 / 20.0).abs() < 1e-12);
        assert!((figures.passes_per_min - 1.0 / (2.0 / 60.0)).abs() < 1e-9); // one pass a tablet in 2 s
        assert!((figures.pass_duration - 2.9 / 3.0).abs() < 1e-9);
        let mean = 29.0 / 3.0_f64;
        let sd = (((9.0 - mean).powi(2) + (20.0 - mean).powi(2) + mean * mean) / 3.0).sqrt();
        assert!((figures.residence_cov - sd / mean).abs() < 1e-12);
        assert!(
            (figures.streamwise_speed - 0.2 * 90.0 / 690.0).abs() < 1e-12
                && figures.speed == figures.streamwise_speed
        );
        assert!((figures.order.s2() - 1.0).abs() < 1e-9 && figures.order.count() == 29);
        assert!(passes.directions().iter().all(|d| (d - Vector3::z()).norm() < 1e-9));
    }

    #[test]
    fn the_sample_stays_bounded_and_fair() {
        let mut passes = SprayPasses::new(&[0], 0, 7);
        let total = 5 * SAMPLE;
        for k in 0..total {
            passes.appearances += 1;
            passes.keep(Vector3::new(k as f64 / total as f64, 0.0, 0.0));
        }
        let kept = passes.directions();
        assert_eq!(kept.len(), SAMPLE);
        let mean = kept.iter().map(|d| d.x).sum::<f64>() / SAMPLE as f64;
        assert!((mean - 0.5).abs() < 0.01, "{mean}"); // standard error 0.002
    }
}
