//! What a frame of the coater costs: 770 round tablets of 1680 panels in the paper's zone.

#[path = "../tests/support/beds.rs"]
mod beds;
#[path = "../tests/support/solids.rs"]
mod solids;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use nalgebra::Vector3;
use pancoat::observers::{Coater, SprayZone};
use pancoat::scene::{Aim, Deposit, Pattern, Spray};
use pancoat::stepping::{Frame, Observer};
use std::hint::black_box;

fn raster(criterion: &mut Criterion) {
    let shapes = [solids::round_tablet(0.0159, 0.00325, 0.0017, 42, 10)];
    let bodies = beds::paper_bed(1);
    let mut group = criterion.benchmark_group("coater frame");
    group.throughput(Throughput::Elements(1));
    for pixels in [[256, 128], [512, 256], [1024, 512]] {
        let spray = Spray {
            spanwise: 0.0762,
            streamwise: 0.0381,
            distance: 0.05,
            aim: Aim::Bed,
            pixels,
            deposit: Deposit::Sprayed { rate: 1.25e-4, solids: 0.2, film_density: 1300.0 },
            pattern: Pattern::default(),
        };
        let zone = SprayZone::facing(Vector3::zeros(), Vector3::y(), &spray);
        let mut coater =
            Coater::new(&shapes, &vec![0; bodies.len()], &spray, zone, None).expect("the shape has panels");
        let mut index = 0;
        group.bench_function(format!("{} x {}", pixels[0], pixels[1]), |bencher| {
            bencher.iter(|| {
                let frame = Frame { index, time: 0.0, bodies: &bodies, drum_angle: 0.0, drum_torque: 0.0 };
                coater.observe(black_box(&frame));
                index += 1;
            });
        });
    }
    group.finish();
}

criterion_group!(benches, raster);
criterion_main!(benches);
