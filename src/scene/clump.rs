//! How a solid is to be made of spheres.

use crate::units::{Length, Whole};
use ron::value::RawValue;
use serde::de::{Deserialize, Deserializer, Error};

/// How many spheres a clump may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SphereBudget {
    /// Exactly so many.
    Count(usize),
    /// As many as it takes to come everywhere this near to the surface, m.
    Error(f64),
}

/// How a clump lies to the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Deserialize)]
pub enum Placement {
    /// All spheres inside.
    #[default]
    Inscribed,
    /// All radii larger by the mean distance of the inscribed clump, so that as much lies outside as is missing inside.
    Balanced,
}

/// `50`, `Count(50)` or `Error(Mm(0.1))`, as it is written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum SpheresSpec {
    Count(Whole),
    Error(Length),
}

#[derive(serde::Deserialize)]
#[serde(rename = "Spheres")]
enum Choice {
    Count(Whole),
    Error(Length),
}

impl<'de> Deserialize<'de> for SpheresSpec {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let written = <&RawValue>::deserialize(deserializer)?.trim();
        if let Ok(count) = written.into_rust::<Whole>() {
            return Ok(Self::Count(count));
        }
        match written.into_rust::<Choice>() {
            Ok(Choice::Count(count)) => Ok(Self::Count(count)),
            Ok(Choice::Error(error)) => Ok(Self::Error(error)),
            Err(_) => Err(D::Error::custom("expected a whole number, Count(..), or Error(..) with a length")),
        }
    }
}
