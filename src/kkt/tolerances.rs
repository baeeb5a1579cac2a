//! How closely the laws of contact are asked to hold, and what is given way where they cannot: values that several stages go by.

use crate::math::judged::Judged;

/// Rate at which bodies that were put into each other part (1/s): a third of the overlap in a step of 1/60 s.
pub(super) const PARTING_RATE: Judged = Judged::new("kkt::PARTING_RATE", 24.0);

/// Multiple of the tolerance from which an overlap counts as put there.
pub(super) const OVERLAPPED: Judged = Judged::new("kkt::OVERLAPPED", 1e7);

/// Turning below this angle (rad) changes no position by more than round-off.
pub(super) const ANGLE_TOLERANCE: f64 = 1e-11;

/// Share of the margin within which the laws hold where the contacts are many (-): a thousandth moves no force that counts.
pub(super) const LARGE_TOLERANCE: f64 = 1e-3;

/// Passes after which laws of many contacts need only hold to [`CLOSE_ENOUGH`], and passes of what has used up its budget.
pub(crate) const FEW_PASSES: usize = 6;

/// Share of its way's margin by which a true gap or slip may miss what the law asks for (-), and of what many contacts missed with the forces of the
/// last step.
pub(super) const CLOSE_ENOUGH: f64 = 0.05;

/// Shares of its own mobility that a contact gives way by, one after the other (-): the first costs a pass three digits.
pub(super) const SOFTNESS: [f64; 3] = [1e-3, 1e-2, 1e-1];

/// Share of its own mobility that every row gives way by to its force (-): `w = (W + s D) p + b`, `D` the diagonal of `W`.
///
/// Where a body fits between two that nothing moves, forces of any size press it and change nothing; an interior point goes to the middle of all
/// of them. With this what rows disagree about, `d`, ends in a force of `d / (s D)`, and what carries `p` rests nearer by a
/// millionth of the way that `p` would move it in the step. Friction gives way to the change of its force only, as it would creep.
pub(super) const YIELDING: f64 = 1e-6;
