//! Tablet shapes.

use super::super::fault::FaultKind;
use super::super::model::{Cap, Recipe, Shape};
use super::super::path::KeyPath;
use super::super::spec::{CapSpec, Named, RecipeSpec, ShapeSpec};
use super::{Allowed, Checker};
use crate::units::Quantity;

/// Lengths of tablets, m.
const TABLET_LENGTH: Allowed = Allowed::from(1e-6).to(1.0);

/// Spheres a clump has unless the scene says otherwise.
const SPHERES: usize = 50;

/// Panels a shape has unless the scene says otherwise: those of the paper's round tablet, about 0.35 mm² each.
const PANELS: usize = 1700;

pub(super) fn shapes(c: &mut Checker<'_>, spec: Option<Named<ShapeSpec>>) -> Vec<Shape> {
    let at = KeyPath::default().field("shapes");
    let entries = spec.map_or(Vec::new(), |named| named.0);
    entries.into_iter().map(|(name, spec)| shape(c, &at.field(&name), name, spec)).collect()
}

fn shape(c: &mut Checker<'_>, at: &KeyPath, name: String, spec: ShapeSpec) -> Shape {
    let recipe = c.need(&at.field("recipe"), spec.recipe, "Sphere(..), Round(..) or Clump(..)");
    let recipe =
        recipe.map_or(Recipe::Sphere { diameter: f64::NAN }, |r| self::recipe(c, &at.field("recipe"), r));
    let (default, spheres) = match recipe {
        Recipe::Sphere { .. } => (1, Allowed::from(1.0).to(1.0)),
        Recipe::Round { .. } => (SPHERES, Allowed::from(1.0).to(10_000.0)),
        Recipe::Clump { .. } => (0, Allowed::from(0.0).to(0.0)),
    };
    let panels = Allowed::from(20.0).to(1e6);
    Shape {
        spheres: c.number_or(&at.field("spheres"), spec.spheres, default as f64, spheres) as usize,
        panels: c.number_or(&at.field("panels"), spec.panels, PANELS as f64, panels) as usize,
        recipe,
        name,
    }
}

fn recipe(c: &mut Checker<'_>, at: &KeyPath, spec: RecipeSpec) -> Recipe {
    match spec {
        RecipeSpec::Sphere { diameter } => {
            Recipe::Sphere { diameter: c.number(&at.field("diameter"), diameter, TABLET_LENGTH) }
        }
        RecipeSpec::Round { diameter, band, cap } => Recipe::Round {
            diameter: c.number(&at.field("diameter"), diameter, TABLET_LENGTH),
            band: c.number(&at.field("band"), band, Allowed::from(0.0).to(1.0)),
            cap: match c.need(&at.field("cap"), cap, "Spherical(..) or Compound(..)") {
                Some(cap) => self::cap(c, &at.field("cap"), cap, diameter.map_or(f64::NAN, Quantity::si)),
                None => Cap::Spherical { height: f64::NAN },
            },
        },
        RecipeSpec::Clump { file, inertia_per_mass } => {
            let path = at.field("inertia_per_mass");
            let inertia = match c.need(&path, inertia_per_mass, "three principal moments, Mm2(x, y, z)") {
                Some(moments) => moments.si(),
                None => [1.0; 3],
            };
            let largest = inertia.iter().copied().fold(0.0, f64::max);
            // Each principal moment is at most the sum of the other two; the least is that of a needle.
            let possible = inertia.iter().all(|&i| i > 1e-8 * largest)
                && 2.0 * largest <= (1.0 + 1e-9) * inertia.iter().sum::<f64>();
            if !possible {
                c.fault(&path, FaultKind::Inertia);
            }
            Recipe::Clump { path: c.file(&at.field("file"), file), inertia_per_mass: inertia }
        }
    }
}

fn cap(c: &mut Checker<'_>, at: &KeyPath, spec: CapSpec, diameter: f64) -> Cap {
    match spec {
        CapSpec::Spherical { height } => {
            // Above a hemisphere the cap would bulge over the band.
            let highest = if diameter.is_nan() { 1.0 } else { diameter / 2.0 };
            Cap::Spherical { height: c.number(&at.field("height"), height, Allowed::above(0.0).to(highest)) }
        }
        CapSpec::Compound { height, exponent } => Cap::Compound {
            height: c.number(&at.field("height"), height, Allowed::above(0.0).to(1.0)),
            exponent: c.number(&at.field("exponent"), exponent, Allowed::above(1.0).to(50.0)),
        },
    }
}
