//! V11, V12: oblique impact of a sphere on a plane. Set-up: Chung & Ooi 2011, test 4, and the materials of Kharaz, Gorham
//! & Salman 2001, Powder Technol. 120, 281 (MFiX DEM05). Expected: separate integrations of the same laws with 4e5 steps a
//! contact and the lever arm r; in gross sliding e_t = 1 − μ(1 + e)/tan θ and ω' = −5μ(1 + e) v cos θ/2r. Tolerance 0.2 %,
//! 2 % against the digitised curve of the paper (law A, 10 degrees and steeper). Deviation known: at 5 degrees and below
//! discrete elements do not follow the experiment (0.79 measured), whatever the law.

use super::support::{Single, law, near, run, set};
use nalgebra::Vector3;
use pancoat::scene::{ContactSettings, TangentialLaw};

const MASS: f64 = 4000.0 * 4.0 / 3.0 * std::f64::consts::PI * 2.5e-3 * 2.5e-3 * 2.5e-3;

/// Angle, law A without tangential dashpot, with it (as the scene runs it), law B, C, paper (0: none).
const TABLE: [(f64, f64, f64, f64, f64, f64); 6] = [
    (2.0, 1.00326, 0.98558, 0.95924, 0.87935, 0.0),
    (5.0, 0.95281, 0.95091, 0.89029, 0.86113, 0.0),
    (10.0, 0.69802, 0.70236, 0.71344, 0.71056, 0.687),
    (15.0, 0.62993, 0.63346, 0.62751, 0.63145, 0.624),
    (20.0, 0.62012, 0.62269, 0.60972, 0.62012, 0.616),
    (25.0, 0.63813, 0.63973, 0.62791, 0.63813, 0.634),
];
const SLIDING: [(f64, f64, f64, f64); 6] = [
    (30.0, 0.68449, -615.25, 0.684),
    (40.0, 0.78289, -544.26, 0.781),
    (50.0, 0.84714, -456.69, 0.845),
    (60.0, 0.89482, -355.24, 0.893),
    (70.0, 0.93369, -243.00, 0.932),
    (80.0, 0.96788, -123.37, 0.966),
];

fn of_scene(name: &str, degrees: f64, more: &[String]) -> (f64, f64) {
    let (s, c) = degrees.to_radians().sin_cos();
    let (vx, vy) = (3.9 * s, 3.9 * c);
    let time = 10.0 * c.powf(-0.2) * if name == "oblique_on_glass" { 1.4 } else { 1.0 };
    let set = set![
        "bodies[0].velocity=MPerS({vx}, -{vy}, 0)",
        "time.impact_speed=MPerS({vy})",
        "time.duration=Us({time})",
        "time.frame_interval=Us(1)",
    ];
    let set = [set.to_vec(), more.to_vec()].concat();
    let state = run(name, &set)[0];
    (state.velocity.x / vx, state.spin.z)
}

fn of_law(degrees: f64, tangential: TangentialLaw, dashpot: f64) -> (f64, f64) {
    let settings = ContactSettings { tangential, ..ContactSettings::default() };
    let (s, c) = degrees.to_radians().sin_cos();
    let single = Single {
        radius: 2.5e-3,
        mass: MASS,
        law: law((380e9 / 2.46, 0.23), (1e18, 0.23), 0.092, 0.98, settings),
        tangential_dashpot: dashpot,
        velocity: Vector3::new(3.9 * s, -3.9 * c, 0.0),
        spin: 0.0,
        steps: 20_000.0,
    };
    let (v, w, _) = single.collide();
    (v.x / (3.9 * s), w)
}

#[test]
fn sticking_tells_the_tangential_law() {
    for (degrees, a, with_dashpot, b, c, paper) in TABLE {
        let what = |law: &str| format!("{law} at {degrees} degrees");
        near(of_law(degrees, TangentialLaw::Total, 0.0).0, a, 2e-3, &what("A"));
        near(of_law(degrees, TangentialLaw::Incremental, 0.0).0, b, 2e-3, &what("B"));
        near(of_law(degrees, TangentialLaw::Rescaled, 0.0).0, c, 2e-3, &what("C"));
        near(of_scene("oblique_impact", degrees, &[]).0, with_dashpot, 2e-3, &what("A of the scene"));
        for (name, tangential) in
            [("Incremental", TangentialLaw::Incremental), ("Rescaled", TangentialLaw::Rescaled)]
        {
            let found = of_scene("oblique_impact", degrees, &set!["contact=(tangential: {name})"]).0;
            near(found, of_law(degrees, tangential, 1.0).0, 2e-3, &what(name));
        }
        if paper > 0.0 {
            near(of_law(degrees, TangentialLaw::Total, 0.0).0, paper, 2e-2, &what("the paper"));
        }
    }
}

#[test]
fn spins_of_law_a() {
    for (degrees, spin) in
        [(5.0, -16.04), (10.0, -204.51), (15.0, -373.55), (20.0, -506.72), (25.0, -596.43), (28.0, -620.25)]
    {
        near(of_law(degrees, TangentialLaw::Total, 0.0).1, spin, 5e-3, "spin");
    }
}

#[test]
fn gross_sliding_follows_coulomb() {
    for (degrees, e_t, spin, paper) in SLIDING {
        let (found, turning) = of_scene("oblique_impact", degrees, &[]);
        near(found, e_t, 2e-3, "e_t");
        near(turning, spin, 2e-3, "spin");
        near(found, paper, 2e-2, "the paper");
        let exact = 1.0 - 0.092 * 1.98 / degrees.to_radians().tan();
        near(found, exact, 1e-3, "Coulomb");
    }
}

#[test]
fn alumina_on_glass() {
    for (degrees, e_t) in [(5.0, 0.9488), (10.0, 0.6970), (15.0, 0.6286), (20.0, 0.6185), (25.0, 0.6361)] {
        near(of_scene("oblique_on_glass", degrees, &[]).0, e_t, 2e-3, "e_t");
    }
    for (degrees, e_t) in [(30.0, 0.6813), (45.0, 0.8160), (60.0, 0.8938)] {
        near(of_scene("oblique_on_glass", degrees, &[]).0, e_t, 2e-3, "e_t, sliding");
    }
}
