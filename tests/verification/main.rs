//! Physics against analytic values, through scenes as a user writes them.

mod energy;
mod head_on;
mod impulse;
mod incline;
mod peers;
mod plane_impact;
mod skins;
mod support;
