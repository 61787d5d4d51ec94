//! What can be wrong with a scene, and how it is told.

use super::outline::Syntax;
use super::pose_table::PoseTableFault;
use std::fmt;
use std::path::PathBuf;

/// All faults of a scene, in the order of its text. Prints one line a fault.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneFaults {
    /// The faults, never empty.
    pub faults: Vec<Fault>,
}

impl std::error::Error for SceneFaults {}

impl From<Fault> for SceneFaults {
    fn from(fault: Fault) -> Self {
        Self { faults: vec![fault] }
    }
}

impl fmt::Display for SceneFaults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, fault) in self.faults.iter().enumerate() {
            if i > 0 {
                f.write_str("\n")?;
            }
            fault.fmt(f)?;
        }
        Ok(())
    }
}

/// One fault.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// Where.
    pub place: Place,
    /// Path of the value, `batches[0].count`; empty for the file as a whole.
    pub path: String,
    /// What is wrong and what is allowed.
    pub kind: FaultKind,
}

/// Where a fault is. Ordered: the file first, then the overrides.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    /// The file as a whole.
    File(String),
    /// A position in the file.
    Text {
        /// The file as the user named it.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
    },
    /// A value given on the command line, `path=value`.
    Override(String),
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.place {
            Place::File(file) => write!(f, "{file}: ")?,
            Place::Text { file, line, column } => write!(f, "{file}:{line}:{column}: ")?,
            Place::Override(set) => write!(f, "--set {set}: ")?,
        }
        let told_by_place = matches!(&self.place, Place::Override(set)
            if set.split_once('=').is_some_and(|(path, _)| path.trim() == self.path));
        if !self.path.is_empty() && !told_by_place {
            write!(f, "{}: ", self.path)?;
        }
        write!(f, "{}", self.kind)
    }
}

/// What is wrong.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FaultKind {
    /// The file cannot be read.
    #[error("cannot read the scene: {0}")]
    Unreadable(String),
    /// The file is far too large for a scene.
    #[error("the file has {bytes} bytes; a scene has at most {limit}")]
    TooLarge {
        /// Its size.
        bytes: u64,
        /// Largest size read.
        limit: u64,
    },
    /// The file is not text.
    #[error("the file is not UTF-8 text")]
    NotText,
    /// There is no embedded scene of that name.
    #[error("no scene of that name is built in; known: {}", list(known))]
    NotEmbedded {
        /// Names of the embedded scenes.
        known: Vec<String>,
    },
    /// The text is not RON.
    #[error("{0}")]
    Syntax(Syntax),
    /// An override is not `path=value`.
    #[error("expected path=value, such as drum.speed=Rpm(30)")]
    OverrideForm,
    /// The value of an override is not RON.
    #[error("the value is not RON: {0}")]
    OverrideValue(Syntax),
    /// The path of an override leads through a value that has no such part.
    #[error("`{parent}` has no part `{step}`")]
    NoSuchPart {
        /// Path of the value reached.
        parent: String,
        /// The step that fails.
        step: String,
    },
    /// A field that does not exist.
    #[error("unknown field; known here: {}{}", list(known), guess(meant.as_ref()))]
    UnknownField {
        /// The fields there are.
        known: Vec<String>,
        /// The field that it may have meant.
        meant: Option<String>,
    },
    /// A choice that does not exist.
    #[error("there is no `{found}`; choices: {}{}", list(known), guess(nearest(found, known)))]
    UnknownChoice {
        /// What is written.
        found: String,
        /// The choices there are.
        known: Vec<String>,
    },
    /// A name that nothing in the scene has.
    #[error("no {what} is named \"{found}\"; known: {}{}", list(known), guess(nearest(found, known)))]
    UnknownName {
        /// Kind of thing.
        what: &'static str,
        /// What is written.
        found: String,
        /// The names there are.
        known: Vec<String>,
    },
    /// A value of another type.
    #[error("{expected}, found `{found}`")]
    Type {
        /// What is expected.
        expected: String,
        /// What is written.
        found: String,
    },
    /// A value that must be given is not.
    #[error("missing; give {0}")]
    Missing(&'static str),
    /// A name given twice.
    #[error("given twice")]
    Repeated,
    /// A number out of range.
    #[error("`{found}` is out of range; allowed: {allowed}")]
    OutOfRange {
        /// What is written.
        found: String,
        /// The range.
        allowed: String,
    },
    /// Two fields of which exactly one must be given.
    #[error("give either `{0}` or `{1}`")]
    EitherOr(&'static str, &'static str),
    /// A value that has no use beside another one.
    #[error("needs {0}, which the scene does not have")]
    Needs(&'static str),
    /// Two materials can touch but have no properties.
    #[error(
        "\"{0}\" and \"{1}\" can touch: give their friction and restitution, between: (\"{0}\", \"{1}\")"
    )]
    MissingPair(String, String),
    /// The scene moves nothing.
    #[error("the scene has nothing that moves; give batches or bodies")]
    Nothing,
    /// Moments that no body has.
    #[error("principal moments must be above 0, none above the sum of the other two")]
    Inertia,
    /// Dimensions that no solid has together.
    #[error("{0}")]
    Impossible(String),
    /// A direction of no length.
    #[error("a direction needs a length above 0")]
    NoDirection,
    /// A tablet that is larger than the drum.
    #[error("\"{shape}\" is {size_mm:.3} mm across, the drum only {room_mm:.3} mm")]
    LargerThanDrum {
        /// Name of the shape.
        shape: String,
        /// Largest extent, mm.
        size_mm: f64,
        /// Smaller one of the drum's diameter and width, mm.
        room_mm: f64,
    },
    /// More solid than fits.
    #[error(
        "the tablets' volume is {:.1} % of the drum's; at most {:.0} % fits",
        100.0 * fraction, 100.0 * limit
    )]
    Overfull {
        /// Solid volume of all tablets over that of the drum.
        fraction: f64,
        /// Largest allowed.
        limit: f64,
    },
    /// More panels than their ids can count.
    #[error("{panels} panels in all; at most {limit} can be told apart")]
    TooManyPanels {
        /// Panels of all tablets.
        panels: u64,
        /// Largest allowed.
        limit: u64,
    },
    /// A corner of a box is not below the other one.
    #[error("every coordinate of `min` must be below that of `max`")]
    InsideOutBox,
    /// Something outside the drum.
    #[error("lies outside the drum")]
    OutsideDrum,
    /// A file that a scene names is not there.
    #[error("there is no file {}", .0.display())]
    NoFile(PathBuf),
    /// A bound on the error of a clump that is not fitted.
    #[error("a Sphere is one sphere and a Clump as it is given: leave `spheres` out")]
    NotFitted,
    /// A pose table that cannot be used.
    #[error(transparent)]
    Poses(#[from] PoseTableFault),
    /// A recipe without a surface in a sprayed scene.
    #[error("a Clump has no surface to coat; give a solid's dimensions or leave out the spray")]
    NoSurface,
}

fn list(names: &[String]) -> String {
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

fn guess(meant: Option<&String>) -> String {
    meant.map(|name| format!(" (did you mean `{name}`?)")).unwrap_or_default()
}

/// The known name that differs least from what is written, if that is not more than about a third of its letters.
pub(super) fn nearest<'n>(found: &str, known: &'n [String]) -> Option<&'n String> {
    let distance = |name: &str| strsim::damerau_levenshtein(&found.to_lowercase(), &name.to_lowercase());
    let near = known.iter().map(|name| (distance(name), name));
    let near = near.filter(|(distance, name)| *distance <= (1 + name.chars().count()) / 3);
    near.min_by_key(|(distance, _)| *distance).map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn guesses_near_names_only() {
        let known = ["speed".to_owned(), "width".to_owned()];
        assert_eq!(nearest("sped", &known), Some(&known[0]));
        assert_eq!(nearest("Speed", &known), Some(&known[0]));
        assert_eq!(nearest("colour", &known), None);
    }
}
