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
mod claim_multibodies;
mod draft;
mod ends;
mod events;
mod filter;
mod flex_cores;
mod force_pair;
mod gather;
mod gather_joints;
mod gather_multibodies;
mod gather_pairs;
mod gather_settings;
mod hand_back;
mod hooks;
mod inset;
mod joint_changes;
mod joint_impulses;
mod joints;
mod landing;
mod lent_multibodies;
mod light_partners;
mod loan;
mod look_again;
mod masters;
mod members;
mod memory;
mod multibody;
mod newcomers;
mod outlines;
mod pair_name;
mod placed;
mod places;
mod pool;
mod pressed_point;
mod quarantine;
mod reading;
#[cfg(feature = "serde-serialize")]
mod record;
mod references;
mod rigid_pairs;
mod rigid_ways;
mod roster;
mod seats;
mod sensor_events;
mod sets;
mod shapes;
mod sleep;
mod soft_body;
mod strikes;
mod sweep;
mod tangles;
mod trespassers;
mod under_way;
mod unlisted;
mod waking;
mod walk;
mod ways;

pub(crate) use carrier::{is_carried, sync_settings, write_surface};
pub(crate) use changes::WorldChange;
pub(crate) use claim::Claims;
pub(crate) use ends::Ends;
pub(crate) use events::EventBook;
pub(crate) use gather::{Gatherer, Sources};
pub(crate) use gather_settings::GatherSettings;
pub(crate) use joint_impulses::{JointImpulse, write_impulses};
pub(crate) use landing::Landing;
pub(crate) use loan::{Lent, Loan};
pub(crate) use memory::Memory;
pub(crate) use newcomers::{DEEP, PutTogether, ReadSets, overlap, overlaps_of_newcomers, put_in};
pub(crate) use pool::FlexPool;
pub(crate) use pressed_point::PressedPoint;
pub(crate) use quarantine::{disable_joints_of_disabled, is_out, quarantine, quarantine_carriers};
pub(crate) use reading::{GatherError, is_representable_motion};
#[cfg(feature = "serde-serialize")]
pub(crate) use record::CouplingRecord;
pub(crate) use seats::Seats;
pub use sets::RapierSets;
pub(crate) use shapes::{ShapeFault, is_met, rounding};
pub(crate) use sleep::{
    keep_awake, keep_landing_awake, look_whether_still, rests, stop_if_asleep, wake_disturbed,
    wake_moving,
};
pub use soft_body::SoftBodyError;
pub(crate) use trespassers::{Trespasser, Trespassers};
pub(crate) use under_way::{Span, UnderWay};
pub(crate) use walk::ClaimedPair;
