//! A flexible body as a block.
//!
//! What all of them have is [`shared`]: the body at rest, where its step begins, loads, contact forces, the iterate, impulses, and what
//! answers to forces. What they step by is one of three methods, each with its own data: [`small`], [`explicit`], [`large`]. [`block`] puts
//! both together.

mod answer;
mod block;
mod compliance;
mod contact_forces;
mod explicit;
#[cfg(feature = "serde-serialize")]
mod explicit_record;
mod following;
mod impulse;
mod iterate;
mod jumps;
mod large;
mod loads;
mod massless_surface;
mod motion;
mod pins;
mod response;
mod shape;
mod shared;
mod small;

pub use block::FlexBlock;
#[cfg(feature = "serde-serialize")]
pub(crate) use explicit_record::ExplicitRecord;
pub use iterate::Balance;
