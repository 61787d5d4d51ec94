//! The stages of a run: filling, settling, frames.

use super::error::SimulationError;
use super::filling::{any_orientation, sites};
use super::frame::{BodyState, Frame, Observer};
use super::settling::SettlingWatch;
use super::simulation::Simulation;
use super::stopwatch::Phase;
use crate::scene::{Drum, Settle};
use crate::shapes::ClearRoom;
use nalgebra::Vector3;
use std::time::Instant;

/// What a run is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// Tablets are put into the drum.
    Filling,
    /// The bed turns until it is stationary.
    Settling,
    /// Frames are handed to observers.
    Running,
}

/// Where a run stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// What it is doing.
    pub stage: Stage,
    /// Simulated time in this stage, s.
    pub time: f64,
    /// Time this stage lasts at most, s.
    pub of: f64,
    /// Bodies so far.
    pub bodies: usize,
}

/// Time between two waves of tablets while the drum is filled, s: long enough to fall half a pan.
const WAVE: f64 = 0.1;
/// A wave takes at most one in so many of the sites, lowest first, so that no tablet falls far.
const WAVES: usize = 6;
/// Waves in a row that place nothing before the drum counts as full.
const PATIENCE: usize = 20;
/// Length of a settling window without baffles, s.
const WINDOW: f64 = 0.5;

impl Simulation {
    /// Fills the drum with the scene's batches while it turns: in waves, tablets
    /// in random orientation take the lowest free sites of a lattice. Batches are mixed evenly.
    ///
    /// # Errors
    /// [`SimulationError::Full`] when tablets no longer find room, or anything that stops a run.
    pub fn fill(&mut self, watch: &mut dyn FnMut(&Progress) -> bool) -> Result<(), SimulationError> {
        let Some((drum, surface)) = self.scene.drum.as_ref().zip(self.drum()) else { return Ok(()) };
        let room = ClearRoom::of(drum, surface);
        let mut waiting = self.waiting();
        let wanted = waiting.len();
        if wanted == 0 {
            return Ok(());
        }
        let radius = self.largest_bounding_radius();
        let sites = sites(&room, radius);
        let mut idle = 0;
        while !waiting.is_empty() {
            let before = waiting.len();
            let share = sites.len().div_ceil(WAVES);
            for site in &sites {
                if waiting.is_empty() || before - waiting.len() >= share {
                    break;
                }
                let free = self.motions.iter().all(|m| (m.position - site).norm() > 2.0 * radius);
                if free && let Some((shape, material, mass)) = waiting.pop() {
                    let orientation = any_orientation(&mut self.rng);
                    let state = BodyState {
                        position: *site,
                        orientation,
                        velocity: Vector3::zeros(),
                        spin: Vector3::zeros(),
                    };
                    self.add_body(shape, material, mass, &state);
                }
            }
            idle = if waiting.len() < before { 0 } else { idle + 1 };
            if idle > PATIENCE {
                return Err(SimulationError::Full { placed: wanted - waiting.len(), wanted });
            }
            let until = self.clock() + WAVE;
            while !waiting.is_empty() && self.clock() < until {
                self.advance_frame()?;
                let progress = Progress {
                    stage: Stage::Filling,
                    time: self.clock(),
                    of: self.clock(),
                    bodies: wanted - waiting.len(),
                };
                self.ask(watch, &progress)?;
            }
        }
        Ok(())
    }

    /// Turns the drum until the bed is stationary, or for the scene's settling time. Returns how long that took, s.
    ///
    /// # Errors
    /// Anything that stops a run.
    pub fn settle(&mut self, watch: &mut dyn FnMut(&Progress) -> bool) -> Result<f64, SimulationError> {
        let (most, auto) = match self.scene.time.settle {
            Settle::Auto { at_most } => (at_most, true),
            Settle::For(time) => (time, false),
        };
        let window = self.scene.drum.as_ref().and_then(Drum::baffle_passage).unwrap_or(WINDOW);
        let start = self.clock();
        let mut settling = SettlingWatch::default();
        let mut window_end = window;
        while self.clock() - start < most - 1e-9 {
            self.advance_frame()?;
            let time = self.clock() - start;
            let progress = Progress { stage: Stage::Settling, time, of: most, bodies: self.motions.len() };
            self.ask(watch, &progress)?;
            let n = self.motions.len().max(1) as f64;
            let speed = self.motions.iter().map(|m| m.velocity.norm()).sum::<f64>() / n;
            let center = self.motions.iter().map(|m| m.position).sum::<Vector3<f64>>() / n;
            settling.note(speed, center.x.atan2(-center.y));
            if auto && time >= window_end {
                window_end += window;
                if settling.close_window() {
                    break;
                }
            }
        }
        Ok(self.clock() - start)
    }

    /// Hands `frames` frames to the observers, numbered from `first`. They look at each while the next one is computed,
    /// and have seen all that were computed when this returns, with an error or without.
    ///
    /// # Errors
    /// Anything that stops a run.
    pub fn run(
        &mut self,
        first: u64,
        frames: u64,
        observers: &mut [&mut dyn Observer],
        watch: &mut dyn FnMut(&Progress) -> bool,
    ) -> Result<(), SimulationError> {
        let interval = self.scene.time.frame_interval;
        let mut show = |frame: Frame<'_>| {
            let start = Instant::now();
            for observer in observers.iter_mut() {
                observer.observe(&frame);
            }
            start.elapsed()
        };
        // The last frame, and its bodies.
        let (mut last, mut states) = (None, Vec::new());
        let mut ended = Ok(());
        for index in first..first + frames {
            let look = || last.take().map(|frame| show(Frame { bodies: &states, ..frame }));
            let (advanced, looking) = rayon::join(|| self.advance_frame(), look);
            self.stopwatch.put(Phase::Observers, looking.unwrap_or_default());
            let time = (index + 1) as f64 * interval;
            ended = advanced.and_then(|()| {
                let (drum_angle, drum_torque) = (self.drum_angle(), self.drum_torque());
                last = Some(Frame { index, time, bodies: &[], drum_angle, drum_torque });
                // Noted by the guards of the frame.
                states.clone_from(&self.good.1);
                let of = (first + frames) as f64 * interval;
                let progress = Progress { stage: Stage::Running, time, of, bodies: states.len() };
                self.ask(watch, &progress)
            });
            if ended.is_err() {
                break;
            }
        }
        let looking = last.map(|frame| show(Frame { bodies: &states, ..frame }));
        self.stopwatch.put(Phase::Observers, looking.unwrap_or_default());
        ended
    }

    fn ask(
        &mut self,
        watch: &mut dyn FnMut(&Progress) -> bool,
        progress: &Progress,
    ) -> Result<(), SimulationError> {
        let go_on = watch(progress);
        self.stopwatch.skip();
        if go_on { Ok(()) } else { Err(SimulationError::Stopped { time: self.clock() }) }
    }

    /// (shape, material, mass) of every tablet of the batches, mixed evenly, in the order they will be taken from the
    /// back.
    fn waiting(&self) -> Vec<(usize, usize, f64)> {
        let mut keyed: Vec<(f64, (usize, usize, f64))> = Vec::new();
        for batch in &self.scene.batches {
            let one = (batch.shape, batch.material, batch.tablet_mass);
            keyed.extend((0..batch.count).map(|k| ((k as f64 + 0.5) / batch.count as f64, one)));
        }
        keyed.sort_by(|a, b| a.0.total_cmp(&b.0));
        keyed.into_iter().map(|(_, one)| one).collect()
    }

    fn largest_bounding_radius(&self) -> f64 {
        let used = self.scene.batches.iter().map(|b| b.shape);
        used.map(|s| self.shapes()[s].clump.bounding_radius()).fold(0.0, f64::max)
    }
}
