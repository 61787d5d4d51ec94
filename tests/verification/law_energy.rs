//! V21: no frictional collision gains energy: E_out ≤ E_in (1 + 1e-6), over angles, friction, spins of both signs and all
//! laws (first law of thermodynamics; LAMMPS once gained 34 % at μ 0.5 and 76 degrees). Without friction nothing turns.
//! A sticking impact beside LAMMPS 29Sep2021 (`scenes/verification/lammps_v21.in` at a step of 1e-10 s): 5e-6 of speed and spin.
//! Deviation known: LAMMPS has the tangential dashpot inside the cap of friction also while sliding, here it acts uncapped and
//! while sticking only (as in LIGGGHTS and MUSEN), which is 5e-4 of v_x; checked against a separate integration of that rule.

use super::support::{Single, law, near};
use nalgebra::Vector3;
use pancoat::scene::{ContactSettings, TangentialLaw};

#[test]
fn collisions_gain_nothing() {
    let laws = [TangentialLaw::Total, TangentialLaw::Incremental, TangentialLaw::Rescaled];
    let mut tried = 0;
    for tangential in laws {
        for friction in [0.0, 0.05, 0.5, 1.0, 1.5, 10.0] {
            for degrees in [0.0, 1.0, 5.0, 20.0, 45.0, 70.0, 76.0, 85.0, 89.0_f64] {
                for (spin, restitution) in
                    [(0.0, 1.0), (300.0, 1.0), (-300.0, 1.0), (300.0, 0.5), (-300.0, 0.9)]
                {
                    let (s, c) = degrees.to_radians().sin_cos();
                    let settings = ContactSettings { tangential, ..ContactSettings::default() };
                    let single = Single {
                        radius: 2e-3,
                        mass: 1.3e-3,
                        law: law((1e6, 0.25), (3e6, 0.3), friction, restitution, settings),
                        tangential_dashpot: 1.0,
                        velocity: Vector3::new(s, -c, 0.0),
                        spin,
                        steps: 2_000.0,
                    };
                    let (v, w, _) = single.collide();
                    let energy = |v: Vector3<f64>, w: f64| 0.5 * v.norm_squared() + 0.2 * 4e-6 * w * w;
                    let (before, after) = (energy(single.velocity, spin), energy(v, w));
                    assert!(
                        after <= before * (1.0 + 1e-6),
                        "{tangential:?} {friction} {degrees} {spin}: {}",
                        after / before - 1.0
                    );
                    if friction == 0.0 {
                        assert_eq!(w, spin, "nothing turns it");
                    }
                    tried += 1;
                }
            }
        }
    }
    assert_eq!(tried, 3 * 6 * 9 * 5);
}

/// A tablet's material on steel at 45 degrees, elastic: rebound comes to that of sticking throughout. Separate integrations of the
/// three laws with 4e5 steps a contact.
#[test]
fn much_friction_sticks() {
    for (tangential, expected) in [
        (TangentialLaw::Total, [0.92205, 0.99698, 0.99723, 0.99723]),
        (TangentialLaw::Incremental, [0.87700, 0.92019, 0.98179, 0.99655]),
        (TangentialLaw::Rescaled, [0.85003, 0.86653, 0.87378, 0.87398]),
    ] {
        for (friction, expected) in [1.0, 1.5, 10.0, 1000.0].into_iter().zip(expected) {
            let settings = ContactSettings { tangential, ..ContactSettings::default() };
            let single = Single {
                radius: 2e-3,
                mass: 1.3e-3,
                law: law((1e6, 0.25), (3e6, 0.3), friction, 1.0, settings),
                tangential_dashpot: 1.0,
                velocity: Vector3::new(0.3, -0.3, 0.0),
                spin: 0.0,
                steps: 200_000.0,
            };
            near(single.collide().0.x / 0.3, expected, 2e-5, &format!("{tangential:?} {friction}"));
        }
    }
}

/// The tangential dashpot, of the normal one; v_x, m/s, and spin, rad/s, after the impact.
#[test]
fn sticking_as_in_lammps() {
    let aluminium = (70e9 / (2.0 * 1.33), 0.33);
    let law = law(aluminium, aluminium, 0.092, 0.98, ContactSettings::default());
    // Dashpots are as the roots of S_t = 8 G* a and S_n = 2 E* a.
    let as_normal = 0.5 * (law.effective_modulus / law.effective_shear).sqrt();
    for (dashpot, speed, spin) in [(0.0, 0.342_876_4, 157.123_58), (0.5, 0.344_215_8, 155.784_18)] {
        let single = Single {
            radius: 2.5e-3,
            mass: 2700.0 * 4.0 / 3.0 * std::f64::consts::PI * 2.5e-3_f64.powi(3),
            law,
            tangential_dashpot: dashpot * as_normal,
            velocity: Vector3::new(0.5, -2.9876, 0.0),
            spin: 0.0,
            steps: 1e6,
        };
        let (v, w, _) = single.collide();
        near(v.y, 2.927_848, 1e-6, "normal speed");
        near(v.x, speed, 5e-6, "v_x");
        near(-w, spin, 5e-6, "spin");
    }
}
