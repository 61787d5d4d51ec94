//! The ID-raster coater: which panels of which tablets face the spray, counted in pixels.
//!
//! Every frame is drawn as the nozzle sees it, each panel under its own number, and the pixels of each number are
//! counted: tablets in front shade those behind, as they do in the pan. In come poses, the shapes' panels, the drum's
//! surface and the spray zone; out go counts, which [`film_volume_per_count`] and [`film_thickness`] turn into film.
//! Drops, air and drying are not modelled: the spray falls straight along the zone's normal.
//!
//! Method: Freireich et al. 2015 (see [`PanelIds`]), there with OpenGL colours.

mod bed;
mod counter;
mod drum;
mod film;
mod flux;
#[cfg(feature = "gpu")]
mod gpu;
#[cfg(not(feature = "gpu"))]
#[path = "no_gpu.rs"]
mod gpu;
mod gun;
mod ledger;
mod raster;
mod triangle;
mod view;

pub(super) use bed::{Bed, Canvas};
pub use counter::Backend;
pub use film::{PanelIds, film_thickness, film_volume_from_mean, film_volume_per_count};
pub use ledger::{CoatLedger, Exposure, SprayLoss};
pub(super) use raster::IdRaster;
pub(super) use view::{Lens, View};

use self::counter::{Counter, on_cpu};
use self::gun::SprayGun;
use super::{Observer, SprayZone};
use crate::scene::Spray;
use crate::shapes::{SurfaceMesh, TabletShape};
use crate::stepping::Frame;
use rayon::prelude::*;
use std::borrow::Borrow;
use std::path::PathBuf;

/// Counts what the spray hits, frame by frame.
#[derive(Debug)]
pub struct Coater {
    bed: Bed,
    gun: SprayGun,
    counter: Counter,
    ledger: CoatLedger,
    exposed: Vec<Exposure>,
}

/// Why a coater cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum CoaterError {
    /// A shape that is to be coated has no panels.
    #[error("shape `{shape}` has no panels to coat")]
    NoPanels {
        /// The shape's name.
        shape: String,
    },
    /// More panels than numbers.
    #[error("{panels} panels in all are more than the {limit} that can be numbered")]
    TooManyPanels {
        /// Panels of all bodies together.
        panels: u64,
        /// Largest number of panels.
        limit: u64,
    },
    /// A spray that deposits nothing.
    #[error("the spray's flux is zero everywhere")]
    NoFlux,
    /// A measured spray could not be read.
    #[error("cannot read the spray's table {path}: {source}")]
    ReadTable {
        /// The file.
        path: PathBuf,
        /// What the reader said.
        source: csv::Error,
    },
    /// A measured spray is not what it should be.
    #[error("{path}:{line}: {what}")]
    Table {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// What is wrong.
        what: &'static str,
    },
    /// Counts of another bed.
    #[error("the stored counts belong to another bed: {found} entries where this one has {expected}")]
    ForeignLedger {
        /// Entries of the ledger.
        found: usize,
        /// Entries that this coater needs.
        expected: usize,
    },
}

impl Coater {
    /// A coater for bodies of shapes `body_shape[body]`, in the order of the frames, sprayed as `spray` says with its
    /// nozzles aimed at `zone`. Without a `drum`, whatever passes the tablets is counted as empty.
    ///
    /// # Errors
    /// All but [`CoaterError::ForeignLedger`].
    pub fn new(
        shapes: &[impl Borrow<TabletShape>],
        body_shape: &[usize],
        spray: &Spray,
        zone: SprayZone,
        drum: Option<&SurfaceMesh>,
    ) -> Result<Self, CoaterError> {
        let bed = Bed::new(shapes, body_shape, drum)?;
        let ledger = CoatLedger::new(bed.ids());
        let gun = SprayGun::new(&zone, spray)?;
        let counter = Counter::new(&bed, &gun, Backend::Cpu);
        Ok(Self { bed, gun, counter, ledger, exposed: Vec::new() })
    }

    /// Has `backend` draw from now on, or the processor where that is not to be had: [`Self::backend`] tells.
    pub fn use_backend(&mut self, backend: Backend) {
        self.settle();
        self.counter = Counter::new(&self.bed, &self.gun, backend);
    }

    /// What draws, for the record of a run, and why not what was asked for: `cpu`, `gpu: NAME (API, driver)`,
    /// `cpu: REASON` or `cpu from frame N on: REASON`.
    pub fn backend(&self) -> &str {
        self.counter.note()
    }

    /// The numbers of the panels.
    pub fn ids(&self) -> &PanelIds {
        self.bed.ids()
    }

    /// Where each nozzle sprays.
    pub fn zones(&self) -> &[SprayZone] {
        self.gun.zones()
    }

    /// Fetches counts that are still on a graphics card, so that [`Self::counts`] and [`Self::ledger`] hold those of all
    /// frames. With the processor they always do.
    pub fn settle(&mut self) {
        self.counter.settle(&self.bed, &self.gun, &mut self.ledger);
    }

    /// Counts of the panels of a body over all frames, in the order of its shape's panels; see [`Self::settle`].
    pub fn counts(&self, body: usize) -> &[u64] {
        &self.ledger().counts()[self.bed.ids().of_body(body)]
    }

    /// All that has been counted; what a checkpoint has to keep. See [`Self::settle`].
    pub fn ledger(&self) -> &CoatLedger {
        debug_assert!(self.counter.is_settled(), "counts of the last frames are still on the graphics card");
        &self.ledger
    }

    /// Goes on from counts kept earlier.
    ///
    /// # Errors
    /// [`CoaterError::ForeignLedger`] when they are not those of as many panels.
    pub fn resume(&mut self, ledger: CoatLedger) -> Result<(), CoaterError> {
        let [found, expected] = [&ledger, &self.ledger].map(|ledger| ledger.counts().len());
        if found != expected {
            return Err(CoaterError::ForeignLedger { found, expected });
        }
        self.settle();
        self.ledger = ledger;
        Ok(())
    }

    /// The bodies seen in the last frame, in their order, and how much of each.
    pub fn exposed(&self) -> &[Exposure] {
        &self.exposed
    }

    /// Takes note of many frames, several at a time, and gives what [`Self::exposed`] would have been after each. Counts
    /// are whole numbers: they do not depend on the number of threads.
    pub fn observe_all(&mut self, frames: &[Frame<'_>]) -> Vec<Vec<Exposure>> {
        if self.counter.uses_gpu() {
            return self.counter.count(&self.bed, &self.gun, frames, &mut self.ledger);
        }
        let share = frames.len().div_ceil(rayon::current_num_threads()).max(1);
        let parts: Vec<_> = frames
            .par_chunks(share)
            .map(|some| {
                let mut canvas = Canvas::new(self.gun.pixels());
                let mut ledger = CoatLedger::new(self.bed.ids());
                let count = |frame| on_cpu(&self.bed, &self.gun, frame, &mut canvas, &mut ledger);
                (some.iter().map(count).collect::<Vec<_>>(), ledger)
            })
            .collect();
        parts
            .into_iter()
            .flat_map(|(exposed, ledger)| {
                self.ledger.merge(&ledger);
                exposed
            })
            .collect()
    }

    /// Counts that every frame adds up to while it is sprayed: those of all pixels of all nozzles. Where the flux is not
    /// even, a pixel counts more than one.
    pub fn counts_per_frame(&self) -> u64 {
        self.gun.counts_per_frame()
    }

    /// Area of the zone that one pixel stands for, m².
    pub fn pixel_area(&self) -> f64 {
        let [width, height] = self.gun.pixels().map(f64::from);
        let [spanwise, streamwise] = self.gun.zones()[0].extent;
        spanwise * streamwise / (width * height)
    }
}

impl Observer for Coater {
    fn observe(&mut self, frame: &Frame<'_>) {
        let exposed = self.counter.count(&self.bed, &self.gun, std::slice::from_ref(frame), &mut self.ledger);
        self.exposed = exposed.into_iter().flatten().collect();
    }
}

#[cfg(test)]
pub(in crate::observers) mod tests {
    use super::*;
    use crate::shapes::{Clump, Panels, Region, Sphere};
    use crate::stepping::BodyState;
    use nalgebra::{Quaternion, UnitQuaternion, Vector3};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// A cube of the given side in twelve panels.
    pub(in crate::observers) fn cube(side: f64) -> TabletShape {
        let corner =
            |k: usize| Vector3::new((k & 1) as f64, (k >> 1 & 1) as f64, (k >> 2) as f64).add_scalar(-0.5);
        let vertices: Vec<_> = (0..8).map(|k| corner(k) * side).collect();
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles: Vec<[u32; 3]> =
            faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).collect();
        let corners = |t: &[u32; 3]| t.map(|v| vertices[v as usize]);
        let doubled = |t: &[u32; 3]| {
            let [a, b, c] = corners(t);
            (b - a).cross(&(c - a))
        };
        TabletShape {
            name: "cube".into(),
            volume: side.powi(3),
            area: 6.0 * side * side,
            inertia_per_mass: Vector3::repeat(side * side / 6.0),
            clump: Clump { spheres: vec![Sphere { center: Vector3::zeros(), radius: side / 2.0 }] },
            repairs: Vec::new(),
            panels: Some(Panels {
                regions: vec![Region::Cap; 12],
                areas: triangles.iter().map(|t| doubled(t).norm() / 2.0).collect(),
                normals: triangles.iter().map(|t| doubled(t).normalize()).collect(),
                centroids: triangles.iter().map(|t| corners(t).iter().sum::<Vector3<f64>>() / 3.0).collect(),
                triangles,
                vertices,
            }),
        }
    }

    /// Bodies at random places of a box about the origin, turned at random.
    pub(in crate::observers) fn tumbled(count: usize, half: [f64; 3], seed: u64) -> Vec<BodyState> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut uniform = move || random.random_range(-1.0..1.0);
        (0..count)
            .map(|_| BodyState {
                position: Vector3::new(
                    half[0] * uniform(),
                    half[1] * uniform() - half[1],
                    half[2] * uniform(),
                ),
                orientation: UnitQuaternion::new_normalize(Quaternion::new(
                    uniform(),
                    uniform(),
                    uniform(),
                    uniform(),
                )),
                velocity: Vector3::zeros(),
                spin: Vector3::zeros(),
            })
            .collect()
    }
}
