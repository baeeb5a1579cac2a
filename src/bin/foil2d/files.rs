//! Files that are read, and places where files are to be written: looked at before anything is computed.

use super::problem::Problem;
use std::fs::{self, File, OpenOptions};
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

/// Bytes of a scene or an outline: millions of points.
pub const MOST_BYTES: u64 = 64 << 20;

/// Refuses what has no end, as a pipe or a device, and what is too large.
pub fn check_readable(path: &Path, most_bytes: u64) -> Result<(), Problem> {
    let found = fs::metadata(path).map_err(|error| Problem::of_file(error, path))?;
    if found.is_dir() {
        return Err(Problem::of_file("this is a folder: name a file", path));
    }
    if !found.is_file() {
        let what = "this is no regular file, but a pipe or device: save it to a file first";
        return Err(Problem::of_file(what, path));
    }
    match found.len() > most_bytes {
        true => Err(too_large(path, most_bytes)),
        false => Ok(()),
    }
}

fn too_large(path: &Path, most_bytes: u64) -> Problem {
    let most = most_bytes >> 20;
    let what =
        format!("the file is larger than {most} MiB, the most that is read: make it smaller");
    Problem::of_file(what, path)
}

/// The text of a file.
pub fn read_text(path: &Path) -> Result<String, Problem> {
    check_readable(path, MOST_BYTES)?;
    let mut bytes = Vec::new();
    File::open(path)
        // Some files tell no length.
        .and_then(|file| file.take(MOST_BYTES + 1).read_to_end(&mut bytes))
        .map_err(|error| Problem::of_file(error, path))?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(too_large(path, MOST_BYTES));
    }
    String::from_utf8(bytes)
        .map_err(|_| Problem::of_file("this is no text: save it as UTF-8", path))
}

/// Makes the folders of files that are to be written, and refuses those that cannot be.
pub fn check_writable(paths: &[PathBuf]) -> Result<(), Problem> {
    for path in paths {
        let refuse = |error| {
            let what = format!("this file cannot be written: {error}");
            Problem::of_file(what, path)
        };
        if let Some(folder) = path.parent().filter(|at| !at.as_os_str().is_empty()) {
            fs::create_dir_all(folder).map_err(refuse)?;
        }
        // A pipe would wait for its reader, and a device keeps nothing.
        if fs::metadata(path).is_ok_and(|found| !found.is_file()) {
            let what = "this file cannot be written: a folder, pipe or device has its name";
            return Err(Problem::of_file(what, path));
        }
        let was_there = path.exists();
        // What stands there stays until there is something new.
        let opened = OpenOptions::new().append(true).create(true).open(path);
        opened.map_err(refuse)?;
        if !was_there {
            fs::remove_file(path).map_err(refuse)?;
        }
    }
    Ok(())
}

/// Prints what a command has to tell. A reader that has gone away, as `head`, has what it wanted.
pub fn print(text: &str) -> Result<(), Problem> {
    let mut out = std::io::stdout().lock();
    let printed = out.write_all(text.as_bytes()).and_then(|()| out.flush());
    match printed {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Problem::plain(error)),
        _ => Ok(()),
    }
}

/// Tells of something beside the results; there may be nobody who reads it.
pub fn note(text: &str) {
    let _ = writeln!(std::io::stderr(), "note: {text}");
}
