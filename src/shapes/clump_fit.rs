//! Fits a clump of inscribed spheres to a closed surface.
//!
//! Candidates are the medial balls of the surface: the largest spheres inside that touch it at a sample point. From
//! them the fit picks greedily, then exchanges one pick at a time for a better candidate nearby until nothing improves.
//! What it lowers is the area-weighted mean square distance from the surface to the clump; for a union of balls this
//! is a facility-location problem, for which the greedy choice is within 1 − 1/e of the best gain (Nemhauser, Wolsey
//! and Fisher 1978, Math. Programming 14, 265).

use super::{Clump, Panels, Sphere};
use nalgebra::Vector3;

/// Largest number of exchange sweeps. Ten to twenty are usual; the limit only bounds the time.
const SWEEPS: usize = 40;

/// How many of the nearest candidates a pick may be exchanged for. More makes the fit slower, not visibly better.
const NEIGHBOURS: usize = 200;

/// A clump of `count` spheres inside a closed surface. Samples are the panels' centroids, so the surface has to be cut
/// finer than the spheres are apart. With `mirror` the surface is taken to be symmetric about z = 0 and the clump is
/// too: both caps then feel the same. Fewer spheres come back only when the surface has fewer distinct medial balls.
pub(super) fn fit(surface: &Panels, count: usize, mirror: bool) -> Clump {
    let keep = |p: &Vector3<f64>| !mirror || p.z >= 0.0;
    let samples = Samples {
        points: surface.centroids.iter().copied().filter(keep).collect(),
        areas: surface
            .centroids
            .iter()
            .zip(&surface.areas)
            .filter(|(c, _)| keep(c))
            .map(|(_, &a)| a)
            .collect(),
    };
    let candidates: Vec<Candidate> = (0..surface.len())
        .filter(|&k| keep(&surface.centroids[k]))
        .map(|k| Candidate::new(medial_ball(surface, k), mirror))
        .collect();
    let mut picks = pick(&samples, &candidates, count);
    exchange(&samples, &candidates, &mut picks);
    Clump { spheres: picks.iter().flat_map(|&k| candidates[k].spheres()).collect() }
}

/// Points of the surface with the area each stands for.
struct Samples {
    points: Vec<Vector3<f64>>,
    areas: Vec<f64>,
}

/// A sphere that may be picked, with its mirror image when it has one.
struct Candidate {
    sphere: Sphere,
    mirrored: bool,
}

impl Candidate {
    /// Balls that all but reach the mirror plane are put onto it.
    fn new(mut sphere: Sphere, mirror: bool) -> Self {
        let on_plane = sphere.center.z.abs() < 0.02 * sphere.radius;
        if mirror && on_plane {
            sphere.radius -= sphere.center.z.abs();
            sphere.center.z = 0.0;
        }
        Self { sphere, mirrored: mirror && !on_plane }
    }

    fn spheres(&self) -> impl Iterator<Item = Sphere> {
        let s = self.sphere;
        let image = Sphere { center: Vector3::new(s.center.x, s.center.y, -s.center.z), ..s };
        std::iter::once(s).chain(self.mirrored.then_some(image))
    }

    /// How many spheres it adds.
    fn cost(&self) -> usize {
        1 + usize::from(self.mirrored)
    }

    /// Square of the distance from a sample to the sphere's surface, m². Samples are on the side of the sphere, so its
    /// image is never nearer. Inscribed spheres leave the distance positive up to round-off.
    fn square(&self, point: &Vector3<f64>) -> f64 {
        ((point - self.sphere.center).norm() - self.sphere.radius).powi(2)
    }
}

/// The largest sphere inside the surface that touches it at the centroid of panel `k`: a large ball shrinks until no
/// sample is inside (Ma, Bae and Choi 2012, Vis. Computer 28, 7), then until no panel is crossed.
fn medial_ball(surface: &Panels, k: usize) -> Sphere {
    let (touch, normal) = (surface.centroids[k], surface.normals[k]);
    let mut radius = surface.vertices.iter().map(|v| (v - touch).norm()).fold(0.0, f64::max);
    loop {
        let center = touch - normal * radius;
        let nearest = (0..surface.len())
            .map(|j| (surface.centroids[j] - center).norm_squared())
            .enumerate()
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map_or(k, |(j, _)| j);
        let to_touch = touch - surface.centroids[nearest];
        let along = normal.dot(&to_touch);
        let smaller = to_touch.norm_squared() / (2.0 * along);
        if nearest == k || along <= 0.0 || smaller > radius * (1.0 - 1e-6) {
            return Sphere { center, radius: radius.min(clearance(surface, &center)) };
        }
        radius = smaller;
    }
}

/// Distance of a point to the nearest panel, m.
fn clearance(surface: &Panels, point: &Vector3<f64>) -> f64 {
    let mut nearest = f64::INFINITY;
    for (k, triangle) in surface.triangles.iter().enumerate() {
        let corners = triangle.map(|v| surface.vertices[v as usize]);
        let reach =
            corners.iter().map(|c| (c - surface.centroids[k]).norm_squared()).fold(0.0, f64::max).sqrt();
        if (point - surface.centroids[k]).norm() - reach < nearest {
            nearest = nearest.min((point - closest_point(&corners, point)).norm());
        }
    }
    nearest
}

/// The point of a triangle nearest to `p` (Ericson 2005, Real-Time Collision Detection, section 5.1.5).
pub(super) fn closest_point(corners: &[Vector3<f64>; 3], p: &Vector3<f64>) -> Vector3<f64> {
    let [a, b, c] = *corners;
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (ab.dot(&(p - a)), ac.dot(&(p - a)));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let (d3, d4) = (ab.dot(&(p - b)), ac.dot(&(p - b)));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let (d5, d6) = (ab.dot(&(p - c)), ac.dot(&(p - c)));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let denominator = 1.0 / (va + vb + vc);
    a + ab * (vb * denominator) + ac * (vc * denominator)
}

/// Area-weighted drop of the square distances when a candidate is added, m⁴.
fn gain(samples: &Samples, squares: &[f64], candidate: &Candidate) -> f64 {
    samples
        .points
        .iter()
        .zip(&samples.areas)
        .zip(squares)
        .map(|((p, area), &square)| area * (square - candidate.square(p)).max(0.0))
        .sum()
}

/// Greedy choice by gain per sphere. Gains only fall as picks are added, so a candidate whose old gain does not beat
/// the best new one need not be looked at again.
fn pick(samples: &Samples, candidates: &[Candidate], count: usize) -> Vec<usize> {
    let start = samples.points.iter().map(Vector3::norm_squared).fold(0.0, f64::max);
    let mut squares = vec![start; samples.points.len()];
    let mut bounds: Vec<f64> = vec![f64::INFINITY; candidates.len()];
    let mut picks = Vec::new();
    let mut left = count;
    while left > 0 {
        let mut order: Vec<usize> = (0..candidates.len()).filter(|&k| candidates[k].cost() <= left).collect();
        order.sort_by(|&a, &b| bounds[b].total_cmp(&bounds[a]).then(a.cmp(&b)));
        let (mut best, mut best_gain) = (None, 0.0);
        for k in order {
            if bounds[k] <= best_gain {
                break;
            }
            bounds[k] = gain(samples, &squares, &candidates[k]) / candidates[k].cost() as f64;
            if bounds[k] > best_gain {
                (best, best_gain) = (Some(k), bounds[k]);
            }
        }
        let Some(k) = best else { break };
        for (square, p) in squares.iter_mut().zip(&samples.points) {
            *square = square.min(candidates[k].square(p));
        }
        left -= candidates[k].cost();
        picks.push(k);
    }
    picks
}

/// Sweeps over the picks; each is exchanged for the candidate of equal cost nearby that lowers the sum most.
fn exchange(samples: &Samples, candidates: &[Candidate], picks: &mut [usize]) {
    let square_row =
        |k: usize| -> Vec<f64> { samples.points.iter().map(|p| candidates[k].square(p)).collect() };
    let mut rows: Vec<Vec<f64>> = picks.iter().map(|&k| square_row(k)).collect();
    for _ in 0..SWEEPS {
        let mut changed = false;
        for i in 0..picks.len() {
            let present = picks[i];
            let mut others = vec![f64::INFINITY; samples.points.len()];
            for (_, row) in rows.iter().enumerate().filter(|&(j, _)| j != i) {
                for (other, &square) in others.iter_mut().zip(row) {
                    *other = other.min(square);
                }
            }
            let sum = |k: usize| -> f64 {
                let square = |j: usize| candidates[k].square(&samples.points[j]).min(others[j]);
                (0..others.len()).map(|j| samples.areas[j] * square(j)).sum()
            };
            let (mut best, mut lowest) = (present, sum(present) * (1.0 - 1e-9));
            for k in neighbours(candidates, present) {
                let sum = sum(k);
                if sum < lowest {
                    (best, lowest) = (k, sum);
                }
            }
            if best != present {
                picks[i] = best;
                rows[i] = square_row(best);
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
}

/// The candidates of equal cost whose spheres are most like that of `k`.
fn neighbours(candidates: &[Candidate], k: usize) -> Vec<usize> {
    let difference = |j: usize| {
        let (a, b) = (&candidates[j].sphere, &candidates[k].sphere);
        (a.center - b.center).norm() + (a.radius - b.radius).abs()
    };
    let mut near: Vec<(f64, usize)> = (0..candidates.len())
        .filter(|&j| j != k && candidates[j].cost() == candidates[k].cost())
        .map(|j| (difference(j), j))
        .collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    near.truncate(NEIGHBOURS);
    near.into_iter().map(|(_, j)| j).collect()
}
