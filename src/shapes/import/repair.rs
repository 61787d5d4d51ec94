//! What is put right in a mesh, and told.

/// A fault of a mesh that was put right. Facets are counted from 1 in the order of the file.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Repair {
    /// Vertices that differed by rounding.
    #[error("joined {count} corners that lay up to {most_um:.2} um beside another")]
    Welded {
        /// How many corners of facets.
        count: usize,
        /// Largest distance, um.
        most_um: f64,
    },
    /// Facets with two equal corners.
    #[error("dropped {count} facets without area, the first is facet {first}")]
    Dropped {
        /// How many.
        count: usize,
        /// The first.
        first: usize,
    },
    /// Facets on the same corners as an earlier one.
    #[error("dropped {count} facets that lie on another, the first is facet {first}")]
    Repeated {
        /// How many.
        count: usize,
        /// The first.
        first: usize,
    },
    /// Facets whose corners are on a line; the neighbour at the longest edge was split instead.
    #[error("replaced {count} facets whose corners are on a line, the first is facet {first}")]
    Straight {
        /// How many.
        count: usize,
        /// The first.
        first: usize,
    },
    /// Facets wound against the others.
    #[error("turned {count} facets that were wound against the others, the first is facet {first}")]
    Turned {
        /// How many.
        count: usize,
        /// The first.
        first: usize,
    },
    /// All facets faced inwards.
    #[error("turned all facets: the surface was inside out")]
    InsideOut,
}
