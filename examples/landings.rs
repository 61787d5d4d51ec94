//! How a tablet of the paper lands, against how many spheres it is made of: one row of a table for each count.
//!
//! `cargo run --release --example landings -- round > docs/data/spheres/landings.csv`
//!
//! Flat: cap down, square to a plane. Rim: the axis 45 degrees from the normal. Either in twelve turns about the axis; mean
//! and standard deviation. The plane is hard and without friction, gravity is off, the speed 0.3 m/s, the restitution asked
//! for 0.5, with 200 steps in a contact of one sphere. Restitution is that of the point of the tablet that is lowest at
//! first: its velocity along the normal when the tablet leaves over that before, as for a rigid body (Stronge 2000, Impact
//! Mechanics, chapter 3).
#![expect(clippy::print_stdout, reason = "an example prints its result")]

use nalgebra::{UnitQuaternion, Vector3};
use pancoat::scene::{
    Boundary, BoundarySurface, DampingMass, FreeBody, Material, PairProperties, PairTable, Scene, Settle,
    Shape, SphereBudget, StepChoice,
};
use pancoat::shapes::{Clump, Solid};
use pancoat::stepping::Simulation;
use std::error::Error;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, TAU};
use std::time::Instant;

const COUNTS: [usize; 7] = [1, 10, 20, 50, 100, 200, 400];
/// Approach speed, m/s.
const SPEED: f64 = 0.3;
const TURNS: u32 = 12;
/// Time after which a landing has to be over, s.
const LONGEST: f64 = 0.1;

fn main() -> Result<(), Box<dyn Error>> {
    let name = std::env::args().nth(1).unwrap_or_else(|| "round".into());
    let scene = Scene::embedded(&name)?;
    println!(
        "spheres,mean_deviation_um,largest_deviation_um,face_roughness_um,band_roughness_um,volume_error_percent,\
         fit_s,flat_body,flat_body_sd,rim_body,rim_body_sd,flat_contact,flat_contact_sd,rim_contact,rim_contact_sd"
    );
    for count in COUNTS {
        let shape = Shape { spheres: SphereBudget::Count(count), ..scene.shapes[0].clone() };
        let solid = Solid::new(&shape.recipe)?;
        let begun = Instant::now();
        let clump = solid.clump(shape.spheres, shape.placement).ok_or("a count is always met")?;
        let fit = begun.elapsed().as_secs_f64();
        let off = clump.deviation(&solid.panels(shape.panels).ok_or("has a surface")?);
        let [mean, largest, cap, band] =
            [off.mean, off.largest, off.cap_roughness, off.band_roughness].map(|m| 1e6 * m);
        let volume = 100.0 * (clump.union().0.volume / solid.volume() - 1.0);
        print!("{count},{mean:.1},{largest:.1},{cap:.1},{band:.1},{volume:.2},{fit:.2}");
        for damping in [DampingMass::Body, DampingMass::Contact] {
            for lean in [0.0, FRAC_PI_4] {
                let (mean, sd) = landings(&scene, &shape, &clump, damping, lean)?;
                print!(",{mean:.4},{sd:.4}");
            }
        }
        println!();
    }
    Ok(())
}

/// Mean and standard deviation over turns of the restitution of tablets whose axis leans by `lean` (rad).
fn landings(
    scene: &Scene,
    shape: &Shape,
    clump: &Clump,
    damping: DampingMass,
    lean: f64,
) -> Result<(f64, f64), Box<dyn Error>> {
    let mut found = Vec::new();
    for turn in 0..TURNS {
        let turn =
            UnitQuaternion::from_axis_angle(&Vector3::z_axis(), TAU * f64::from(turn) / f64::from(TURNS));
        // The axis z of the tablet to y, the normal of the plane, and away from it.
        let upright = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), -FRAC_PI_2 + lean);
        found.push(landing(scene, shape, clump, damping, upright * turn)?);
    }
    let n = f64::from(TURNS);
    let mean = found.iter().sum::<f64>() / n;
    Ok((mean, (found.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / n).sqrt()))
}

fn landing(
    scene: &Scene,
    shape: &Shape,
    clump: &Clump,
    damping: DampingMass,
    orientation: UnitQuaternion<f64>,
) -> Result<f64, Box<dyn Error>> {
    let lowest = clump.spheres.iter().map(|s| orientation * s.center - Vector3::y() * s.radius);
    let foot = lowest.reduce(|low, p| if p.y < low.y { p } else { low }).ok_or("a clump has spheres")?;
    let mut alone = scene.clone();
    alone.materials.push(Material { name: "rigid".into(), shear_modulus: 1e12, poisson: 0.3 });
    let hard = alone.materials.len() - 1;
    alone.pairs = PairTable::new(alone.materials.len(), PairProperties { friction: 0.0, restitution: 0.5 });
    alone.gravity = Vector3::zeros();
    alone.shapes = vec![shape.clone()];
    (alone.drum, alone.spray) = (None, None);
    let batch = alone.batches.pop().ok_or("the scene has a batch")?;
    alone.bodies = vec![FreeBody {
        shape: 0,
        material: batch.material,
        mass: batch.tablet_mass,
        position: -Vector3::y() * (foot.y - 1e-6),
        orientation,
        velocity: -Vector3::y() * SPEED,
        spin: Vector3::zeros(),
    }];
    alone.boundaries = vec![Boundary {
        surface: BoundarySurface::Plane { point: Vector3::zeros(), normal: Vector3::y() },
        material: hard,
        velocity: Vector3::zeros(),
        spin: Vector3::zeros(),
    }];
    alone.contact.damping_mass = damping;
    (alone.time.step, alone.time.impact_speed) = (StepChoice::PerContact(200.0), SPEED);
    (alone.time.settle, alone.time.frame_interval) = (Settle::For(0.0), 5e-5);

    let mut simulation = Simulation::new(&alone)?;
    let mut met = false;
    for frame in 0..(LONGEST / alone.time.frame_interval) as u64 {
        simulation.run(frame, 1, &mut [], &mut |_| true)?;
        let touching = simulation.tally().wall_contacts > 0;
        if met && !touching {
            let state = simulation.states()[0];
            // The foot has turned with the tablet.
            let arm = state.orientation * (orientation.inverse() * foot);
            return Ok((state.velocity + state.spin.cross(&arm)).y / SPEED);
        }
        met |= touching;
    }
    Err("the tablet does not leave".into())
}
