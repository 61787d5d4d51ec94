//! Coating statistics and asymptotes from stored data.
//!
//! In: how much coating every panel of every tablet carries ([`CoatMap`]), and series over time. Out: the batch averages
//! of Freireich et al. 2015 (appendix), power laws, and the limit of intra-tablet uniformity with its interval. This room
//! knows no scene, no simulation and no file: plain slices come in, plain values go out.
//!
//! SI units. A coefficient of variation (CoV) is dimensionless. The paper is Freireich, Kumar, Ketterhagen, Su, Wassgren
//! and Zeitler 2015, "Comparisons of intra-tablet coating variability using DEM simulations, asymptotic limit models, and
//! experiments", Chem. Eng. Sci. 131, 197, doi 10.1016/j.ces.2015.03.013; its equations are cited by number.

mod asymptote;
mod asymptote_estimate;
mod averaging;
mod bootstrap;
mod coat_map;
mod normality;
mod order_tensor;
mod orientation_only;
mod power_law;
mod profiles;
mod rank_correlation;
mod regions;
mod representative;
mod series;
mod student;
mod tablet_spread;
mod tablet_surface;
pub mod thz;
mod trial_process;
mod work_precision;

pub use asymptote::Asymptote;
pub use asymptote_estimate::AsymptoteEstimate;
pub use averaging::{BatchStatistics, Identities, TabletMoments, sample_sd};
pub use bootstrap::{Bootstrap, Interval, quantile};
pub use coat_map::{Amount, CoatMap};
pub use normality::AndersonDarling;
pub use order_tensor::OrderTensor;
pub use orientation_only::CoatPattern;
pub use power_law::PowerLaw;
pub use profiles::ProfileBin;
pub use rank_correlation::Spearman;
pub use regions::{RegionMeans, region_means};
pub use representative::RepresentativeTablet;
pub use series::SeriesRow;
pub use student::mean_95;
pub use tablet_spread::{SpreadLaw, tablets_to_measure};
pub use tablet_surface::TabletSurface;
pub use trial_process::{TrialExpectation, TrialProcess};
pub use work_precision::{Precision, Run, work_precision};

/// Why a model cannot be computed from the data it was given.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ModelError {
    /// The amounts are not a whole number of tablets.
    #[error("{amounts} coating amounts are not a whole number of tablets of {panels} panels")]
    RaggedMap {
        /// Length of the amounts.
        amounts: usize,
        /// Length of the panel areas.
        panels: usize,
    },
    /// A panel has no area, or a negative or non-finite one.
    #[error("panel {panel} has the area {area} m²; every panel needs a positive area")]
    PanelArea {
        /// Number of the panel.
        panel: usize,
        /// Its area, m².
        area: f64,
    },
    /// Two lists that belong together differ in length.
    #[error("{what}: {found} values where {expected} are needed")]
    Length {
        /// Which list.
        what: &'static str,
        /// Length found.
        found: usize,
        /// Length needed.
        expected: usize,
    },
    /// There is too little data for the estimate.
    #[error("{what} needs at least {needed} {unit}, there are {found}")]
    TooFew {
        /// Which estimate.
        what: &'static str,
        /// What is counted.
        unit: &'static str,
        /// Number found.
        found: usize,
        /// Number needed.
        needed: usize,
    },
    /// No tablet carries any coating, so that no ratio to the mean thickness exists.
    #[error("no tablet carries any coating: coefficients of variation do not exist yet")]
    Uncoated,
}
