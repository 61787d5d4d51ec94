//! Which surface is seen at each pixel: triangles drawn into a buffer of numbers and depths.
//!
//! Vertices lie on a grid of 1/256 pixel and edge functions are integers, so that with the top-left rule every pixel
//! centre belongs to exactly one of two triangles that share an edge. At equal depth the lower number wins, so the
//! order of drawing does not matter. Depth per tile lets a caller skip what is hidden entirely.

use super::triangle::{Bounds, DepthPlane, LANE_STEP, LANES, ScreenVertex, Sides, Triangle};
use wide::{f32x4, i32x4, u32x4};

/// Side of a depth tile, pixels.
const TILE: usize = 8;

/// Number and depth of the nearest surface at each pixel.
#[derive(Debug, Clone)]
pub(in crate::observers) struct IdRaster {
    width: usize,
    height: usize,
    /// Last column and row.
    last: [i32; 2],
    /// From a row to the next: whole tiles, and what a step over their end may touch.
    stride: usize,
    ids: Vec<u32>,
    /// Beyond the screen nearer than anything, so that nothing is drawn there.
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
        let (tiles_across, tiles_down) = (width.div_ceil(TILE), height.div_ceil(TILE));
        let stride = tiles_across * TILE + LANES;
        let size = stride * tiles_down * TILE;
        let mut raster = Self {
            width,
            height,
            last,
            stride,
            ids: vec![0; size],
            depths: vec![f32::NEG_INFINITY; size],
            tile_depths: vec![f32::INFINITY; tiles_across * tiles_down],
            tiles_across,
        };
        raster.clear(0);
        raster
    }

    /// Last column and row.
    pub(super) fn last(&self) -> [i32; 2] {
        self.last
    }

    /// Numbers seen, row by row.
    pub(in crate::observers) fn rows(&self) -> impl Iterator<Item = &[u32]> {
        self.ids.chunks_exact(self.stride).take(self.height).map(|row| &row[..self.width])
    }

    /// Number and depth at a pixel; the depth is infinite where nothing is.
    pub(in crate::observers) fn at(&self, x: usize, y: usize) -> (u32, f32) {
        let at = y * self.stride + x;
        (self.ids[at], self.depths[at])
    }

    /// Empties the screen: `background` at every pixel.
    pub(in crate::observers) fn clear(&mut self, background: u32) {
        self.ids.fill(background);
        let rows = self.depths.chunks_exact_mut(self.stride).take(self.height);
        rows.for_each(|row| row[..self.width].fill(f32::INFINITY));
        self.tile_depths.fill(f32::INFINITY);
    }

    /// Whether nothing as deep as `nearest` or deeper can be seen in `area`.
    #[inline]
    pub(in crate::observers) fn hides(&self, area: &Bounds, nearest: f32) -> bool {
        let (left, right) = (area.columns[0] as usize / TILE, area.columns[1] as usize / TILE);
        let (top, bottom) = (area.rows[0] as usize / TILE, area.rows[1] as usize / TILE);
        for row in top..=bottom {
            for &furthest in &self.tile_depths[row * self.tiles_across..][left..=right] {
                if nearest <= furthest {
                    return false;
                }
            }
        }
        true
    }

    /// Brings the tile depths of `area` up to date. Until then [`Self::hides`] errs on the side of seeing.
    pub(in crate::observers) fn settle(&mut self, area: &Bounds) {
        let (left, right) = (area.columns[0] as usize / TILE, area.columns[1] as usize / TILE);
        let (top, bottom) = (area.rows[0] as usize / TILE, area.rows[1] as usize / TILE);
        for row in top..=bottom {
            let depths = &self.depths[row * TILE * self.stride..][..TILE * self.stride];
            let tiles = &mut self.tile_depths[row * self.tiles_across..][left..=right];
            for (tile, column) in tiles.iter_mut().zip(left..) {
                let mut furthest = f32x4::splat(f32::NEG_INFINITY);
                for depths in depths.chunks_exact(self.stride) {
                    for depths in depths[column * TILE..][..TILE].as_chunks::<LANES>().0 {
                        furthest = furthest.fast_max(f32x4::new(*depths));
                    }
                }
                let [a, b, c, d] = furthest.to_array();
                *tile = a.max(b).max(c.max(d));
            }
        }
    }

    /// Brings all tile depths up to date.
    pub(in crate::observers) fn settle_all(&mut self) {
        self.settle(&Bounds { columns: [0, self.last[0]], rows: [0, self.last[1]] });
    }

    /// Draws a triangle under the number `id`.
    #[inline]
    pub(in crate::observers) fn draw(&mut self, vertices: [&ScreenVertex; 3], id: u32, sides: Sides) {
        let Some(triangle) = Triangle::new(vertices, sides) else { return };
        let Some(bounds) = triangle.bounds(self.last) else { return };
        if self.hides(&bounds, triangle.nearest()) {
            return;
        }
        let plane = DepthPlane::new(&triangle);
        if triangle.is_small() {
            self.draw_small(&triangle, &bounds, &plane, id);
        } else {
            self.draw_large(&triangle, &bounds, &plane, id);
        }
    }

    /// Tests the pixels of `bounds`, some at a time.
    fn draw_small(&mut self, triangle: &Triangle, bounds: &Bounds, plane: &DepthPlane, id: u32) {
        let [mut ab, mut bc, mut ca] = triangle.lane_edges(bounds);
        for y in bounds.rows[0]..=bounds.rows[1] {
            let row = plane.row(y);
            let (mut a, mut b, mut c) = (ab.value, bc.value, ca.value);
            let mut x = bounds.columns[0];
            while x <= bounds.columns[1] {
                let inside = !(a | b | c).is_negative();
                if inside.any() {
                    self.put(x, y, inside, plane.depths(row, x), id);
                }
                a += ab.per_lanes;
                b += bc.per_lanes;
                c += ca.per_lanes;
                x += LANE_STEP;
            }
            ab.value += ab.per_row;
            bc.value += bc.per_row;
            ca.value += ca.per_row;
        }
    }

    /// Fills the columns that are inside, row by row.
    fn draw_large(&mut self, triangle: &Triangle, bounds: &Bounds, plane: &DepthPlane, id: u32) {
        let lanes = i32x4::from([0, 1, 2, 3]);
        for y in bounds.rows[0]..=bounds.rows[1] {
            let row = plane.row(y);
            let [first, last] = triangle.span(bounds, y);
            for x in (first..=last).step_by(LANES) {
                let inside = i32x4::splat(last - x).simd_ge(lanes);
                self.put(x, y, inside, plane.depths(row, x), id);
            }
        }
    }

    /// Puts `id` at those pixels from (x, y) on which are `inside` and in front of what is there.
    #[inline]
    fn put(&mut self, x: i32, y: i32, inside: i32x4, depths: f32x4, id: u32) {
        let pixels = y as usize * self.stride + x as usize..y as usize * self.stride + x as usize + LANES;
        let (seen_ids, seen_depths) = (&mut self.ids[pixels.clone()], &mut self.depths[pixels]);
        let (old_ids, old_depths) = (u32x4::from(&*seen_ids), f32x4::from(&*seen_depths));
        let inside: f32x4 = bytemuck::cast(inside);
        let candidates = inside & depths.simd_le(old_depths);
        if candidates.any() {
            let ids = u32x4::splat(id);
            let lower: f32x4 = bytemuck::cast(ids.simd_lt(old_ids));
            let wins = candidates & (depths.simd_lt(old_depths) | lower);
            seen_depths.copy_from_slice(wins.select(depths, old_depths).as_array());
            let wins: u32x4 = bytemuck::cast(wins);
            seen_ids.copy_from_slice(wins.select(ids, old_ids).as_array());
        }
    }
}
