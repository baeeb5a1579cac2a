//! Steps of the non-linear equation of motion (C.1), `M ẍ + Q(x, ẋ) = R`, with forces that the user gives.
//!
//! The step of (C.5) without contact becomes Newton's iteration on the increment of acceleration `Δ`:
//! `x' = q0 + b0 Δ`, `ẋ' = q1 + b1 Δ`, `ẍ' = q2 + b2 Δ`,
//!
//! ```text
//! r(Δ) = R' - [M ẍ' + Q(x', ẋ')],    (b2 M + b1 ∂Q/∂ẋ + b0 ∂Q/∂x) dΔ = r,    Δ += s dΔ
//! ```
//!
//! with the first row of (C.5) as its first iteration if `Q = C ẋ + K x`. The share `s` is halved until the residual falls.
//!
//! | file | owns |
//! |---|---|
//! | `force` | [`InternalForce`], what the user writes |
//! | `laws` | a spring, a drag, and the sum of two forces |
//! | `stepper` | [`NonLinearStepper`]: one step by Beta-2 |
//! | `newton` | the iteration and its line search |
//! | `difference` | tangents by finite differences |
//! | `dense` | LU factors of small dense matrices |
//!
//! Matrices are dense and row-major: the module is for springs, dampers and lumped models of some dozens of dofs.

mod dense;
mod difference;
mod error;
mod force;
mod laws;
mod newton;
mod stepper;

pub use error::NonLinearError;
pub use force::{InternalForce, TangentSource};
pub use laws::{CubicSpring, QuadraticDrag, Sum};
pub use newton::{NewtonReport, NewtonSettings};
pub use stepper::{Motion, NonLinearStepper};
