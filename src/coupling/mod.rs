//! The border with rapier: carriers, detection, claiming, gathering and handing back.
//!
//! Together with [`crate::pipeline`] this is the only part that reads or writes rapier's sets.

mod attach;
mod candidates;
mod carrier;
mod changes;
mod claim;
mod claim_attachments;
mod claim_joints;
mod draft;
mod events;
mod filter;
mod flex_cores;
mod force_pair;
mod gather;
mod gather_joints;
mod gather_pairs;
mod hand_back;
mod hooks;
mod inset;
mod joints;
mod link_gate;
mod links;
mod look_again;
mod masters;
mod members;
mod multibody;
mod multibody_rows;
mod newcomers;
mod outlines;
mod pair_name;
mod places;
mod pressed_point;
mod quarantine;
mod reading;
#[cfg(feature = "serde-serialize")]
mod record;
mod references;
mod rigid_pairs;
mod rigid_ways;
mod roster;
mod sensor_events;
mod sets;
mod shapes;
mod sleep;
mod strikes;
mod sweep;
mod trespassers;
mod under_way;
mod waking;
mod walk;
mod ways;

pub(crate) use carrier::{is_carried, sync_settings, write_surface};
pub(crate) use changes::WorldChange;
pub(crate) use claim::Claims;
pub(crate) use events::EventBook;
pub(crate) use gather::{GatherSettings, Gatherer};
pub(crate) use hand_back::{Landing, hand_back, land};
pub(crate) use hooks::HookGate;
pub(crate) use joints::{JointImpulse, write_impulses};
pub(crate) use links::LinkBook;
pub(crate) use masters::Masters;
pub(crate) use newcomers::overlaps_of_newcomers;
pub(crate) use pressed_point::PressedPoint;
pub(crate) use quarantine::{quarantine, quarantine_carriers};
pub(crate) use reading::{GatherError, is_held_motion};
#[cfg(feature = "serde-serialize")]
pub(crate) use record::CouplingRecord;
pub use sets::RapierSets;
pub(crate) use shapes::{ShapeFault, rounding};
pub(crate) use sleep::{is_asleep, keep_awake, rests, stop_if_asleep, wake_disturbed, wake_moving};
pub(crate) use trespassers::Trespassers;
pub(crate) use under_way::Span;
pub(crate) use walk::ClaimedPair;
