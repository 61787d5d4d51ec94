//! The bed as a view sees it: which bodies are worth drawing, and drawing them nearest first.

use super::CoaterError;
use super::drum::DrumMesh;
use super::film::PanelIds;
use super::raster::IdRaster;
use super::triangle::{Bounds, LANES, ScreenVertex, Sides};
use super::view::{Lens, Placement, View};
use crate::shapes::{Panels, SurfaceMesh, TabletShape};
use crate::stepping::Frame;
use nalgebra::Vector3;
use std::borrow::Borrow;
use wide::f32x4;

/// Everything a view can see, the same in every frame but for the poses.
#[derive(Debug, Clone)]
pub(in crate::observers) struct Bed {
    solids: Vec<Solid>,
    body_shape: Vec<usize>,
    ids: PanelIds,
    drum: DrumMesh,
}

/// Where a bed is drawn; one per thread.
#[derive(Debug, Clone)]
pub(in crate::observers) struct Canvas {
    pub(in crate::observers) raster: IdRaster,
    vertices: Vec<ScreenVertex>,
    candidates: Vec<Candidate>,
}

/// The panels of a shape, ready for drawing.
#[derive(Debug, Clone)]
struct Solid {
    /// Body coordinates of the vertices, some at a time; the last ones repeat a vertex.
    vertices: Vec<[f32x4; 3]>,
    triangles: Vec<[u32; 3]>,
    /// Middle of the box about the vertices, m.
    middle: [f32; 3],
    /// From the middle to the sides of the box, m.
    half: [f32; 3],
}

/// A body that may be seen.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate {
    pub(super) body: usize,
    nearest: f32,
    pub(super) placement: Placement,
    area: Bounds,
}

impl Bed {
    /// A bed of bodies whose shapes are `body_shape[body]`, in the order of the frames.
    ///
    /// # Errors
    /// [`CoaterError::NoPanels`] when a body's shape has none, [`CoaterError::TooManyPanels`].
    pub(in crate::observers) fn new(
        shapes: &[impl Borrow<TabletShape>],
        body_shape: &[usize],
        drum: Option<&SurfaceMesh>,
    ) -> Result<Self, CoaterError> {
        let solids = shapes
            .iter()
            .map(Borrow::borrow)
            .map(|shape| {
                let panels = shape.panels.as_ref().filter(|panels| !panels.is_empty());
                panels.map(Solid::new).ok_or_else(|| CoaterError::NoPanels { shape: shape.name.clone() })
            })
            .collect::<Result<Vec<_>, _>>()?;
        let ids = PanelIds::new(body_shape.iter().map(|&shape| solids[shape].triangles.len()))?;
        Ok(Self { solids, body_shape: body_shape.to_vec(), ids, drum: DrumMesh::new(drum) })
    }

    pub(in crate::observers) fn ids(&self) -> &PanelIds {
        &self.ids
    }

    /// Draws a frame as `view` sees it.
    ///
    /// For parallel rays, bodies wholly above the nozzle are left out and one that reaches through its plane is drawn
    /// whole. A pinhole leaves out what comes closer to it than a twentieth of its distance.
    pub(in crate::observers) fn draw(&self, view: &View, frame: &Frame<'_>, canvas: &mut Canvas) {
        canvas.raster.clear(self.ids.panels() + PanelIds::EMPTY);
        self.drum.draw(view, frame.drum_angle, self.ids.panels(), &mut canvas.raster);
        let mut candidates = std::mem::take(&mut canvas.candidates);
        self.candidates(view, frame, canvas.raster.last(), &mut candidates);
        for candidate in &candidates {
            if !canvas.raster.hides(&candidate.area, candidate.nearest) {
                self.draw_body(candidate.body, view.lens(), &candidate.placement, canvas);
            }
        }
        canvas.candidates = candidates;
    }

    /// Replaces `candidates` by the bodies whose boxes touch a screen up to the `last` column and row, nearest first.
    pub(super) fn candidates(
        &self,
        view: &View,
        frame: &Frame<'_>,
        last: [i32; 2],
        candidates: &mut Vec<Candidate>,
    ) {
        candidates.clear();
        candidates.extend(frame.bodies.iter().enumerate().filter_map(|(body, state)| {
            let placement = view.place(state);
            let solid = &self.solids[self.body_shape[body]];
            let (middle, half) = placement.box_about(solid.middle, solid.half);
            let bounds = view.lens().screen_box(middle, half)?;
            let area = Bounds::between(bounds.min, bounds.max, last)?;
            Some(Candidate { body, nearest: bounds.nearest, placement, area })
        }));
        candidates.sort_unstable_by(|a, b| a.nearest.total_cmp(&b.nearest).then(a.body.cmp(&b.body)));
    }

    /// Draws a body unless it turns out, vertex by vertex, to be hidden after all.
    fn draw_body(&self, body: usize, lens: &Lens, placement: &Placement, canvas: &mut Canvas) {
        let solid = &self.solids[self.body_shape[body]];
        canvas.vertices.clear();
        let mut bounds = ScreenBounds::EMPTY;
        for point in &solid.vertices {
            let seen = lens.screen(placement.apply(point));
            bounds.include(seen);
            canvas.vertices.extend(ScreenVertex::snap(seen));
        }
        let Some(area) = bounds.pixels(canvas.raster.last()) else { return };
        if canvas.raster.hides(&area, bounds.nearest()) {
            return;
        }
        for (id, triangle) in (self.ids.id(body, 0)..).zip(&solid.triangles) {
            let corners = triangle.map(|vertex| &canvas.vertices[vertex as usize]);
            canvas.raster.draw(corners, id, Sides::Front);
        }
        canvas.raster.settle(&area);
    }
}

/// The box about what is seen of a body.
struct ScreenBounds {
    min: [f32x4; 3],
    max: [f32x4; 3],
}

impl ScreenBounds {
    const EMPTY: Self =
        Self { min: [f32x4::splat(f32::INFINITY); 3], max: [f32x4::splat(f32::NEG_INFINITY); 3] };

    fn include(&mut self, seen: [f32x4; 3]) {
        for ((min, max), seen) in self.min.iter_mut().zip(&mut self.max).zip(seen) {
            *min = min.fast_min(seen);
            *max = max.fast_max(seen);
        }
    }

    fn nearest(&self) -> f32 {
        self.min[2].to_array().into_iter().fold(f32::INFINITY, f32::min)
    }

    fn pixels(&self, last: [i32; 2]) -> Option<Bounds> {
        let [left, top, _] = self.min.map(|v| v.to_array().into_iter().fold(f32::INFINITY, f32::min));
        let [right, bottom, _] = self.max.map(|v| v.to_array().into_iter().fold(f32::NEG_INFINITY, f32::max));
        Bounds::between([left, top], [right, bottom], last)
    }
}

/// What a graphics card is handed of a bed.
#[cfg(feature = "gpu")]
impl Bed {
    pub(super) fn shape_of(&self, body: usize) -> usize {
        self.body_shape[body]
    }

    pub(super) fn shapes(&self) -> usize {
        self.solids.len()
    }

    /// Vertices (m, the last one some times over) and triangles of a shape.
    pub(super) fn shape(&self, shape: usize) -> (impl Iterator<Item = [f32; 3]>, &[[u32; 3]]) {
        let solid = &self.solids[shape];
        let points = solid.vertices.iter().flat_map(|some| {
            let [x, y, z] = some.map(f32x4::to_array);
            (0..LANES).map(move |lane| [x[lane], y[lane], z[lane]])
        });
        (points, &solid.triangles)
    }

    /// Vertices of the drum, m.
    pub(super) fn drum_points(&self) -> impl Iterator<Item = [f32; 3]> {
        self.drum.vertices().iter().map(|vertex| vertex.data.0[0].map(|x| x as f32))
    }

    /// Triangles of the drum by what they belong to: its place among the numbers that follow those of the panels.
    pub(super) fn drum_parts(&self) -> &[(u32, Vec<[u32; 3]>)] {
        self.drum.parts()
    }
}

impl Canvas {
    pub(in crate::observers) fn new(pixels: [u32; 2]) -> Self {
        Self { raster: IdRaster::new(pixels), vertices: Vec::new(), candidates: Vec::new() }
    }
}

impl Solid {
    fn new(panels: &Panels) -> Self {
        let fold = |pick: fn(f64, f64) -> f64| {
            panels.vertices.iter().fold(panels.vertices[0], |sides, vertex| sides.zip_map(vertex, pick))
        };
        let (min, max) = (fold(f64::min), fold(f64::max));
        let single = |v: &Vector3<f64>| v.data.0[0].map(|x| x as f32);
        Self {
            vertices: panels
                .vertices
                .chunks(LANES)
                .map(|some| {
                    std::array::from_fn(|k| {
                        std::array::from_fn(|lane| some[lane.min(some.len() - 1)][k] as f32).into()
                    })
                })
                .collect(),
            triangles: panels.triangles.clone(),
            middle: single(&((min + max) / 2.0)),
            half: single(&((max - min) / 2.0)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observers::SprayZone;
    use crate::observers::coater::tests::{cube, tumbled};
    use crate::observers::coater::view::jitter;
    use crate::scene::Rays;
    use crate::stepping::BodyState;

    fn zone() -> SprayZone {
        SprayZone {
            center: Vector3::new(0.0, 0.0, 0.0),
            spanwise: Vector3::z(),
            streamwise: -Vector3::x(),
            normal: Vector3::y(),
            extent: [0.06, 0.03],
            distance: 0.02,
        }
    }

    /// Every body, near or not, hidden or not, in the order given.
    fn draw_all(bed: &Bed, view: &View, bodies: &[BodyState], order: &[usize], canvas: &mut Canvas) {
        canvas.raster.clear(bed.ids.panels() + PanelIds::EMPTY);
        for &body in order {
            bed.draw_body(body, view.lens(), &view.place(&bodies[body]), canvas);
        }
    }

    #[test]
    fn what_is_left_out_would_not_have_been_seen() {
        let cubes = [cube(0.01)];
        // All below the nozzle: the reference above drops none.
        let bodies = tumbled(120, [0.05, 0.03, 0.06], 1);
        let bed = Bed::new(&cubes, &vec![0; bodies.len()], None).unwrap();
        for (index, rays) in (0..8).flat_map(|index| [(index, Rays::Parallel), (index, Rays::Diverging)]) {
            let view = View::new(&zone(), rays, [200, 100], jitter(index));
            let frame = Frame { index, time: 0.0, bodies: &bodies, drum_angle: 0.0, drum_torque: 0.0 };
            let (mut culled, mut whole) = (Canvas::new([200, 100]), Canvas::new([200, 100]));
            bed.draw(&view, &frame, &mut culled);
            let order: Vec<usize> = (0..bodies.len()).rev().collect();
            draw_all(&bed, &view, &bodies, &order, &mut whole);
            assert!(culled.candidates.len() < bodies.len());
            assert!(culled.raster.rows().eq(whole.raster.rows()), "frame {index} {rays:?}");
        }
    }

    #[test]
    fn a_body_through_the_near_plane_is_whole_and_one_above_it_is_gone() {
        let cubes = [cube(0.01)];
        let bed = Bed::new(&cubes, &[0, 0], None).unwrap();
        let at = |y: f64, z: f64| {
            let mut body = tumbled(1, [0.0; 3], 1)[0];
            body.position = Vector3::new(0.0, y, z);
            body.orientation = nalgebra::UnitQuaternion::identity();
            body
        };
        let bodies = [at(0.02, -0.015), at(0.0251, 0.015)];
        let frame = Frame { index: 0, time: 0.0, bodies: &bodies, drum_angle: 0.0, drum_torque: 0.0 };
        let mut canvas = Canvas::new([60, 30]);
        bed.draw(&View::new(&zone(), Rays::Parallel, [60, 30], [0.0; 2]), &frame, &mut canvas);
        let seen = |body: usize| {
            let ids = bed.ids.of_body(body);
            canvas.raster.rows().flatten().filter(|&&id| ids.contains(&(id as usize))).count()
        };
        assert_eq!((seen(0), seen(1)), (100, 0));
    }
}
