#[path = "../tests/support/solids.rs"]
mod solids;
use nalgebra::*;
use pancoat::observers::*;
use pancoat::scene::*;
use pancoat::shapes::*;
use pancoat::stepping::*;
fn stl(path: &str, part: impl Fn(usize) -> Part, m: &mut SurfaceMesh) {
    let t = std::fs::read_to_string(path).unwrap();
    let v: Vec<Vector3<f64>> = t
        .lines()
        .filter_map(|l| l.trim().strip_prefix("vertex "))
        .map(|l| {
            let c: Vec<f64> = l.split_whitespace().map(|x| x.parse().unwrap()).collect();
            Vector3::new(c[0], c[1], c[2] - 0.05)
        })
        .collect();
    for (k, tri) in v.chunks(3).enumerate() {
        let f = m.vertices.len() as u32;
        m.vertices.extend(tri);
        m.triangles.push([f, f + 1, f + 2]);
        m.parts.push(part(k));
    }
}
fn main() {
    let dir = "/work/shared/peers/common/";
    let shape = solids::round_tablet(0.0159, 0.0032, 0.002, 42, 10);
    let n = shape.panels.as_ref().unwrap().len();
    let bodies: Vec<BodyState> = std::fs::read_to_string(format!("{dir}start_tablets.csv"))
        .unwrap()
        .lines()
        .map(|l| {
            let c: Vec<f64> = l.split(',').map(|x| x.parse().unwrap()).collect();
            BodyState {
                position: Vector3::new(c[0], c[1], c[2] - 0.05),
                orientation: UnitQuaternion::new_normalize(Quaternion::new(c[3], c[4], c[5], c[6])),
                velocity: Vector3::zeros(),
                spin: Vector3::zeros(),
            }
        })
        .collect();
    let pan = default_pan();
    let drum = drum_mesh(&pan);
    let spray = Spray {
        spanwise: 0.0762,
        streamwise: 0.0381,
        distance: 0.05,
        aim: Aim::Bed,
        pixels: [512, 256],
        deposit: Deposit { rate: 1.25e-4, solids: 0.2, film_density: 1300.0 },
        pattern: Pattern::default(),
    };
    let pos: Vec<_> = bodies.iter().map(|b| b.position).collect();
    let surface = BedSurface::fit(&pos, 0.0063).unwrap();
    println!("panels {n} angle {} height {}", surface.angle_of_repose_deg(), surface.height);
    let zone = surface.zone(&spray);
    let shapes = [shape];
    let bs = vec![0; bodies.len()];
    let mut coater = Coater::new(&shapes, &bs, &spray, zone, Some(&drum)).unwrap();
    let t = std::time::Instant::now();
    let frames = 1500;
    for index in 0..frames {
        coater.observe(&Frame { index, time: 0.0, bodies: &bodies, drum_angle: 0.0, drum_torque: 0.0 });
    }
    println!(
        "{} frames/s, exposed {}, loss {:?}",
        frames as f64 / t.elapsed().as_secs_f64(),
        coater.exposed().len(),
        coater.ledger().loss()
    );
    let film: Vec<f64> = (0..bodies.len())
        .map(|k| {
            let mut x = (k as u64 + 1).wrapping_mul(0x9E3779B97F4A7C15);
            x ^= x >> 29;
            x = x.wrapping_mul(0xBF58476D1CE4E5B9);
            let u = (x >> 11) as f64 / (1u64 << 53) as f64;
            0.15 + 1.7 * u
        })
        .collect();
    let mut picture = BedPicture::new(&shapes, &bs, &drum, 900).unwrap();
    let t = std::time::Instant::now();
    let image = picture.draw(
        &Frame { index: 0, time: 0.0, bodies: &bodies, drum_angle: 0.0, drum_torque: 0.0 },
        &film,
        Some(&zone),
    );
    println!("picture {:?}", t.elapsed());
    image.write_png(std::path::Path::new("/tmp/bed.png")).unwrap();
}
