//! Plane contact geometry of rounded convex parts, free of any engine type: signed distance of a point, contacts of
//! a pair, projection on a boundary segment.
//!
//! A part is the Minkowski sum of a convex core (point, segment, polygon or half-plane) and a disc of radius `r`, so
//! its signed distance follows from that of the core,
//!
//! ```text
//! distance(p) = distance_core(p) - r,      surface point = foot + r normal,      grad distance = normal,
//! ```
//!
//! with `distance < 0` inside. No query allocates.

mod clip;
mod convex_part;
mod depth;
mod entered;
mod entry;
mod outline;
mod pair_axis;
mod polygon_pair;
mod pose;
mod segment_query;
mod separation;
pub(crate) mod tangle;

pub use convex_part::{ConvexPart, Feature};
pub(crate) use depth::{DEEP, RESTING, RESTING_THIN};
pub use entered::{crossing_overlap, entered_separation, start_separation};
pub use polygon_pair::{FaceOrVertex, PairContact, PairContacts, PairReference, polygon_pair};
pub use pose::Pose2;
pub use segment_query::{SegmentQuery, SegmentRegion, segment_query};
pub use separation::{Separation, faced_separation, separation};
