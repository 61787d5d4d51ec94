//! The orientation-only limit: exact directions, the order tensor's closed form, and frozen and random extremes.

use super::tablets::{ALMOND, OVAL, ROUND, TRIANGULAR};
use nalgebra::Vector3;
use pancoat::models::{OrderTensor, region_means};

/// Directions spread evenly over the sphere (a golden spiral).
fn even_directions(n: u32) -> Vec<Vector3<f64>> {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let direction = |k: u32| {
        let z: f64 = 1.0 - 2.0 * (f64::from(k) + 0.5) / f64::from(n);
        let (sin, cos) = (golden * f64::from(k)).sin_cos();
        Vector3::new((1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z)
    };
    (0..n).map(direction).collect()
}

/// Directions whose density about z goes with exp(κ cos²): the Maier-Saupe distribution.
fn ordered_directions(kappa: f64) -> Vec<Vector3<f64>> {
    // Inverse of the cumulated density on a fine grid, turned by the golden angle from one to the next.
    let (n, grid) = (20_000_u32, 20_000_u32);
    let mut cumulated = vec![0.0];
    for k in 0..grid {
        let z = 2.0 * (f64::from(k) + 0.5) / f64::from(grid) - 1.0;
        cumulated.push(cumulated[k as usize] + (kappa * z * z).exp());
    }
    let (total, mut place) = (cumulated[grid as usize], 0);
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let mut direction = |k: u32| {
        let wanted = total * (f64::from(k) + 0.5) / f64::from(n);
        while cumulated[place + 1] < wanted {
            place += 1;
        }
        let share = (wanted - cumulated[place]) / (cumulated[place + 1] - cumulated[place]);
        let z = 2.0 * (place as f64 + share) / f64::from(grid) - 1.0;
        let (sin, cos) = (golden * f64::from(k)).sin_cos();
        Vector3::new((1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z)
    };
    (0..n).map(&mut direction).collect()
}

fn p2(z: f64) -> f64 {
    1.5 * z * z - 0.5
}

/// Per shape: mean and standard deviation of P₂(n_z) over the surface, CoV with every tablet frozen cap up, then CoV and cap
/// over band at S₂ = 0.144, 0.297 and 0.557 by the closed form.
#[test]
fn closed_form_and_frozen_limits_of_the_papers_tablets() {
    let table = [
        (ALMOND, 0.357, 0.686, 0.80, [0.116, 0.225, 0.389], [1.28, 1.64, 2.55]),
        (OVAL, 0.279, 0.641, 0.80, [0.110, 0.216, 0.380], [1.25, 1.59, 2.43]),
        (ROUND, 0.462, 0.607, 0.62, [0.100, 0.192, 0.325], [1.26, 1.61, 2.49]),
        (TRIANGULAR, 0.315, 0.648, 0.79, [0.110, 0.216, 0.378], [1.26, 1.60, 2.48]),
    ];
    for (tablet, mean_p2, sd_p2, frozen, covs, ratios) in table {
        let surface = tablet.surface(200, 60);
        let name = tablet.name;
        let area: f64 = surface.areas.iter().sum();
        assert!((area / tablet.area - 1.0).abs() < 0.005, "{name}: {area} mm²");

        let mean = surface.mean(|j| p2(surface.normals[j].z));
        let sd = surface.mean(|j| (p2(surface.normals[j].z) - mean).powi(2)).sqrt();
        assert!((mean - mean_p2).abs() < 0.003 && (sd - sd_p2).abs() < 0.003, "{name}: {mean} {sd}");

        let cap_up = surface.view().orientation_limit(&[Vector3::z(), -Vector3::z()]).unwrap();
        assert!((cap_up.cov / frozen - 1.0).abs() < 0.01, "{name}: {}", cap_up.cov);

        for ((kappa, s2), (cov, ratio)) in
            [(1.0, 0.144), (2.0, 0.297), (4.0, 0.557)].into_iter().zip(covs.into_iter().zip(ratios))
        {
            let directions = ordered_directions(kappa);
            let order = OrderTensor::of(&directions);
            assert!((order.s2() - s2).abs() < 0.001, "{}", order.s2());
            let form = surface.view().orientation_expansion(&order).unwrap();
            let by_hand = 1.25 * order.s2() * sd / (1.0 + 1.25 * order.s2() * mean);
            assert!((form.cov / by_hand - 1.0).abs() < 1e-6, "{name}: {} {by_hand}", form.cov);

            let exact = surface.view().orientation_limit(&directions).unwrap();
            assert!((exact.cov / cov - 1.0).abs() < 0.012, "{name} S2 {s2}: {} {cov}", exact.cov);
            let allowed = if s2 < 0.3 { 0.006 } else { 0.025 };
            assert!(
                (form.cov / exact.cov - 1.0).abs() < allowed,
                "{name} S2 {s2}: {} {}",
                form.cov,
                exact.cov
            );
            let means = region_means(&exact.relative, &surface.areas, &surface.on_cap).unwrap().unwrap();
            assert!((means.ratio() / ratio - 1.0).abs() < 0.02, "{name} S2 {s2}: {} {ratio}", means.ratio());
            assert!(exact.cov < cap_up.cov);
        }
    }
}

/// Random orientations coat every convex surface evenly: each panel sees ⟨max(0, cos)⟩ = 1/4, so the mean projected area is a
/// quarter of the surface (Cauchy).
#[test]
fn random_orientations_leave_no_variation() {
    for tablet in [ALMOND, OVAL, ROUND, TRIANGULAR] {
        let surface = tablet.surface(60, 15);
        let directions = even_directions(40_000);
        let limit = surface.view().orientation_limit(&directions).unwrap();
        assert!(limit.cov < 2e-4, "{}: {}", tablet.name, limit.cov);
        let order = OrderTensor::of(&directions);
        assert!(order.q().norm() < 1e-4);
        let projected = |s: &Vector3<f64>| {
            surface.normals.iter().zip(&surface.areas).map(|(n, a)| a * n.dot(s).max(0.0)).sum::<f64>()
        };
        let mean = directions.iter().step_by(40).map(projected).sum::<f64>() / 1000.0;
        let quarter = surface.areas.iter().sum::<f64>() / 4.0;
        assert!((mean / quarter - 1.0).abs() < 2e-3, "{mean} {quarter}");
    }
}

/// A tablet that rolls about its length shows its sides but not its ends: the ends of the band stay thin.
#[test]
fn rolling_leaves_the_ends_of_an_oval_thin() {
    let surface = OVAL.surface(120, 30);
    // Spray directions in the plane across the length, caps favoured.
    let directions: Vec<Vector3<f64>> = (0..360)
        .map(|k| f64::from(k).to_radians())
        .flat_map(|a| {
            std::iter::repeat_n(Vector3::new(0.0, a.sin(), a.cos()), if a.cos().abs() > 0.7 { 3 } else { 1 })
        })
        .collect();
    let order = OrderTensor::of(&directions);
    assert!(order.along(&Vector3::x()) < order.along(&Vector3::y()));
    let pattern = surface.view().orientation_limit(&directions).unwrap();
    let band = |along_x: bool| {
        let chosen = |j: &usize| !surface.on_cap[*j] && (surface.normals[*j].x.abs() > 0.9) == along_x;
        let panels: Vec<usize> = (0..surface.areas.len()).filter(chosen).collect();
        panels.iter().map(|&j| pattern.relative[j] * surface.areas[j]).sum::<f64>()
            / panels.iter().map(|&j| surface.areas[j]).sum::<f64>()
    };
    assert!(band(true) < 0.5 * band(false), "{} {}", band(true), band(false));
}
