//! The run record and the report page.
//!
//! In: the files of a run directory ([`ReportData::read`]) or plain values. Out: one HTML file ([`page`]). Nothing here
//! computes physics; a report can be made again from an old run.

mod base64;
mod charts;
mod data;
mod gather;
mod map;
mod number;
mod page;
mod verdict;
pub mod vtp;

pub use data::{Limit, Quantity, ReportData, ShapeCoating, ThicknessMap};
pub use gather::{ReportError, write_series};
pub use page::page;
