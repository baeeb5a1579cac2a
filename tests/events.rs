//! What rapier's event handlers hear of flexible bodies and of the rigid bodies that are solved with them.

mod common;

#[path = "events/collisions.rs"]
mod collisions;
#[path = "events/drops.rs"]
mod drops;
#[path = "events/filters.rs"]
mod filters;
#[path = "events/forces.rs"]
mod forces;
#[path = "events/hooks.rs"]
mod hooks;
#[path = "events/led_hooks.rs"]
mod led_hooks;
#[path = "events/refused_hooks.rs"]
mod refused_hooks;
#[path = "events/support.rs"]
mod support;
