//! Flexible bodies: how they are described, what they remember, and the set that holds them.

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
mod materials;
mod pin;
#[cfg(feature = "serde-serialize")]
mod record;
mod region;
mod set;
mod state;
mod steering;
mod stillness;
mod surface;

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
pub use pin::Pin;
#[cfg(feature = "serde-serialize")]
pub(crate) use record::{SetRecord, SetRecordError};
pub use region::Region;
pub use set::FlexBodySet;
pub use state::{AppliedLoad, BodyEnergy, FlexState, FrameMotion, KnownLoads, Linearized};
pub use surface::SurfacePick;
pub(crate) use surface::{OFFSET, contact_offset};
