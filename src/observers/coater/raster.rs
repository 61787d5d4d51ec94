//! Which surface is seen at each pixel: triangles drawn into a buffer of numbers and depths.
//!
//! Vertices lie on a grid of 1/256 pixel and edge functions are integers, so that with the top-left rule every pixel
//! centre belongs to exactly one of two triangles that share an edge. At equal depth the lower number wins, so the
//! order of drawing does not matter. Depth per tile lets a caller skip what is hidden entirely.

/// Steps of the vertex grid per pixel.
const SUBPIXELS: i32 = 256;
/// Side of a depth tile, pixels.
const TILE: usize = 16;
/// Vertices further out are moved here, pixels: far beyond any screen, near enough for exact edge functions.
const FAR_OUT: f32 = 1e6;

/// A vertex on the screen.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::observers) struct ScreenVertex {
    x: i32,
    y: i32,
    depth: f32,
}

impl ScreenVertex {
    /// Snaps screen coordinates to the grid. What is nearer than the near plane comes to lie on it.
    pub(in crate::observers) fn new([x, y, depth]: [f32; 3]) -> Self {
        let snap =
            |pixels: f32| (pixels.clamp(-FAR_OUT, FAR_OUT) * SUBPIXELS as f32).round_ties_even() as i32;
        Self { x: snap(x), y: snap(y), depth: depth.max(0.0) }
    }
}

/// Which sides of a triangle can be seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::observers) enum Sides {
    /// The one from which it winds counter-clockwise.
    Front,
    /// Both.
    Both,
}

/// Pixels from `left` to `right` and `top` to `bottom`, all inclusive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::observers) struct PixelBox {
    left: usize,
    right: usize,
    top: usize,
    bottom: usize,
}

/// Number and depth of the nearest surface at each pixel.
#[derive(Debug, Clone)]
pub(in crate::observers) struct IdRaster {
    width: usize,
    height: usize,
    /// Last column and row.
    last: [i32; 2],
    ids: Vec<u32>,
    depths: Vec<f32>,
    /// Depth of the furthest pixel of each tile, or more.
    tile_depths: Vec<f32>,
    tiles_across: usize,
}

impl IdRaster {
    /// An empty screen of `pixels` columns and rows.
    pub(in crate::observers) fn new(pixels: [u32; 2]) -> Self {
        let last = pixels.map(|size| i32::try_from(size).unwrap_or(i32::MAX) - 1);
        let [width, height] = pixels.map(|size| size as usize);
        let tiles_across = width.div_ceil(TILE);
        Self {
            width,
            height,
            last,
            ids: vec![0; width * height],
            depths: vec![f32::INFINITY; width * height],
            tile_depths: vec![f32::INFINITY; tiles_across * height.div_ceil(TILE)],
            tiles_across,
        }
    }

    /// Numbers seen, row by row.
    pub(in crate::observers) fn ids(&self) -> &[u32] {
        &self.ids
    }

    /// Depths seen, row by row; infinite where nothing is.
    pub(in crate::observers) fn depths(&self) -> &[f32] {
        &self.depths
    }

    /// Empties the screen: `background` at every pixel.
    pub(in crate::observers) fn clear(&mut self, background: u32) {
        self.ids.fill(background);
        self.depths.fill(f32::INFINITY);
        self.tile_depths.fill(f32::INFINITY);
    }

    /// The pixels whose centres lie between `min` and `max` (pixels); `None` when there are none on the screen.
    pub(in crate::observers) fn pixels_between(&self, min: [f32; 2], max: [f32; 2]) -> Option<PixelBox> {
        // Half a step of the vertex grid and the rounding of f32 stay within a hundredth of a pixel.
        let first = |x: f32| (x - 0.01).ceil().max(0.0) as usize;
        let last = |x: f32, size: usize| (x + 0.01).floor().min(size as f32 - 1.0);
        let (right, bottom) = (last(max[0], self.width), last(max[1], self.height));
        let (left, top) = (first(min[0]), first(min[1]));
        (right >= left as f32 && bottom >= top as f32).then_some(PixelBox {
            left,
            right: right as usize,
            top,
            bottom: bottom as usize,
        })
    }

    /// Whether nothing as deep as `nearest` or deeper can be seen in `area`.
    pub(in crate::observers) fn hides(&self, area: &PixelBox, nearest: f32) -> bool {
        (area.top / TILE..=area.bottom / TILE).all(|row| {
            let tiles = &self.tile_depths[row * self.tiles_across..][area.left / TILE..=area.right / TILE];
            tiles.iter().all(|&far| nearest > far)
        })
    }

    /// Brings the tile depths of `area` up to date. Until then [`Self::hides`] errs on the side of seeing.
    pub(in crate::observers) fn settle(&mut self, area: &PixelBox) {
        for row in area.top / TILE..=area.bottom / TILE {
            for column in area.left / TILE..=area.right / TILE {
                let across = column * TILE..self.width.min((column + 1) * TILE);
                let down = row * TILE..self.height.min((row + 1) * TILE);
                self.tile_depths[row * self.tiles_across + column] = down
                    .flat_map(|y| &self.depths[y * self.width..][across.clone()])
                    .fold(0.0, |far, &depth| depth.max(far));
            }
        }
    }

    /// Brings all tile depths up to date.
    pub(in crate::observers) fn settle_all(&mut self) {
        self.settle(&PixelBox { left: 0, right: self.width - 1, top: 0, bottom: self.height - 1 });
    }

    /// Draws a triangle under the number `id`.
    pub(in crate::observers) fn draw(&mut self, [a, b, c]: [ScreenVertex; 3], id: u32, sides: Sides) {
        // Rows run downwards: what winds counter-clockwise for the viewer has a negative area here.
        let area = cross(a, b, c);
        if area == 0 || (area > 0 && sides == Sides::Front) {
            return;
        }
        let [a, b, c] = if area < 0 { [a, c, b] } else { [a, b, c] };
        let [left, top] = [a.x.min(b.x).min(c.x), a.y.min(b.y).min(c.y)].map(|v| first_pixel(v).max(0));
        let right = a.x.max(b.x).max(c.x).div_euclid(SUBPIXELS).min(self.last[0]);
        let bottom = a.y.max(b.y).max(c.y).div_euclid(SUBPIXELS).min(self.last[1]);
        if left > right || top > bottom {
            return;
        }
        let edges = [Edge::new(a, b), Edge::new(b, c), Edge::new(c, a)];
        let plane = DepthPlane::new(a, b, c);
        for y in top..=bottom {
            let span = edges.iter().fold((left, right), |span, edge| edge.narrow(span, y));
            if span.0 <= span.1 {
                let row = y as usize * self.width;
                let pixels = row + span.0 as usize..=row + span.1 as usize;
                fill(&mut self.ids[pixels.clone()], &mut self.depths[pixels], id, &plane, span.0, y);
            }
        }
    }
}

/// Writes `id` wherever the plane lies in front of what is there.
fn fill(ids: &mut [u32], depths: &mut [f32], id: u32, plane: &DepthPlane, left: i32, y: i32) {
    let row = plane.row(y);
    for ((x, seen), at) in (left..).zip(ids).zip(depths) {
        let depth = plane.depth(row, x);
        if depth < *at || (depth == *at && id < *seen) {
            *at = depth;
            *seen = id;
        }
    }
}

/// The first pixel whose centre is not left of (or above) this grid coordinate.
fn first_pixel(grid: i32) -> i32 {
    (grid + SUBPIXELS - 1).div_euclid(SUBPIXELS)
}

/// Twice the area of (a, b, c), grid steps squared, positive when they turn clockwise on the screen.
fn cross(a: ScreenVertex, b: ScreenVertex, c: ScreenVertex) -> i64 {
    let [bx, by, cx, cy] = [b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y].map(i64::from);
    bx * cy - cx * by
}

/// E(x, y) = at_origin + per_column x + per_row y for pixel centres: not negative inside.
struct Edge {
    at_origin: i64,
    per_column: i64,
    per_row: i64,
}

impl Edge {
    /// The edge from `a` to `b` of a triangle that turns clockwise on the screen.
    fn new(a: ScreenVertex, b: ScreenVertex) -> Self {
        let [ax, ay, dx, dy] = [a.x, a.y, b.x - a.x, b.y - a.y].map(i64::from);
        let top_or_left = dy < 0 || (dy == 0 && dx > 0);
        Self {
            at_origin: dy * ax - dx * ay - i64::from(!top_or_left),
            per_column: -dy * i64::from(SUBPIXELS),
            per_row: dx * i64::from(SUBPIXELS),
        }
    }

    /// The part of a span of columns in row `y` that is inside.
    fn narrow(&self, (left, right): (i32, i32), y: i32) -> (i32, i32) {
        let at_row = self.at_origin + self.per_row * i64::from(y);
        let (left, right) = (i64::from(left), i64::from(right));
        let (left, right) = match self.per_column {
            0 if at_row < 0 => (left, left - 1),
            0 => (left, right),
            step if step > 0 => (left.max(-at_row.div_euclid(step)), right),
            step => (left, right.min(at_row.div_euclid(-step))),
        };
        (left.min(i64::from(i32::MAX)) as i32, right.max(-1) as i32)
    }
}

/// Depth over the screen, kept between the depths of the vertices: planes seen edge-on would overshoot.
struct DepthPlane {
    x: f32,
    y: f32,
    depth: f32,
    per_column: f32,
    per_row: f32,
    nearest: f32,
    furthest: f32,
}

impl DepthPlane {
    fn new(a: ScreenVertex, b: ScreenVertex, c: ScreenVertex) -> Self {
        let [bx, by, cx, cy] = [b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y].map(|v| v as f32);
        let (db, dc) = (b.depth - a.depth, c.depth - a.depth);
        let scale = SUBPIXELS as f32 / cross(a, b, c) as f32;
        Self {
            x: a.x as f32 / SUBPIXELS as f32,
            y: a.y as f32 / SUBPIXELS as f32,
            depth: a.depth,
            per_column: (db * cy - dc * by) * scale,
            per_row: (dc * bx - db * cx) * scale,
            nearest: a.depth.min(b.depth).min(c.depth),
            furthest: a.depth.max(b.depth).max(c.depth),
        }
    }

    fn row(&self, y: i32) -> f32 {
        self.depth + self.per_row * (y as f32 - self.y)
    }

    fn depth(&self, row: f32, x: i32) -> f32 {
        (row + self.per_column * (x as f32 - self.x)).max(self.nearest).min(self.furthest)
    }
}
