//! `foil2d doctor`.

use super::build::{Built, build};
use super::files::print;
use super::problem::Problem;
use super::source::Source;
use super::words::of_finding;
use foil2d::doctor;
use std::path::Path;

/// Says what is likely a mistake in a scene.
pub fn examine(path: &Path) -> Result<(), Problem> {
    let source = Source::read(path)?;
    let built = build(&source)?;
    match findings(&built).as_slice() {
        [] => print("nothing is likely a mistake\n"),
        found => print(&(found.join("\n") + "\n")),
    }
}

/// What the doctor finds, with the names that the scene gives its bodies.
pub fn findings(built: &Built) -> Vec<String> {
    let found = doctor::examine(&built.world, &built.flex_bodies, &built.flex.parameters);
    let told = found.iter();
    told.map(|finding| of_finding(finding, &built.names))
        .collect()
}
