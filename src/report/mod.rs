//! The run record, the folder it lies in, and the report page made of both.
//!
//! In: the files of a run folder ([`ReportData::read`]) or plain values. Out: those files ([`RunDir`]), and one HTML file
//! ([`page()`]). Nothing here computes physics; a report can be made again from an old run.

mod accuracy;
mod base64;
mod charts;
mod coating;
mod compare;
mod data;
mod gather;
mod html;
mod map;
mod number;
mod page;
mod record;
mod results_table;
mod run_dir;
mod shape;
mod tables;
mod tablet_charts;
mod thz;
mod verdict;
pub mod vtp;

pub use accuracy::{AccuracyAxis, AccuracyCase, accuracy_page, accuracy_table};
pub use compare::{ComparedShape, MEASURES, comparison_page};
pub use data::{Limit, Quantity, ReportData, ShapeCoating, ThicknessMap};
pub use gather::ReportError;
pub use page::page;
pub use record::{
    Bed, Coating, Derived, EnergyAudit, Estimate, Exponent, Guards, Machine, Passes, Performance,
    RECORD_FORMAT, Results, RunRecord, SprayAim, Status,
};
pub use results_table::results_table;
pub use run_dir::{RunDir, RunDirError, SeriesFile};
pub use shape::shape_page;
pub use tables::{PanelRow, TabletRow};
pub use thz::{ThzSide, thz_page};
