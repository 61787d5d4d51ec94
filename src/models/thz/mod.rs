//! Thickness measured by terahertz pulsed imaging, against a simulated map.
//!
//! A scan is a list of points with thickness and reflectivity ([`ThzScan`]). It is turned onto the tablet's panels
//! ([`Pose`]), averaged panel by panel ([`ThzMap`]), and compared with the average tablet of a run after both were given the
//! same mean ([`ThzComparison`]), as Freireich et al. 2015 do in sections 7 and 8.3; uncertainties are added here.

mod comparison;
mod pose;
mod scan;

pub use comparison::{PanelDifference, SimulatedMap, ThzComparison, ThzMap};
pub use pose::Pose;
pub use scan::{ThzError, ThzPoint, ThzScan};
