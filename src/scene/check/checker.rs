//! The questions every check asks, and the list of faults.

use super::super::decode::{Located, shown};
use super::super::fault::FaultKind;
use super::super::outline::Node;
use super::super::path::{KeyPath, Step};
use super::super::spec::Direction;
use super::Allowed;
use crate::units::{Number, Quantity, Triple, Whole};
use nalgebra::Vector3;
use std::path::{Path, PathBuf};

/// Notes faults at their places.
pub(super) struct Checker<'a> {
    pub(super) text: &'a str,
    pub(super) root: &'a Node,
    pub(super) base_dir: &'a Path,
    pub(super) faults: &'a mut Vec<Located>,
}

impl Checker<'_> {
    /// Notes a fault. A value that the file leaves out has the place of the section that lacks it.
    pub(super) fn fault(&mut self, path: &KeyPath, kind: FaultKind) {
        let (node, _) = path.follow(self.root);
        self.faults.push(Located { at: node.span.start, path: path.clone(), kind });
    }

    /// Whether a fault of this value, or of a part of it, has been told.
    pub(super) fn told(&self, path: &KeyPath) -> bool {
        self.faults.iter().any(|fault| fault.path.steps().starts_with(path.steps()))
    }

    /// A value that must be given. Nothing is noted if the value, or all around it, has been refused already, or if a
    /// misspelt field is likely to be it.
    pub(super) fn need<T>(&mut self, path: &KeyPath, value: Option<T>, what: &'static str) -> Option<T> {
        if value.is_none() {
            let refused = self.faults.iter().any(|fault| {
                let around = path.steps().starts_with(fault.path.steps());
                around
                    || matches!(&fault.kind, FaultKind::UnknownField { meant: Some(meant), .. }
                    if path.is_beside(&fault.path, meant))
            });
            if !refused && !self.told(path) {
                self.fault(path, FaultKind::Missing(what));
            }
        }
        value
    }

    /// A number that must be given, in SI; NaN after a fault.
    pub(super) fn number<Q: Quantity>(&mut self, path: &KeyPath, value: Option<Q>, allowed: Allowed) -> f64 {
        match self.need(path, value, Q::WHAT) {
            Some(value) => self.in_range(path, value, allowed),
            None => f64::NAN,
        }
    }

    /// A number with a default, in SI; NaN after a fault.
    pub(super) fn number_or<Q: Quantity>(
        &mut self,
        path: &KeyPath,
        value: Option<Q>,
        default: f64,
        allowed: Allowed,
    ) -> f64 {
        value.map_or(default, |value| self.in_range(path, value, allowed))
    }

    fn in_range<Q: Quantity>(&mut self, path: &KeyPath, value: Q, allowed: Allowed) -> f64 {
        if allowed.holds(value.si()) {
            return value.si();
        }
        self.out_of_range::<Q>(path, allowed);
        f64::NAN
    }

    /// Notes that a number of the file is not in its range.
    pub(super) fn out_of_range<Q: Quantity>(&mut self, path: &KeyPath, allowed: Allowed) {
        let written = &self.text[path.follow(self.root).0.span.clone()];
        let number = written.split_once('(').map_or(written, |(choice, inner)| match choice {
            // `Fixed(Us(100))`: the number is inside the choice.
            choice if Q::UNITS.iter().all(|unit| unit.name != choice.trim()) => inner,
            _ => written,
        });
        let allowed = allowed.in_words::<Q>(number);
        self.fault(path, FaultKind::OutOfRange { found: shown(written), allowed });
    }

    /// A count that must be given; 0 after a fault.
    pub(super) fn count(&mut self, path: &KeyPath, value: Option<Whole>, allowed: Allowed) -> usize {
        self.number(path, value, allowed) as usize
    }

    /// Three components, none larger than `most` in magnitude.
    pub(super) fn triple<Q: Quantity>(
        &mut self,
        path: &KeyPath,
        value: Triple<Q>,
        most: f64,
    ) -> Vector3<f64> {
        let allowed = Allowed::from(-most).to(most);
        if !value.si().iter().all(|&x| allowed.holds(x)) {
            self.out_of_range::<Q>(path, allowed);
        }
        Vector3::from(value.si())
    }

    /// A unit vector.
    pub(super) fn direction(&mut self, path: &KeyPath, value: Option<Direction>) -> Vector3<f64> {
        let Some((x, y, z)) = self.need(path, value, "a direction (x, y, z)") else {
            return Vector3::zeros();
        };
        let [x, y, z] = [x, y, z].map(Number::si);
        // Scaled first: the squares of 1e200 or 1e-200 are no numbers to take a root of.
        let largest = x.abs().max(y.abs()).max(z.abs());
        if largest == 0.0 {
            self.fault(path, FaultKind::NoDirection);
            return Vector3::zeros();
        }
        (Vector3::new(x, y, z) / largest).normalize()
    }

    /// Index of the entry of `section` that has this name; 0 after a fault.
    pub(super) fn name(
        &mut self,
        path: &KeyPath,
        value: Option<String>,
        what: &'static str,
        section: &str,
    ) -> usize {
        let Some(found) = self.need(path, value, "a name") else { return 0 };
        let known: Vec<String> = match self.root.field(section) {
            Some(section) => section.value.entries().iter().map(|entry| entry.name.clone()).collect(),
            None => Vec::new(),
        };
        let index = known.iter().position(|name| *name == found);
        if index.is_none() {
            self.fault(path, FaultKind::UnknownName { what, found, known });
        }
        index.unwrap_or(0)
    }

    /// A file, from the folder of the scene.
    pub(super) fn file(&mut self, path: &KeyPath, value: Option<String>) -> PathBuf {
        let Some(name) = self.need(path, value, "the name of a file") else { return PathBuf::new() };
        let file = self.base_dir.join(name);
        if !file.is_file() {
            self.fault(path, FaultKind::NoFile(file.clone()));
        }
        file
    }

    /// Path of an item of a section.
    pub(super) fn item(section: &str, index: usize) -> KeyPath {
        KeyPath::default().then(Step::Field(section.to_owned())).index(index)
    }
}
