//! How much coating lies where.

use super::ModelError;

/// A number that amounts of coating are counted in.
pub trait Amount: Copy + Sync {
    /// The amount as a real number; counts are exact up to 2⁵³.
    fn value(self) -> f64;
}

impl Amount for u32 {
    fn value(self) -> f64 {
        f64::from(self)
    }
}

impl Amount for u64 {
    fn value(self) -> f64 {
        self as f64
    }
}

impl Amount for f64 {
    fn value(self) -> f64 {
        self
    }
}

/// Coating amounts on every panel of every tablet of one shape.
///
/// `amounts` is row-major, `tablets × panels`, in counts of any unit (pixels, weighted pixels, volumes); one count is the
/// volume `unit_volume` (k_V of Eq 4, m³), so that the thickness is h_ij = k_V c_ij / A_j (Eqs 4-5, m).
///
/// ```
/// use pancoat::models::CoatMap;
/// let areas = [2.0e-6, 1.0e-6];
/// let map = CoatMap::new(&areas, &[4_u32, 1, 0, 3], 1.0e-12)?;
/// assert_eq!((map.tablets(), map.panels()), (2, 2));
/// assert!((map.thickness(0, 0) - 2.0e-6).abs() < 1e-18); // 4 × 1e-12 m³ over 2e-6 m²
/// # Ok::<(), pancoat::models::ModelError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct CoatMap<'a, T> {
    areas: &'a [f64],
    amounts: &'a [T],
    unit_volume: f64,
}

impl<'a, T: Amount> CoatMap<'a, T> {
    /// A map over panels of `areas` (m²), rows of `amounts` per tablet, and m³ per count.
    ///
    /// # Errors
    /// [`ModelError::RaggedMap`] and [`ModelError::PanelArea`].
    pub fn new(areas: &'a [f64], amounts: &'a [T], unit_volume: f64) -> Result<Self, ModelError> {
        if let Some(panel) = areas.iter().position(|a| !(a.is_finite() && *a > 0.0)) {
            return Err(ModelError::PanelArea { panel, area: areas[panel] });
        }
        if areas.is_empty() || !amounts.len().is_multiple_of(areas.len()) {
            return Err(ModelError::RaggedMap { amounts: amounts.len(), panels: areas.len() });
        }
        Ok(Self { areas, amounts, unit_volume })
    }

    /// Panels per tablet.
    pub fn panels(&self) -> usize {
        self.areas.len()
    }

    /// Number of tablets.
    pub fn tablets(&self) -> usize {
        self.amounts.len() / self.areas.len()
    }

    /// Area of each panel, m².
    pub fn areas(&self) -> &'a [f64] {
        self.areas
    }

    /// Surface of one tablet, m².
    pub fn tablet_area(&self) -> f64 {
        self.areas.iter().sum()
    }

    /// Volume of one count, m³.
    pub fn unit_volume(&self) -> f64 {
        self.unit_volume
    }

    /// The counts of all tablets, row-major.
    pub fn amounts(&self) -> &'a [T] {
        self.amounts
    }

    /// The counts of one tablet.
    pub fn row(&self, tablet: usize) -> &'a [T] {
        &self.amounts[tablet * self.panels()..][..self.panels()]
    }

    /// Thickness of a panel of a tablet, m (Eq 5).
    pub fn thickness(&self, tablet: usize, panel: usize) -> f64 {
        self.unit_volume * self.row(tablet)[panel].value() / self.areas[panel]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ragged_amounts_and_empty_panels_are_refused() {
        assert!(matches!(
            CoatMap::new(&[1.0, 1.0], &[1_u32; 3], 1.0),
            Err(ModelError::RaggedMap { amounts: 3, panels: 2 })
        ));
        assert!(matches!(
            CoatMap::new(&[1.0, 0.0], &[1_u32; 2], 1.0),
            Err(ModelError::PanelArea { panel: 1, .. })
        ));
        assert!(matches!(CoatMap::new(&[], &[0_u32; 0], 1.0), Err(ModelError::RaggedMap { .. })));
    }
}
