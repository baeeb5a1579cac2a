//! Contact: candidates, their kinematics (gap, normal, rows of `G`) and their law (friction, restitution).

mod apart;
mod candidate;
mod kinematics;
mod law;
mod memory;
mod rigid_pair;
mod surface;

pub use candidate::{Candidate, ContactKey, Owner, Pair};
pub use kinematics::{Attachment, Kinematics, PlacedPart, Scene};
pub use law::{ContactLaw, Direction};
pub use memory::{ContactMemory, Remembered};
pub use surface::{Cone, SurfacePoint, closest_surface_point};
