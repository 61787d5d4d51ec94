//! The surface that a thickness map lies on.

use super::ModelError;
use nalgebra::Vector3;

/// The panels of a tablet in body axes: origin at the centre of mass, caps normal to z. All lists have one entry per panel.
#[derive(Debug, Clone, Copy)]
pub struct TabletSurface<'a> {
    pub(super) centroids: &'a [Vector3<f64>],
    pub(super) normals: &'a [Vector3<f64>],
    pub(super) areas: &'a [f64],
    pub(super) on_cap: &'a [bool],
}

impl<'a> TabletSurface<'a> {
    /// A surface of panels with these centroids (m), outward unit normals and areas (m²); `on_cap` tells caps from band.
    ///
    /// # Errors
    /// [`ModelError::Length`] when the lists differ in length.
    pub fn new(
        centroids: &'a [Vector3<f64>],
        normals: &'a [Vector3<f64>],
        areas: &'a [f64],
        on_cap: &'a [bool],
    ) -> Result<Self, ModelError> {
        let surface = Self { centroids, normals, areas, on_cap };
        surface.expect("centroids", centroids.len())?;
        surface.expect("panel normals", normals.len())?;
        surface.expect("panel regions", on_cap.len())?;
        Ok(surface)
    }

    /// Number of panels.
    pub fn panels(&self) -> usize {
        self.areas.len()
    }

    /// Fails unless there are as many of `what` as panels.
    pub(super) fn expect(&self, what: &'static str, found: usize) -> Result<(), ModelError> {
        let expected = self.panels();
        if found == expected { Ok(()) } else { Err(ModelError::Length { what, found, expected }) }
    }
}
