//! The program `foil2d`, as a user runs it.

mod drops;
mod refusals;
mod runs;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder of its own for a test.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("cli")
        .join(name);
    // What an earlier run has left would hide what this one does not write.
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder in target");
    folder
}

fn foil2d(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_foil2d"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the program starts")
}

/// What a command that succeeds prints.
fn told(arguments: &[&str], folder: &Path) -> String {
    let output = foil2d(arguments, folder);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{arguments:?}: {errors}");
    assert_no_rust(&errors);
    String::from_utf8(output.stdout).expect("text")
}

/// What a command that fails complains about.
fn complaint(arguments: &[&str], folder: &Path) -> String {
    let output = foil2d(arguments, folder);
    let scene = std::fs::read_to_string(folder.join("scene.toml")).unwrap_or_default();
    assert!(
        !output.status.success(),
        "{arguments:?} is refused: {scene}"
    );
    assert!(output.stdout.is_empty(), "nothing else is told");
    let complaint = String::from_utf8(output.stderr).expect("text");
    assert!(complaint.starts_with("error: "), "{complaint}");
    assert_no_rust(&complaint);
    complaint
}

/// Who writes scenes in TOML knows no methods and no handles.
fn assert_no_rust(told: &str) {
    for word in ["::", "Handle", "FlexBody", "`.", "()", "panicked", "RUST"] {
        assert!(!told.contains(word), "{word} in: {told}");
    }
}

const STEEL: &str =
    "[materials.steel]\nyoung = 2.1e11\npoisson = 0.3\ndensity = 7800.0\nrayleigh = 1e-3\n";

const BEAM: &str = r#"
[[flexible]]
name = "beam"
material = "steel"
shape.rectangle = { size = [1.0, 0.02], cells = [20, 2] }
thickness = 0.05
pin = [{ nodes.box = [[-inf, -inf], [0.0, inf]] }]
"#;

/// The last row of the table of histories, by the names of its columns.
fn last_row(folder: &Path) -> Vec<(String, f64)> {
    let table = std::fs::read_to_string(folder.join("history.csv")).expect("histories");
    let mut lines = table.lines();
    let names: Vec<String> = lines
        .next()
        .expect("names")
        .split(',')
        .map(String::from)
        .collect();
    let last = lines.last().expect("a row").split(',');
    let values = last.map(|value| value.parse().expect("a number"));
    names.into_iter().zip(values).collect()
}

fn column(row: &[(String, f64)], name: &str) -> f64 {
    let found = row.iter().find(|(own, _)| own == name);
    found
        .unwrap_or_else(|| panic!("no column {name} in {row:?}"))
        .1
}
