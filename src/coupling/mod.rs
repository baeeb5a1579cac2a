//! The border with rapier: carriers, detection, claiming, gathering and handing back.
//!
//! Together with [`crate::pipeline`] this is the only part that reads or writes rapier's sets.

mod candidates;
mod carrier;
mod claim;
mod events;
mod force_pair;
mod gather;
mod hand_back;
mod hooks;
mod masters;
mod nearby;
mod places;
mod reading;
mod references;
mod sets;
mod shapes;

pub(crate) use carrier::{is_carried, sync_settings, write_surface};
pub(crate) use claim::Claims;
pub(crate) use events::{EventBook, PressedPoint};
pub(crate) use gather::{GatherSettings, Gatherer};
pub(crate) use hand_back::{Landing, hand_back, land};
pub(crate) use hooks::HookGate;
pub(crate) use masters::Masters;
pub(crate) use reading::{GatherError, is_held_motion};
pub use sets::RapierSets;
