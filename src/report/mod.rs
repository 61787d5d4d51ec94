//! The run record and the report page.
