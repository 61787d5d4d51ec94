//! Units of scene files as serde reads them.

use pancoat::units::*;
use serde::Deserialize;
use std::f64::consts::{PI, TAU};

fn read<T: for<'de> Deserialize<'de>>(text: &str) -> Result<T, String> {
    ron::from_str(text).map_err(|fault| fault.code.to_string())
}

#[test]
fn units_turn_to_si() {
    assert_eq!(read::<Length>("Mm(15.9)").map(Length::si), Ok(0.0159));
    assert_eq!(read::<Length>("Inch(1)").map(Length::si), Ok(0.0254));
    let turns = read::<AngularSpeed>("Rpm(60)").expect("has a unit").si();
    approx::assert_relative_eq!(turns, TAU, max_relative = 1e-15);
    assert_eq!(read::<Angle>("Deg(180)").map(Angle::si), Ok(PI));
    assert_eq!(read::<MassRate>("GPerMin(7.5)").map(MassRate::si), Ok(1.25e-4));
    assert_eq!(read::<Density>("GPerCm3(1.3)").map(Density::si), Ok(1300.0));
    assert_eq!(read::<Triple<Length>>("Cm(1, -2, 3e1)").map(Triple::si), Ok([0.01, -0.02, 0.3]));
    assert_eq!(read::<Whole>("1e3").map(Whole::si), Ok(1000.0));
}

#[test]
fn what_has_no_unit_or_a_wrong_one_is_refused_with_the_units_there_are() {
    let modulus = "expected a modulus with its unit: MPa(..), Pa(..), KPa(..) or GPa(..)";
    for text in ["1e6", "Mm(1)", "MPa", "MPa()", "MPa(1, 2)", "MPa(\"1\")", "MPa(NaN)", "\"MPa(1)\"", "(1)"] {
        assert_eq!(read::<Modulus>(text).map(Modulus::si), Err(modulus.to_owned()), "{text}");
    }
    for text in ["Mm(1, 2)", "Mm(1, 2, inf)", "(1, 2, 3)", "Mm(1)", "Kg(1, 2, 3)"] {
        assert!(read::<Triple<Length>>(text).is_err(), "{text}");
    }
    for text in ["1.5", "1e300", "Mm(1)", "true", "NaN"] {
        assert_eq!(read::<Whole>(text).map(Whole::si), Err("expected a whole number".to_owned()), "{text}");
    }
}
