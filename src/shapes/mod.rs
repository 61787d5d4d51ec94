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
mod error;
mod import;
mod imported;
mod mass;
mod measures;
mod mesh;
mod outline;
mod panels;
mod pressed;
mod quadrature;
mod remesh;
mod rings;
mod solid;
mod sphere;
mod stl;
mod tablet;
mod tree;

pub use clump::{Clump, Deviation, Sphere};
pub use drum::{ClearRoom, PATCH_ANGLE, default_pan, drum_mesh, drum_surface};
pub use error::{MeshFault, ShapeError};
pub use import::{ClosedMesh, ImportedSurface, Repair, read_closed_mesh, read_surface};
pub use mass::MassProperties;
pub use measures::{PanelQuality, ShapeMeasures};
pub use mesh::{Part, SurfaceMesh};
pub use panels::{Panels, Region};
pub use solid::Solid;
pub use stl::write_stl;
pub use tablet::TabletShape;
