//! Unit-carrying numbers of scene files, turned to SI.
//!
//! A scene writes `Mm(15.9)`, `Rpm(22)` or `MPa(1)`; reading gives a [`Length`], an [`AngularSpeed`] or a [`Modulus`]
//! that holds the SI number. A bare number, a unit of another quantity, an infinity or a NaN is refused with the list
//! of units that the quantity has. Ranges are not checked here: they depend on what the number is for.

use serde::de::{
    Deserialize, DeserializeSeed, Deserializer, EnumAccess, Error, SeqAccess, VariantAccess, Visitor,
};
use std::f64::consts::{PI, TAU};
use std::fmt;
use std::marker::PhantomData;

/// A unit: one of it is `times / over` in SI. Two numbers, so that `Mm(15.9)` is 15.9 / 1000, rounded once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// Name in scene files.
    pub name: &'static str,
    times: f64,
    over: f64,
}

impl Unit {
    /// `value` of this unit, in SI.
    pub fn to_si(self, value: f64) -> f64 {
        value * self.times / self.over
    }

    /// `value` in SI, in this unit.
    pub fn of_si(self, value: f64) -> f64 {
        value * self.over / self.times
    }
}

/// A finite number with a dimension, held in SI.
pub trait Quantity: Copy {
    /// What the number is, with its article: `a length`.
    const WHAT: &'static str;
    /// The units a scene may use, the usual one first.
    const UNITS: &'static [Unit];

    /// Takes a number in SI.
    fn from_si(value: f64) -> Self;

    /// The number in SI.
    fn si(self) -> f64;
}

macro_rules! quantities {
    ($($name:ident, $what:literal, $si:literal: { $($unit:ident = $times:tt / $over:tt),+ })*) => {$(
        #[doc = concat!("In SI: ", $si, ".")]
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub struct $name(f64);

        impl Quantity for $name {
            const WHAT: &'static str = $what;
            const UNITS: &'static [Unit] = &[$(Unit { name: stringify!($unit), times: $times, over: $over }),+];

            fn from_si(value: f64) -> Self {
                Self(value)
            }

            fn si(self) -> f64 {
                self.0
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer
                    .deserialize_enum(stringify!($name), &[], WithUnit::<Self>(PhantomData))
                    .map_err(|_| D::Error::custom(format_args!("expected {}", WithUnit::<Self>(PhantomData))))
            }
        }
    )*};
}

quantities! {
    Length, "a length", "m": { Mm = 1.0 / 1e3, Um = 1.0 / 1e6, Cm = 1.0 / 1e2, M = 1.0 / 1.0, Inch = 0.0254 / 1.0 }
    Mass, "a mass", "kg": { Mg = 1.0 / 1e6, G = 1.0 / 1e3, Kg = 1.0 / 1.0 }
    Angle, "an angle", "rad": { Deg = PI / 180.0, Rad = 1.0 / 1.0 }
    Speed, "a speed", "m/s": { MPerS = 1.0 / 1.0, MmPerS = 1.0 / 1e3 }
    AngularSpeed, "an angular speed", "rad/s": { Rpm = TAU / 60.0, RadPerS = 1.0 / 1.0, DegPerS = PI / 180.0 }
    Acceleration, "an acceleration", "m/s²": { MPerS2 = 1.0 / 1.0 }
    Modulus, "a modulus", "Pa": { MPa = 1e6 / 1.0, Pa = 1.0 / 1.0, KPa = 1e3 / 1.0, GPa = 1e9 / 1.0 }
    TimeSpan, "a time", "s": { S = 1.0 / 1.0, Ms = 1.0 / 1e3, Us = 1.0 / 1e6, Min = 60.0 / 1.0, H = 3600.0 / 1.0 }
    MassRate, "a mass rate", "kg/s": { GPerMin = 1.0 / 6e4, GPerS = 1.0 / 1e3, KgPerS = 1.0 / 1.0 }
    Density, "a density", "kg/m³": { KgPerM3 = 1.0 / 1.0, GPerCm3 = 1e3 / 1.0 }
    InertiaPerMass, "an inertia per mass", "m²": { Mm2 = 1.0 / 1e6, M2 = 1.0 / 1.0 }
}

/// Reads `Unit(number)`.
struct WithUnit<Q>(PhantomData<Q>);

impl<Q: Quantity> fmt::Display for WithUnit<Q> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} with its unit: ", Q::WHAT)?;
        list_units(f, Q::UNITS, "(..)")
    }
}

impl<'de, Q: Quantity> Visitor<'de> for WithUnit<Q> {
    type Value = Q;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }

    fn visit_enum<A: EnumAccess<'de>>(self, data: A) -> Result<Q, A::Error> {
        let (unit, content) = data.variant_seed(UnitOf(Q::UNITS))?;
        Ok(Q::from_si(unit.to_si(finite(content.newtype_variant()?)?)))
    }
}

fn list_units(f: &mut fmt::Formatter<'_>, units: &[Unit], after: &str) -> fmt::Result {
    for (i, unit) in units.iter().enumerate() {
        let separator = match i {
            0 => "",
            _ if i + 1 == units.len() => " or ",
            _ => ", ",
        };
        write!(f, "{separator}{}{after}", unit.name)?;
    }
    Ok(())
}

fn finite<E: Error>(value: f64) -> Result<f64, E> {
    if value.is_finite() { Ok(value) } else { Err(E::custom("not finite")) }
}

/// Finds the unit of a name.
struct UnitOf(&'static [Unit]);

impl<'de> DeserializeSeed<'de> for UnitOf {
    type Value = Unit;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Unit, D::Error> {
        deserializer.deserialize_identifier(self)
    }
}

impl Visitor<'_> for UnitOf {
    type Value = Unit;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        list_units(f, self.0, "")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<Unit, E> {
        self.0.iter().copied().find(|unit| unit.name == name).ok_or_else(|| E::custom("unknown unit"))
    }
}

/// Three components of one quantity, written `Mm(1, 2, 3)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triple<Q>([f64; 3], PhantomData<Q>);

impl<Q> Triple<Q> {
    /// The components in SI.
    pub fn si(self) -> [f64; 3] {
        self.0
    }
}

impl<'de, Q: Quantity> Deserialize<'de> for Triple<Q> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let visitor = TripleVisitor::<Q>(PhantomData);
        deserializer
            .deserialize_enum("Triple", &[], visitor)
            .map_err(|_| D::Error::custom(format_args!("expected {}", TripleVisitor::<Q>(PhantomData))))
    }
}

struct TripleVisitor<Q>(PhantomData<Q>);

impl<Q: Quantity> fmt::Display for TripleVisitor<Q> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "three numbers, each {}, with their unit: ", Q::WHAT)?;
        list_units(f, Q::UNITS, "(x, y, z)")
    }
}

impl<'de, Q: Quantity> Visitor<'de> for TripleVisitor<Q> {
    type Value = Triple<Q>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }

    fn visit_enum<A: EnumAccess<'de>>(self, data: A) -> Result<Triple<Q>, A::Error> {
        let (unit, content) = data.variant_seed(UnitOf(Q::UNITS))?;
        let numbers = content.tuple_variant(3, ThreeNumbers)?;
        Ok(Triple(numbers.map(|x| unit.to_si(x)), PhantomData))
    }
}

struct ThreeNumbers;

impl<'de> Visitor<'de> for ThreeNumbers {
    type Value = [f64; 3];

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("three numbers")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut numbers: A) -> Result<[f64; 3], A::Error> {
        let mut triple = [0.0; 3];
        for (i, slot) in triple.iter_mut().enumerate() {
            let number = numbers.next_element()?.ok_or_else(|| A::Error::invalid_length(i, &self))?;
            *slot = finite(number)?;
        }
        Ok(triple)
    }
}

/// A dimensionless finite number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Number(f64);

impl Quantity for Number {
    const WHAT: &'static str = "a plain number";
    const UNITS: &'static [Unit] = &[];

    fn from_si(value: f64) -> Self {
        Self(value)
    }

    fn si(self) -> f64 {
        self.0
    }
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = f64::deserialize(deserializer).and_then(finite);
        value.map(Self).map_err(|_| D::Error::custom("expected a number"))
    }
}

/// A dimensionless whole number of at most 2⁵³ in magnitude, so that reading it as a number is exact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Whole(f64);

impl Whole {
    const LARGEST: f64 = 9_007_199_254_740_992.0;
}

impl Quantity for Whole {
    const WHAT: &'static str = "a whole number";
    const UNITS: &'static [Unit] = &[];

    fn from_si(value: f64) -> Self {
        Self(value)
    }

    fn si(self) -> f64 {
        self.0
    }
}

impl<'de> Deserialize<'de> for Whole {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match f64::deserialize(deserializer) {
            Ok(value) if value.fract() == 0.0 && value.abs() <= Self::LARGEST => Ok(Self(value)),
            _ => Err(D::Error::custom("expected a whole number")),
        }
    }
}
