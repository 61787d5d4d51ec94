//! Recipes of tablets.

use super::super::fault::FaultKind;
use super::super::path::KeyPath;
use super::super::recipe::{Cap, Outline, Recipe};
use super::super::spec::{CapSpec, RecipeSpec};
use super::{Allowed, Checker};
use crate::units::{InertiaPerMass, Length, Triple};

/// Lengths of tablets, m.
const TABLET_LENGTH: Allowed = Allowed::from(1e-6).to(1.0);

/// Coefficients of outlines, m; what is too much for an outline, [`Recipe::fault`] says.
const HARMONIC: Allowed = Allowed::from(-1.0).to(1.0);

/// The recipe at `at`. What its numbers make together is checked if each of them is allowed.
pub(super) fn recipe(c: &mut Checker<'_>, at: &KeyPath, spec: RecipeSpec) -> Recipe {
    let mut tablet = Tablet { c, at };
    let recipe = match spec {
        RecipeSpec::Sphere { diameter } => Recipe::Sphere { diameter: tablet.length("diameter", diameter) },
        RecipeSpec::Round { diameter, band, cap } => {
            let diameter = tablet.length("diameter", diameter);
            Recipe::Round { diameter, band: tablet.band(band), cap: tablet.cap(cap, diameter / 2.0) }
        }
        RecipeSpec::Oval { length, width, fourth_harmonic, band, cap } => {
            let (length, width) = tablet.size(length, width);
            let fourth_harmonic = tablet.fourth_harmonic(fourth_harmonic);
            tablet.pressed(Outline::Oval { length, width, fourth_harmonic }, band, cap)
        }
        RecipeSpec::Almond { length, width, fourth_harmonic, third_harmonic, band, cap } => {
            let (length, width) = tablet.size(length, width);
            let fourth_harmonic = tablet.fourth_harmonic(fourth_harmonic);
            let third_harmonic = tablet.third_harmonic(third_harmonic);
            tablet.pressed(Outline::Almond { length, width, fourth_harmonic, third_harmonic }, band, cap)
        }
        RecipeSpec::Triangular { length, width, fourth_harmonic, third_harmonic, band, cap } => {
            let (length, width) = tablet.size(length, width);
            let fourth_harmonic = tablet.fourth_harmonic(fourth_harmonic);
            let third_harmonic = tablet.third_harmonic(third_harmonic);
            tablet.pressed(Outline::Triangular { length, width, fourth_harmonic, third_harmonic }, band, cap)
        }
        RecipeSpec::Capsule { length, width, band, cap } => {
            let (length, width) = tablet.size(length, width);
            tablet.pressed(Outline::Capsule { length, width }, band, cap)
        }
        RecipeSpec::Bullet { length, width, band, cap } => {
            let (length, width) = tablet.size(length, width);
            tablet.pressed(Outline::Bullet { length, width }, band, cap)
        }
        RecipeSpec::HalfMoon { length, width, band, cap } => {
            let (length, width) = tablet.size(length, width);
            tablet.pressed(Outline::HalfMoon { length, width }, band, cap)
        }
        RecipeSpec::Shield { length, width, band, cap } => {
            let (length, width) = tablet.size(length, width);
            tablet.pressed(Outline::Shield { length, width }, band, cap)
        }
        RecipeSpec::Mesh { file, unit } => Recipe::Mesh {
            path: c.file(&at.field("file"), file),
            scale: c.number(&at.field("unit"), unit, TABLET_LENGTH),
        },
        RecipeSpec::Clump { file, inertia_per_mass } => Recipe::Clump {
            path: c.file(&at.field("file"), file),
            inertia_per_mass: inertia(c, &at.field("inertia_per_mass"), inertia_per_mass),
        },
    };
    if !c.told(at)
        && let Some(fault) = recipe.fault()
    {
        c.fault(at, FaultKind::Impossible(fault));
    }
    recipe
}

/// The numbers of a tablet by its dimensions.
struct Tablet<'c, 'f> {
    c: &'c mut Checker<'f>,
    at: &'c KeyPath,
}

impl Tablet<'_, '_> {
    fn length(&mut self, name: &str, value: Option<Length>) -> f64 {
        self.c.number(&self.at.field(name), value, TABLET_LENGTH)
    }

    fn size(&mut self, length: Option<Length>, width: Option<Length>) -> (f64, f64) {
        (self.length("length", length), self.length("width", width))
    }

    fn fourth_harmonic(&mut self, value: Option<Length>) -> f64 {
        self.c.number_or(&self.at.field("fourth_harmonic"), value, 0.0, HARMONIC)
    }

    fn third_harmonic(&mut self, value: Option<Length>) -> f64 {
        self.c.number(&self.at.field("third_harmonic"), value, HARMONIC)
    }

    fn band(&mut self, value: Option<Length>) -> f64 {
        self.c.number(&self.at.field("band"), value, Allowed::from(0.0).to(1.0))
    }

    fn pressed(&mut self, outline: Outline, band: Option<Length>, cap: Option<CapSpec>) -> Recipe {
        Recipe::Pressed { outline, band: self.band(band), cap: self.cap(cap, outline.mean_radius()) }
    }

    /// The cap over a band of this radius (m), which may be NaN.
    fn cap(&mut self, spec: Option<CapSpec>, radius: f64) -> Cap {
        let (c, at) = (&mut *self.c, self.at.field("cap"));
        let radius = if radius.is_nan() { 1.0 } else { radius };
        let Some(spec) = c.need(&at, spec, "Spherical(..), Compound(..) or Bevelled(..)") else {
            return Cap::Spherical { height: f64::NAN };
        };
        let mut height =
            |value, lowest: Allowed, highest| c.number(&at.field("height"), value, lowest.to(highest));
        match spec {
            // Above a hemisphere the cap would bulge over the band.
            CapSpec::Spherical { height: h } => {
                Cap::Spherical { height: height(h, Allowed::from(0.0), radius) }
            }
            CapSpec::Compound { height: h, exponent } => Cap::Compound {
                height: height(h, Allowed::above(0.0), 1.0),
                exponent: c.number(&at.field("exponent"), exponent, Allowed::above(1.0).to(50.0)),
            },
            CapSpec::Bevelled { height: h, width } => Cap::Bevelled {
                height: height(h, Allowed::above(0.0), 1.0),
                width: c.number(&at.field("width"), width, Allowed::above(0.0).below(radius)),
            },
        }
    }
}

/// Principal moments over mass, m².
fn inertia(c: &mut Checker<'_>, at: &KeyPath, moments: Option<Triple<InertiaPerMass>>) -> [f64; 3] {
    let moments = match c.need(at, moments, "three principal moments, Mm2(x, y, z)") {
        Some(moments) => moments.si(),
        None => return [1.0; 3],
    };
    let largest = moments.iter().copied().fold(0.0, f64::max);
    // Each principal moment is at most the sum of the other two; the least is that of a needle.
    let possible = moments.iter().all(|&i| i > 1e-8 * largest)
        && 2.0 * largest <= (1.0 + 1e-9) * moments.iter().sum::<f64>();
    if !possible {
        c.fault(at, FaultKind::Inertia);
    }
    moments
}
