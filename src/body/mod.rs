//! Flexible bodies: how they are described, what they remember, and the set that holds them.
//!
//! | | |
//! |---|---|
//! | [`FlexBodyBuilder`] | describes a body: mesh, material, place, pins, loads, contact |
//! | [`FlexBodySet`] | holds bodies and attachments, named by handles; puts them into a rapier world and takes them out |
//! | [`FlexBody`] | a body in the set: where it is, its stresses and forces (N, Pa), its energy; loads and velocities may be set between steps |
//! | [`AttachmentBuilder`] | pins, welds or springs nodes to the world, a rigid or another flexible body |
//! | [`BuildError`], [`FlexBodyError`], [`AttachmentError`] | what was wrong, and the cure; nothing has then been changed |

mod access;
mod analysis;
mod attachment;
mod build;
mod builder;
mod contact_inertia;
mod contact_settings;
mod error;
mod flex_body;
mod frame;
mod handle;
mod kept_force;
mod materials;
mod pin;
mod placing;
mod pre_stretch;
#[cfg(feature = "serde-serialize")]
mod record;
mod region;
mod set;
mod state;
mod steering;
mod stillness;
mod surface;
mod surface_mass;

pub(crate) use access::KeptMotion;
pub(crate) use attachment::{Anchor, Choice, Plan, Shift};
pub use attachment::{
    Attachment, AttachmentBuilder, AttachmentError, AttachmentHandle, AttachmentKind,
    AttachmentTarget,
};
pub use builder::FlexBodyBuilder;
pub use contact_inertia::ContactInertia;
pub use contact_settings::ContactSettings;
pub use error::{BuildError, FlexBodyError};
pub use flex_body::FlexBody;
pub use frame::{Arms, Frame, frame_of};
pub use handle::FlexBodyHandle;
pub(crate) use kept_force::KeptForce;
pub use pin::Pin;
pub use pre_stretch::PreStretch;
#[cfg(feature = "serde-serialize")]
pub(crate) use record::{SetRecord, SetRecordError};
pub use region::Region;
pub use set::FlexBodySet;
pub use state::{AppliedLoad, BodyEnergy, FlexState, FrameMotion, KnownLoads, Linearized};
pub(crate) use stillness::{Rest, rest_way};
pub use surface::SurfacePick;
pub(crate) use surface::{OFFSET, contact_offset};
