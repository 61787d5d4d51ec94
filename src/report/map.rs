//! Coating maps of tablets, in three dimensions.

use super::ThicknessMap;
use super::charts::ink;
use plotly::common::{ColorBar, ColorScale, ColorScalePalette, Font, HoverInfo, Title};
use plotly::layout::{AspectMode, Axis, Camera, Eye, LayoutScene, Margin};
use plotly::traces::mesh3d::{IntensityMode, Lighting, Mesh3D};
use plotly::{Layout, Plot};

/// What the ends of the colours stand for, in the unit of the map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    low: f64,
    high: f64,
}

impl Scale {
    /// From the lowest to the highest value of all maps, so that maps side by side can be compared.
    pub(super) fn over<'a>(maps: impl Iterator<Item = &'a Vec<f64>>) -> Self {
        let start = Self { low: f64::INFINITY, high: f64::NEG_INFINITY };
        maps.flatten().fold(start, |scale, &h| Self { low: scale.low.min(h), high: scale.high.max(h) })
    }
}

/// Room that a map takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Size {
    /// The map of a section.
    Large,
    /// One of several.
    Small,
}

/// A tablet with every panel in the colour of its value, in `unit`; pointing at a panel shows its numbers.
pub(super) fn panel_map(map: &ThicknessMap, values: &[f64], unit: &str, scale: Scale, size: Size) -> Plot {
    let corner = |k: usize| map.triangles.iter().map(|t| t[k] as usize).collect::<Vec<_>>();
    let coordinate = |k: usize| map.vertices_mm.iter().map(|v| rounded(v[k])).collect::<Vec<_>>();
    let label = |(panel, value): (usize, &f64)| {
        let region = if map.on_cap[panel] { "cap" } else { "band" };
        format!("{value:.2} {unit} · {region}, panel {panel}")
    };
    let (height, distance, bar) = match size {
        Size::Large => (460, 1.0, 14),
        Size::Small => (250, 0.9, 9),
    };
    let mesh = Mesh3D::new(
        coordinate(0),
        coordinate(1),
        coordinate(2),
        Some(corner(0)),
        Some(corner(1)),
        Some(corner(2)),
    )
    .intensity(values.iter().map(|h| rounded(*h)).collect())
    .intensity_mode(IntensityMode::Cell)
    .c_min(scale.low)
    .c_max(scale.high)
    .color_scale(ColorScale::Palette(ColorScalePalette::Viridis))
    .color_bar(ColorBar::new().title(Title::with_text(unit)).thickness(bar).outline_width(0))
    .flat_shading(true)
    .lighting(Lighting::new().ambient(0.85).diffuse(0.35).specular(0.05).roughness(0.9))
    .hover_info(HoverInfo::Text)
    .text_array(values.iter().enumerate().map(label).collect::<Vec<_>>());
    let axis = || Axis::new().visible(false);
    let scene = LayoutScene::new()
        .aspect_mode(AspectMode::Data)
        .x_axis(axis())
        .y_axis(axis())
        .z_axis(axis())
        .camera(Camera::new().eye(Eye::from((0.95 * distance, -1.25 * distance, 0.85 * distance))));
    let mut plot = Plot::new();
    plot.add_trace(mesh);
    plot.set_layout(
        Layout::new()
            .scene(scene)
            .height(height)
            .font(Font::new().family("system-ui, sans-serif").size(12).color(ink::TEXT))
            .paper_background_color("#ffffff")
            .margin(Margin::new().left(0).right(0).top(26).bottom(0)),
    );
    plot
}

/// A value to 1e-4 of its unit, which keeps the page small.
fn rounded(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}
