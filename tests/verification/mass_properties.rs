//! V32: volume and inertia. Two overlapping spheres R = 1 at distance d: V = 2·4/3π − π(4 + d)(2 − d)²/12, and the moments of
//! the union of the clump, which sums over spheres would miss by 4 to 18 %; tolerance of the union's numerical integration
//! 3e-3. Round biconvex tablet (a 5, band 3, cap 1 mm): closed forms, 1e-8.

use super::support::near;
use nalgebra::Vector3;
use pancoat::scene::{Cap, Placement, Recipe, Shape, SphereBudget};
use pancoat::shapes::{Clump, Sphere, TabletShape};

#[test]
fn union_of_two_spheres() {
    for (d, volume, axial, across) in [
        (1.0, 7.068_583_470_577, 3.004_147_974_995, 5.213_080_309_551),
        (1.5, 8.017_606_251_349, 3.297_240_570_867, 8.032_639_263_071),
    ] {
        let sphere = |x: f64| Sphere { center: Vector3::new(x, 0.0, 0.0), radius: 1.0 };
        let (mass, _) = Clump { spheres: vec![sphere(-d / 2.0), sphere(d / 2.0)] }.union();
        near(mass.volume, volume, 3e-3, "volume");
        near(mass.volume * mass.inertia_per_mass[(0, 0)], axial, 3e-3, "along");
        near(mass.volume * mass.inertia_per_mass[(1, 1)], across, 3e-3, "across");
    }
}

#[test]
fn round_biconvex_tablet() {
    let cap = Cap::Spherical { height: 1e-3 };
    let recipe = Recipe::Round { diameter: 10e-3, band: 3e-3, cap };
    let spheres = SphereBudget::Count(1);
    let shape = Shape { name: "round".into(), recipe, spheres, placement: Placement::Inscribed, panels: 20 };
    let tablet = TabletShape::build(&shape, false).expect("is a tablet");
    near(tablet.volume, 315.206_463e-9, 1e-8, "volume");
    near(tablet.area, 257.610_598e-6, 1e-8, "area");
    let moments = tablet.inertia_per_mass * tablet.volume;
    near(moments.z, 3_612.936_27e-15, 1e-8, "I_z");
    near(moments.x, 2_255.768_25e-15, 1e-8, "I_x");
}
