//! pancoat tumbles pharmaceutical tablets in a rotating pan, sprays them, and says how uniform each tablet's
//! coating is, how uniform it can ever get, and how sure it is of that.
//!
//! Data flows one way through the rooms of this house:
//!
//! ```text
//! scene.ron -> scene -> shapes (clump, panels, drum mesh) -> world (Rapier) -> contact -> stepping --Frame--> observers
//! observers' series -> models -> run record -> report
//! ```
//!
//! | room | one purpose | may name |
//! |---|---|---|
//! | [`units`] | unit-carrying numbers of scene files, turned to SI | nothing |
//! | [`scene`] | the scene file, its faults by line and column, the validated [`scene::Scene`] | `units` |
//! | [`shapes`] | what a solid is: recipes, clumps, panels, mass, the drum's mesh | `scene` |
//! | [`world`] | the only owner of Rapier's sets: bodies, colliders, drum drive, near pairs, filling | `scene`, `shapes` |
//! | [`contact`] | Hertz-Mindlin, sphere lists per body pair, contact history, forces | `scene`, `shapes`, `world` |
//! | [`stepping`] | the simulation: integrator, time step, guards, the loop, the frame | all above |
//! | [`models`] | coating statistics and asymptotes from stored data | nothing |
//! | [`observers`] | what looks at frames: coater, bed statistics, picture | `scene`, `shapes`, `stepping`, `models` |
//! | [`report`] | the run record and the page made of it | `models` |
//! | [`cli`] | arguments, progress, exit codes | all |
//!
//! SI units inside; y is up; the drum's axis is z; positive rotation is counter-clockwise seen from +z.
//! `tests/architecture.rs` holds the table above against the code.

pub mod cli;
pub mod contact;
pub mod models;
pub mod observers;
pub mod report;
pub mod scene;
pub mod shapes;
pub mod stepping;
pub mod units;
pub mod world;
