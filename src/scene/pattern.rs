//! What a nozzle's spray looks like. The default is the paper's: one nozzle, square to the bed, whose parallel rays fill
//! a rectangle evenly and without pause.

use std::path::PathBuf;

/// The spray of a nozzle, and how many there are.
#[derive(Debug, Clone, PartialEq)]
pub struct Pattern {
    /// Border of the sprayed area.
    pub outline: Outline,
    /// How the flux is spread inside it.
    pub flux: Flux,
    /// Which way the drops fly.
    pub rays: Rays,
    /// Lean of the spray about the middle of its zone.
    pub tilt: Tilt,
    /// Where the nozzles stand along the drum's axis, from the middle of the zone, m. They share the rate evenly.
    pub nozzles: Vec<f64>,
    /// On and off in turn; `None` sprays all the time.
    pub cycle: Option<Cycle>,
}

impl Default for Pattern {
    fn default() -> Self {
        Self {
            outline: Outline::Rectangle,
            flux: Flux::Uniform,
            rays: Rays::Parallel,
            tilt: Tilt { spanwise: 0.0, streamwise: 0.0 },
            nozzles: vec![0.0],
            cycle: None,
        }
    }
}

/// Border of the sprayed area, within the spanwise and streamwise extent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outline {
    /// All of it.
    Rectangle,
    /// The ellipse that touches its sides; a circle when they are equal.
    Ellipse,
}

/// How the flux is spread over the sprayed area. Lengths are in halves of the extents: (±1, ±1) are the corners.
#[derive(Debug, Clone, PartialEq)]
pub enum Flux {
    /// The same everywhere.
    Uniform,
    /// exp(−ρ²/2σ²) about the middle.
    Gaussian {
        /// Width σ.
        sigma: f64,
    },
    /// The same everywhere outside the ellipse ρ = inner, nothing inside: a hollow cone.
    Annular {
        /// Size of the hole, 0 to 1.
        inner: f64,
    },
    /// Two Gaussians side by side along the drum's axis, as shaping air makes of a spray that it pinches too hard.
    Dumbbell {
        /// From the middle to the middle of a lobe.
        offset: f64,
        /// Width σ of a lobe.
        sigma: f64,
    },
    /// As measured with a patternator: a CSV file of numbers without a header, rows down the slope, columns along the
    /// drum's axis, evenly over the extents.
    Table {
        /// File, as resolved from the scene file's folder.
        path: PathBuf,
    },
}

/// Which way the drops fly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rays {
    /// All along the axis of the spray.
    Parallel,
    /// Away from the nozzle, which is a point.
    Diverging,
}

/// Lean of the spray about the middle of its zone, rad, each below a right angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tilt {
    /// Moves the nozzle along the drum's axis.
    pub spanwise: f64,
    /// Moves the nozzle down the slope.
    pub streamwise: f64,
}

/// A spray that pauses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cycle {
    /// How long it sprays, s; a run begins with it.
    pub on: f64,
    /// How long it pauses, s.
    pub off: f64,
}
