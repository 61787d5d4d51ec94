//! Fits a clump of spheres to a closed surface.
//!
//! Candidates are the medial balls of the surface: the largest spheres inside that touch it at a sample point. From
//! them the fit picks greedily, then exchanges one pick at a time for a better candidate nearby until nothing improves.
//! What it lowers is the area-weighted mean square distance from the surface to the clump; for a union of balls this
//! is a facility-location problem, for which the greedy choice is within 1 − 1/e of the best gain (Nemhauser, Wolsey
//! and Fisher 1978, Math. Programming 14, 265).

use super::tree::TriangleTree;
use super::{Clump, Panels, Sphere};
use crate::scene::{Placement, SphereBudget};
use nalgebra::Vector3;

/// Largest number of exchange sweeps. Ten to twenty are usual; the limit only bounds the time.
const SWEEPS: usize = 40;

/// How many of the nearest candidates a pick may be exchanged for. More makes the fit slower, not visibly better.
const NEIGHBOURS: usize = 200;

/// Most spheres that an error bound may lead to. Contacts of such a clump already cost more than a fine mesh.
const MOST_SPHERES: usize = 1000;

/// A clump for a closed surface. Samples are the panels' centroids, so the surface has to be cut finer than the spheres
/// are apart. With `mirror` the surface is taken to be symmetric about z = 0 and the clump is too: both caps then feel
/// the same. Fewer spheres come back only when the surface has fewer distinct medial balls; `None` when an error bound
/// would take more than [`MOST_SPHERES`].
pub(super) fn fit_clump(
    surface: &Panels,
    budget: SphereBudget,
    placement: Placement,
    mirror: bool,
) -> Option<Clump> {
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
    let tree = TriangleTree::new(surface.corners().collect());
    let candidates: Vec<Candidate> = (0..surface.len())
        .filter(|&k| keep(&surface.centroids[k]))
        .map(|k| Candidate::new(medial_ball(surface, &tree, k), &tree, mirror))
        .collect();
    let clump = |count: usize| {
        let mut picks = pick(&samples, &candidates, count);
        exchange(&samples, &candidates, &mut picks);
        let mut clump = Clump { spheres: picks.iter().flat_map(|&k| candidates[k].spheres()).collect() };
        if placement == Placement::Balanced {
            let larger = clump.deviation(surface).mean;
            clump.spheres.iter_mut().for_each(|s| s.radius += larger);
        }
        clump
    };
    match budget {
        SphereBudget::Count(count) => Some(clump(count)),
        SphereBudget::Error(error) => {
            let good = |clump: &Clump| clump.deviation(surface).largest <= error;
            let (mut best, mut too_few) = (clump(1), 0);
            while !good(&best) {
                if best.spheres.len() <= too_few || best.spheres.len() >= MOST_SPHERES {
                    return None;
                }
                too_few = best.spheres.len();
                best = clump((2 * too_few).min(MOST_SPHERES));
            }
            // Halves the interval between too few and enough.
            while best.spheres.len() - too_few > 1 {
                let middle = clump(usize::midpoint(too_few, best.spheres.len()));
                if good(&middle) { best = middle } else { too_few = middle.spheres.len() }
            }
            Some(best)
        }
    }
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
    /// Balls whose centre all but reaches the mirror plane are put onto it.
    fn new(mut sphere: Sphere, tree: &TriangleTree, mirror: bool) -> Self {
        let on_plane = sphere.center.z.abs() < 0.02 * sphere.radius;
        if mirror && on_plane {
            sphere.center.z = 0.0;
            sphere.radius = tree.nearest(&sphere.center).distance;
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
/// point of the surface is inside (the shrinking ball of Ma, Bae and Choi 2012, Vis. Computer 28, 7).
fn medial_ball(surface: &Panels, tree: &TriangleTree, k: usize) -> Sphere {
    let (touch, normal) = (surface.centroids[k], surface.normals[k]);
    let mut radius = surface.vertices.iter().map(|v| (v - touch).norm()).fold(0.0, f64::max);
    loop {
        let center = touch - normal * radius;
        let foot = tree.nearest(&center);
        let to_touch = touch - foot.point;
        let smaller = to_touch.norm_squared() / (2.0 * normal.dot(&to_touch));
        // Near the end the touching point itself, or its neighbour, is the nearest; then nothing is left to gain.
        if foot.distance < radius * (1.0 - 1e-6) && smaller > 0.0 && smaller < radius * (1.0 - 1e-6) {
            radius = smaller;
        } else {
            return Sphere { center, radius: radius.min(foot.distance) };
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Cap, Outline, Recipe};
    use crate::shapes::imported::ImportedSolid;
    use crate::shapes::{ClosedMesh, Deviation, Solid};

    const MM: f64 = 1e-3;

    fn oval() -> Solid {
        let outline = Outline::Oval { length: 19.2 * MM, width: 10.8 * MM, fourth_harmonic: -0.2211 * MM };
        let cap = Cap::Compound { height: 1.5814 * MM, exponent: 3.5728 };
        Solid::new(&Recipe::Pressed { outline, band: 4.6971 * MM, cap }).expect("a good recipe")
    }

    fn fit(budget: SphereBudget, placement: Placement) -> Clump {
        oval().clump(budget, placement).expect("can be met")
    }

    fn deviation(clump: &Clump) -> Deviation {
        clump.deviation(&oval().panels(6000).expect("a surface"))
    }

    #[test]
    fn an_error_bound_is_met_with_few_spheres() {
        let clump = fit(SphereBudget::Error(0.7 * MM), Placement::Inscribed);
        let largest = deviation(&clump).largest;
        assert!(largest < 0.75 * MM, "{largest}");
        assert!(clump.spheres.len() < 60, "{}", clump.spheres.len());
    }

    #[test]
    fn an_error_bound_that_takes_too_many_spheres_is_refused() {
        assert_eq!(oval().clump(SphereBudget::Error(1e-6), Placement::Inscribed), None);
    }

    #[test]
    fn a_balanced_clump_is_as_much_outside_as_inside() {
        let budget = SphereBudget::Count(50);
        let (inside, balanced) = (fit(budget, Placement::Inscribed), fit(budget, Placement::Balanced));
        let surface = oval().panels(6000).expect("a surface");
        let mean = |clump: &Clump| -> f64 {
            let signed = |(c, a): (&Vector3<f64>, &f64)| clump.distance(c) * a;
            surface.centroids.iter().zip(&surface.areas).map(signed).sum::<f64>()
                / surface.areas.iter().sum::<f64>()
        };
        assert!(mean(&balanced).abs() < 0.02 * mean(&inside), "{} {}", mean(&balanced), mean(&inside));
        let volume_error = |clump: &Clump| (clump.union().0.volume / oval().volume() - 1.0).abs();
        assert!(volume_error(&balanced) < 0.25 * volume_error(&inside));
        assert!(deviation(&balanced).largest < deviation(&inside).largest);
    }

    #[test]
    fn more_spheres_make_smoother_faces() {
        let of = |count| deviation(&fit(SphereBudget::Count(count), Placement::Inscribed));
        let (few, many) = (of(20), of(100));
        assert!(
            many.mean < 0.6 * few.mean && many.cap_roughness < 0.6 * few.cap_roughness,
            "{few:?} {many:?}"
        );
    }

    #[test]
    fn one_sphere_is_the_largest_that_fits_a_ball_like_solid() {
        let recipe =
            Recipe::Round { diameter: 10.0 * MM, band: 0.0, cap: Cap::Spherical { height: 5.0 * MM } };
        let clump = Solid::new(&recipe)
            .expect("good")
            .clump(SphereBudget::Count(1), Placement::Inscribed)
            .expect("is fitted");
        assert!((clump.spheres[0].radius - 5.0 * MM).abs() < 0.02 * MM);
        assert!(clump.spheres[0].center.norm() < 0.05 * MM);
    }

    /// An L of 10 × 10 × 4 mm with arms 4 mm wide: spheres stay in the arms and do not bridge the notch.
    #[test]
    fn a_concave_solid_is_filled_from_inside() {
        let plan = [[0., 0.], [10., 0.], [10., 4.], [4., 4.], [4., 10.], [0., 10.]];
        let level = |z: f64| plan.map(|[x, y]| Vector3::new(x * MM, y * MM, z * MM));
        let vertices = [level(0.0), level(4.0)].concat();
        let top = [[6, 7, 8], [6, 8, 9], [6, 9, 10], [6, 10, 11]];
        let mut triangles: Vec<[u32; 3]> = top.to_vec();
        triangles.extend(top.map(|[a, b, c]| [a - 6, c - 6, b - 6]));
        for k in 0..6 {
            let next = (k + 1) % 6;
            triangles.extend([[k, next, next + 6], [k, next + 6, k + 6]]);
        }
        let solid = ImportedSolid::new(&ClosedMesh { vertices, triangles, repairs: Vec::new() });
        assert!((solid.mass.volume - 256.0 * MM.powi(3)).abs() < 1e-20);
        let surface = solid.panels(5000);
        let clump =
            fit_clump(&surface, SphereBudget::Count(60), Placement::Inscribed, false).expect("is fitted");
        let deviation = clump.deviation(&surface);
        assert_eq!(clump.spheres.len(), 60);
        assert!(surface.centroids.iter().all(|c| clump.distance(c) > -1e-3 * MM));
        assert!(deviation.mean < 0.3 * MM, "{deviation:?}");
    }

    #[test]
    fn the_same_surface_gives_the_same_clump() {
        let fit = || fit(SphereBudget::Count(30), Placement::Inscribed);
        assert_eq!(fit(), fit());
    }

    /// The round tablet of the paper by another generator (docs/data/clumps/mss.py says which), as good as its settings
    /// make it: spheres of both stick out of the surface here, so the clumps of this fit are balanced.
    #[test]
    fn clumps_are_nearer_than_those_of_a_published_generator() {
        let cap = Cap::Compound { height: 1.6973 * MM, exponent: 2.8823 };
        let round = Recipe::Round { diameter: 15.9 * MM, band: 3.2452 * MM, cap };
        let round = Solid::new(&round).expect("good");
        let surface = round.panels(6000).expect("a surface");
        for count in [20, 50, 100] {
            let path = format!("{}/docs/data/clumps/mss_{count}.txt", env!("CARGO_MANIFEST_DIR"));
            let text = std::fs::read_to_string(path).expect("is part of the repository");
            let sphere = |line: &str| {
                let numbers: Vec<f64> =
                    line.split(' ').map(|x| x.parse::<f64>().expect("a number") * MM).collect();
                Sphere { center: Vector3::new(numbers[0], numbers[1], numbers[2]), radius: numbers[3] }
            };
            let other = Clump { spheres: text.lines().map(sphere).collect() };
            assert_eq!(other.spheres.len(), count);
            let own = round.clump(SphereBudget::Count(count), Placement::Balanced).expect("a count is met");
            let (own, other) = (own.deviation(&surface), other.deviation(&surface));
            assert!(own.mean < 0.75 * other.mean && own.largest < 0.6 * other.largest, "{own:?} {other:?}");
        }
    }
}
