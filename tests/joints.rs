//! Joints and attachments: rapier's impulse joints on claimed bodies, and flexible bodies held by something.

mod common;

#[path = "joints/jammed.rs"]
mod jammed;

#[path = "joints/support.rs"]
mod support;

#[path = "joints/hinges.rs"]
mod hinges;

#[path = "joints/hung.rs"]
mod hung;

#[path = "joints/beside_rapier.rs"]
mod beside_rapier;

#[path = "joints/attachments.rs"]
mod attachments;

#[path = "joints/flung.rs"]
mod flung;

#[path = "joints/forces.rs"]
mod forces;

#[path = "joints/multibody.rs"]
mod multibody;

#[path = "joints/multibody_alike.rs"]
mod multibody_alike;

#[path = "joints/multibody_changes.rs"]
mod multibody_changes;

#[path = "joints/multibody_soft.rs"]
mod multibody_soft;

#[path = "joints/multibody_land.rs"]
mod multibody_land;
#[path = "joints/multibody_rest.rs"]
mod multibody_rest;

#[path = "joints/coming_and_going.rs"]
mod coming_and_going;

#[path = "joints/caught.rs"]
mod caught;

#[path = "joints/contradiction.rs"]
mod contradiction;
#[path = "joints/put_apart.rs"]
mod put_apart;

#[path = "joints/pinned_twice.rs"]
mod pinned_twice;
#[path = "joints/welded_twice.rs"]
mod welded_twice;

#[path = "joints/touching.rs"]
mod touching;

#[path = "joints/light_hub.rs"]
mod light_hub;

#[path = "joints/light_partner.rs"]
mod light_partner;

#[path = "joints/stiff_chain.rs"]
mod stiff_chain;

#[path = "joints/taut.rs"]
mod taut;
#[path = "joints/taut_links.rs"]
mod taut_links;

#[path = "joints/inside.rs"]
mod inside;

#[path = "joints/sandwich.rs"]
mod sandwich;

#[path = "joints/jumps.rs"]
mod jumps;

#[path = "joints/clamped.rs"]
mod clamped;
