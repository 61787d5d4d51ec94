//! Text to spec, with every typing fault told at once.
//!
//! `ron` stops at the first fault. Its path is known, so the innermost named field that holds the fault is blanked out
//! of a copy of the text (all other bytes keep their place) and the text is read again, until it can be read. Every
//! field of the spec is optional, hence a blanked field hides nothing but itself.

use super::fault::{FaultKind, nearest};
use super::outline::{Entry, Kind, Node};
use super::path::{KeyPath, Step};
use super::spec::SceneSpec;
use ron::error::Error;
use serde_path_to_error::Segment;
use std::ops::Range;

/// Most typing faults told of one file.
const MOST_FAULTS: usize = 50;

/// A fault at a path of the text.
#[derive(Debug, PartialEq)]
pub(super) struct Located {
    pub(super) at: usize,
    pub(super) path: KeyPath,
    pub(super) kind: FaultKind,
}

/// Reads `text`, whose outline is `root`. Returns what could be read and the faults of the rest; no spec if the text is
/// no scene at all.
pub(super) fn decode(text: &str, root: &Node) -> (Option<SceneSpec>, Vec<Located>) {
    let mut faults = Vec::new();
    let mut readable = text.to_owned();
    repeated(root, &KeyPath::default(), &mut |entry, path| {
        faults.push(Located { at: entry.key.start, path, kind: FaultKind::Repeated });
        blank(&mut readable, entry);
    });
    while faults.len() < MOST_FAULTS {
        let (segments, error) = match read(&readable) {
            Ok(spec) => return (Some(spec), faults),
            Err(fault) => fault,
        };
        let Way { entry, node, path } = follow(root, &segments, &readable);
        let at = match (&error, entry) {
            (Error::NoSuchStructField { .. }, Some(entry)) => entry.key.start,
            _ => node.span.start,
        };
        faults.push(Located { at, path, kind: kind(error, &text[node.span.clone()]) });
        match entry {
            Some(entry) => blank(&mut readable, entry),
            None => break,
        }
    }
    (None, faults)
}

fn read(text: &str) -> Result<SceneSpec, (Vec<Segment>, Error)> {
    let options = ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
    let mut deserializer =
        ron::Deserializer::from_str_with_options(text, &options).map_err(|fault| (Vec::new(), fault.code))?;
    let spec: SceneSpec = serde_path_to_error::deserialize(&mut deserializer)
        .map_err(|fault| (fault.path().iter().cloned().collect(), fault.into_inner()))?;
    deserializer.end().map_err(|fault| (Vec::new(), fault))?;
    Ok(spec)
}

/// Calls `found` for each field whose name occurred before in the same brackets.
fn repeated(node: &Node, path: &KeyPath, found: &mut impl FnMut(&Entry, KeyPath)) {
    match &node.kind {
        Kind::Leaf => {}
        Kind::Items(items) => {
            for (i, item) in items.iter().enumerate() {
                repeated(item, &path.index(i), found);
            }
        }
        Kind::Fields { entries, .. } => {
            for (i, entry) in entries.iter().enumerate() {
                let path = path.field(&entry.name);
                if entries[..i].iter().any(|earlier| earlier.name == entry.name) {
                    found(entry, path);
                } else {
                    repeated(&entry.value, &path, found);
                }
            }
        }
    }
}

/// Where segments lead.
struct Way<'n> {
    /// The last named field on the way.
    entry: Option<&'n Entry>,
    /// The value reached.
    node: &'n Node,
    path: KeyPath,
}

fn follow<'n>(root: &'n Node, segments: &[Segment], readable: &str) -> Way<'n> {
    let mut way = Way { entry: None, node: root, path: KeyPath::default() };
    for segment in segments {
        let (step, next) = match segment {
            Segment::Map { key } => {
                // A repeated field: the one that has not been blanked.
                let entry = way.node.entries().iter().find(|e| e.name == *key && !is_blank(readable, e));
                way.entry = entry.or(way.entry);
                (Step::Field(key.clone()), entry.map(|entry| &entry.value))
            }
            Segment::Seq { index } => (Step::Index(*index), way.node.item(*index)),
            Segment::Enum { .. } | Segment::Unknown => continue,
        };
        let Some(next) = next else { break };
        way.path = way.path.then(step);
        way.node = next;
    }
    way
}

fn is_blank(text: &str, entry: &Entry) -> bool {
    text[entry.key.clone()].trim().is_empty()
}

/// Overwrites a field and the comma behind it with spaces.
fn blank(text: &mut String, entry: &Entry) {
    fill(text, entry.key.start..entry.value.span.end);
    if let Some(comma) = entry.comma {
        fill(text, comma..comma + 1);
    }
}

fn fill(text: &mut String, range: Range<usize>) {
    let spaces: String = text[range.clone()].chars().map(|c| if c == '\n' { '\n' } else { ' ' }).collect();
    let spaces = format!("{spaces:<width$}", width = range.len());
    text.replace_range(range, &spaces);
}

fn kind(error: Error, written: &str) -> FaultKind {
    let names = |known: &[&str]| known.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
    let expected = match error {
        Error::NoSuchStructField { expected, found, .. } => {
            let known = names(expected);
            return FaultKind::UnknownField { meant: nearest(&found, &known).cloned(), known };
        }
        Error::NoSuchEnumVariant { expected, found, .. } => {
            return FaultKind::UnknownChoice { found, known: names(expected) };
        }
        Error::ExpectedBoolean => "expected `true` or `false`".to_owned(),
        Error::ExpectedString => "expected text in quotes".to_owned(),
        Error::ExpectedMap => "expected named entries, {\"name\": (..)}".to_owned(),
        Error::ExpectedArray => "expected a list, [..]".to_owned(),
        Error::SuggestRawIdentifier(_) | Error::InvalidIdentifier(_) | Error::ExpectedIdentifier => {
            "expected the name of a choice".to_owned()
        }
        Error::ExpectedStructLike
        | Error::ExpectedNamedStructLike(_)
        | Error::ExpectedDifferentStructName { .. } => "expected (..)".to_owned(),
        error => {
            let message = error.to_string();
            let mut letters = message.chars();
            letters.next().map_or(String::new(), |first| first.to_lowercase().chain(letters).collect())
        }
    };
    FaultKind::Type { expected, found: shown(written) }
}

/// The first line of a value, cut to a readable length.
pub(crate) fn shown(written: &str) -> String {
    let line = written.lines().next().unwrap_or("");
    let mut shown: String = line.chars().take(40).collect();
    if shown.len() < written.len() {
        shown.push('…');
    }
    shown
}
