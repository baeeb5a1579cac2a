//! Why results were not written.

use crate::fe::model::ModelError;
use std::path::PathBuf;
use thiserror::Error;

/// Why results were not written.
#[derive(Debug, Error)]
pub enum OutputError {
    /// A file could not be written.
    #[error("{} cannot be written: {source}", .path.display())]
    Unwritable {
        /// Its path.
        path: PathBuf,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// A picture cannot be painted at the width that was asked for.
    #[error("a picture {width} px wide cannot be painted, {reason}: ask for another width")]
    Unpaintable {
        /// The width (px).
        width: u32,
        /// Why not.
        reason: String,
    },
    /// An element cannot evaluate its strain.
    #[error(transparent)]
    Stress(#[from] ModelError),
}

/// Writes a whole file, and the folder it is to be in.
pub(in crate::io) fn write(path: PathBuf, contents: &[u8]) -> Result<(), OutputError> {
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let made = folder.map_or(Ok(()), std::fs::create_dir_all);
    made.and_then(|()| std::fs::write(&path, contents))
        .map_err(|source| OutputError::Unwritable { path, source })
}
