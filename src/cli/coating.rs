//! The coating of a run: counts while it runs, statistics at output times, results at its end.

use super::bed::CoatedBed;
use super::outcome::Outcome;
use crate::models::{
    AsymptoteEstimate, BatchStatistics, Bootstrap, CoatMap, CoatPattern, ModelError, SpreadLaw,
    TabletSurface, region_means,
};
use crate::observers::statistics::{CoatingSeries, SprayPasses};
use crate::observers::{
    Backend, Coater, CoaterError, Observer, SprayZone, film_volume_from_mean, film_volume_per_count,
};
use crate::report::{
    self, Estimate, Exponent, PanelRow, Passes, RunDirError, RunRecord, SeriesFile, SprayAim, TabletRow,
    ThicknessMap, vtp,
};
use crate::scene::{Deposit, Scene, Spray};
use crate::shapes::{Panels, Region, TabletShape};
use crate::stepping::Frame;
use std::collections::BTreeMap;

/// Shortest block of time for the estimate of the limit, s: longer than a tablet takes round the bed.
const SHORTEST_BLOCK: f64 = 2.0;
/// Most blocks, an even number; each keeps a count for every panel of every tablet. Then pairs become one, and blocks are
/// twice as long from there on: the limit is known early, and long runs have long blocks.
const MOST_BLOCKS: usize = 10;
/// A tablet that a shadow hides for so long has not left the spray, s.
const SHADOW: f64 = 0.1;
/// Tablets and trials of the orientation-only Monte Carlo.
const MONTE_CARLO: (usize, u64) = (100, 400);
/// CoV_inter follows its power law from here on, s (Freireich et al. 2015, section 8.1).
const MIXED: f64 = 10.0;

/// What the spray has put on the tablets.
pub(super) struct Coating {
    pub(super) coater: Coater,
    /// Coated shapes, the one with the most tablets first.
    shapes: Vec<CoatedShape>,
    frame_interval: f64,
    frames_per_block: u64,
    deposit: Deposit,
    duration: f64,
}

struct CoatedShape {
    shape: TabletShape,
    panels: Panels,
    on_cap: Vec<bool>,
    /// Of the Monte Carlo.
    seed: u64,
    bodies: Vec<usize>,
    series: CoatingSeries,
    passes: SprayPasses,
    /// Counts at the end of the last block, tablet after tablet.
    blocked: Vec<u64>,
    /// What was gained in each block.
    blocks: Vec<Vec<u64>>,
}

/// Why coating cannot go on.
#[derive(Debug, thiserror::Error)]
pub(super) enum CoatingError {
    #[error(transparent)]
    Model(#[from] ModelError),
    #[error(transparent)]
    Folder(#[from] RunDirError),
}

impl Coating {
    /// Coats bodies that are about to be sprayed in `zone`, for `frames` frames, drawn by `backend`.
    pub(super) fn new(
        scene: &Scene,
        bed: &CoatedBed<'_>,
        spray: &Spray,
        zone: SprayZone,
        frames: u64,
        backend: Backend,
    ) -> Result<Self, CoaterError> {
        let mut coater = Coater::new(bed.shapes, bed.body_shapes, spray, zone, bed.drum)?;
        coater.use_backend(backend);
        let interval = scene.time.frame_interval;
        let shortest = (SHORTEST_BLOCK / interval).ceil() as u64;
        let mut shapes: Vec<CoatedShape> = bed
            .shapes
            .iter()
            .enumerate()
            .filter_map(|(index, shape)| {
                let kinds = bed.body_shapes.iter().enumerate();
                let bodies: Vec<usize> = kinds.filter(|(_, kind)| **kind == index).map(|(b, _)| b).collect();
                let panels = shape.panels.clone().filter(|_| !bodies.is_empty())?;
                Some(CoatedShape {
                    shape: shape.clone(),
                    seed: scene.seed,
                    blocked: vec![0; bodies.len() * panels.len()],
                    on_cap: panels.regions.iter().map(|&region| region == Region::Cap).collect(),
                    panels,
                    passes: SprayPasses::new(&bodies, (SHADOW / interval).round() as u64, scene.seed),
                    bodies,
                    series: CoatingSeries::new(scene.outputs.series_interval),
                    blocks: Vec::new(),
                })
            })
            .collect();
        shapes.sort_by_key(|shape| std::cmp::Reverse(shape.bodies.len()));
        Ok(Self {
            coater,
            shapes,
            frame_interval: interval,
            frames_per_block: shortest.min(frames).max(1),
            deposit: spray.deposit,
            duration: frames as f64 * interval,
        })
    }

    /// Does what is due after frame `done` (from 1). Returns CoV_intra when a row was due.
    pub(super) fn note(&mut self, done: u64, file: &mut SeriesFile) -> Result<Option<f64>, CoatingError> {
        let time = done as f64 * self.frame_interval;
        let mut cov_intra = None;
        if self.is_due(done) {
            self.coater.settle();
        }
        let volume_per_count = self.volume_per_count(done);
        if self.series_is_due(done) {
            for (k, shape) in self.shapes.iter_mut().enumerate() {
                let counts = shape.counts(&self.coater);
                let map = CoatMap::new(&shape.panels.areas, &counts, volume_per_count)?;
                let batch = shape.series.record(time, &map)?;
                if let (Some(row), Some(_), true) = (shape.series.rows().last(), batch, k == 0) {
                    file.add(row)?;
                    cov_intra = Some(row.cov_intra);
                }
            }
        }
        if done.is_multiple_of(self.frames_per_block) {
            if done / self.frames_per_block > MOST_BLOCKS as u64 {
                self.shapes.iter_mut().for_each(CoatedShape::merge_blocks);
                self.frames_per_block *= 2;
            } else {
                self.shapes.iter_mut().for_each(|shape| shape.close_block(&self.coater));
            }
        }
        Ok(cov_intra)
    }

    /// Takes note of stored frames.
    pub(super) fn observe_all(&mut self, frames: &[Frame<'_>]) {
        let exposed = self.coater.observe_all(frames);
        for (frame, exposed) in frames.iter().zip(&exposed) {
            for shape in &mut self.shapes {
                shape.passes.observe(frame, &self.coater.zones()[0], exposed);
            }
        }
    }

    /// Whether something is due after frame `done`.
    pub(super) fn is_due(&self, done: u64) -> bool {
        self.series_is_due(done) || done.is_multiple_of(self.frames_per_block)
    }

    fn series_is_due(&self, done: u64) -> bool {
        let time = done as f64 * self.frame_interval;
        self.shapes.first().is_some_and(|main| main.series.is_due(time))
    }

    /// k_V after `done` frames, m³. A measured mean thickness is that of the end, and grows evenly until then.
    pub(super) fn volume_per_count(&self, done: u64) -> f64 {
        match self.deposit {
            Deposit::Sprayed { rate, solids, film_density } => {
                let counts = self.coater.counts_per_frame();
                film_volume_per_count(rate, solids, film_density, self.frame_interval, counts)
            }
            Deposit::Measured { mean_thickness, .. } => {
                let share = done as f64 * self.frame_interval / self.duration;
                let area = self.shapes.iter().map(CoatedShape::area).sum();
                let on_tablets = self.coater.ledger().total() - self.coater.ledger().loss().total();
                film_volume_from_mean(share * mean_thickness, area, on_tablets.max(1))
            }
        }
    }

    /// Whether the limit can be estimated anew after frame `done`: a block of time has ended, and it is not the first.
    pub(super) fn has_news(&self, done: u64) -> bool {
        done.is_multiple_of(self.frames_per_block) && done > self.frames_per_block
    }

    /// What came out of `done` frames, on bodies of `masses` (kg).
    pub(super) fn outcome(&mut self, done: u64, masses: &[f64]) -> Result<Outcome, ModelError> {
        self.coater.settle();
        let volume_per_count = self.volume_per_count(done);
        let lost = self.coater.ledger().loss().total();
        let mut outcome = Outcome {
            backend: self.coater.backend().to_owned(),
            volume_per_count,
            main: report::Coating::default(),
            shapes: BTreeMap::new(),
            efficiency: 1.0 - lost as f64 / self.coater.ledger().total().max(1) as f64,
            identity_residual: 0.0,
            tablets: Vec::new(),
            panels: Vec::new(),
            surfaces: String::new(),
            film: vec![0.0; masses.len()],
        };
        let mut maps = Vec::new();
        for (k, shape) in self.shapes.iter().enumerate() {
            let counts = shape.counts(&self.coater);
            let map = CoatMap::new(&shape.panels.areas, &counts, volume_per_count)?;
            let batch = match BatchStatistics::of(&map) {
                Err(ModelError::Uncoated) => continue,
                batch => batch?,
            };
            let residual = batch.identities.worst().max(shape.series.worst_identity());
            outcome.identity_residual = outcome.identity_residual.max(residual);
            let mut coating = shape.coating(&batch, volume_per_count, self.block_time());
            let pattern = shape.without_shadows(&mut coating);
            if k == 0 {
                outcome.main = coating;
            }
            if self.shapes.len() > 1 {
                outcome.shapes.insert(shape.shape.name.clone(), coating);
            }
            let area = map.tablet_area();
            for (k, (&body, tablet)) in shape.bodies.iter().zip(&batch.tablets).enumerate() {
                let own: Vec<f64> = (0..map.panels()).map(|panel| map.thickness(k, panel)).collect();
                let regions = region_means(&own, &shape.panels.areas, &shape.on_cap)?;
                outcome.film[body] = tablet.mean;
                outcome.tablets.push(TabletRow {
                    tablet: body,
                    shape: shape.shape.name.clone(),
                    mass_mg: 1e6 * masses[body],
                    coat_mass_mg: 1e6 * self.deposit.film_density() * area * tablet.mean,
                    mean_thickness_um: 1e6 * tablet.mean,
                    cov_intra: tablet.cov(),
                    cap_to_band: regions.map(|means| means.ratio()).filter(|ratio| ratio.is_finite()),
                });
            }
            outcome.panels.extend(shape.panel_rows(&batch));
            maps.push(shape.thickness_map(&batch, &map, pattern.as_ref()));
        }
        outcome.tablets.sort_by_key(|row| row.tablet);
        outcome.surfaces = vtp::write(&maps);
        Ok(outcome)
    }

    /// Length of a block, s.
    fn block_time(&self) -> f64 {
        self.frames_per_block as f64 * self.frame_interval
    }

    /// Puts into the record what is known before the first frame.
    pub(super) fn describe(&self, record: &mut RunRecord) {
        let zone = &self.coater.zones()[0];
        record.derived.spray =
            Some(SprayAim { center_mm: (zone.center * 1e3).into(), normal: zone.normal.into() });
        record.derived.panels = self.shapes.iter().map(|s| (s.shape.name.clone(), s.panels.len())).collect();
        self.coater.backend().clone_into(&mut record.backend);
    }
}

impl CoatedShape {
    /// Of the panels of all its tablets, m².
    fn area(&self) -> f64 {
        self.bodies.len() as f64 * self.panels.areas.iter().sum::<f64>()
    }

    /// Counts of all tablets, row by row.
    fn counts(&self, coater: &Coater) -> Vec<u64> {
        self.bodies.iter().flat_map(|&body| coater.counts(body)).copied().collect()
    }

    fn close_block(&mut self, coater: &Coater) {
        let now = self.counts(coater);
        self.blocks.push(now.iter().zip(&self.blocked).map(|(now, before)| now - before).collect());
        self.blocked = now;
    }

    fn merge_blocks(&mut self) {
        let pair = |pair: &[Vec<u64>]| pair[0].iter().zip(&pair[1]).map(|(a, b)| a + b).collect();
        self.blocks = self.blocks.chunks_exact(2).map(pair).collect();
    }

    fn coating(&self, batch: &BatchStatistics, volume_per_count: f64, block_time: f64) -> report::Coating {
        let maps: Result<Vec<_>, _> =
            self.blocks.iter().map(|gain| CoatMap::new(&self.panels.areas, gain, volume_per_count)).collect();
        let duration = self.blocks.len() as f64 * block_time;
        // One tablet, or no whole block yet, has no estimate.
        let limit = maps.and_then(|maps| AsymptoteEstimate::from_blocks(&maps, duration)).ok();
        report::Coating {
            cov_intra: Some(batch.moments),
            cov_inter: Some(batch.inter),
            cov_intra_asymptote: limit.map(|limit| Estimate {
                value: limit.asymptote.cov(),
                low: limit.interval.low,
                high: limit.interval.high,
                noise_time_s: limit.asymptote.noise_time,
            }),
            mean_thickness_um: Some(1e6 * batch.mean_thickness),
            cov_inter_exponent: self.series.law_of_inter(MIXED, &Bootstrap::default()).ok().map(exponent),
            sd_cov_intra_exponent: self.series.spread_of_cov(&Bootstrap::default()).ok().map(exponent),
            orientation_index: region_means(&batch.average, &self.panels.areas, &self.on_cap)
                .ok()
                .flatten()
                .map(|means| means.orientation_index()),
            passes: self.passes(),
            ..report::Coating::default()
        }
    }

    fn passes(&self) -> Passes {
        let Some(figures) = self.passes.figures() else { return Passes::default() };
        Passes {
            tablets_in_spray: Some(figures.tablets_in_spray),
            passes_per_min: Some(figures.passes_per_min),
            pass_duration_s: Some(figures.pass_duration),
            cov_residence_time: Some(figures.residence_cov),
            speed_in_spray_m_per_s: Some(figures.speed),
            order_to_spray: Some(figures.order.s2()),
        }
    }

    /// The limit of the tablets as they were turned, without shadows, by three ways; `None` before any was hit.
    fn without_shadows(&self, coating: &mut report::Coating) -> Option<CoatPattern> {
        let Panels { centroids, normals, areas, .. } = &self.panels;
        let surface = TabletSurface::new(centroids, normals, areas, &self.on_cap).ok()?;
        let (directions, order) = (self.passes.directions(), self.passes.figures()?.order);
        let pattern = surface.orientation_limit(directions).ok()?;
        let played = surface.orientation_monte_carlo(directions, MONTE_CARLO.0, &[MONTE_CARLO.1], self.seed);
        coating.cov_intra_orientation_only = Some(pattern.cov);
        coating.cov_intra_orientation_monte_carlo = played.ok().and_then(|covs| covs.last().copied());
        coating.cov_intra_order_tensor = surface.orientation_expansion(&order).ok().map(|p| p.cov);
        Some(pattern)
    }

    fn panel_rows<'a>(&'a self, batch: &'a BatchStatistics) -> impl Iterator<Item = PanelRow> + 'a {
        (0..self.panels.len()).map(|k| {
            let (center, normal) = (self.panels.centroids[k] * 1e3, self.panels.normals[k]);
            PanelRow {
                panel: k,
                shape: self.shape.name.clone(),
                region: if self.panels.regions[k] == Region::Cap { "cap" } else { "band" }.to_owned(),
                x_mm: center.x,
                y_mm: center.y,
                z_mm: center.z,
                nx: normal.x,
                ny: normal.y,
                nz: normal.z,
                area_mm2: 1e6 * self.panels.areas[k],
                average_um: 1e6 * batch.average[k],
                // Its map is the sum over tablets and times, so at the same mean it is the average tablet's.
                representative_um: Some(1e6 * batch.average[k]),
            }
        })
    }

    fn thickness_map(
        &self,
        batch: &BatchStatistics,
        map: &CoatMap<'_, u64>,
        pattern: Option<&CoatPattern>,
    ) -> ThicknessMap {
        let um = |thickness: &[f64]| thickness.iter().map(|h| 1e6 * h).collect::<Vec<_>>();
        let mut others = BTreeMap::from([(ThicknessMap::SD.to_owned(), um(&batch.panel_sd))]);
        if let Some(pattern) = pattern {
            let thickness = pattern.relative.iter().map(|h| 1e6 * h * batch.mean_thickness).collect();
            others.insert(ThicknessMap::WITHOUT_SHADOWS.to_owned(), thickness);
        }
        let ranked = batch.ranked();
        if let [first, .., last] = ranked[..] {
            for (name, tablet) in ThicknessMap::SINGLE.iter().zip([first, ranked[ranked.len() / 2], last]) {
                let thickness = (0..map.panels()).map(|panel| 1e6 * map.thickness(tablet, panel)).collect();
                others.insert((*name).to_owned(), thickness);
            }
        }
        ThicknessMap {
            vertices_mm: self.panels.vertices.iter().map(|v| (v * 1e3).into()).collect(),
            triangles: self.panels.triangles.clone(),
            areas_mm2: self.panels.areas.iter().map(|area| 1e6 * area).collect(),
            on_cap: self.on_cap.clone(),
            average_um: um(&batch.average),
            others,
        }
    }
}

impl Observer for Coating {
    fn observe(&mut self, frame: &Frame<'_>) {
        self.coater.observe(frame);
        for shape in &mut self.shapes {
            shape.passes.observe(frame, &self.coater.zones()[0], self.coater.exposed());
        }
    }
}

fn exponent(spread: SpreadLaw) -> Exponent {
    Exponent { value: spread.law.exponent, low: spread.exponent.low, high: spread.exponent.high }
}
