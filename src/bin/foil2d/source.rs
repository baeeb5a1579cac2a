//! Where a scene comes from: its text, and the places of its values in it.

use super::at::At;
use super::problem::Problem;
use super::scene::SceneFile;
use std::path::{Path, PathBuf};

/// A scene with the text it was read from.
pub struct Source {
    path: PathBuf,
    text: String,
    pub scene: SceneFile,
}

impl Source {
    /// Reads a scene.
    pub fn read(path: &Path) -> Result<Self, Problem> {
        let text = std::fs::read_to_string(path)
            .map_err(|error| Problem::plain(format!("{}: {error}", path.display())))?;
        let scene = toml::from_str(&text).map_err(|error| match error.span() {
            Some(span) => Problem::at(error.message(), path, &text, span.start),
            None => Problem::plain(format!("{}: {}", path.display(), error.message())),
        })?;
        Ok(Self {
            path: path.to_owned(),
            text,
            scene,
        })
    }

    /// What is wrong with a value, told where it stands.
    pub fn problem<T>(&self, at: &At<T>, what: impl std::fmt::Display) -> Problem {
        Problem::at(what, &self.path, &self.text, at.byte())
    }

    /// A file named in the scene: beside the scene, if it is not absolute.
    pub fn beside(&self, path: &Path) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(path)
    }
}
