//! What users of rapier rely on, once with rapier alone and once with every dynamic body solved by the flexible stage.
//!
//! Each behaviour is a scene and a verdict, our own words for what rapier's tests and documents promise. In the second run a joint that
//! locks nothing leads from every body to one on which a flexible block lies, a kilometre away: all of them are claimed, and no force
//! acts that did not before. Both runs must give the same verdict, but for these:
//!
//! | behaviour | with the flexible stage |
//! |---|---|
//! | `a_conveyor_set_by_the_hook_carries` | `tangent_velocity` of `modify_solver_contacts` is not looked at: contacts know no belts; let a kinematic body move |
//! | `a_box_slides_over_the_joints_of_a_polyline` | the pseudo-normals of an oriented polyline are not looked at: a face that slides may catch at a joint of two segments, as it does on rapier's plain polylines; use a cuboid or a convex decomposition |
//!
//! `DIFFERENCES` in `support` is that list; a behaviour in it that no longer differs fails too.

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
