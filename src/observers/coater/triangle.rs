//! A triangle on the grid of the screen: its exact inside and its depth.

use wide::{f32x4, i32x4};

/// Steps of the vertex grid per pixel, as a power of two.
const SUBPIXEL_BITS: u32 = 8;
const SUBPIXELS: i32 = 1 << SUBPIXEL_BITS;
/// Pixels looked at at once.
pub(super) const LANES: usize = 4;
/// The same, as a step along a row.
pub(super) const LANE_STEP: i32 = 4;
/// Triangles with longer sides (grid steps) have edge functions that `i32` cannot hold: 2 · 31 000 · (31 000 + 4 · 256)
/// is just below 2³¹.
const LONGEST_IN_I32: i32 = 31_000;
/// Vertices further out are moved here, pixels: far beyond any screen, near enough for exact edge functions in `i64`.
const FAR_OUT: f32 = 1e6;

/// A vertex on the screen.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::observers) struct ScreenVertex {
    x: i32,
    y: i32,
    depth: f32,
}

/// Which sides of a triangle can be seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::observers) enum Sides {
    /// The one from which it winds counter-clockwise.
    Front,
    /// Both.
    Both,
}

/// A triangle that is seen, its vertices clockwise on the screen, whose rows run downwards.
#[derive(Debug, Clone, Copy)]
pub(super) struct Triangle {
    vertices: [ScreenVertex; 3],
    /// Twice its area, grid steps squared, above 0.
    area: i64,
    /// Left and right, top and bottom, grid steps.
    columns: [i32; 2],
    rows: [i32; 2],
}

/// Columns and rows of pixels, first to last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::observers) struct Bounds {
    pub(super) columns: [i32; 2],
    pub(super) rows: [i32; 2],
}

impl Bounds {
    /// The pixels, up to the `last` column and row of a screen, whose centres lie between `min` and `max` (pixels).
    pub(super) fn between(min: [f32; 2], max: [f32; 2], last: [i32; 2]) -> Option<Self> {
        // Half a step of the vertex grid and the rounding of f32 stay within a hundredth of a pixel.
        let [columns, rows] = std::array::from_fn(|k| {
            let (low, high) = ((min[k] - 0.01).ceil().max(0.0), (max[k] + 0.01).floor().min(last[k] as f32));
            [low as i32, high.max(-1.0) as i32]
        });
        (columns[0] <= columns[1] && rows[0] <= rows[1]).then_some(Self { columns, rows })
    }
}

impl ScreenVertex {
    /// Snaps the screen coordinates of some vertices to the grid.
    pub(in crate::observers) fn snap([x, y, depth]: [f32x4; 3]) -> [Self; LANES] {
        let grid = |pixels: f32x4| {
            let kept = pixels.fast_max(f32x4::splat(-FAR_OUT)).fast_min(f32x4::splat(FAR_OUT));
            (kept * SUBPIXELS as f32).fast_round_int().to_array()
        };
        let (x, y, depth) = (grid(x), grid(y), depth.to_array());
        std::array::from_fn(|lane| Self { x: x[lane], y: y[lane], depth: depth[lane] })
    }
}

impl Triangle {
    /// `None` when it is edge-on or shows its back.
    #[inline]
    pub(super) fn new([a, b, c]: [&ScreenVertex; 3], sides: Sides) -> Option<Self> {
        // What winds counter-clockwise for the viewer has a negative area where rows run downwards.
        let area = cross(a, b, c);
        if area == 0 || (area > 0 && sides == Sides::Front) {
            return None;
        }
        let vertices = if area < 0 { [*a, *c, *b] } else { [*a, *b, *c] };
        Some(Self {
            vertices,
            area: area.abs(),
            columns: [a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x)],
            rows: [a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y)],
        })
    }

    /// The pixels of a screen, up to the `last` column and row, whose centres it may cover.
    #[inline]
    pub(super) fn bounds(&self, last: [i32; 2]) -> Option<Bounds> {
        let first = |low: i32| ((low + SUBPIXELS - 1) >> SUBPIXEL_BITS).max(0);
        let columns = [first(self.columns[0]), (self.columns[1] >> SUBPIXEL_BITS).min(last[0])];
        let rows = [first(self.rows[0]), (self.rows[1] >> SUBPIXEL_BITS).min(last[1])];
        (columns[0] <= columns[1] && rows[0] <= rows[1]).then_some(Bounds { columns, rows })
    }

    /// Depth of its nearest vertex.
    #[inline]
    pub(super) fn nearest(&self) -> f32 {
        let [a, b, c] = &self.vertices;
        a.depth.min(b.depth).min(c.depth)
    }

    /// Whether its edge functions fit in `i32`.
    #[inline]
    pub(super) fn is_small(&self) -> bool {
        (self.columns[1] - self.columns[0]).max(self.rows[1] - self.rows[0]) <= LONGEST_IN_I32
    }

    #[inline]
    fn edges(&self) -> [(ScreenVertex, ScreenVertex); 3] {
        let [a, b, c] = self.vertices;
        [(a, b), (b, c), (c, a)]
    }

    /// Edge functions of a small triangle at the first pixels of the first row of `bounds`.
    #[inline]
    pub(super) fn lane_edges(&self, bounds: &Bounds) -> [LaneEdge; 3] {
        let [a, b, c] = &self.vertices;
        [LaneEdge::new(a, b, bounds), LaneEdge::new(b, c, bounds), LaneEdge::new(c, a, bounds)]
    }

    /// The columns of `bounds` that are inside in row `y`, first to last; none when they are in reverse order.
    pub(super) fn span(&self, bounds: &Bounds, y: i32) -> [i32; 2] {
        let mut span = bounds.columns.map(i64::from);
        for (from, to) in self.edges() {
            let [x, y] = [-from.x, y * SUBPIXELS - from.y].map(i64::from);
            let (dx, dy) = (to.x - from.x, to.y - from.y);
            let in_column_0 = i64::from(dx) * y - i64::from(dy) * x - i64::from(!is_top_or_left(dx, dy));
            let step = -i64::from(dy) * i64::from(SUBPIXELS);
            match step.signum() {
                1 => span[0] = span[0].max(-in_column_0.div_euclid(step)),
                -1 => span[1] = span[1].min(in_column_0.div_euclid(-step)),
                _ if in_column_0 < 0 => span[1] = -1,
                _ => {}
            }
        }
        [span[0].min(i64::from(i32::MAX)) as i32, span[1].max(-1) as i32]
    }
}

/// An edge function, not negative inside, over a row of pixels and from row to row.
#[derive(Debug, Clone, Copy)]
pub(super) struct LaneEdge {
    pub(super) value: i32x4,
    pub(super) per_lanes: i32x4,
    pub(super) per_row: i32x4,
}

impl LaneEdge {
    #[inline]
    fn new(from: &ScreenVertex, to: &ScreenVertex, bounds: &Bounds) -> Self {
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        let (x, y) = (bounds.columns[0] * SUBPIXELS - from.x, bounds.rows[0] * SUBPIXELS - from.y);
        let first = dx * y - dy * x - i32::from(!is_top_or_left(dx, dy));
        let step = -dy * SUBPIXELS;
        // first + lane · step, from the two bits of the lane.
        let odd = i32x4::splat(step) & i32x4::from([0, -1, 0, -1]);
        let upper = i32x4::splat(2 * step) & i32x4::from([0, 0, -1, -1]);
        Self {
            value: i32x4::splat(first) + odd + upper,
            per_lanes: i32x4::splat(LANE_STEP * step),
            per_row: i32x4::splat(dx * SUBPIXELS),
        }
    }
}

/// Twice the area of (a, b, c), grid steps squared, positive when they turn clockwise on the screen.
#[inline]
fn cross(a: &ScreenVertex, b: &ScreenVertex, c: &ScreenVertex) -> i64 {
    let (bx, by) = (i64::from(b.x - a.x), i64::from(b.y - a.y));
    let (cx, cy) = (i64::from(c.x - a.x), i64::from(c.y - a.y));
    bx * cy - cx * by
}

/// Whether pixel centres on an edge belong to the triangle: on top and left edges they do, so that of two triangles
/// with a common edge exactly one has them.
#[inline]
fn is_top_or_left(dx: i32, dy: i32) -> bool {
    dy < 0 || (dy == 0 && dx > 0)
}

/// Depth over the screen, kept between the depths of the vertices: planes seen edge-on would overshoot.
#[derive(Debug, Clone, Copy)]
pub(super) struct DepthPlane {
    x: f32,
    y: f32,
    depth: f32,
    per_column: f32,
    per_row: f32,
    nearest: f32,
    furthest: f32,
}

impl DepthPlane {
    #[inline]
    pub(super) fn new(triangle: &Triangle) -> Self {
        let [a, b, c] = triangle.vertices;
        let (bx, by) = ((b.x - a.x) as f32, (b.y - a.y) as f32);
        let (cx, cy) = ((c.x - a.x) as f32, (c.y - a.y) as f32);
        let (db, dc) = (b.depth - a.depth, c.depth - a.depth);
        let scale = SUBPIXELS as f32 / triangle.area as f32;
        Self {
            x: a.x as f32 / SUBPIXELS as f32,
            y: a.y as f32 / SUBPIXELS as f32,
            depth: a.depth,
            per_column: (db * cy - dc * by) * scale,
            per_row: (dc * bx - db * cx) * scale,
            nearest: triangle.nearest(),
            furthest: a.depth.max(b.depth).max(c.depth),
        }
    }

    /// Depth in row `y` below the first vertex.
    #[inline]
    pub(super) fn row(&self, y: i32) -> f32 {
        self.depth + self.per_row * (y as f32 - self.y)
    }

    /// Depths at pixel `x` of a row and the next ones.
    #[inline]
    pub(super) fn depths(&self, row: f32, x: i32) -> f32x4 {
        let columns = f32x4::splat(x as f32) + f32x4::from([0.0, 1.0, 2.0, 3.0]) - f32x4::splat(self.x);
        let depths = f32x4::splat(row) + columns * f32x4::splat(self.per_column);
        depths.fast_max(f32x4::splat(self.nearest)).fast_min(f32x4::splat(self.furthest))
    }
}
