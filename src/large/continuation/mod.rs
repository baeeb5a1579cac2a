//! Equilibria along a path, past limit points: `r(x, λ) = f0 + λ (f1 - f0) - f_int(x) = 0` with one more equation.
//!
//! The unknowns are the positions of free dofs and the load factor λ together. An increment goes on along the tangent of the path, and is
//! corrected in the plane normal to it (Riks, Wempner; consistently linearised as by Ramm):
//!
//! ```text
//! |  K   -q | | dx |   | r |        K = -∂r/∂x,  q = ∂r/∂λ
//! |  cᵀ   d | | dλ | = | g |        c·dx = 0 normal to the tangent, or dλ = 0, or dx_i = 0 at the end that is asked for
//! ```
//!
//! That system is regular where `K` is not, so that loads may fall and places go back; the tangent is oriented by the one before it. Lengths
//! along the path are root mean squares of displacements over the masses, in radii of gyration: neither units nor numbering nor
//! the size of cells matter.
//!
//! `K` need be neither definite nor, with forces that turn with the body, symmetric: it is factorized by [`lu`](crate::linalg::lu) in every iteration.
//!
//! | file | owns |
//! |---|---|
//! | `case` | loads and places along the path, and where to stop |
//! | `follower` | forces that turn with the body, and their derivative |
//! | `bordered` | the factor and the system above |
//! | `corrector` | Newton's iteration on it |
//! | `report` | [`PathPoint`], [`LimitPoint`], [`PathReport`] |
//! | `stepper` | [`PathStepper`]: increments, limit points, ends |
//! | `branch` | crossings of paths, and the way along the other one |

mod bordered;
mod branch;
mod case;
mod corrector;
mod follower;
mod length;
mod report;
mod stepper;

pub use branch::BranchPoint;
pub use case::{PathCase, PathEnd, PathSettings};
pub use follower::FollowerForce;
pub use report::{LimitPoint, PathPoint, PathReport};
pub use stepper::PathStepper;
