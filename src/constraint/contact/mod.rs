//! Contact: candidates, their kinematics (gap, normal, rows of `G`) and their law (friction, restitution).

mod apart;
mod candidate;
mod kinematics;
mod law;
mod measure;
mod memory;
mod rigid_pair;
mod scene;
mod surface;

pub use candidate::{Candidate, ContactKey, Owner, Pair};
pub use kinematics::{Attachment, Kinematics};
pub use law::{ContactLaw, Direction};
pub use memory::{ContactMemory, Remembered};
pub use scene::{PlacedPart, Scene};
pub use surface::{Cone, SurfacePoint, closest_surface_point};
