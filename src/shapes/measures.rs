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

/// Table 4 as printed: almond, oval, round and triangular. Length, width, thickness, area, volume and sphericity agree
/// with each other to 0.05 %; of the last two columns see [`ShapeMeasures::against_table_4`].
const TABLE_4: [[f64; 8]; 4] = [
    [20.6, 12.1, 7.86, 644.7, 1182.0, 0.8383, 2.201, 0.6385],
    [19.2, 10.8, 7.86, 588.6, 1112.0, 0.8816, 1.829, 0.6317],
    [15.9, 15.9, 6.64, 584.5, 1042.0, 0.8502, 2.556, 0.3842],
    [19.2, 12.5, 8.46, 652.1, 1300.0, 0.8835, 1.886, 0.1561],
];

impl ShapeMeasures {
    /// The row of Table 4 that has this length, width and thickness within 0.5 %.
    pub fn in_table_4(&self) -> Option<Self> {
        let near = |found: f64, printed: f64| (found / printed - 1.0).abs() < 0.005;
        let row = TABLE_4.into_iter().find(|row| {
            near(self.length_mm, row[0]) && near(self.width_mm, row[1]) && near(self.thickness_mm, row[2])
        })?;
        let [length_mm, width_mm, thickness_mm, area_mm2, volume_mm3, sphericity, aspect_ratio, band_to_face] =
            row;
        Some(Self {
            length_mm,
            width_mm,
            thickness_mm,
            area_mm2,
            volume_mm3,
            sphericity,
            aspect_ratio,
            band_to_face,
        })
    }

    /// What in a row of Table 4 (`self`) cannot be, in words.
    ///
    /// The aspect ratio is defined there as (L + W)/(2 T), which the printed L, W and T give only for the triangular
    /// tablet. Its band over face area of 0.1561 would leave 282 mm² to each cap over an outline of about 185 mm²: over all
    /// convex outlines of the recipe, caps that keep thickness, volume and this ratio miss the printed area by 3.6 % and
    /// more. With 0.6151, its digits in another order, all measures come out to 0.1 %. A test of the recipes shows both.
    pub fn against_table_4(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let own = (self.length_mm + self.width_mm) / (2.0 * self.thickness_mm);
        if (own / self.aspect_ratio - 1.0).abs() > 0.01 {
            notes.push(format!(
                "Table 4 prints an aspect ratio of {}, but its own length, width and thickness give {own:.3}",
                self.aspect_ratio
            ));
        }
        if self.band_to_face < 0.2 {
            notes.push(format!(
                "Table 4 prints {} for band over face area, which leaves no caps that fit its area and volume; 0.6151, \
                 its digits in another order, fits all",
                self.band_to_face
            ));
        }
        notes
    }
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
