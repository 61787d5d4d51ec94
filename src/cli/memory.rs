//! How much memory a run needs, and how much there is.

use crate::scene::Scene;
use crate::shapes::{Panels, TabletShape};

/// Bytes of a body: state, engine, near pairs.
const BODY: f64 = 20e3;
/// Bytes of a sphere of a body: its place in the engine's compound and in contact lists.
const SPHERE: f64 = 400.0;
/// Bytes of a panel of a body: counts, blocks of time, statistics.
const PANEL: f64 = 80.0;
/// Bytes of a pixel: number and depth.
const PIXEL: f64 = 8.0;

/// Bytes a run needs beside the program itself.
pub(super) fn needed(scene: &Scene, shapes: &[TabletShape]) -> f64 {
    let bodies = scene.batches.iter().map(|b| (b.shape, b.count));
    let bodies = bodies.chain(scene.bodies.iter().map(|b| (b.shape, 1)));
    let per_body: f64 = bodies
        .map(|(shape, count)| {
            let panels = shapes[shape].panels.as_ref().map_or(0, Panels::len);
            let spheres = shapes[shape].clump.spheres.len();
            count as f64 * (BODY + SPHERE * spheres as f64 + PANEL * panels as f64)
        })
        .sum();
    let pixels = scene.spray.as_ref().map_or(0.0, |s| s.pixels.map(f64::from).iter().product());
    per_body + PIXEL * pixels
}

/// Bytes that the system can give out, where it tells (Linux).
pub(super) fn free() -> Option<f64> {
    let told = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = told.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kib: f64 = line.trim().strip_suffix(" kB")?.parse().ok()?;
    Some(1024.0 * kib)
}
