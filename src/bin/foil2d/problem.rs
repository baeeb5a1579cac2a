//! What is wrong, where in the scene it stands, and what to do.

use std::fmt;
use std::path::{Path, PathBuf};

/// Something that stops the command.
#[derive(Debug)]
pub struct Problem {
    what: String,
    file: Option<PathBuf>,
    /// Line and column, counted from one.
    place: Option<(usize, usize)>,
}

impl Problem {
    /// One without a place in a file.
    pub fn plain(what: impl fmt::Display) -> Self {
        Self {
            what: what.to_string(),
            file: None,
            place: None,
        }
    }

    /// One of a file as a whole.
    pub fn of_file(what: impl fmt::Display, path: &Path) -> Self {
        Self {
            file: Some(path.to_owned()),
            ..Self::plain(what)
        }
    }

    /// One at a byte of a file's text.
    pub fn at(what: impl fmt::Display, path: &Path, text: &str, byte: usize) -> Self {
        let before = text.get(..byte).unwrap_or(text);
        let line = 1 + before.matches('\n').count();
        let start = before.rfind('\n').map_or(0, |end| end + 1);
        let column = 1 + before[start..].chars().count();
        Self {
            place: Some((line, column)),
            ..Self::of_file(what, path)
        }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(file) = &self.file {
            write!(f, "{}:", file.display())?;
            if let Some((line, column)) = self.place {
                write!(f, "{line}:{column}:")?;
            }
            f.write_str(" ")?;
        }
        f.write_str(self.what.trim_end())
    }
}
