//! A synthetic terahertz scan: points of a known map in an unknown pose come back as that map.

use super::tablets::{ALMOND, OVAL, ROUND, Surface, Tablet};
use nalgebra::{UnitQuaternion, Vector3};
use pancoat::models::thz::{SimulatedMap, ThzComparison, ThzMap, ThzScan};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::fmt::Write;

/// Thickness in µm: caps over band, thin ends, one of them thinner by `ends` µm per mm.
fn truth(surface: &Surface, ends: f64) -> Vec<f64> {
    let at = |j: usize| {
        let (n, c) = (surface.normals[j], surface.centroids[j]);
        40.0 + 20.0 * n.z.abs() - 8.0 * n.x.powi(2) + ends * c.x
    };
    (0..surface.areas.len()).map(at).collect()
}

/// About `wanted` points on a tablet (mm) as a scanner's table, turned and shifted, with noise (µm) and bad points; `reach` is how far from
/// its panel's centre a point may be, 1 for anywhere on the panel.
fn scan(
    surface: &Surface,
    map: &[f64],
    wanted: usize,
    noise: f64,
    reach: f64,
    rng: &mut ChaCha8Rng,
) -> (String, UnitQuaternion<f64>) {
    let turn = UnitQuaternion::from_euler_angles(
        rng.random_range(-3.0..3.0),
        rng.random_range(-1.5..1.5),
        rng.random_range(-3.0..3.0),
    );
    let area: f64 = surface.areas.iter().sum();
    let mut table = String::from("thickness_um,x_mm,y_mm,z_mm,reflectivity_percent\n");
    for (panel, triangle) in surface.triangles.iter().enumerate() {
        let expected = wanted as f64 * surface.areas[panel] / area;
        let count = expected as usize + usize::from(rng.random_bool(expected.fract()));
        for _ in 0..count {
            let (mut u, mut v): (f64, f64) = (rng.random_range(0.0..1.0), rng.random_range(0.0..1.0));
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let [a, b, c] = triangle.map(|k| surface.vertices[k as usize]);
            let centre = (a + b + c) / 3.0;
            let place = centre + reach * (a + u * (b - a) + v * (c - a) - centre);
            let p = turn * place + Vector3::new(3.0, -7.0, 21.0);
            let scatter = noise * (0..12).map(|_| rng.random_range(-0.5..0.5)).sum::<f64>();
            // One point in twenty looks at an edge: it reflects little, and its thickness is wrong.
            let (thickness, reflectivity) =
                if rng.random_bool(0.05) { (200.0, 8.0) } else { (map[panel] + scatter, 20.0) };
            let _ = writeln!(table, "{thickness},{},{},{},{reflectivity}", p.x, p.y, p.z);
        }
    }
    (table, turn)
}

fn in_metres(tablet: &Tablet) -> (Surface, Surface) {
    let mm = tablet.surface(48, 12);
    let mut m = tablet.surface(48, 12);
    m.centroids.iter_mut().chain(&mut m.vertices).for_each(|p| *p *= 1e-3);
    m.areas.iter_mut().for_each(|a| *a *= 1e-6);
    (mm, m)
}

#[test]
fn a_scan_in_an_unknown_pose_gives_its_map_back() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    // Ends may differ where the shape tells them apart.
    for (tablet, ends) in [(ALMOND, 0.3), (OVAL, 0.0)] {
        let (mm, surface) = in_metres(&tablet);
        let map = truth(&mm, ends);
        let (table, turn) = scan(&mm, &map, 9000, 1.0, 1.0, &mut rng);
        let scan = ThzScan::read(table.as_bytes(), ThzScan::CUT).unwrap();
        assert!((300..600).contains(&scan.dropped), "{}", scan.dropped);

        let measured = ThzMap::new(&scan, &surface.view());
        assert!(measured.pose.residual < 5e-5, "{}: {} m", tablet.name, measured.pose.residual);
        if tablet.name == "almond" {
            // Its ends differ; what is left open is a half turn about its length.
            let left = measured.pose.rotation * turn;
            let half = left * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
            assert!(left.angle().min(half.angle()) < 0.01, "{}", left.angle());
        }
        // The simulation knows the map up to a factor, and its tablets hardly differ.
        let simulated: Vec<f64> = map.iter().map(|h| h * 2e-7).collect();
        let sd: Vec<f64> = simulated.iter().map(|h| h * 0.002).collect();
        let known = SimulatedMap { average: &simulated, panel_sd: &sd, tablets: 770 };
        let comparison = ThzComparison::new(&[measured], &known, &surface.view()).unwrap();
        assert!((comparison.scale / 5.0 - 1.0).abs() < 0.01, "{}", comparison.scale);
        let (covered, correlation) = (comparison.covered, comparison.correlation);
        assert!(covered > 0.95 && correlation > 0.95, "{covered} {correlation}");
        let ratio = |r: Option<pancoat::models::RegionMeans>| r.unwrap().ratio();
        let (found, wanted) = (ratio(comparison.measured_regions), ratio(comparison.simulated_regions));
        assert!((found / wanted - 1.0).abs() < 0.02, "{found} {wanted}");
        assert!((comparison.measured_cov / comparison.simulated_cov - 1.0).abs() < 0.05);
    }
}

/// Differences are as large as their uncertainties say, when measured tablets differ from the average as simulated ones do.
#[test]
fn differences_are_as_large_as_their_uncertainties() {
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    let (mm, surface) = in_metres(&ROUND);
    let average = truth(&mm, 0.0);
    let spread = 4.0;
    let maps: Vec<ThzMap> = (0..3)
        .map(|_| {
            let own: Vec<f64> = average
                .iter()
                .map(|h| h + spread * (0..12).map(|_| rng.random_range(-0.5..0.5)).sum::<f64>())
                .collect();
            // The tablets' turn about their axis is not known from their shape; here it is known.
            let (table, turn) = scan(&mm, &own, 6000, 2.0, 0.4, &mut rng);
            let scan = ThzScan::read(table.as_bytes(), ThzScan::CUT).unwrap();
            let mut map = ThzMap::new(&scan, &surface.view());
            let back = turn.inverse();
            let shift = Vector3::new(3.0, -7.0, 21.0) * 1e-3;
            map.points.fill(0);
            map.thickness.fill(0.0);
            for point in &scan.points {
                let p = back * (point.position - shift);
                let nearest = |j: &usize| (surface.centroids[*j] - p).norm_squared();
                let panel =
                    (0..surface.areas.len()).min_by(|a, b| nearest(a).total_cmp(&nearest(b))).unwrap();
                map.points[panel] += 1;
                map.thickness[panel] += point.thickness;
            }
            map.thickness.iter_mut().zip(&map.points).for_each(|(h, n)| *h /= f64::from((*n).max(1)));
            map
        })
        .collect();
    let metres: Vec<f64> = average.iter().map(|h| h * 1e-6).collect();
    let known = SimulatedMap { average: &metres, panel_sd: &vec![spread * 1e-6; metres.len()], tablets: 770 };
    let comparison = ThzComparison::new(&maps, &known, &surface.view()).unwrap();
    assert!((0.85..1.15).contains(&comparison.chi_squared), "{}", comparison.chi_squared);
    assert!((comparison.scale - 1.0).abs() < 0.01);
}
