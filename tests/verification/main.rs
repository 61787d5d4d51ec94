//! Physics against analytic values and other codes, through scenes as a user writes them (`scenes/verification`).
//! `docs/verification.md` lists the cases.

mod bouncing;
mod convergence;
mod damping_mass;
mod determinism;
mod drum_bodies;
mod elastic_gas;
mod energy;
mod expected;
mod extremes;
mod glued_sphere;
mod hertz;
mod impulse;
mod incline;
mod law_energy;
mod many_contacts;
mod mass_properties;
mod mesh_surfaces;
mod momentum;
mod neck;
mod objectivity;
mod oblique;
mod peers;
mod restitution;
mod rolling;
mod spinning;
mod statics;
mod support;
mod tablet_material;
mod tangential_laws;
mod tops;
