//! A glance at a scene before it runs: an example that the doctor has something to say of is no example.

use foil2d::doctor::{Finding, examine};
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

/// Refuses a scene in which something is likely a mistake, with what it is.
pub fn require_sound(
    world: &PhysicsWorld,
    flex_bodies: &FlexBodySet,
    flex: &FlexPipeline,
) -> Result<(), String> {
    let findings = examine(world, flex_bodies, &flex.parameters);
    let words: Vec<String> = findings.iter().map(Finding::to_string).collect();
    if words.is_empty() {
        Ok(())
    } else {
        Err(words.join("\n"))
    }
}
