use nalgebra::Vector3;
use pancoat::observers::*;
use pancoat::scene::*;
use pancoat::stepping::*;
fn main() {
    let threads: usize = std::env::args().nth(1).unwrap().parse().unwrap();
    let secs: f64 = std::env::args().nth(2).unwrap().parse().unwrap();
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().expect("first pool");
    let pair = PairProperties { friction: 0.5, restitution: 0.5 };
    let scene = Scene {
        title: "x".into(),
        seed: 1,
        gravity: Vector3::new(0.0, -9.81, 0.0),
        materials: vec![
            Material { name: "tablet".into(), shear_modulus: 1e6, poisson: 0.25 },
            Material { name: "steel".into(), shear_modulus: 3e6, poisson: 0.3 },
        ],
        pairs: PairTable::new(2, pair),
        shapes: vec![Shape {
            name: "tablet".into(),
            recipe: Recipe::Round {
                diameter: 15.9e-3,
                band: 3.2452e-3,
                cap: Cap::Compound { height: 1.6973e-3, exponent: 2.8823 },
            },
            spheres: 60,
            panels: 1700,
        }],
        batches: vec![Batch { shape: 0, material: 0, tablet_mass: 1.3e-3, count: 769 }],
        drum: Some(Drum {
            diameter: 0.25,
            width: 0.1,
            speed: 22.0 * std::f64::consts::TAU / 60.0,
            material: 1,
            facets: 90,
            baffles: Some(Baffles { count: 4, height: 12e-3, thickness: 6e-3, tilt: 20f64.to_radians() }),
        }),
        bodies: vec![],
        boundaries: vec![],
        contact: ContactSettings::default(),
        time: Time {
            step: StepChoice::PerContact(std::env::args().nth(3).map_or(25.0, |s| s.parse().unwrap())),
            impact_speed: 0.3,
            settle: Settle::Auto { at_most: 6.0 },
            duration: secs,
            frame_interval: 0.02,
        },
        spray: Some(Spray {
            spanwise: 76.2e-3,
            streamwise: 38.1e-3,
            distance: 0.05,
            aim: Aim::Bed,
            pixels: [512, 256],
            deposit: Deposit { rate: 7.5e-3 / 60.0, solids: 0.2, film_density: 1300.0 },
        }),
        outputs: Outputs { series_interval: 1.0, report: false, picture: false, statistics: false },
    };
    let t = std::time::Instant::now();
    let mut sim = Simulation::new(&scene).unwrap();
    println!(
        "build {:.2} s  {:?} spc {}",
        t.elapsed().as_secs_f64(),
        sim.time_step(),
        sim.time_step().steps_per_contact()
    );
    println!(
        "rmin {} spheres {} panels {}",
        sim.shapes()[0].clump.smallest_radius(),
        sim.shapes()[0].clump.spheres.len(),
        sim.shapes()[0].panels.as_ref().unwrap().len()
    );
    let mut last = 0.0;
    let mut watch = |p: &Progress| {
        if p.time - last > 0.25 || p.time < last {
            last = p.time;
            eprintln!("{:?} {:.2} {} wall {:.1}", p.stage, p.time, p.bodies, t.elapsed().as_secs_f64());
        }
        true
    };
    sim.fill(&mut watch).unwrap();
    println!(
        "filled {} at {:.2}, deepest {:.3}",
        sim.body_shapes().len(),
        sim.clock(),
        sim.deepest_overlap()
    );
    let s = sim.settle(&mut watch).unwrap();
    println!("settled {s} deepest {:.3} {:?}", sim.deepest_overlap(), sim.tally());
    let mut pos = vec![];
    for k in 0..25 {
        sim.run(k, 1, &mut [], &mut |_| true).unwrap();
        pos.extend(sim.states().iter().map(|s| s.position));
    }
    let bed = BedSurface::fit(&pos, 6.3e-3).unwrap();
    println!("angle {:.2} height {:.2} mm", bed.angle_of_repose_deg(), bed.height * 1e3);
    let mut coater = Coater::new(
        sim.shapes(),
        sim.body_shapes(),
        scene.spray.as_ref().unwrap(),
        bed.zone(scene.spray.as_ref().unwrap()),
        sim.drum(),
    )
    .unwrap();
    sim.run(0, 1, &mut [&mut coater], &mut |_| true).unwrap();
    let panels = sim.shapes()[0].panels.clone().unwrap();
    let cov = |c: &Coater| {
        let n = sim_n(c);
        let a: f64 = panels.areas.iter().sum();
        let mut mus = vec![];
        let mut s2 = 0.0;
        for b in 0..n {
            let h: Vec<f64> = c.counts(b).iter().zip(&panels.areas).map(|(c, a)| *c as f64 / a).collect();
            let mu: f64 = h.iter().zip(&panels.areas).map(|(h, a)| h * a).sum::<f64>() / a;
            mus.push(mu);
            s2 += h.iter().zip(&panels.areas).map(|(h, a)| (h - mu).powi(2) * a).sum::<f64>() / a;
        }
        let m = mus.iter().sum::<f64>() / n as f64;
        let inter = (mus.iter().map(|x| (x - m).powi(2)).sum::<f64>() / n as f64).sqrt() / m;
        ((s2 / n as f64).sqrt() / m, inter)
    };
    println!("first frame {:?} loss {:?}", cov(&coater), coater.ledger().loss());
    let (w, st) = (std::time::Instant::now(), sim.stopwatch().seconds());
    let frames = (secs / 0.02) as u64;
    for k in 1..frames {
        sim.run(k, 1, &mut [&mut coater], &mut |_| true).unwrap();
        if k % 50 == 0 {
            println!("{:.2} {:?}", (k + 1) as f64 * 0.02, cov(&coater));
        }
    }
    println!(
        "wall/s {:.2} {:?}",
        w.elapsed().as_secs_f64() / secs,
        sim.stopwatch().seconds().iter().zip(st).map(|(a, b)| (a.0, (a.1 - b.1) / secs)).collect::<Vec<_>>()
    );
    println!("{}", sim.state_hash());
}
fn sim_n(c: &Coater) -> usize {
    c.ids().bodies()
}
