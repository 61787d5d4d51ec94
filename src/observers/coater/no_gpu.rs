//! What stands for the graphics card in a build without one.

use super::bed::Bed;
use super::counter::GpuError;
use super::gun::SprayGun;
use super::ledger::Exposure;
use crate::stepping::Frame;

/// No graphics card.
#[derive(Debug)]
pub(super) enum GpuCounter {}

impl GpuCounter {
    pub(super) fn new(_: &Bed, _: &SprayGun, _: bool) -> Result<Self, GpuError> {
        Err(GpuError::NotBuilt)
    }

    pub(super) fn name(&self) -> &str {
        match *self {}
    }

    pub(super) fn count(
        &mut self,
        _: &Bed,
        _: &SprayGun,
        _: &[&Frame<'_>],
    ) -> Result<Vec<Vec<Exposure>>, GpuError> {
        match *self {}
    }

    pub(super) fn collect(&mut self) -> Result<Vec<u64>, GpuError> {
        match *self {}
    }
}
