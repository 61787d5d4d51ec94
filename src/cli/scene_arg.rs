//! The scene of a command.

use crate::scene::{SceneFaults, SceneText};
use std::path::{Path, PathBuf};

/// Which scene, with which values.
#[derive(Debug, clap::Args)]
pub(super) struct SceneArg {
    /// Scene file, or the name of a built-in scene: round, sphere, almond, oval, triangular, capsule, bullet,
    /// half_moon, shield, flat
    #[arg(value_name = "SCENE")]
    pub(super) scene: PathBuf,
    /// Put a value into the scene, such as drum.speed='Rpm(30)' or spray=None; may be repeated
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(super) overrides: Vec<String>,
}

impl SceneArg {
    /// Reads the scene. A file comes before a built-in scene of the same name.
    pub(super) fn read(&self) -> Result<SceneText, SceneFaults> {
        self.read_with(&[])
    }

    /// Reads the scene with more overrides after those of the arguments.
    pub(super) fn read_with(&self, more: &[String]) -> Result<SceneText, SceneFaults> {
        let overrides = [&self.overrides[..], more].concat();
        let bare = self.scene.extension().is_none() && self.scene.parent() == Some(Path::new(""));
        match self.scene.to_str() {
            Some(name) if bare && !self.scene.is_file() => SceneText::embedded(name, &overrides),
            _ => SceneText::read(&self.scene, &overrides),
        }
    }

    /// The scene's name, for the folder of its results.
    pub(super) fn name(&self) -> &Path {
        self.scene.file_stem().map_or(Path::new("scene"), Path::new)
    }
}
