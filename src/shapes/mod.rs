//! What a solid is: tablet recipes turned into sphere clumps (for contact), panels (for coating) and mass properties,
//! and the triangle mesh of the drum.
//!
//! Body axes are the principal axes of inertia with the origin at the centre of mass; the tablet's axis of symmetry,
//! normal to its caps, is z. Lengths in m.

mod cap;
mod clump;
mod clump_file;
mod clump_fit;
mod drum;
mod mass;
mod mesh;
mod outline;
mod panels;
mod pressed;
mod quadrature;
mod rings;
mod sphere;
mod stl;
mod tablet;

pub use clump::{Clump, Deviation, Sphere};
pub use drum::{PATCH_ANGLE, default_pan, drum_mesh};
pub use mass::MassProperties;
pub use mesh::{Part, SurfaceMesh};
pub use panels::{Panels, Region};
pub use stl::{read_stl, write_stl};
pub use tablet::{ShapeError, TabletShape};
