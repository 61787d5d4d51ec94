//! What draws the coater's frames: the processor, or a graphics card as long as the two agree.

use super::bed::{Bed, Canvas};
use super::gpu::GpuRaster;
use super::view::View;
use crate::stepping::Frame;

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

/// A graphics card's picture is compared with the processor's every so many pictures, the first included.
const CHECK_EVERY: u64 = 1024;

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
    #[error("the graphics card saw something else at {differ} of {pixels} pixels")]
    Disagrees { differ: usize, pixels: usize },
}

/// Draws frames.
#[derive(Debug)]
pub(super) struct Painter {
    canvas: Canvas,
    gpu: Option<GpuRaster>,
    drawn: u64,
    note: String,
}

impl Painter {
    /// A painter for pictures of `pixels`. Never fails: what is not to be had is noted, and the processor draws.
    pub(super) fn new(bed: &Bed, pixels: [u32; 2], backend: Backend) -> Self {
        let gpu = match backend {
            Backend::Cpu => None,
            Backend::Auto | Backend::Gpu => Some(GpuRaster::new(bed, pixels, false)),
            Backend::GpuSoftware => Some(GpuRaster::new(bed, pixels, true)),
        };
        let (gpu, note) = match gpu {
            None => (None, "cpu".to_owned()),
            Some(Ok(gpu)) => {
                let note = format!("gpu: {}", gpu.name());
                (Some(gpu), note)
            }
            Some(Err(error)) => (None, format!("cpu: {error}")),
        };
        Self { canvas: Canvas::new(pixels), gpu, drawn: 0, note }
    }

    /// What draws, and why not what was asked for.
    pub(super) fn note(&self) -> &str {
        &self.note
    }

    pub(super) fn uses_gpu(&self) -> bool {
        self.gpu.is_some()
    }

    /// Draws a frame and hands its rows of numbers to `look`.
    ///
    /// When the graphics card fails or sees something else than the processor, the processor's picture counts, and goes
    /// on counting.
    pub(super) fn draw(
        &mut self,
        bed: &Bed,
        view: &View,
        frame: &Frame<'_>,
        look: impl FnOnce(&mut dyn Iterator<Item = &[u32]>),
    ) {
        let check = self.drawn.is_multiple_of(CHECK_EVERY);
        self.drawn += 1;
        if let Some(gpu) = &mut self.gpu {
            let width = self.canvas.raster.width();
            let seen = gpu.draw(bed, view, frame).and_then(|seen| {
                if check {
                    bed.draw(view, frame, &mut self.canvas);
                    agree(seen, self.canvas.raster.rows().flatten())?;
                }
                Ok(seen)
            });
            match seen {
                Ok(seen) => return look(&mut seen.chunks_exact(width)),
                Err(error) => {
                    self.note = format!("cpu from frame {} on: {error}", frame.index);
                    self.gpu = None;
                }
            }
        }
        bed.draw(view, frame, &mut self.canvas);
        look(&mut self.canvas.raster.rows());
    }
}

/// Whether two pictures differ in no more than single pixels at the edges of panels: one in five thousand, measured one
/// in twenty-five thousand and fewer.
fn agree<'a>(gpu: &[u32], cpu: impl Iterator<Item = &'a u32>) -> Result<(), GpuError> {
    let differ = gpu.iter().zip(cpu).filter(|(gpu, cpu)| gpu != cpu).count();
    let pixels = gpu.len();
    if differ > 4 + pixels / 5000 { Err(GpuError::Disagrees { differ, pixels }) } else { Ok(()) }
}
