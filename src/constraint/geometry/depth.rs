//! How deep is deep: the one length, relative to a part, that tells what rests on it from what has come into it.

use crate::math::judged::Judged;

/// Depth, relative to the least thickness of a part, down to which a point rests on its surface (-).
///
/// Bodies at rest in rapier overlap by a few thousandths of their size, and what is solved here by rounding. A point that came in by
/// less may as well be outside; larger values let points that come in close to a corner be taken for ones that came through the
/// other face.
pub const RESTING: Judged = Judged::new("constraint::RESTING", 1e-3);

/// The same, relative to the size, where there is no thickness, or where two faces are compared: a tenth of it, or a face that is kept
/// though another is better would report gaps that are wrong by what rests (-).
pub const RESTING_THIN: Judged = RESTING.times(0.1);

/// Depth from which bodies have been put or shot into each other, ten times what rests (-).
pub const DEEP: Judged = RESTING.times(10.0);
