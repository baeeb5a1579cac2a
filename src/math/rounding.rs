//! What rounding may have made of a number, by what the number was computed from.
//!
//! A sum of `n` products in double precision is off by at most `n u` of the sum of their sizes, `u = ε/2 = 1.1e-16` (Higham, *Accuracy and
//! Stability of Numerical Algorithms*, 2nd ed., §3.1), and what was solved from such sums by that times the condition of the system. What
//! is below one of these shares of the terms it came from is taken for nothing; each is far below what any length, force or motion of a
//! scene means, and far above what it stands for. So nothing depends on their digits.

/// After some tens of operations, such as a determinant, a pivot or the change of one sweep (-): 45 ε.
pub const FEW: f64 = 1e-14;

/// A sum over a body or a scene, thousands of terms (-): 4,500 ε.
pub const SUM: f64 = 1e-12;

/// The answer of a factorized system to such sums (-): what is left of a row, a pivot or a vector when others have been taken out of it and
/// it depends on them. Ten times [`SUM`].
pub const SOLVED: f64 = 1e-11;

/// What was iterated, or computed from what had been solved (-): ten times [`SOLVED`].
pub const ITERATED: f64 = 1e-10;

/// A share of something by which it is measured, such as a cosine, a weight, a place along an edge, or what depends on what was iterated (-):
/// ten times [`ITERATED`].
pub const SHARE: f64 = 1e-9;

/// The square of what leaves nothing of a lever (-): `(√ε)²`, in which a mobility by levers goes under.
pub const SQUARE: f64 = 1e-16;

/// What single precision leaves of numbers that a user or rapier has given, in builds of any precision (-): 8 ε of it.
pub const SINGLE: f64 = 1e-6;
