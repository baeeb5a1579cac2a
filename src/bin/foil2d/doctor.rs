//! `foil2d doctor`.

use super::build::{Built, build};
use super::problem::Problem;
use super::source::Source;
use foil2d::doctor;
use std::path::Path;

/// Says what is likely a mistake in a scene.
pub fn examine(path: &Path) -> Result<(), Problem> {
    let source = Source::read(path)?;
    let built = build(&source)?;
    let found = findings(&built);
    match found.as_slice() {
        [] => println!("nothing is likely a mistake"),
        found => found.iter().for_each(|finding| println!("{finding}")),
    }
    Ok(())
}

/// What the doctor finds, with the names that the scene gives its bodies.
pub fn findings(built: &Built) -> Vec<String> {
    let found = doctor::examine(&built.world, &built.flex_bodies, &built.flex.parameters);
    let told = found.iter().map(|finding| {
        let named = built.flexible.iter();
        named.fold(finding.to_string(), |words, (name, handle)| {
            words.replace(&format!("{handle:?}"), &format!("`{name}`"))
        })
    });
    told.collect()
}
