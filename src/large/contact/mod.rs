//! Equilibrium against rigid obstacles, by Lagrange multipliers and Coulomb's law.
//!
//! Nodes of the surface that touch are on the obstacle, `g(x) = 0`; what holds them there is what is out of balance there,
//! `λ n + t τ = f_int - f`, so no multiplier is an unknown of its own. The equations of such a node, with the residual `r = f - f_int`, are
//!
//! ```text
//! open      r = 0                           while g > 0
//! sticks    g = 0,  s = 0                   while λ ≥ 0,  |t| ≤ μ λ
//! slides    g = 0,  (τ - σ μ n)·r = 0       while λ ≥ 0,  σ s ≤ 0         t = σ μ λ
//! ```
//!
//! with the slip `s` of the material point along the obstacle since the beginning of the increment. Newton's iterations solve them for the
//! positions, with the turning of `n` along what is round, and look anew at every iterate which of them hold: a semismooth Newton method (Alart and Curnier 1991;
//! Hintermüller, Ito, Kunisch 2002). The system is not symmetric where something slides, and is factorized by LU.
//!
//! | file | owns |
//! |---|---|
//! | `obstacle` | [`Obstacle`]: gap, normal and curvature |
//! | `touch` | what a node does at an obstacle, and its equations |
//! | `passage` | whether an obstacle goes through the surface within an increment |
//! | `iteration` | the iteration, from an increment's guess to its equilibrium |
//! | `stepper` | [`ContactStepper`]: load cases |

mod iteration;
mod obstacle;
mod passage;
mod stepper;
mod touch;

pub use obstacle::Obstacle;
pub use stepper::{ContactCase, ContactStepper};
pub use touch::ContactPoint;
