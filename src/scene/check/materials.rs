//! Materials and the properties of their pairs.

use super::super::fault::FaultKind;
use super::super::model::{Material, PairProperties, PairTable, Scene};
use super::super::path::KeyPath;
use super::super::spec::{MaterialSpec, Named, PairSpec};
use super::{Allowed, Checker};
use std::collections::BTreeSet;

/// Shear moduli from foam to rigid walls (diamond: 5e11 Pa).
const SHEAR_MODULUS: Allowed = Allowed::above(0.0).to(1e20);

/// Poisson's ratio of a stable isotropic solid.
const POISSON: Allowed = Allowed::above(-1.0).to(0.5);

const FRICTION: Allowed = Allowed::from(0.0).to(10.0);

/// 0 is left out: the damping ratio of Hertz contacts, −ln e / √(ln² e + π²), has no value there.
const RESTITUTION: Allowed = Allowed::above(0.0).to(1.0);

/// The table, and which pairs the file gives (smaller index first).
pub(super) struct Pairs {
    pub(super) table: PairTable,
    pub(super) given: BTreeSet<(usize, usize)>,
}

pub(super) fn materials(c: &mut Checker<'_>, spec: Option<Named<MaterialSpec>>) -> Vec<Material> {
    let at = KeyPath::default().field("materials");
    let entries = c.need(&at, spec, "at least one material").map_or(Vec::new(), |named| named.0);
    let material = |(name, spec): (String, MaterialSpec)| {
        let at = at.field(&name);
        Material {
            shear_modulus: c.number(&at.field("shear_modulus"), spec.shear_modulus, SHEAR_MODULUS),
            poisson: c.number(&at.field("poisson"), spec.poisson, POISSON),
            name,
        }
    };
    entries.into_iter().map(material).collect()
}

pub(super) fn pairs(c: &mut Checker<'_>, specs: Vec<PairSpec>, materials: &[Material]) -> Pairs {
    // Pairs that cannot touch keep this; those that can must be given.
    let untouched = PairProperties { friction: 0.0, restitution: 1.0 };
    let mut table = PairTable::new(materials.len(), untouched);
    let mut given = BTreeSet::new();
    for (i, spec) in specs.into_iter().enumerate() {
        let at = Checker::item("pairs", i);
        let properties = PairProperties {
            friction: c.number(&at.field("friction"), spec.friction, FRICTION),
            restitution: c.number(&at.field("restitution"), spec.restitution, RESTITUTION),
        };
        let at = at.field("between");
        let Some((a, b)) = c.need(&at, spec.between, "two materials (\"a\", \"b\")") else { continue };
        let (a, b) = (
            c.name(&at.index(0), Some(a), "material", "materials"),
            c.name(&at.index(1), Some(b), "material", "materials"),
        );
        if c.told(&at) || a.max(b) >= materials.len() {
            continue;
        }
        table.set(a, b, properties);
        if !given.insert((a.min(b), a.max(b))) {
            c.fault(&at, FaultKind::Repeated);
        }
    }
    Pairs { table, given }
}

/// Notes each pair of materials that can touch and has no properties.
pub(super) fn all_pairs_given(c: &mut Checker<'_>, scene: &Scene, given: &BTreeSet<(usize, usize)>) {
    let at = KeyPath::default();
    let sections = ["materials", "pairs", "batches", "bodies", "boundaries", "drum"];
    if sections.iter().any(|section| c.told(&at.field(section))) {
        return; // Which pairs occur is not known yet.
    }
    // Two of a material already touch each other.
    let mut moving: Vec<usize> = Vec::new();
    let bodies = scene.bodies.iter().map(|b| b.material);
    for m in scene.batches.iter().flat_map(|b| vec![b.material; b.count.min(2)]).chain(bodies) {
        if moving.iter().filter(|known| **known == m).count() < 2 {
            moving.push(m);
        }
    }
    let fixed = scene.drum.iter().map(|d| d.material).chain(scene.boundaries.iter().map(|b| b.material));
    let fixed: Vec<usize> = fixed.collect();
    let mut touching = BTreeSet::new();
    for (i, &a) in moving.iter().enumerate() {
        for &b in moving[i + 1..].iter().chain(&fixed) {
            touching.insert((a.min(b), a.max(b)));
        }
    }
    for &(a, b) in touching.difference(given) {
        let name = |index: usize| scene.materials[index].name.clone();
        c.fault(&at.field("pairs"), FaultKind::MissingPair(name(a), name(b)));
    }
}
