//! The coater against answers known in closed form.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[path = "support/clipper.rs"]
mod clipper;
#[path = "support/solids.rs"]
mod solids;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use pancoat::observers::{
    Backend, Coater, Observer, Packing, PanelIds, PoseReader, Recorder, Recording, SprayZone, StoredFrame,
    film_thickness, read_pose_table,
};
use pancoat::scene::{Aim, Cycle, Deposit, Flux, Footprint, Pattern, Rays, Spray, Tilt};
use pancoat::shapes::{Part, SurfaceMesh, TabletShape};
use pancoat::stepping::{BodyState, Frame};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use solids::{block, icosphere, round_tablet, solid};
use std::fmt::Write;

const EXTENT: [f64; 2] = [0.08, 0.04];

fn spray_gun(pixels: [u32; 2], pattern: Pattern) -> Spray {
    Spray {
        spanwise: EXTENT[0],
        streamwise: EXTENT[1],
        distance: 0.05,
        aim: Aim::Bed,
        pixels,
        deposit: Deposit::Sprayed { rate: 1.25e-4, solids: 0.2, film_density: 1300.0 },
        pattern,
    }
}

/// Sprays downwards on the origin from 50 mm above; columns run along z, rows along −x.
fn patterned(
    shapes: &[TabletShape],
    body_shape: &[usize],
    spray: &Spray,
    drum: Option<&SurfaceMesh>,
) -> Coater {
    let zone = SprayZone::facing(Vector3::zeros(), Vector3::y(), spray);
    Coater::new(shapes, body_shape, spray, zone, drum).unwrap()
}

fn coater(
    shapes: &[TabletShape],
    body_shape: &[usize],
    pixels: [u32; 2],
    drum: Option<&SurfaceMesh>,
) -> Coater {
    patterned(shapes, body_shape, &spray_gun(pixels, Pattern::default()), drum)
}

fn body(x: f64, y: f64, z: f64, orientation: UnitQuaternion<f64>) -> BodyState {
    BodyState {
        position: Vector3::new(x, y, z),
        orientation,
        velocity: Vector3::zeros(),
        spin: Vector3::zeros(),
    }
}

fn turned_at_random(random: &mut ChaCha8Rng) -> UnitQuaternion<f64> {
    // Four normal numbers, each a sum of uniform ones, point evenly over the sphere of rotations.
    let mut normal = || (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
    UnitQuaternion::new_normalize(Quaternion::new(normal(), normal(), normal(), normal()))
}

fn spray(coater: &mut Coater, frames: std::ops::Range<u64>, bodies: &[BodyState], drum_angle: f64) {
    for index in frames {
        coater.observe(&Frame { index, time: 0.0, bodies, drum_angle, drum_torque: 0.0 });
    }
}

/// A loose heap of tablets in and around the zone.
fn heap(count: usize, seed: u64) -> Vec<BodyState> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    (0..count)
        .map(|_| {
            let [x, y, z] = [0.03, 0.01, 0.06].map(|half| half * random.random_range(-1.0..1.0));
            body(x, y - 0.01, z, turned_at_random(&mut random))
        })
        .collect()
}

/// An open tube about the z axis with a vane along the bottom and one end wall.
fn tube(radius: f64, width: f64) -> SurfaceMesh {
    let at = |k: u32, z: f64| {
        let (s, c) = (f64::from(k) / 60.0 * std::f64::consts::TAU).sin_cos();
        Vector3::new(radius * c, radius * s, z)
    };
    let mut mesh = SurfaceMesh { vertices: Vec::new(), triangles: Vec::new(), parts: Vec::new() };
    let mut quad = |corners: [Vector3<f64>; 4], part| {
        let first = mesh.vertices.len() as u32;
        mesh.vertices.extend(corners);
        mesh.triangles.extend([[0, 1, 2], [0, 2, 3]].map(|t: [u32; 3]| t.map(|v| v + first)));
        mesh.parts.extend([part; 2]);
    };
    let (back, front) = (-width / 2.0, width / 2.0);
    for k in 0..60 {
        quad([at(k, back), at(k + 1, back), at(k + 1, front), at(k, front)], Part::Wall);
        let center = Vector3::new(0.0, 0.0, back);
        quad([center, at(k, back), at(k + 1, back), center], Part::End(0));
    }
    let vane = |x: f64, z: f64| Vector3::new(x, -0.9 * radius, z);
    quad([vane(-0.005, back), vane(0.005, back), vane(0.005, front), vane(-0.005, front)], Part::Baffle(0));
    mesh
}

/// Area-weighted mean and variance of thickness (Eqs. 9 and 10).
fn moments(thickness: &[f64], areas: &[f64]) -> (f64, f64) {
    let area: f64 = areas.iter().sum();
    let mean = thickness.iter().zip(areas).map(|(h, a)| h * a).sum::<f64>() / area;
    let variance = thickness.iter().zip(areas).map(|(h, a)| (h - mean).powi(2) * a).sum::<f64>() / area;
    (mean, variance)
}

#[test]
fn every_frame_adds_up_to_its_pixels() {
    let shapes = [round_tablet(0.0159, 0.00382, 0.00141, 24, 5), icosphere(0.004, 2)];
    let body_shape: Vec<usize> = (0..80).map(|k| k % 2).collect();
    let drum = tube(0.06, 0.06);
    // Sizes that are no multiple of a tile or of a vector.
    for pixels in [[200, 100], [37, 19], [8, 513]] {
        let mut coater = coater(&shapes, &body_shape, pixels, Some(&drum));
        for index in 0..6 {
            let before = coater.ledger().total();
            spray(&mut coater, index..index + 1, &heap(80, index), 0.3 * index as f64);
            let on_tablets: u64 = coater.exposed().iter().map(|e| e.counts).sum();
            assert!(on_tablets > 0);
            assert_eq!(coater.ledger().total() - before, u64::from(pixels[0]) * u64::from(pixels[1]));
        }
        let loss = coater.ledger().loss();
        let on_tablets: u64 = (0..80).flat_map(|b| coater.counts(b)).sum();
        assert_eq!(
            on_tablets + loss.wall + loss.ends + loss.baffles + loss.empty,
            6 * coater.counts_per_frame()
        );
        assert!(loss.wall > 0 && loss.empty > 0);
    }
}

#[test]
fn the_empty_drum_catches_everything_on_the_right_part() {
    let drum = tube(0.06, 0.06);
    let mut coater = coater(&[icosphere(0.004, 1)], &[], [400, 200], Some(&drum));
    spray(&mut coater, 0..16, &[], 0.0);
    let loss = coater.ledger().loss();
    // The drum is 60 mm wide in a zone of 80 mm, the vane 10 mm of 40 mm; the upper wall is behind the nozzle.
    let share = |counts: u64| counts as f64 / coater.ledger().total() as f64;
    assert!((share(loss.empty) - 0.25).abs() < 1e-3);
    assert!((share(loss.baffles) - 0.75 * 0.25).abs() < 1e-3);
    assert!((share(loss.wall) - 0.75 * 0.75).abs() < 1e-3);
    assert_eq!(loss.ends, 0);
    // Turned half round, the vane is above the nozzle and hides nothing.
    let mut turned = self::coater(&[icosphere(0.004, 1)], &[], [400, 200], Some(&drum));
    spray(&mut turned, 0..1, &[], std::f64::consts::PI);
    assert_eq!(turned.ledger().loss().baffles, 0);
}

#[test]
fn the_order_of_tablets_changes_nothing() {
    let shapes = [round_tablet(0.0159, 0.00382, 0.00141, 24, 5)];
    let bodies = heap(60, 3);
    let backwards: Vec<_> = bodies.iter().rev().copied().collect();
    let [mut forth, mut back] = [(); 2].map(|()| coater(&shapes, &[0; 60], [256, 128], None));
    spray(&mut forth, 0..4, &bodies, 0.0);
    spray(&mut back, 0..4, &backwards, 0.0);
    for k in 0..60 {
        assert_eq!(forth.counts(k), back.counts(59 - k), "tablet {k}");
    }
}

#[test]
fn moving_everything_by_whole_pixels_changes_nothing() {
    let shapes = [round_tablet(0.0159, 0.00382, 0.00141, 24, 5)];
    let pixels = [256, 128];
    let bodies = heap(60, 4);
    let mut still = coater(&shapes, &[0; 60], pixels, None);
    spray(&mut still, 0..8, &bodies, 0.0);
    let shift = Vector3::new(-17.0 * EXTENT[1] / 128.0, 0.001, 231.0 * EXTENT[0] / 256.0);
    let moved: Vec<_> = bodies.iter().map(|b| BodyState { position: b.position + shift, ..*b }).collect();
    let zone = SprayZone { center: still.zones()[0].center + shift, ..still.zones()[0] };
    let mut shifted =
        Coater::new(&shapes, &[0; 60], &spray_gun(pixels, Pattern::default()), zone, None).unwrap();
    spray(&mut shifted, 0..8, &moved, 0.0);
    let moved_pixels: u64 = (0..60)
        .flat_map(|k| still.counts(k).iter().zip(shifted.counts(k)))
        .map(|(a, b)| a.abs_diff(*b))
        .sum();
    assert!(moved_pixels as f64 <= 1e-4 * still.ledger().total() as f64, "{moved_pixels}");
}

#[test]
fn a_lone_tablet_shows_each_panel_its_projected_area() {
    let shapes = [round_tablet(0.0159, 0.00382, 0.00141, 36, 8)];
    let panels = shapes[0].panels.as_ref().unwrap();
    let orientation = UnitQuaternion::from_euler_angles(0.4, 0.2, -0.7);
    let mut coater = coater(&shapes, &[0], [512, 256], None);
    spray(&mut coater, 0..256, &[body(0.001, -0.002, 0.003, orientation)], 0.0);
    let mut total = (0.0, 0.0);
    for (j, &count) in coater.counts(0).iter().enumerate() {
        let seen = count as f64 * coater.pixel_area() / 256.0;
        let exact = panels.areas[j] * (orientation * panels.normals[j]).y.max(0.0);
        // A 256th of a pixel for each of the panel's borders, each a few pixels long.
        assert!((seen - exact).abs() < 0.15 * coater.pixel_area(), "panel {j}: {seen} instead of {exact}");
        total = (total.0 + seen, total.1 + exact);
    }
    assert!((total.0 / total.1 - 1.0).abs() < 1e-4, "{total:?}");
}

/// Against areas clipped exactly: a tablet that hangs over the border of the zone, and one half under another.
#[test]
fn counts_tend_to_the_exact_visible_areas() {
    let shapes = [round_tablet(0.0159, 0.00382, 0.00141, 36, 8)];
    let tablet = |x, y, z, angles: [f64; 3]| {
        body(x, y, z, UnitQuaternion::from_euler_angles(angles[0], angles[1], angles[2]))
    };
    let below = tablet(0.016, -0.012, 0.001, [0.4, 0.2, -0.7]);
    let above = tablet(0.009, 0.003, 0.007, [1.2, -0.3, 0.4]);
    let half = EXTENT.map(|extent| extent / 2.0);
    for bodies in [vec![below], vec![below, above]] {
        let before = bodies.get(1).map(|above| (&shapes[0], above));
        let exact = clipper::seen_areas(&shapes[0], &below, before, half);
        let mut error = Vec::new();
        for frames in [4, 256] {
            let mut coater = coater(&shapes, &vec![0; bodies.len()], [512, 256], None);
            spray(&mut coater, 0..frames, &bodies, 0.0);
            let seen =
                coater.counts(0).iter().map(|&count| count as f64 * coater.pixel_area() / frames as f64);
            let off: f64 = seen.zip(&exact).map(|(seen, exact)| (seen - exact).abs()).sum();
            error.push(off / exact.iter().sum::<f64>());
        }
        // Evenly spread shifts of the grid leave an error of about 1/frames^0.7: 1.8e-3 and 2.5e-3 after 256 frames, and
        // 1.1e-4 and 1.6e-4 after 8192.
        assert!(error[1] < 3e-3 && error[1] < error[0] / 8.0, "{error:?}");
    }
    // Nothing in the way: the clipper itself comes to A_j n_y.
    let whole = clipper::seen_areas(&shapes[0], &tablet(0.0, 0.0, 0.0, [0.4, 0.2, -0.7]), None, half);
    let panels = shapes[0].panels.as_ref().unwrap();
    for (j, seen) in whole.iter().enumerate() {
        let normal = below.orientation * panels.normals[j];
        assert!((seen - panels.areas[j] * normal.y.max(0.0)).abs() < 1e-18, "panel {j}");
    }
}

/// Verification case V47: a fixed sphere in a parallel spray, cosine law. h ~ max(cos θ, 0) has mean 1/4 and mean
/// square 1/6 over the sphere: CoV² = (1/6)/(1/16) − 1 = 5/3.
#[test]
fn a_fixed_sphere_follows_the_cosine_law() {
    let shapes = [icosphere(0.015, 4)];
    let areas = &shapes[0].panels.as_ref().unwrap().areas;
    let mut coater = coater(&shapes, &[0], [512, 256], None);
    spray(&mut coater, 0..64, &[body(0.0, 0.0, 0.0, UnitQuaternion::identity())], 0.0);
    let thickness: Vec<f64> = film_thickness(coater.counts(0), areas, 1.0).collect();
    let (mean, variance) = moments(&thickness, areas);
    let cov = variance.sqrt() / mean;
    assert!((cov - (5.0_f64 / 3.0).sqrt()).abs() < 2e-3, "{cov}");
}

/// V47, second part: after n independent random orientations the expected variance over a sphere is that of one
/// divided by n: CoV = sqrt(5/(3n)).
#[test]
fn random_orientations_average_out() {
    let (rows, columns, turns) = (4, 8, 25_u64);
    let shapes = [icosphere(0.0045, 2)];
    let areas = &shapes[0].panels.as_ref().unwrap().areas;
    let count = rows * columns;
    let mut coater = coater(&shapes, &vec![0; count], [512, 256], None);
    let mut random = ChaCha8Rng::seed_from_u64(47);
    for index in 0..turns {
        let bodies: Vec<_> = (0..count)
            .map(|k| {
                let (row, column) = ((k / columns) as f64, (k % columns) as f64);
                body(0.01 * (row - 1.5), 0.0, 0.01 * (column - 3.5), turned_at_random(&mut random))
            })
            .collect();
        spray(&mut coater, index..index + 1, &bodies, 0.0);
    }
    let (mut mean, mut variance) = (0.0, 0.0);
    for k in 0..count {
        let thickness: Vec<f64> = film_thickness(coater.counts(k), areas, 1.0).collect();
        let (m, v) = moments(&thickness, areas);
        mean += m / count as f64;
        variance += v / count as f64;
    }
    let ratio = (variance.sqrt() / mean) / (5.0 / (3.0 * turns as f64)).sqrt();
    // 32 tablets of 25 turns scatter by about 3 %.
    assert!((ratio - 1.0).abs() < 0.06, "{ratio}");
}

/// Verification case V50: the lower of two equal spheres, one above the other at a lateral offset d, shows its disc
/// less the lens common to both: 1 − (2 acos(d/2r) − (d/r) sqrt(1 − d²/4r²))/π.
#[test]
fn a_sphere_shades_the_one_below_by_the_lens_of_two_discs() {
    let radius = 0.008;
    let shapes = [icosphere(radius, 5)];
    for offset in [0.5_f64, 1.0, 1.5] {
        let lens = 2.0 * (offset / 2.0).acos() - offset * (1.0 - offset * offset / 4.0).sqrt();
        let expected = 1.0 - lens / std::f64::consts::PI;
        let mut coater = coater(&shapes, &[0, 0], [512, 256], None);
        let above = body(0.0, 0.0, radius * (offset - 0.5), UnitQuaternion::identity());
        let below = body(0.0, -0.02, -radius * 0.5, UnitQuaternion::identity());
        spray(&mut coater, 0..64, &[above, below], 0.0);
        let [whole, part] = [0, 1].map(|k| coater.counts(k).iter().sum::<u64>() as f64);
        assert!((part / whole - expected).abs() < 1e-3, "{} instead of {expected}", part / whole);
    }
}

/// Verification case V53: numbers at both ends of the range name the right panels.
#[test]
fn the_first_and_the_last_panel_are_counted_as_themselves() {
    let shapes = [icosphere(0.004, 0), icosphere(0.012, 0)];
    let mut body_shape = vec![0; 400];
    body_shape[399] = 1;
    let far = body(1.0, 0.0, 0.0, UnitQuaternion::identity());
    let mut bodies = vec![far; 400];
    let last = shapes[1].panels.as_ref().unwrap().normals.len() - 1;
    let facing = |shape: usize, panel: usize| {
        let normal = shapes[shape].panels.as_ref().unwrap().normals[panel];
        UnitQuaternion::rotation_between(&normal, &Vector3::y()).unwrap()
    };
    bodies[0] = body(0.0, 0.0, -0.03, facing(0, 0));
    bodies[399] = body(0.0, 0.0, 0.02, facing(1, last));
    let mut coater = coater(&shapes, &body_shape, [256, 128], None);
    spray(&mut coater, 0..4, &bodies, 0.0);
    let most = |k: usize| coater.counts(k).iter().enumerate().max_by_key(|(_, count)| **count).unwrap().0;
    assert_eq!((most(0), most(399)), (0, last));
    assert_eq!(coater.exposed().iter().map(|e| e.body).collect::<Vec<_>>(), [0, 399]);
    assert!((1..399).all(|k| coater.counts(k).iter().all(|&count| count == 0)));
    assert_eq!(coater.ids().id(399, last) + 1, coater.ids().panels());
}

/// Verification case V52: the pixels of one equilateral triangle over n pixels scatter, over random places and turns, by
/// 0.5745 n^(−3/4) of n; by simulation 0.210, 0.0998, 0.0435 and 0.0180 for n of 4, 10, 30 and 100.
#[test]
fn a_panel_of_n_pixels_is_off_by_n_to_the_minus_three_quarters() {
    let pixel = EXTENT[0] / 512.0;
    let (rows, columns, frames) = (4, 8, 100);
    let count = rows * columns;
    for (n, expected) in [(4.0_f64, 0.210), (10.0, 0.0998), (30.0, 0.0435), (100.0, 0.0180)] {
        let radius = pixel * (4.0 * n / 27.0_f64.sqrt()).sqrt();
        let corner = |k: u32| {
            let (s, c) = (f64::from(k) * std::f64::consts::TAU / 3.0).sin_cos();
            Vector3::new(radius * c, radius * s, 0.0)
        };
        let shapes = [solid("panel", (0..3).map(corner).collect(), vec![[0, 1, 2]])];
        let up = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), -std::f64::consts::FRAC_PI_2);
        let mut coater = coater(&shapes, &vec![0; count], [512, 256], None);
        let mut random = ChaCha8Rng::seed_from_u64(52);
        let (mut sum, mut square) = (0.0, 0.0);
        for index in 0..frames {
            let bodies: Vec<_> = (0..count)
                .map(|k| {
                    let mut near = |at: f64| 0.009 * at + 3.0 * pixel * random.random::<f64>();
                    let (x, z) = (near((k / columns) as f64 - 1.5), near((k % columns) as f64 - 3.5));
                    let turn = std::f64::consts::TAU * random.random::<f64>();
                    body(x, 0.0, z, UnitQuaternion::from_axis_angle(&Vector3::y_axis(), turn) * up)
                })
                .collect();
            spray(&mut coater, index..index + 1, &bodies, 0.0);
            let mut seen = vec![0.0; count];
            coater.exposed().iter().for_each(|e| seen[e.body] = e.counts as f64);
            sum += seen.iter().sum::<f64>();
            square += seen.iter().map(|counts| (counts - n).powi(2)).sum::<f64>();
        }
        let samples = (frames * count as u64) as f64;
        let (mean, scatter) = (sum / samples / n, (square / samples).sqrt() / n);
        // 3200 samples know a scatter to 1.3 % and a mean to a 57th of the scatter.
        assert!((mean - 1.0).abs() < 4.0 * expected / samples.sqrt(), "{n}: {mean}");
        assert!((scatter / expected - 1.0).abs() < 0.05, "{n}: {scatter} instead of {expected}");
        assert!((scatter / (0.5745 * n.powf(-0.75)) - 1.0).abs() < 0.08, "{n}: {scatter}");
    }
}

/// V53 in the raster itself: of 17.9 million panels the last are drawn and counted as themselves.
#[test]
fn panels_beyond_24_bits_are_drawn_as_themselves() {
    let shapes = [icosphere(0.012, 3)];
    let many = 14_000;
    let far = body(1.0, 0.0, 0.0, UnitQuaternion::identity());
    let near = body(0.0, 0.0, 0.0, UnitQuaternion::identity());
    let mut bodies = vec![far; many];
    bodies[many - 1] = near;
    let [mut all, mut one] = [many, 1].map(|n| coater(&shapes, &vec![0; n], [256, 128], None));
    assert!(all.ids().panels() > 1 << 24);
    spray(&mut all, 0..2, &bodies, 0.0);
    spray(&mut one, 0..2, &[near], 0.0);
    assert_eq!(all.counts(many - 1), one.counts(0));
    assert_eq!(all.ledger().loss(), one.ledger().loss());
}

/// Beyond 2²⁴ numbers, where colours and single precision give out.
#[test]
fn ten_thousand_tablets_have_their_own_numbers() {
    let ids = PanelIds::new(std::iter::repeat_n(1856, 10_000)).unwrap();
    for id in [0, 1, 255, 256, 65_535, 65_536, 70_000, 16_777_214, 16_777_215, 16_777_217, 18_559_999] {
        let body = ids.body(id).unwrap();
        assert_eq!(ids.id(body, id as usize % 1856), id);
    }
    assert_eq!(ids.body(18_560_000), None);
}

/// Counts on the panels of a block whose normals point along `direction`, as an area, m².
fn seen_area(coater: &Coater, block: &TabletShape, frames: u64, direction: Vector3<f64>) -> f64 {
    let normals = &block.panels.as_ref().unwrap().normals;
    let counts =
        coater.counts(0).iter().zip(normals).filter(|(_, n)| n.dot(&direction) > 0.99).map(|(c, _)| *c);
    counts.sum::<u64>() as f64 * coater.pixel_area() / frames as f64
}

/// A tilted spray sees a face by the cosine of its angle, and the side of a block that it leans to by the sine.
#[test]
fn a_tilted_spray_sees_the_sides() {
    let shapes = [block([0.01; 3])];
    let angle = 30.0_f64.to_radians();
    let tilt = |spanwise: f64, streamwise: f64| {
        let pattern = Pattern { tilt: Tilt { spanwise, streamwise }, ..Pattern::default() };
        let mut coater = patterned(&shapes, &[0], &spray_gun([512, 256], pattern), None);
        spray(&mut coater, 0..32, &[body(0.0, 0.0, 0.0, UnitQuaternion::identity())], 0.0);
        coater
    };
    for (coater, side) in [(tilt(angle, 0.0), Vector3::z()), (tilt(0.0, angle), -Vector3::x())] {
        let [top, side] = [Vector3::y(), side * coater.zones()[0].spanwise.z.signum()]
            .map(|direction| seen_area(&coater, &shapes[0], 32, direction));
        assert!((top / (1e-4 * angle.cos()) - 1.0).abs() < 2e-3, "{top}");
        assert!((side / (1e-4 * angle.sin()) - 1.0).abs() < 2e-3, "{side}");
    }
}

/// A diverging spray sees the square on top of a block, a fifth of the way up to the nozzle, 1/0.8² times as large, and
/// none of its sides when it stands on the axis. Off the axis the inner side is seen.
#[test]
fn a_diverging_spray_sees_the_near_larger() {
    let shapes = [block([0.01, 0.02, 0.01])];
    let pattern = Pattern { rays: Rays::Diverging, ..Pattern::default() };
    let run = |z: f64| {
        let mut coater = patterned(&shapes, &[0], &spray_gun([512, 256], pattern.clone()), None);
        spray(&mut coater, 0..32, &[body(0.0, 0.0, z, UnitQuaternion::identity())], 0.0);
        let faces = [Vector3::y(), Vector3::z(), -Vector3::z()];
        faces.map(|direction| seen_area(&coater, &shapes[0], 32, direction))
    };
    let [top, outer, inner] = run(0.0);
    assert!(
        (top / (1e-4 / 0.64) - 1.0).abs() < 2e-3 && outer == 0.0 && inner == 0.0,
        "{top} {outer} {inner}"
    );
    let [top, outer, inner] = run(0.02);
    // The edges 15 mm off the axis at heights 10 and −10 mm are seen at 15/0.8 and 15/1.2 mm, their widths 10/0.8 and
    // 10/1.2 mm.
    let trapezoid = (0.015 / 0.8 - 0.015 / 1.2) * (0.01 / 0.8 + 0.01 / 1.2) / 2.0;
    assert!((top / (1e-4 / 0.64) - 1.0).abs() < 2e-3 && outer == 0.0, "{top} {outer}");
    assert!((inner / trapezoid - 1.0).abs() < 5e-3, "{inner} instead of {trapezoid}");
}

#[test]
fn every_pattern_adds_up_and_pauses_count_nothing() {
    let shapes = [round_tablet(0.0159, 0.00382, 0.00141, 24, 5)];
    let bodies = heap(60, 9);
    let patterns = [
        Pattern { footprint: Footprint::Ellipse, ..Pattern::default() },
        Pattern { flux: Flux::Gaussian { sigma: 0.5 }, rays: Rays::Diverging, ..Pattern::default() },
        Pattern {
            flux: Flux::Dumbbell { offset: 0.5, sigma: 0.3 },
            nozzles: vec![-0.02, 0.0, 0.02],
            ..Pattern::default()
        },
        Pattern {
            flux: Flux::Annular { inner: 0.3 },
            cycle: Some(Cycle { on: 1.0, off: 1.0 }),
            ..Pattern::default()
        },
    ];
    for pattern in patterns {
        let mut coater = patterned(&shapes, &[0; 60], &spray_gun([128, 64], pattern.clone()), None);
        for (index, time) in [(0, 0.0), (1, 1.5), (2, 2.5)] {
            coater.observe(&Frame { index, time, bodies: &bodies, drum_angle: 0.0, drum_torque: 0.0 });
            assert_eq!(coater.exposed().is_empty(), pattern.cycle.is_some() && index == 1);
        }
        let sprayed = if pattern.cycle.is_some() { 2 } else { 3 };
        assert_eq!(coater.ledger().frames(), sprayed);
        assert_eq!(coater.ledger().total(), sprayed * coater.counts_per_frame());
        let on_tablets: u64 = (0..60).flat_map(|b| coater.counts(b)).sum();
        assert!(on_tablets > 0);
    }
}

/// Weights do what they say: a block in the middle of a Gaussian spray gets the share of the bell over it.
#[test]
fn a_bell_favours_its_middle() {
    let shapes = [block([0.02, 0.01, 0.04])];
    let pattern = Pattern { flux: Flux::Gaussian { sigma: 0.5 }, ..Pattern::default() };
    let mut coater = patterned(&shapes, &[0], &spray_gun([256, 128], pattern), None);
    spray(&mut coater, 0..4, &[body(0.0, 0.0, 0.0, UnitQuaternion::identity())], 0.0);
    let share = coater.counts(0).iter().sum::<u64>() as f64 / coater.ledger().total() as f64;
    // The block covers half of each extent: (erf(½/(σ√2)) / erf(1/(σ√2)))², erf(0.707107) = 0.682689 and
    // erf(1.414214) = 0.954500.
    assert!((share - (0.682_689_f64 / 0.954_500).powi(2)).abs() < 2e-3, "{share}");
}

/// Frames coated side by side give what they give one after the other, whatever the number of threads.
#[test]
fn batches_of_frames_give_the_same_counts() {
    let shapes = [round_tablet(0.0159, 0.00382, 0.00141, 24, 5)];
    let heaps: Vec<_> = (0..7).map(|seed| heap(60, seed)).collect();
    let frames: Vec<_> = heaps
        .iter()
        .zip(0..)
        .map(|(bodies, index)| Frame { index, time: 0.0, bodies, drum_angle: 0.0, drum_torque: 0.0 })
        .collect();
    let mut single = coater(&shapes, &[0; 60], [128, 64], None);
    let exposed: Vec<_> = frames
        .iter()
        .map(|frame| {
            single.observe(frame);
            single.exposed().to_vec()
        })
        .collect();
    for threads in [1, 2, 3, 16] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut batch = coater(&shapes, &[0; 60], [128, 64], None);
        assert_eq!(pool.install(|| batch.observe_all(&frames)), exposed);
        assert_eq!(batch.ledger(), single.ledger());
    }
}

/// Poses on disk, exact or as a table, are coated to the counts of the run; compact ones to within a pixel's noise.
#[test]
fn stored_poses_are_coated_like_those_of_the_run() {
    let shapes = [round_tablet(0.0159, 0.00382, 0.00141, 24, 5)];
    let drum = tube(0.06, 0.06);
    let new = || coater(&shapes, &[0; 60], [256, 128], Some(&drum));
    let folder = tempfile::tempdir().unwrap();
    let [exact, compact, table] = ["exact", "compact", "table.csv"].map(|name| folder.path().join(name));
    let packing = Packing::Compact { min: Vector3::repeat(-0.06), max: Vector3::repeat(0.06) };
    let recording = |packing| Recording { packing, body_shapes: vec![0; 60], aim: None };
    let mut recorders = [
        Recorder::create(&exact, recording(Packing::Exact)).unwrap(),
        Recorder::create(&compact, recording(packing)).unwrap(),
    ];
    let mut rows = String::from("time_s,id,x,y,z,qw,qx,qy,qz\n");
    let mut run = new();
    for index in 0..6 {
        let (bodies, time) = (heap(60, index), 0.02 * index as f64);
        let frame = Frame { index, time, bodies: &bodies, drum_angle: 2.3 * time, drum_torque: 0.0 };
        run.observe(&frame);
        for recorder in &mut recorders {
            recorder.observe(&frame);
        }
        for (id, BodyState { position: p, orientation: q, .. }) in bodies.iter().enumerate() {
            writeln!(rows, "{time},{id},{},{},{},{},{},{},{}", p.x, p.y, p.z, q.w, q.i, q.j, q.k).unwrap();
        }
    }
    std::fs::write(&table, rows).unwrap();
    for recorder in &mut recorders {
        recorder.flush().unwrap();
    }

    let coat = |frames: Vec<StoredFrame>| {
        let mut coater = new();
        coater.observe_all(&frames.iter().map(StoredFrame::as_frame).collect::<Vec<_>>());
        coater
    };
    let read = |path| PoseReader::open(path).unwrap().map(Result::unwrap).collect();
    assert_eq!(coat(read(&exact)).ledger(), run.ledger());
    assert_eq!(coat(read_pose_table(&table, 2.3).unwrap()).ledger(), run.ledger());
    let packed = coat(read(&compact));
    let counts = |coater: &Coater| (0..60).flat_map(|b| coater.counts(b).to_vec()).collect::<Vec<_>>();
    let moved: u64 = counts(&packed).iter().zip(counts(&run)).map(|(a, b)| a.abs_diff(b)).sum();
    // Poses off by about 10 µm in pixels of 312 µm move a few percent of the pixels between neighbouring panels.
    assert!((moved as f64) < 0.1 * run.ledger().total() as f64, "{moved} of {}", run.ledger().total());
    // 9 bytes a pose, 40 for each frame, and what the file begins with.
    let bytes = std::fs::metadata(&compact).unwrap().len();
    assert!(bytes < 9 * 6 * 60 + 6 * 40 + 512, "{bytes}");
}

/// The backend's note tells a build without graphics cards from one that found none.
#[test]
fn what_is_not_to_be_had_is_noted_and_the_processor_draws() {
    let shapes = [icosphere(0.004, 2)];
    let mut coater = coater(&shapes, &[0], [64, 32], None);
    assert_eq!(coater.backend(), "cpu");
    coater.use_backend(Backend::Auto);
    let note = coater.backend().to_owned();
    assert!(note.starts_with("gpu: ") || note.starts_with("cpu: "), "{note}");
    assert_eq!(
        note == "cpu: this program was built without support for graphics cards",
        cfg!(not(feature = "gpu"))
    );
    spray(&mut coater, 0..1, &[body(0.0, 0.0, 0.0, UnitQuaternion::identity())], 0.0);
    assert_eq!(coater.ledger().total(), 64 * 32);
}

/// Pictures of a graphics card, here of a program that acts as one. Where there is none the test says so and passes,
/// unless `REQUIRE_GPU` is set.
#[cfg(feature = "gpu")]
mod graphics_card {
    use super::*;

    #[test]
    fn both_see_the_same() {
        let shapes = [round_tablet(0.0159, 0.00382, 0.00141, 24, 5), icosphere(0.004, 2)];
        let body_shape: Vec<usize> = (0..120).map(|k| k % 2).collect();
        let drum = tube(0.06, 0.06);
        for rays in [Rays::Parallel, Rays::Diverging] {
            let pattern = Pattern { rays, ..Pattern::default() };
            let spray_gun = spray_gun([500, 250], pattern);
            let [mut cpu, mut gpu] =
                [(); 2].map(|()| patterned(&shapes, &body_shape, &spray_gun, Some(&drum)));
            gpu.use_backend(Backend::GpuSoftware);
            if !gpu.backend().starts_with("gpu: ") {
                assert!(std::env::var_os("REQUIRE_GPU").is_none(), "{}", gpu.backend());
                eprintln!("not tested: {}", gpu.backend());
                return;
            }
            for index in 0..8 {
                let bodies = heap(120, index);
                spray(&mut cpu, index..index + 1, &bodies, 0.4 * index as f64);
                spray(&mut gpu, index..index + 1, &bodies, 0.4 * index as f64);
            }
            gpu.settle();
            assert!(gpu.backend().starts_with("gpu: "), "{}", gpu.backend());
            assert_eq!(gpu.ledger().total(), cpu.ledger().total());
            let (a, b) = (cpu.ledger().loss(), gpu.ledger().loss());
            assert!(a.wall > 0 && a.empty > 0 && a.baffles > 0, "{a:?}");
            let mut moved = a.wall.abs_diff(b.wall) + a.ends.abs_diff(b.ends);
            moved += a.baffles.abs_diff(b.baffles) + a.empty.abs_diff(b.empty);
            for body in 0..120 {
                moved +=
                    cpu.counts(body).iter().zip(gpu.counts(body)).map(|(a, b)| a.abs_diff(*b)).sum::<u64>();
            }
            assert!(moved as f64 <= 2e-4 * cpu.ledger().total() as f64, "{rays:?}: {moved}");
        }
    }

    /// Without a driver there is no card, and no panic.
    #[test]
    fn no_driver_is_no_harm() {
        let output = std::process::Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "what_is_not_to_be_had_is_noted_and_the_processor_draws"])
            .env("VK_DRIVER_FILES", "/nonexistent")
            .env("VK_ICD_FILENAMES", "/nonexistent")
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
    }
}
