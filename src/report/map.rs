//! The coating map of a tablet, in three dimensions.

use super::ThicknessMap;
use super::charts::ink;
use plotly::common::{ColorBar, ColorScale, ColorScalePalette, Font, HoverInfo, Title};
use plotly::layout::{AspectMode, Axis, Camera, Eye, LayoutScene, Margin};
use plotly::traces::mesh3d::{IntensityMode, Lighting, Mesh3D};
use plotly::{Layout, Plot};

/// The average tablet, every panel in the colour of its thickness; pointing at a panel shows its numbers.
pub(super) fn thickness_map(map: &ThicknessMap) -> Plot {
    let corner = |k: usize| map.triangles.iter().map(|t| t[k] as usize).collect::<Vec<_>>();
    let coordinate = |k: usize| map.vertices_mm.iter().map(|v| v[k]).collect::<Vec<_>>();
    let label = |(panel, um): (usize, &f64)| {
        let region = if map.on_cap[panel] { "cap" } else { "band" };
        format!("{um:.2} µm · {region}, panel {panel}")
    };
    let labels: Vec<String> = map.average_um.iter().enumerate().map(label).collect();
    let mesh = Mesh3D::new(
        coordinate(0),
        coordinate(1),
        coordinate(2),
        Some(corner(0)),
        Some(corner(1)),
        Some(corner(2)),
    )
    .intensity(map.average_um.clone())
    .intensity_mode(IntensityMode::Cell)
    .color_scale(ColorScale::Palette(ColorScalePalette::Viridis))
    .color_bar(ColorBar::new().title(Title::with_text("µm")).thickness(14).outline_width(0))
    .flat_shading(true)
    .lighting(Lighting::new().ambient(0.85).diffuse(0.35).specular(0.05).roughness(0.9))
    .hover_info(HoverInfo::Text)
    .text_array(labels);
    let axis = || Axis::new().visible(false);
    let scene = LayoutScene::new()
        .aspect_mode(AspectMode::Data)
        .x_axis(axis())
        .y_axis(axis())
        .z_axis(axis())
        .camera(Camera::new().eye(Eye::from((0.95, -1.25, 0.85))));
    let mut plot = Plot::new();
    plot.add_trace(mesh);
    plot.set_layout(
        Layout::new()
            .scene(scene)
            .height(460)
            .font(Font::new().family("system-ui, sans-serif").size(13).color(ink::TEXT))
            .paper_background_color("#ffffff")
            .margin(Margin::new().left(0).right(0).top(0).bottom(0)),
    );
    plot
}
