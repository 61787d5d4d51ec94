//! Who draws and counts the coater's frames: the processor, or a graphics card as long as the two agree.

use super::bed::{Bed, Canvas};
use super::gpu::GpuCounter;
use super::gun::SprayGun;
use super::ledger::{CoatLedger, Exposure};
use crate::observers::StoredFrame;
use crate::stepping::{BodyState, Frame};
use nalgebra::{UnitQuaternion, Vector3};

/// What is to draw the coater's frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Backend {
    /// A graphics card where there is one, else the processor.
    Auto,
    /// The processor.
    #[default]
    Cpu,
    /// A graphics card.
    Gpu,
    /// A program that acts as a graphics card: slower than the processor, for tests.
    GpuSoftware,
}

/// Most frames that a graphics card has counted and the ledger does not hold yet.
pub(super) const PENDING: usize = 32;
/// Frames of the test that a graphics card has to pass before it is used.
const TESTED: u64 = 4;

/// Why a graphics card is not used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[cfg_attr(
    not(feature = "gpu"),
    expect(dead_code, reason = "a build without graphics cards has one reason only")
)]
pub(super) enum GpuError {
    #[error("this program was built without support for graphics cards")]
    NotBuilt,
    #[error("no graphics card: {0}")]
    None(String),
    #[error("the only graphics card is a program, {0}")]
    Software(String),
    #[error("the graphics card failed: {0}")]
    Failed(String),
    #[error("the graphics card counted something else in {moved} of {total} counts")]
    Disagrees { moved: u64, total: u64 },
}

/// Counts frames into a ledger.
#[derive(Debug)]
pub(super) struct Counter {
    canvas: Canvas,
    gpu: Option<Gpu>,
    note: String,
}

#[derive(Debug)]
struct Gpu {
    counter: GpuCounter,
    /// Frames whose counts are on the card only. Should it fail, the processor counts them again.
    pending: Vec<StoredFrame>,
}

impl Counter {
    /// A counter for what `gun` sprays. Never fails: what is not to be had is noted, and the processor counts.
    pub(super) fn new(bed: &Bed, gun: &SprayGun, backend: Backend) -> Self {
        let mut canvas = Canvas::new(gun.pixels());
        let gpu = (backend != Backend::Cpu).then(|| {
            let counter = GpuCounter::new(bed, gun, backend == Backend::GpuSoftware)?;
            tested(counter, bed, gun, &mut canvas)
        });
        let (gpu, note) = match gpu {
            None => (None, "cpu".to_owned()),
            Some(Ok(counter)) => {
                let note = format!("gpu: {}", counter.name());
                (Some(Gpu { counter, pending: Vec::new() }), note)
            }
            Some(Err(error)) => (None, format!("cpu: {error}")),
        };
        Self { canvas, gpu, note }
    }

    /// What counts, and why not what was asked for.
    pub(super) fn note(&self) -> &str {
        &self.note
    }

    pub(super) fn uses_gpu(&self) -> bool {
        self.gpu.is_some()
    }

    /// Whether the ledger has all that was counted.
    pub(super) fn is_settled(&self) -> bool {
        self.gpu.as_ref().is_none_or(|gpu| gpu.pending.is_empty())
    }

    /// Counts frames and gives the bodies seen in each. The ledger has them after [`Self::settle`].
    pub(super) fn count(
        &mut self,
        bed: &Bed,
        gun: &SprayGun,
        frames: &[Frame<'_>],
        ledger: &mut CoatLedger,
    ) -> Vec<Vec<Exposure>> {
        let mut exposed = Vec::with_capacity(frames.len());
        for some in frames.chunks(PENDING) {
            if let Some(seen) = self.count_on_gpu(bed, gun, some, ledger) {
                exposed.extend(seen);
            } else {
                exposed.extend(some.iter().map(|frame| on_cpu(bed, gun, frame, &mut self.canvas, ledger)));
            }
        }
        exposed
    }

    /// Brings the ledger up to date.
    pub(super) fn settle(&mut self, bed: &Bed, gun: &SprayGun, ledger: &mut CoatLedger) {
        if let Some(Err(error)) = self.gpu.as_mut().map(|gpu| gpu.collect(gun, ledger)) {
            self.fall_back(&error, 0, bed, gun, ledger);
        }
    }

    /// `None` when no graphics card counted these frames.
    fn count_on_gpu(
        &mut self,
        bed: &Bed,
        gun: &SprayGun,
        frames: &[Frame<'_>],
        ledger: &mut CoatLedger,
    ) -> Option<Vec<Vec<Exposure>>> {
        match self.gpu.as_mut()?.count(bed, gun, frames, ledger) {
            Ok(exposed) => Some(exposed),
            Err(error) => {
                let from = frames.first().map_or(0, |frame| frame.index);
                self.fall_back(&error, from, bed, gun, ledger);
                None
            }
        }
    }

    /// Gives up the graphics card and counts on the processor what only the card had counted. `from` is the first frame
    /// that the card has not begun.
    fn fall_back(&mut self, error: &GpuError, from: u64, bed: &Bed, gun: &SprayGun, ledger: &mut CoatLedger) {
        let pending = self.gpu.take().map_or_else(Vec::new, |gpu| gpu.pending);
        let from = pending.first().map_or(from, |frame| frame.index);
        self.note = format!("cpu from frame {from} on: {error}");
        for frame in &pending {
            on_cpu(bed, gun, &frame.as_frame(), &mut self.canvas, ledger);
        }
    }
}

impl Gpu {
    /// Counts at most [`PENDING`] frames.
    fn count(
        &mut self,
        bed: &Bed,
        gun: &SprayGun,
        frames: &[Frame<'_>],
        ledger: &mut CoatLedger,
    ) -> Result<Vec<Vec<Exposure>>, GpuError> {
        if self.pending.len() + frames.len() > PENDING {
            self.collect(gun, ledger)?;
        }
        let sprayed: Vec<_> = frames.iter().filter(|frame| gun.is_on(frame.time)).collect();
        let mut seen = self.counter.count(bed, gun, &sprayed)?.into_iter();
        self.pending.extend(sprayed.into_iter().map(StoredFrame::from));
        let next = |frame: &Frame<'_>| if gun.is_on(frame.time) { seen.next() } else { None };
        Ok(frames.iter().map(next).map(Option::unwrap_or_default).collect())
    }

    /// Moves the card's counts to the ledger.
    fn collect(&mut self, gun: &SprayGun, ledger: &mut CoatLedger) -> Result<(), GpuError> {
        if self.pending.is_empty() {
            return Ok(());
        }
        let counts = self.counter.collect()?;
        let total = gun.counts_per_frame() * self.pending.len() as u64;
        let counted: u64 = counts.iter().sum();
        if counted != total {
            return Err(GpuError::Disagrees { moved: counted.abs_diff(total), total });
        }
        ledger.add_frames(&counts, self.pending.len() as u64);
        self.pending.clear();
        Ok(())
    }
}

/// Counts a frame on the processor and gives the bodies seen in it.
pub(super) fn on_cpu(
    bed: &Bed,
    gun: &SprayGun,
    frame: &Frame<'_>,
    canvas: &mut Canvas,
    ledger: &mut CoatLedger,
) -> Vec<Exposure> {
    let mut exposed = Vec::new();
    if gun.is_on(frame.time) {
        for view in gun.views(frame.index) {
            bed.draw(&view, frame, canvas);
            ledger.add(canvas.raster.rows(), gun.weights(), bed.ids(), &mut exposed);
        }
        ledger.end_frame(&mut exposed);
    }
    exposed
}

/// The graphics card, if it counts a heap of all bodies as the processor does, but for single pixels at the edges of
/// panels: one in five thousand, measured one in twenty-five thousand and fewer.
fn tested(
    mut counter: GpuCounter,
    bed: &Bed,
    gun: &SprayGun,
    canvas: &mut Canvas,
) -> Result<GpuCounter, GpuError> {
    let heap = heap(bed.ids().bodies(), gun);
    let frame = |index| Frame { index, time: 0.0, bodies: &heap, drum_angle: 0.0, drum_torque: 0.0 };
    let frames: Vec<_> = (0..TESTED).map(frame).collect();
    counter.count(bed, gun, &frames.iter().collect::<Vec<_>>())?;
    let counts = counter.collect()?;
    let mut ledger = CoatLedger::new(bed.ids());
    for frame in &frames {
        on_cpu(bed, gun, frame, canvas, &mut ledger);
    }
    let total = ledger.total();
    let moved = ledger.differs_by(&counts);
    let pixel = gun.weights().map_or(1, |weights| u64::from(weights.iter().copied().max().unwrap_or(1)));
    let same_total = counts.iter().sum::<u64>() == total;
    if same_total && moved <= 4 * pixel + total / 5000 {
        Ok(counter)
    } else {
        Err(GpuError::Disagrees { moved, total })
    }
}

/// Bodies strewn over the first zone, turned every way.
fn heap(bodies: usize, gun: &SprayGun) -> Vec<BodyState> {
    let zone = &gun.zones()[0];
    let [wide, long] = zone.extent;
    // Multiples of two irrational numbers fill a square evenly.
    let share = |k: usize, step: f64| (step * k as f64).fract() - 0.5;
    (0..bodies)
        .map(|k| BodyState {
            position: zone.center
                + zone.spanwise * (wide * share(k, 0.754_877_666_246_693))
                + zone.streamwise * (long * share(k, 0.569_840_290_998_053))
                - zone.normal * (zone.distance * share(k, 0.618_033_988_749_895).abs()),
            orientation: UnitQuaternion::from_euler_angles(k as f64, 2.0 * k as f64, 3.0 * k as f64),
            velocity: Vector3::zeros(),
            spin: Vector3::zeros(),
        })
        .collect()
}

#[cfg(all(test, feature = "gpu"))]
mod tests {
    use super::*;
    use crate::observers::SprayZone;
    use crate::observers::coater::tests::{cube, tumbled};
    use crate::scene::{Aim, Deposit, Flux, Pattern, Spray};

    /// A card that is lost in the middle loses no count: the processor counts again what only the card had counted.
    #[test]
    fn nothing_is_lost_with_a_graphics_card() {
        for flux in [Flux::Uniform, Flux::Gaussian { sigma: 0.5 }] {
            let spray = Spray {
                spanwise: 0.08,
                streamwise: 0.04,
                distance: 0.05,
                aim: Aim::Bed,
                pixels: [160, 80],
                deposit: Deposit::Measured { mean_thickness: 1e-4, film_density: 1300.0 },
                pattern: Pattern { flux, ..Pattern::default() },
            };
            let zone = SprayZone::facing(Vector3::zeros(), Vector3::y(), &spray);
            let gun = SprayGun::new(&zone, &spray).unwrap();
            let bed = Bed::new(&[cube(0.01)], &[0; 40], None).unwrap();
            let mut counter = Counter::new(&bed, &gun, Backend::GpuSoftware);
            if !counter.uses_gpu() {
                assert!(std::env::var_os("REQUIRE_GPU").is_none(), "{}", counter.note());
                eprintln!("not tested: {}", counter.note());
                return;
            }
            let (mut ledger, mut expected) = (CoatLedger::new(bed.ids()), CoatLedger::new(bed.ids()));
            let mut canvas = Canvas::new(gun.pixels());
            for index in 0..6 {
                if index == 3 {
                    counter.gpu.as_ref().unwrap().counter.lose();
                }
                let bodies = tumbled(40, [0.03, 0.01, 0.05], index);
                let frame = Frame { index, time: 0.0, bodies: &bodies, drum_angle: 0.0, drum_torque: 0.0 };
                let seen = counter.count(&bed, &gun, &[frame], &mut ledger);
                let exposed = on_cpu(&bed, &gun, &frame, &mut canvas, &mut expected);
                assert_eq!(seen[0].len(), exposed.len());
            }
            counter.settle(&bed, &gun, &mut ledger);
            let lost = "cpu from frame 0 on: the graphics card failed";
            assert!(counter.note().starts_with(lost), "{}", counter.note());
            assert_eq!(ledger, expected);
        }
    }
}
