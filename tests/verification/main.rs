//! Physics against analytic values, through scenes as a user writes them.

mod head_on;
mod incline;
mod plane_impact;
mod skins;
mod support;
