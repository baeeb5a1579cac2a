//! Where a scene comes from: its text, and the places of its values in it.

use super::at::At;
use super::files::read_text;
use super::problem::Problem;
use super::scene::SceneFile;
use super::words::of_parser;
use std::path::{Path, PathBuf};

/// A scene with the text it was read from.
pub struct Source {
    path: PathBuf,
    text: String,
    /// What the scene is called: its file's name without the ending, unless somebody knows better.
    pub title: String,
    pub scene: SceneFile,
}

impl Source {
    /// Reads a scene.
    pub fn read(path: &Path) -> Result<Self, Problem> {
        let what = match path.extension().and_then(|ending| ending.to_str()) {
            Some("svg" | "json" | "geojson") => {
                "this is a drawing: `foil2d drop` makes a scene of it"
            }
            Some("msh") => "this is a mesh: name it in a scene, `shape.msh.file = \"...\"`",
            _ => "",
        };
        if !what.is_empty() {
            return Err(Problem::of_file(what, path));
        }
        let text = read_text(path)?;
        let scene = toml::from_str(&text).map_err(|error| match error.span() {
            Some(span) => Problem::at(of_parser(error.message()), path, &text, span.start),
            None => Problem::of_file(of_parser(error.message()), path),
        })?;
        Ok(Self {
            path: path.to_owned(),
            text,
            title: stem_of(path),
            scene,
        })
    }

    /// What is wrong with a value, told where it stands.
    pub fn problem<T>(&self, at: &At<T>, what: impl std::fmt::Display) -> Problem {
        match at.byte() {
            Some(byte) => Problem::at(what, &self.path, &self.text, byte),
            None => Problem::of_file(what, &self.path),
        }
    }

    /// A file named in the scene: beside the scene, if it is not absolute.
    pub fn beside(&self, path: &Path) -> PathBuf {
        self.path.parent().unwrap_or(Path::new("")).join(path)
    }
}

/// The name of a file without its ending.
pub fn stem_of(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default();
    stem.to_string_lossy().into_owned()
}
