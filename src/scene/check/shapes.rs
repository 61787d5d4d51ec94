//! Tablet shapes.

use super::super::clump::{SphereBudget, SpheresSpec};
use super::super::fault::FaultKind;
use super::super::model::Shape;
use super::super::path::KeyPath;
use super::super::recipe::Recipe;
use super::super::spec::{Named, ShapeSpec};
use super::recipe::recipe;
use super::{Allowed, Checker};
use crate::units::Length;

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
    let written =
        c.need(&at.field("recipe"), spec.recipe, "a solid such as Sphere(..), Round(..) or Oval(..)");
    let recipe = written.map_or(Recipe::Sphere { diameter: f64::NAN }, |r| recipe(c, &at.field("recipe"), r));
    let (default, spheres) = match recipe {
        Recipe::Sphere { .. } => (1, Allowed::from(1.0).to(1.0)),
        Recipe::Round { .. } | Recipe::Pressed { .. } | Recipe::Mesh { .. } => {
            (SPHERES, Allowed::from(1.0).to(10_000.0))
        }
        Recipe::Clump { .. } => (0, Allowed::from(0.0).to(0.0)),
    };
    let panels = Allowed::from(20.0).to(1e6);
    Shape {
        spheres: self::spheres(c, &at.field("spheres"), spec.spheres, default, spheres),
        placement: spec.placement.unwrap_or_default(),
        panels: c.number_or(&at.field("panels"), spec.panels, PANELS as f64, panels) as usize,
        recipe,
        name,
    }
}

/// How many spheres; a bound of the error is for solids that are fitted.
fn spheres(
    c: &mut Checker<'_>,
    at: &KeyPath,
    spec: Option<SpheresSpec>,
    default: usize,
    allowed: Allowed,
) -> SphereBudget {
    match spec {
        None => SphereBudget::Count(default),
        Some(SpheresSpec::Count(count)) => SphereBudget::Count(c.count(at, Some(count), allowed)),
        Some(SpheresSpec::Error(error)) => {
            if default != SPHERES {
                c.fault(at, FaultKind::NotFitted);
            }
            SphereBudget::Error(c.number::<Length>(at, Some(error), Allowed::from(1e-6).to(1.0)))
        }
    }
}
