//! A scene file with the overrides in it: what is checked, stored beside a run's results and hashed.

use super::check::check;
use super::decode::{Located, decode};
use super::fault::{Fault, FaultKind, Place, SceneFaults};
use super::model::Scene;
use super::outline::{Node, SyntaxFault, outline};
use super::overrides;
use super::source::Source;
use std::path::{Path, PathBuf};

/// Scenes that the program carries, by name.
const EMBEDDED: [(&str, &str); 10] = [
    ("round", include_str!("../../scenes/round.ron")),
    ("sphere", include_str!("../../scenes/sphere.ron")),
    ("almond", include_str!("../../scenes/almond.ron")),
    ("oval", include_str!("../../scenes/oval.ron")),
    ("triangular", include_str!("../../scenes/triangular.ron")),
    ("capsule", include_str!("../../scenes/capsule.ron")),
    ("bullet", include_str!("../../scenes/bullet.ron")),
    ("half_moon", include_str!("../../scenes/half_moon.ron")),
    ("shield", include_str!("../../scenes/shield.ron")),
    ("flat", include_str!("../../scenes/flat.ron")),
];

/// The text of a scene, overrides put in.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneText {
    source: Source,
    outline: Node,
    base_dir: PathBuf,
}

impl SceneText {
    /// Reads a file and puts `overrides`, each `path=value`, into it in turn.
    ///
    /// # Errors
    /// The file cannot be read or is not RON, or an override has no place in it.
    pub fn read(path: &Path, overrides: &[String]) -> Result<Self, SceneFaults> {
        Self::with_overrides(Source::read(path)?, path.parent().unwrap_or(Path::new("")), overrides)
    }

    /// Takes a text. `file_name` is what faults call it, `base_dir` the folder of the files it names.
    ///
    /// # Errors
    /// The text is not RON, or an override has no place in it.
    pub fn new(
        text: &str,
        file_name: &str,
        base_dir: &Path,
        overrides: &[String],
    ) -> Result<Self, SceneFaults> {
        Self::with_overrides(Source::new(text, file_name), base_dir, overrides)
    }

    /// A scene that the program carries: `round` or `sphere`.
    ///
    /// # Errors
    /// There is no such scene, or an override has no place in it.
    pub fn embedded(name: &str, overrides: &[String]) -> Result<Self, SceneFaults> {
        let Some((_, text)) = EMBEDDED.iter().find(|(known, _)| *known == name) else {
            let known = EMBEDDED.iter().map(|(name, _)| (*name).to_owned()).collect();
            let place = Place::File(name.to_owned());
            return Err(Fault { place, path: String::new(), kind: FaultKind::NotEmbedded { known } }.into());
        };
        Self::new(text, name, Path::new(""), overrides)
    }

    fn with_overrides(
        mut source: Source,
        base_dir: &Path,
        overrides: &[String],
    ) -> Result<Self, SceneFaults> {
        let mut root = outlined(&source)?;
        let mut faults = Vec::new();
        for set in overrides {
            match overrides::apply(&mut source, &root, set) {
                Ok(()) => root = outlined(&source)?,
                Err(of_set) => faults.extend(of_set.faults),
            }
        }
        if faults.is_empty() {
            Ok(Self { source, outline: root, base_dir: base_dir.to_owned() })
        } else {
            Err(SceneFaults { faults })
        }
    }

    /// The text as it is checked: the file's, with the overrides put in.
    pub fn text(&self) -> &str {
        self.source.text()
    }

    /// Checks the scene.
    ///
    /// # Errors
    /// All faults, in the order of the text, those of overrides last.
    pub fn scene(&self) -> Result<Scene, SceneFaults> {
        let (spec, mut located) = decode(self.text(), &self.outline);
        let scene = spec.map(|spec| check(spec, self.text(), &self.outline, &self.base_dir, &mut located));
        if let (Some(scene), true) = (scene, located.is_empty()) {
            return Ok(scene);
        }
        let fault = |fault: Located| Fault {
            place: self.source.place(fault.at),
            path: fault.path.to_string(),
            kind: fault.kind,
        };
        let mut faults: Vec<Fault> = located.into_iter().map(fault).collect();
        faults.sort_by(|a, b| a.place.cmp(&b.place));
        Err(SceneFaults { faults })
    }
}

fn outlined(source: &Source) -> Result<Node, SceneFaults> {
    let fault = |fault: SyntaxFault| Fault {
        place: source.place(fault.at),
        path: String::new(),
        kind: FaultKind::Syntax(fault.what),
    };
    outline(source.text()).map_err(|syntax| fault(syntax).into())
}

impl Scene {
    /// Reads and checks a scene file with `overrides`, each `path=value`, put into it.
    ///
    /// # Errors
    /// All faults found, see [`SceneText`].
    pub fn load(path: &Path, overrides: &[String]) -> Result<Self, SceneFaults> {
        SceneText::read(path, overrides)?.scene()
    }

    /// Checks a text. `file_name` is what faults call it, `base_dir` the folder of the files it names.
    ///
    /// # Errors
    /// All faults found, see [`SceneText`].
    pub fn parse(
        text: &str,
        file_name: &str,
        base_dir: &Path,
        overrides: &[String],
    ) -> Result<Self, SceneFaults> {
        SceneText::new(text, file_name, base_dir, overrides)?.scene()
    }

    /// A scene that the program carries: `round` or `sphere`.
    ///
    /// # Errors
    /// There is no such scene.
    pub fn embedded(name: &str) -> Result<Self, SceneFaults> {
        SceneText::embedded(name, &[])?.scene()
    }
}
