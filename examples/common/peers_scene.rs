//! The drum of other codes' decks as a scene: 200 mm across, 100 mm wide, 22 rpm, no baffles, 770 bodies of 1.3 g from the
//! start states and clumps in `scenes/peers`.

use nalgebra::{UnitQuaternion, Vector3};
use pancoat::scene::{
    ContactSettings, Drum, FreeBody, Material, Outputs, PairProperties, PairTable, Placement, Recipe, Scene,
    Settle, Shape, SphereBudget, StepChoice, Time, Wall,
};
use std::path::{Path, PathBuf};

/// Mass of a body, kg.
pub(crate) const MASS: f64 = 1.3e-3;
/// Radius of the spheres, m.
pub(crate) const RADIUS: f64 = 6.558_744e-3;
/// Principal moments of a tablet, kg m².
pub(crate) const MOMENTS: [f64; 3] = [2.13425e-8, 2.13425e-8, 3.58666e-8];
/// Width of the drum, m. The decks' drum begins at z = 0, this one is centred on it.
pub(crate) const WIDTH: f64 = 0.1;

/// Spheres of a tablet in a case `peers20`, `peers50` or `peers100`; `None` for `spheres`.
pub(crate) fn spheres_per_tablet(case: &str) -> Option<usize> {
    let count = case.strip_prefix("peers")?;
    Some(count.parse().expect("a number of spheres"))
}

/// The scene of a case at friction `friction` with the decks' step, or `dt`, s.
pub(crate) fn peers_scene(case: &str, friction: f64, dt: Option<f64>) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/peers");
    let pair = PairProperties { friction, restitution: 0.5 };
    let (recipe, spheres, step, start) = match spheres_per_tablet(case) {
        Some(n) => {
            let path: PathBuf = folder.join(format!("clump_{n}.txt"));
            let recipe = Recipe::Clump { path, inertia_per_mass: MOMENTS.map(|moment| moment / MASS) };
            let step = match n {
                20 => 5e-5,
                50 => 4e-5,
                _ => 2.5e-5,
            };
            (recipe, n, step, "start_tablets.csv")
        }
        None => (Recipe::Sphere { diameter: 2.0 * RADIUS }, 1, 1.25e-4, "spheres_start.csv"),
    };
    let text = std::fs::read_to_string(folder.join(start)).expect("the start state");
    let bodies = text.lines().map(|line| {
        let v: Vec<f64> = line.split(',').map(|x| x.trim().parse().expect("a number")).collect();
        let axis = if v.len() > 5 { Vector3::new(v[3], v[4], v[5]) } else { Vector3::z() };
        FreeBody {
            shape: 0,
            material: 0,
            mass: MASS,
            position: Vector3::new(v[0], v[1], v[2] - 0.5 * WIDTH),
            orientation: UnitQuaternion::rotation_between(&Vector3::z(), &axis).unwrap_or_default(),
            velocity: if v.len() > 8 { Vector3::new(v[6], v[7], v[8]) } else { Vector3::zeros() },
            spin: Vector3::zeros(),
        }
    });
    Scene {
        title: case.into(),
        seed: 1,
        gravity: Vector3::new(0.0, -9.81, 0.0),
        materials: vec![
            Material { name: "tablet".into(), shear_modulus: 1e6, poisson: 0.25 },
            Material { name: "steel".into(), shear_modulus: 3e6, poisson: 0.3 },
        ],
        pairs: PairTable::new(2, pair),
        shapes: vec![Shape {
            name: "tablet".into(),
            recipe,
            spheres: SphereBudget::Count(spheres),
            placement: Placement::Inscribed,
            panels: 0,
        }],
        batches: vec![],
        drum: Some(Drum {
            diameter: 0.2,
            width: WIDTH,
            speed: 22.0 * std::f64::consts::TAU / 60.0,
            material: 1,
            wall: Wall::Cylinder,
            facets: 90,
            axis_tilt: 0.0,
            baffles: None,
        }),
        bodies: bodies.collect(),
        boundaries: vec![],
        contact: ContactSettings::default(),
        time: Time {
            step: StepChoice::Fixed(dt.unwrap_or(step)),
            impact_speed: 0.3,
            settle: Settle::For(0.0),
            duration: 1.0,
            frame_interval: 0.02,
        },
        spray: None,
        outputs: Outputs {
            series_interval: 1.0,
            report: false,
            picture: false,
            statistics: false,
            energy: false,
            record: None,
        },
    }
}
