//! The run record, the folder it lies in, and the report page made of both.
//!
//! Stored data come in: a record, tables and a coated surface, so that a report can be made anew from an old run. This
//! room knows no simulation.

mod base64;
mod charts;
mod data;
mod gather;
mod map;
mod number;
mod page;
mod record;
mod run_dir;
mod tables;
mod verdict;
pub mod vtp;

pub use data::{Limit, Quantity, ReportData, ShapeCoating, ThicknessMap};
pub use gather::{GatherError, gather};
pub use page::page;
pub use record::{
    Bed, Coating, Derived, Estimate, Guards, Machine, Performance, RECORD_FORMAT, Results, RunRecord,
    SprayAim, Status,
};
pub use run_dir::{RunDir, RunDirError, SeriesFile};
pub use tables::{PanelRow, TabletRow};
