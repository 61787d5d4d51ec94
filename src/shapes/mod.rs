//! What a solid is: tablet recipes turned into sphere clumps (for contact), panels (for coating) and mass properties,
//! and the triangle mesh of the drum.
//!
//! Body axes are the principal axes of inertia with the origin at the centre of mass; the tablet's axis of symmetry,
//! normal to its caps, is z. Lengths in m.

mod clump;
mod mesh;
mod panels;
mod tablet;

pub use clump::{Clump, Sphere};
pub use mesh::{Part, SurfaceMesh};
pub use panels::{Panels, Region};
pub use tablet::{ShapeError, TabletShape};
