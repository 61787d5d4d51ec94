//! The representative tablet.

use super::averaging::area_moments;
use super::{Amount, ModelError};

/// One tablet that takes the coating of all: every tablet seen in the spray zone in a frame is a coating trial of it
/// (Freireich et al. 2015, section 5 and Fig 5).
///
/// As amounts only add up, the order of trials does not matter: after a run its map is the sum over tablets and frames, which
/// is the average tablet (Eq 16) times the number of tablets, and its CoV is that of the average tablet (Eq 19). That it
/// nears the limit some hundred times sooner than single tablets do is the appendix's result; what bias is left after a finite
/// time is what [`super::AsymptoteEstimate`] removes.
///
/// ```
/// use pancoat::models::RepresentativeTablet;
/// let mut tablet = RepresentativeTablet::new(2);
/// tablet.add_trial(&[3_u32, 0])?;
/// tablet.add_trial(&[1_u32, 2])?;
/// assert!((tablet.cov(&[1.0, 1.0])? - 1.0 / 3.0).abs() < 1e-12); // amounts 4 and 2: mean 3, deviation 1
/// assert_eq!(tablet.thickness(&[1.0, 1.0], 60.0)?, [80.0, 40.0]); // scaled to a mean of 60
/// # Ok::<(), pancoat::models::ModelError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct RepresentativeTablet {
    amounts: Vec<f64>,
    trials: u64,
}

impl RepresentativeTablet {
    /// A bare tablet of so many panels.
    pub fn new(panels: usize) -> Self {
        Self { amounts: vec![0.0; panels], trials: 0 }
    }

    /// Adds what the panels of one tablet received.
    ///
    /// # Errors
    /// [`ModelError::Length`] when the tablet has another number of panels.
    pub fn add_trial<T: Amount>(&mut self, received: &[T]) -> Result<(), ModelError> {
        let (found, expected) = (received.len(), self.amounts.len());
        if found != expected {
            return Err(ModelError::Length { what: "panels of a trial", found, expected });
        }
        self.amounts.iter_mut().zip(received).for_each(|(sum, amount)| *sum += amount.value());
        self.trials += 1;
        Ok(())
    }

    /// How many tablets were added.
    pub fn trials(&self) -> u64 {
        self.trials
    }

    /// Thickness on panels of `areas`, scaled to `mean`, in the unit of `mean`.
    ///
    /// # Errors
    /// [`ModelError::Uncoated`] before the first coating, [`ModelError::Length`] when there are not as many areas.
    pub fn thickness(&self, areas: &[f64], mean: f64) -> Result<Vec<f64>, ModelError> {
        let (raw, found) = self.raw(areas)?;
        Ok(raw.into_iter().map(|h| h * mean / found.0).collect())
    }

    /// Standard deviation over mean of its thickness: the predicted limit of CoV_intra.
    ///
    /// # Errors
    /// As for [`Self::thickness`].
    pub fn cov(&self, areas: &[f64]) -> Result<f64, ModelError> {
        let (mean, variance) = self.raw(areas)?.1;
        Ok(variance.sqrt() / mean)
    }

    fn raw(&self, areas: &[f64]) -> Result<(Vec<f64>, (f64, f64)), ModelError> {
        if areas.len() != self.amounts.len() {
            return Err(ModelError::Length {
                what: "panel areas",
                found: areas.len(),
                expected: self.amounts.len(),
            });
        }
        let thickness: Vec<f64> = self.amounts.iter().zip(areas).map(|(c, a)| c / a).collect();
        let moments = area_moments(&thickness, areas);
        if moments.0 > 0.0 { Ok((thickness, moments)) } else { Err(ModelError::Uncoated) }
    }
}
