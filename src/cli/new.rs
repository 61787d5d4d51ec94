//! `pancoat new`: a commented scene to begin with.

use super::args::NewArgs;
use super::failure::Failure;
use super::print_line;
use crate::scene::SceneText;
use std::fs::OpenOptions;
use std::io::Write;

/// Writes a built-in scene as a file; one that is there is left alone.
pub(super) fn new(args: &NewArgs) -> Result<(), Failure> {
    let scene = SceneText::embedded(&args.name, &[])?;
    let path = args.out.clone().unwrap_or_else(|| format!("{}.ron", args.name).into());
    let file = OpenOptions::new().write(true).create_new(true).open(&path);
    let written = file.and_then(|mut file| file.write_all(scene.text().as_bytes()));
    written.map_err(|source| Failure::NewScene { path: path.clone(), source })?;
    print_line(&path.display().to_string())
}
