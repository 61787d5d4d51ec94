//! The way to a value in a scene: `drum.baffles.tilt`, `batches[0].count`, `shapes["my tablet"].spheres`.

use super::outline::{Kind, Node};
use std::fmt;

/// A way from the root of a scene to one of its values.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct KeyPath {
    steps: Vec<Step>,
}

/// One step of a path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Step {
    /// Into a field, or a map's entry.
    Field(String),
    /// Into a list's item.
    Index(usize),
}

impl KeyPath {
    /// The field `name` of this value.
    pub(super) fn field(&self, name: &str) -> Self {
        self.then(Step::Field(name.to_owned()))
    }

    /// Item `index` of this value.
    pub(super) fn index(&self, index: usize) -> Self {
        self.then(Step::Index(index))
    }

    /// This way and one more step.
    pub(super) fn then(&self, step: Step) -> Self {
        let mut steps = self.steps.clone();
        steps.push(step);
        Self { steps }
    }

    /// The steps, from the root.
    pub(super) fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// Whether this is the field `name` beside the field `other`.
    pub(super) fn is_beside(&self, other: &Self, name: &str) -> bool {
        match (self.steps.split_last(), other.steps.split_last()) {
            (Some((Step::Field(last), section)), Some((_, others))) => last == name && section == others,
            _ => false,
        }
    }

    /// Reads what [`fmt::Display`] prints.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let mut steps = Vec::new();
        let mut rest = text;
        while !rest.is_empty() {
            if let Some(quoted) = rest.strip_prefix("[\"") {
                let (name, after) = quoted.split_once("\"]")?;
                steps.push(Step::Field(name.to_owned()));
                rest = after;
            } else if let Some(numbered) = rest.strip_prefix('[') {
                let (index, after) = numbered.split_once(']')?;
                steps.push(Step::Index(index.parse().ok()?));
                rest = after;
            } else {
                let dotted = if steps.is_empty() { rest } else { rest.strip_prefix('.')? };
                let end = dotted.find(['.', '[']).unwrap_or(dotted.len());
                let name = &dotted[..end];
                if !is_plain(name) {
                    return None;
                }
                steps.push(Step::Field(name.to_owned()));
                rest = &dotted[end..];
            }
        }
        (!steps.is_empty()).then_some(Self { steps })
    }

    /// Follows the path as far as the text goes: the value reached and the steps left over.
    pub(super) fn follow<'n>(&self, root: &'n Node) -> (&'n Node, &[Step]) {
        let mut node = root;
        for (i, step) in self.steps.iter().enumerate() {
            let next = match step {
                Step::Field(name) => node.field(name).map(|entry| &entry.value),
                Step::Index(index) if matches!(node.kind, Kind::Items(_)) => node.item(*index),
                Step::Index(_) => None,
            };
            match next {
                Some(next) => node = next,
                None => return (node, &self.steps[i..]),
            }
        }
        (node, &[])
    }
}

fn is_plain(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-')
}

impl fmt::Display for KeyPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, step) in self.steps.iter().enumerate() {
            match step {
                Step::Index(index) => write!(f, "[{index}]")?,
                Step::Field(name) if !is_plain(name) => write!(f, "[\"{name}\"]")?,
                Step::Field(name) if i == 0 => f.write_str(name)?,
                Step::Field(name) => write!(f, ".{name}")?,
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prints_what_it_reads() {
        for text in ["drum.baffles.tilt", "batches[0].count", "shapes[\"my tablet\"].spheres", "a"] {
            assert_eq!(KeyPath::parse(text).expect("is a path").to_string(), text);
        }
        for text in ["", ".a", "a..b", "a[x]", "a[1", "a b", "a[0]b", "a."] {
            assert_eq!(KeyPath::parse(text), None, "{text}");
        }
    }
}
