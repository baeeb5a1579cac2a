//! Flexible bodies: how they are described, what they remember, and the set that holds them.

mod attachment;
mod build;
mod builder;
mod contact_offset;
mod contact_settings;
mod critical;
mod error;
mod flex_body;
mod frame;
mod handle;
mod kept_motion;
mod pick;
mod pin;
#[cfg(feature = "serde-serialize")]
mod record;
mod set;
mod small_strain;
mod state;
mod steering;
mod stillness;

pub(crate) use attachment::{Anchor, Choice, Plan, Shift};
pub use attachment::{
    Attachment, AttachmentBuilder, AttachmentError, AttachmentHandle, AttachmentKind,
    AttachmentTarget,
};
pub use builder::{ContactInertia, FlexBodyBuilder};
pub(crate) use contact_offset::contact_offset;
pub use contact_settings::ContactSettings;
pub use error::{BuildError, FlexBodyError};
pub use flex_body::FlexBody;
pub use frame::{Arms, Frame, frame_of};
pub use handle::FlexBodyHandle;
pub(crate) use kept_motion::KeptMotion;
pub use pick::SurfacePick;
pub use pin::Pin;
#[cfg(feature = "serde-serialize")]
pub(crate) use record::{SetRecord, SetRecordError};
pub use set::FlexBodySet;
pub use state::{AppliedLoad, BodyEnergy, FlexState, FrameMotion, KnownLoads};
