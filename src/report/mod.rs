//! The run record and the report page.

mod base64;
mod charts;
mod data;
mod map;
mod number;
mod page;
mod verdict;
pub mod vtp;

pub use data::{Limit, Quantity, ReportData, ShapeCoating, ThicknessMap};
pub use page::page;
