//! Values set on the command line, `drum.speed=Rpm(30)`, put into the text of a scene before it is read, so that they
//! meet the same checks as the file.

use super::fault::{Fault, FaultKind, Place, SceneFaults};
use super::outline::{Kind, Node, outline};
use super::path::{KeyPath, Step};
use super::source::Source;
use std::fmt::Write as _;

/// Puts one override, `path=value`, into the text, whose outline is `root`.
///
/// An existing value is replaced. A field that the scene leaves out is added, with the sections on the way to it.
pub(super) fn apply(source: &mut Source, root: &Node, set: &str) -> Result<(), SceneFaults> {
    let fault =
        |kind| SceneFaults::from(Fault { place: Place::Override(set.to_owned()), path: String::new(), kind });
    let (path, value) = set.split_once('=').ok_or_else(|| fault(FaultKind::OverrideForm))?;
    let value = value.trim();
    let path = KeyPath::parse(path.trim()).ok_or_else(|| fault(FaultKind::OverrideForm))?;
    outline(value).map_err(|f| fault(FaultKind::OverrideValue(f.what)))?;
    // A line comment in the value must not swallow what follows.
    let value = if value.contains("//") { format!("{value}\n") } else { value.to_owned() };
    match path.follow(root) {
        (node, []) => source.splice(node.span.clone(), &value, set),
        (parent, missing) => {
            let reached = path.steps().len() - missing.len();
            let (at, text) = addition(parent, missing, value).ok_or_else(|| {
                let parent =
                    path.steps()[..reached].iter().cloned().fold(KeyPath::default(), |p, s| p.then(s));
                let step = KeyPath::default().then(missing[0].clone());
                fault(FaultKind::NoSuchPart { parent: parent.to_string(), step: step.to_string() })
            })?;
            source.splice(at..at, &text, set);
        }
    }
    Ok(())
}

/// The text that adds the `missing` fields to `parent`, and where it goes; `None` if `parent` cannot have them.
fn addition(parent: &Node, missing: &[Step], value: String) -> Option<(usize, String)> {
    let Kind::Fields { entries, close, map } = &parent.kind else { return None };
    let mut nested = value;
    for (i, step) in missing.iter().enumerate().rev() {
        let Step::Field(name) = step else { return None };
        let mut field = String::new();
        let key = if i == 0 && *map { format!("{name:?}") } else { name.clone() };
        write!(field, "{key}: {nested}").ok()?;
        nested = if i == 0 { field } else { format!("({field})") };
    }
    match entries.last() {
        Some(last) => Some((last.value.span.end, format!(", {nested}"))),
        None => Some((*close, nested)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(text: &str, set: &str) -> Result<String, String> {
        let mut source = Source::new(text, "f");
        let root = outline(text).expect("is RON");
        apply(&mut source, &root, set).map_err(|fault| fault.to_string())?;
        Ok(source.text().to_owned())
    }

    #[test]
    fn replaces_and_adds_values() {
        let text = "(drum: (speed: Rpm(22), ), list: [(n: 1)], shapes: {\"a\": (n: 1)}, none: ())";
        for (set, change, result) in [
            ("drum.speed=Rpm(30)", "Rpm(22)", "Rpm(30)"),
            ("list[0].n=2", "[(n: 1)]", "[(n: 2)]"),
            ("shapes.a.n = 7", "\"a\": (n: 1)", "\"a\": (n: 7)"),
            ("drum.width=Mm(3)", "Rpm(22)", "Rpm(22), width: Mm(3)"),
            ("shapes.b.n=3", "(n: 1)}", "(n: 1), \"b\": (n: 3)}"),
            ("none.x.y=1", "none: ()", "none: (x: (y: 1))"),
            ("spray=None", "none: ()", "none: (), spray: None"),
        ] {
            assert_eq!(with(text, set), Ok(text.replacen(change, result, 1)), "{set}");
        }
    }

    #[test]
    fn says_what_an_override_lacks() {
        for (set, message) in [
            ("a", "--set a: expected path=value, such as drum.speed=Rpm(30)"),
            ("a..b=1", "--set a..b=1: expected path=value, such as drum.speed=Rpm(30)"),
            ("a=(1", "--set a=(1: the value is not RON: expected `,` or `)`"),
            ("list[2].n=1", "--set list[2].n=1: `list` has no part `[2]`"),
            ("a.b=1", "--set a.b=1: `a` has no part `b`"),
        ] {
            assert_eq!(with("(a: 1, list: [])", set), Err(message.to_owned()));
        }
    }
}
