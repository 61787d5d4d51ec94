//! What stands for the graphics card in a build without one.

use super::bed::Bed;
use super::painter::GpuError;
use super::view::View;
use crate::stepping::Frame;

/// No graphics card.
#[derive(Debug)]
pub(super) enum GpuRaster {}

impl GpuRaster {
    pub(super) fn new(_: &Bed, _: [u32; 2], _: bool) -> Result<Self, GpuError> {
        Err(GpuError::NotBuilt)
    }

    pub(super) fn name(&self) -> &str {
        match *self {}
    }

    pub(super) fn draw(&mut self, _: &Bed, _: &View, _: &Frame<'_>) -> Result<&[u32], GpuError> {
        match *self {}
    }
}
