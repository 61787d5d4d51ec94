//! What can be wrong with a shape or its file.

use std::path::{Path, PathBuf};

/// Why a shape cannot be built or stored.
#[derive(Debug, thiserror::Error)]
pub enum ShapeError {
    /// A file could not be read.
    #[error("cannot read {path}: {source}")]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file could not be written.
    #[error("cannot write {path}: {source}")]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file's content is not what it should be.
    #[error("{path}:{line}: {fault}")]
    Content {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// What is wrong and what is expected.
        fault: String,
    },
    /// A mesh cannot be used.
    #[error("{path}: {fault}")]
    Mesh {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        fault: MeshFault,
    },
    /// A recipe's numbers do not make a solid.
    #[error("shape `{name}`: {fault}")]
    Recipe {
        /// Name of the shape.
        name: String,
        /// What is wrong, as [`crate::scene::Recipe::fault`] says it.
        fault: String,
    },
    /// A clump within the error asked for has too many spheres.
    #[error(
        "shape `{name}`: more than 1000 spheres are needed to come everywhere within {error_mm} mm; allow more"
    )]
    TooNear {
        /// Name of the shape.
        name: String,
        /// The error asked for, mm.
        error_mm: f64,
    },
    /// Panels were asked of a clump recipe.
    #[error(
        "shape `{name}` is given sphere by sphere and has no surface to spray: \
         leave the spray out, or describe the solid by its dimensions"
    )]
    NoSurface {
        /// Name of the shape.
        name: String,
    },
}

/// What is wrong with a triangle mesh. Facets are counted from 1 in the order of the file.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum MeshFault {
    /// The name of the file ends in something else.
    #[error("the format is not known by its name; expected .stl, .obj or .ply")]
    UnknownFormat,
    /// A binary STL file of another length than its header says.
    #[error(
        "the header announces {announced} facets, the file has room for {room}: it is cut off or damaged"
    )]
    FacetCount {
        /// What the header says.
        announced: u64,
        /// What the length of the file allows.
        room: u64,
    },
    /// A PLY file that ends before its header says.
    #[error("the file ends before {element} {number} of {announced}: it is cut off or damaged")]
    EndsEarly {
        /// `vertex` or `face`.
        element: &'static str,
        /// The first that is missing, from 1.
        number: usize,
        /// What the header says.
        announced: usize,
    },
    /// There is no facet.
    #[error("there is no facet in the file")]
    Empty,
    /// There are more facets than can be handled in reasonable time.
    #[error("{facets} facets are too many; export a coarser mesh of at most {most}")]
    TooMany {
        /// How many there are.
        facets: usize,
        /// How many may be.
        most: usize,
    },
    /// The file is longer than any mesh that can be handled.
    #[error("the file is longer than {} MB; export a coarser mesh", most / 1_000_000)]
    TooLong {
        /// Bytes that may be.
        most: u64,
    },
    /// A coordinate is NaN or infinite.
    #[error("facet {facet} has a coordinate that is not a finite number")]
    NotFinite {
        /// The facet.
        facet: usize,
    },
    /// A face asks for a vertex that does not exist.
    #[error("facet {facet} names vertex {vertex}, but there are {vertices}")]
    NoVertex {
        /// The facet.
        facet: usize,
        /// The vertex it names.
        vertex: i64,
        /// How many vertices there are.
        vertices: usize,
    },
    /// The size is not that of what it should be.
    #[error(
        "it would be {extent} m across, expected {least} to {most} m: \
         is the unit right? (Mm(1) for a file in mm, Inch(1) for one in inches)"
    )]
    Size {
        /// Largest extent, m.
        extent: f64,
        /// Smallest that is plausible, m.
        least: f64,
        /// Largest that is plausible, m.
        most: f64,
    },
    /// A drum's mesh that is not what the scene says.
    #[error(
        "the mesh is {across_mm:.2} mm across its axis z and reaches to +-{:.2} mm along it, other than the drum's \
         `diameter` and `width`: give those of the mesh, or is the unit wrong?",
        wide_mm / 2.0
    )]
    NotTheDrum {
        /// Twice its largest distance from the axis, mm.
        across_mm: f64,
        /// Twice its largest distance from the middle along the axis, mm.
        wide_mm: f64,
    },
    /// Corners on a line, in a way that cannot be put right.
    #[error("the corners of facet {facet} are on a line")]
    Straight {
        /// The facet.
        facet: usize,
    },
    /// There is a hole.
    #[error(
        "the surface is open: {edges} edges have a facet on one side only, the first is of facet {facet}"
    )]
    Open {
        /// How many edges.
        edges: usize,
        /// A facet at the hole.
        facet: usize,
    },
    /// Surfaces meet in an edge.
    #[error("{edges} edges have more than two facets, the first is of facet {facet}")]
    ManyAtEdge {
        /// How many edges.
        edges: usize,
        /// A facet there.
        facet: usize,
    },
    /// Surfaces touch in a point.
    #[error("the surface touches itself in a corner of facet {facet}")]
    TouchesInPoint {
        /// A facet there.
        facet: usize,
    },
    /// A one-sided surface.
    #[error("the surface has one side only: facet {facet} cannot be wound like its neighbours")]
    OneSided {
        /// A facet there.
        facet: usize,
    },
    /// Facets of an open surface that face to different sides.
    #[error("facet {facet} is wound against its neighbour: unify the normals before export")]
    Unlike {
        /// The facet.
        facet: usize,
    },
    /// More than one connected surface.
    #[error("there are {bodies} separate surfaces; a tablet is bounded by one")]
    SeveralBodies {
        /// How many.
        bodies: usize,
    },
    /// The surface crosses itself.
    #[error("facets {first} and {second} cross each other")]
    Crossing {
        /// One facet.
        first: usize,
        /// The other.
        second: usize,
    },
}

impl ShapeError {
    pub(super) fn read(path: &Path, source: std::io::Error) -> Self {
        Self::Read { path: path.to_owned(), source }
    }

    pub(super) fn content(path: &Path, line: usize, fault: impl Into<String>) -> Self {
        Self::Content { path: path.to_owned(), line, fault: fault.into() }
    }

    pub(super) fn mesh(path: &Path, fault: MeshFault) -> Self {
        Self::Mesh { path: path.to_owned(), fault }
    }
}
