//! What users of rapier rely on, once with rapier alone and once with every dynamic body solved by the flexible stage.
//!
//! Each behaviour is a scene and a verdict, our own words for what rapier's tests and documents promise. In the second run a joint that
//! locks nothing leads from every body to one on which a flexible block lies, a kilometre away: all of them are claimed, and no force
//! acts that did not before. Both runs must give the same verdict. What does not would be listed in `DIFFERENCES` in `support`, with the reason; a behaviour in that list that
//! differs no more fails too.

mod common;

#[macro_use]
#[path = "rapier_behaviours/support.rs"]
mod support;

#[path = "rapier_behaviours/bodies.rs"]
mod bodies;
#[path = "rapier_behaviours/changes.rs"]
mod changes;
#[path = "rapier_behaviours/contacts.rs"]
mod contacts;
#[path = "rapier_behaviours/events.rs"]
mod events;
#[path = "rapier_behaviours/joints.rs"]
mod joints;
#[path = "rapier_behaviours/sleep.rs"]
mod sleep;
