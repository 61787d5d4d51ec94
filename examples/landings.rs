//! How a tablet of the paper lands, against how many spheres it is made of: one row of a table for each count.
//!
//! `cargo run --release --example landings -- round > docs/data/spheres/landings.csv`
//!
//! Flat: cap down, square to a plane. Rim: the axis 45 degrees from the normal, mean and standard deviation over eight turns
//! about the axis. The plane is hard and without friction, gravity is off, the speed 0.3 m/s, the restitution asked for 0.5,
//! with 200 steps in a contact of one sphere. Restitution is that of the point of the tablet that is lowest at
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
/// Turns about the axis that landings on the rim are averaged over.
const TURNS: u32 = 8;
/// Time after which a landing has to be over, s.
const LONGEST: f64 = 0.1;

fn main() -> Result<(), Box<dyn Error>> {
    let name = std::env::args().nth(1).unwrap_or_else(|| "round".into());
    let scene = Scene::embedded(&name)?;
    println!(
        "spheres,mean_deviation_um,largest_deviation_um,face_roughness_um,band_roughness_um,volume_error_percent,\
         fit_s,flat_body,rim_body,rim_body_sd,flat_contact,rim_contact,rim_contact_sd"
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
            let landing = |lean: f64, turn: f64| landing(&scene, &shape, &clump, damping, lean, turn);
            let turns = (0..TURNS).map(|k| landing(FRAC_PI_4, TAU * f64::from(k) / f64::from(TURNS)));
            let rim = turns.collect::<Result<Vec<_>, _>>()?;
            let mean = rim.iter().sum::<f64>() / f64::from(TURNS);
            let sd = (rim.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / f64::from(TURNS)).sqrt();
            print!(",{:.4},{mean:.4},{sd:.4}", landing(0.0, 0.0)?);
        }
        println!();
    }
    Ok(())
}

/// Restitution of a tablet whose axis leans by `lean` from the normal after a turn about it, rad.
fn landing(
    scene: &Scene,
    shape: &Shape,
    clump: &Clump,
    damping: DampingMass,
    lean: f64,
    turn: f64,
) -> Result<f64, Box<dyn Error>> {
    // The axis z of the tablet to y, the normal of the plane, and away from it.
    let orientation = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), lean - FRAC_PI_2)
        * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn);
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
