//! The scene file as it is written: the mirror that serde fills. `None` means that the file leaves the key out (or that
//! its value was refused, which has been told already). What is needed, allowed and assumed is decided in `check`.
//! `docs/scene.md` describes every key.

use super::clump::{Placement, SpheresSpec};
use crate::units::{
    Acceleration, Angle, AngularSpeed, Density, InertiaPerMass, Length, Mass, MassRate, Modulus, Number,
    Speed, TimeSpan, Triple, Whole,
};
use serde::Deserialize;
use serde::de::{Deserializer, MapAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;

#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, rename = "Scene")]
pub(super) struct SceneSpec {
    pub(super) format: Option<Whole>,
    pub(super) title: Option<String>,
    pub(super) seed: Option<Whole>,
    pub(super) gravity: Option<Triple<Acceleration>>,
    pub(super) materials: Option<Named<MaterialSpec>>,
    pub(super) pairs: Option<Vec<PairSpec>>,
    pub(super) shapes: Option<Named<ShapeSpec>>,
    pub(super) batches: Option<Vec<BatchSpec>>,
    pub(super) drum: Option<DrumSpec>,
    pub(super) bodies: Option<Vec<BodySpec>>,
    pub(super) boundaries: Option<Vec<BoundarySpec>>,
    pub(super) contact: Option<ContactSpec>,
    pub(super) time: Option<TimeSpec>,
    pub(super) spray: Option<SpraySpec>,
    pub(super) outputs: Option<OutputsSpec>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Material")]
pub(super) struct MaterialSpec {
    pub(super) shear_modulus: Option<Modulus>,
    pub(super) poisson: Option<Number>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Pair")]
pub(super) struct PairSpec {
    pub(super) between: Option<(String, String)>,
    pub(super) friction: Option<Number>,
    pub(super) restitution: Option<Number>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Shape")]
pub(super) struct ShapeSpec {
    pub(super) recipe: Option<RecipeSpec>,
    pub(super) spheres: Option<SpheresSpec>,
    pub(super) placement: Option<Placement>,
    pub(super) panels: Option<Whole>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Recipe")]
pub(super) enum RecipeSpec {
    Sphere {
        diameter: Option<Length>,
    },
    Round {
        diameter: Option<Length>,
        band: Option<Length>,
        cap: Option<CapSpec>,
    },
    Oval {
        length: Option<Length>,
        width: Option<Length>,
        fourth_harmonic: Option<Length>,
        band: Option<Length>,
        cap: Option<CapSpec>,
    },
    Almond {
        length: Option<Length>,
        width: Option<Length>,
        fourth_harmonic: Option<Length>,
        third_harmonic: Option<Length>,
        band: Option<Length>,
        cap: Option<CapSpec>,
    },
    Triangular {
        length: Option<Length>,
        width: Option<Length>,
        fourth_harmonic: Option<Length>,
        third_harmonic: Option<Length>,
        band: Option<Length>,
        cap: Option<CapSpec>,
    },
    Capsule {
        length: Option<Length>,
        width: Option<Length>,
        band: Option<Length>,
        cap: Option<CapSpec>,
    },
    Bullet {
        length: Option<Length>,
        width: Option<Length>,
        band: Option<Length>,
        cap: Option<CapSpec>,
    },
    HalfMoon {
        length: Option<Length>,
        width: Option<Length>,
        band: Option<Length>,
        cap: Option<CapSpec>,
    },
    Shield {
        length: Option<Length>,
        width: Option<Length>,
        band: Option<Length>,
        cap: Option<CapSpec>,
    },
    Mesh {
        file: Option<String>,
        unit: Option<Length>,
    },
    Clump {
        file: Option<String>,
        inertia_per_mass: Option<Triple<InertiaPerMass>>,
    },
}

#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Cap")]
pub(super) enum CapSpec {
    Spherical { height: Option<Length> },
    Compound { height: Option<Length>, exponent: Option<Number> },
    Bevelled { height: Option<Length>, width: Option<Length> },
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Batch")]
pub(super) struct BatchSpec {
    pub(super) shape: Option<String>,
    pub(super) material: Option<String>,
    pub(super) tablet_mass: Option<Mass>,
    pub(super) count: Option<Whole>,
    pub(super) mass: Option<Mass>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Drum")]
pub(super) struct DrumSpec {
    pub(super) diameter: Option<Length>,
    pub(super) width: Option<Length>,
    pub(super) speed: Option<AngularSpeed>,
    pub(super) material: Option<String>,
    pub(super) wall: Option<WallSpec>,
    pub(super) facets: Option<Whole>,
    pub(super) baffles: Option<BafflesSpec>,
    pub(super) axis_tilt: Option<Angle>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Wall")]
pub(super) enum WallSpec {
    Cylinder,
    Profile(Vec<(Length, Length)>),
    Mesh { file: Option<String>, unit: Option<Length> },
}

#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Baffles")]
pub(super) struct BafflesSpec {
    pub(super) count: Option<Whole>,
    pub(super) height: Option<Length>,
    pub(super) thickness: Option<Length>,
    pub(super) tilt: Option<Angle>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Body")]
pub(super) struct BodySpec {
    pub(super) shape: Option<String>,
    pub(super) material: Option<String>,
    pub(super) mass: Option<Mass>,
    pub(super) position: Option<Triple<Length>>,
    pub(super) orientation: Option<OrientationSpec>,
    pub(super) velocity: Option<Triple<Speed>>,
    pub(super) spin: Option<Triple<AngularSpeed>>,
    pub(super) poses: Option<String>,
}

/// `(x, y, z)` without a unit.
pub(super) type Direction = (Number, Number, Number);

#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Orientation")]
pub(super) enum OrientationSpec {
    AxisAngle { axis: Option<Direction>, angle: Option<Angle> },
    Quaternion { w: Option<Number>, x: Option<Number>, y: Option<Number>, z: Option<Number> },
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Boundary")]
pub(super) struct BoundarySpec {
    pub(super) surface: Option<SurfaceSpec>,
    pub(super) material: Option<String>,
    pub(super) velocity: Option<Triple<Speed>>,
    pub(super) spin: Option<Triple<AngularSpeed>>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Surface")]
pub(super) enum SurfaceSpec {
    Plane { point: Option<Triple<Length>>, normal: Option<Direction> },
    Box { min: Option<Triple<Length>>, max: Option<Triple<Length>> },
    Mesh { file: Option<String>, unit: Option<Length> },
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Contact")]
pub(super) struct ContactSpec {
    pub(super) mode: Option<ContactModeSpec>,
    pub(super) no_tension: Option<bool>,
    pub(super) tangential: Option<TangentialSpec>,
    pub(super) damping_mass: Option<DampingMassSpec>,
}

#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "ContactMode")]
pub(super) enum ContactModeSpec {
    HertzMindlin,
    Impulse { step: Option<TimeSpan> },
}

#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename = "Tangential")]
pub(super) enum TangentialSpec {
    Total,
    Incremental,
    Rescaled,
}

#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename = "DampingMass")]
pub(super) enum DampingMassSpec {
    Body,
    Contact,
}

#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, rename = "Time")]
pub(super) struct TimeSpec {
    pub(super) step: Option<StepSpec>,
    pub(super) impact_speed: Option<Speed>,
    #[serde(default)]
    pub(super) settle: SettleSpec,
    pub(super) duration: Option<TimeSpan>,
    pub(super) frame_interval: Option<TimeSpan>,
}

#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename = "Step")]
pub(super) enum StepSpec {
    PerContact(Number),
    Fixed(TimeSpan),
}

/// Not an `Option`, because `None` is one of the choices.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(rename = "Settle")]
pub(super) enum SettleSpec {
    #[default]
    #[serde(skip)]
    LeftOut,
    Auto,
    AutoWithin(TimeSpan),
    For(TimeSpan),
    None,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Spray")]
pub(super) struct SpraySpec {
    pub(super) spanwise: Option<Length>,
    pub(super) streamwise: Option<Length>,
    pub(super) distance: Option<Length>,
    pub(super) aim: Option<AimSpec>,
    pub(super) pixels: Option<(Whole, Whole)>,
    pub(super) deposit: Option<DepositSpec>,
    pub(super) footprint: Option<FootprintSpec>,
    pub(super) flux: Option<FluxSpec>,
    pub(super) rays: Option<RaysSpec>,
    pub(super) tilt: Option<TiltSpec>,
    pub(super) nozzles: Option<Vec<Length>>,
    pub(super) cycle: Option<CycleSpec>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Aim")]
pub(super) enum AimSpec {
    Bed,
    Fixed { target: Option<Triple<Length>>, normal: Option<Direction> },
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Deposit")]
pub(super) struct DepositSpec {
    pub(super) rate: Option<MassRate>,
    pub(super) solids: Option<Number>,
    pub(super) mean_thickness: Option<Length>,
    pub(super) film_density: Option<Density>,
}

#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename = "Footprint")]
pub(super) enum FootprintSpec {
    Rectangle,
    Ellipse,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Flux")]
pub(super) enum FluxSpec {
    Uniform,
    Gaussian { sigma: Option<Number> },
    Annular { inner: Option<Number> },
    Dumbbell { offset: Option<Number>, sigma: Option<Number> },
    Table { file: Option<String> },
}

#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename = "Rays")]
pub(super) enum RaysSpec {
    Parallel,
    Diverging,
}

#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, rename = "Tilt")]
pub(super) struct TiltSpec {
    pub(super) spanwise: Option<Angle>,
    pub(super) streamwise: Option<Angle>,
}

#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, rename = "Cycle")]
pub(super) struct CycleSpec {
    pub(super) on: Option<TimeSpan>,
    pub(super) off: Option<TimeSpan>,
}

#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, rename = "Outputs")]
pub(super) struct OutputsSpec {
    pub(super) series_interval: Option<TimeSpan>,
    pub(super) report: Option<bool>,
    pub(super) picture: Option<bool>,
    pub(super) statistics: Option<bool>,
    pub(super) energy: Option<bool>,
    pub(super) record: Option<RecordSpec>,
}

#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename = "Record")]
pub(super) enum RecordSpec {
    Compact,
    Exact,
}

/// A map's entries in the order of the file, which is the order of their indices in the scene.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Named<T>(pub(super) Vec<(String, T)>);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Named<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(NamedVisitor(PhantomData))
    }
}

struct NamedVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for NamedVisitor<T> {
    type Value = Named<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("named entries, {\"name\": (..)}")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Named<T>, A::Error> {
        let mut entries = Vec::new();
        while let Some(entry) = map.next_entry()? {
            entries.push(entry);
        }
        Ok(Named(entries))
    }
}
