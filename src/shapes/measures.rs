//! Numbers by which tablet shapes and their panels are judged.

use super::tree::Bounds;
use super::{Panels, Region, TabletShape};
use serde::Serialize;
use std::f64::consts::PI;

/// The shape measures of Freireich et al. 2015, Chem. Eng. Sci. 131, 197, Table 4. Keys carry their unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ShapeMeasures {
    /// Longer extent in the plane of the band L, mm.
    pub length_mm: f64,
    /// Shorter extent in the plane of the band W, mm.
    pub width_mm: f64,
    /// Extent along the axis T, mm.
    pub thickness_mm: f64,
    /// Surface area A, mm².
    pub area_mm2: f64,
    /// Volume V, mm³.
    pub volume_mm3: f64,
    /// Surface of the sphere of that volume over the surface, (36 π V²)^(1/3)/A, dimensionless.
    pub sphericity: f64,
    /// (L + W)/(2 T), dimensionless.
    pub aspect_ratio: f64,
    /// Area of the band over that of both caps, dimensionless.
    pub band_to_face: f64,
}

/// How good panels are.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PanelQuality {
    /// Number of panels.
    pub panels: usize,
    /// Smallest angle of any panel, degrees.
    pub smallest_angle_deg: f64,
    /// Largest panel area over the smallest, dimensionless.
    pub area_ratio: f64,
}

impl TabletShape {
    /// Shape measures: area and volume of the true solid, extents and band share of the panels. `None` without panels.
    pub fn measures(&self) -> Option<ShapeMeasures> {
        let panels = self.panels.as_ref()?;
        let extents = Bounds::of(&panels.vertices).extents() * 1e3;
        let (length_mm, width_mm, thickness_mm) =
            (extents.x.max(extents.y), extents.x.min(extents.y), extents.z);
        let (area_mm2, volume_mm3) = (self.area * 1e6, self.volume * 1e9);
        let of = |region| -> f64 {
            panels
                .areas
                .iter()
                .zip(&panels.regions)
                .filter(|&(_, &r)| r == region)
                .map(|(area, _)| area)
                .sum()
        };
        Some(ShapeMeasures {
            length_mm,
            width_mm,
            thickness_mm,
            area_mm2,
            volume_mm3,
            sphericity: (36.0 * PI * volume_mm3 * volume_mm3).cbrt() / area_mm2,
            aspect_ratio: (length_mm + width_mm) / (2.0 * thickness_mm),
            band_to_face: of(Region::Band) / of(Region::Cap),
        })
    }
}

impl Panels {
    /// Number, angles and areas of the panels. Below 20 degrees, or above a ratio of 3, the pixels that a panel gets
    /// depend on how it lies in the raster.
    pub fn quality(&self) -> PanelQuality {
        let smallest = self
            .corners()
            .flat_map(|[a, b, c]| [(b - a).angle(&(c - a)), (c - b).angle(&(a - b)), (a - c).angle(&(b - c))])
            .fold(f64::INFINITY, f64::min);
        let largest_area = self.areas.iter().copied().fold(0.0, f64::max);
        let smallest_area = self.areas.iter().copied().fold(f64::INFINITY, f64::min);
        PanelQuality {
            panels: self.len(),
            smallest_angle_deg: smallest.to_degrees(),
            area_ratio: largest_area / smallest_area,
        }
    }
}
