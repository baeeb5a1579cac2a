//! Bodies that bend, stretch and fold: steps and equilibria of a [`FiniteStrainModel`] in world coordinates.
//!
//! This steps one such body by itself, under nodal loads and with held dofs. In a [`FlexPipeline`](crate::pipeline::FlexPipeline) a
//! [`FlexBody`](crate::body::FlexBody) of a [`HyperelasticSolid`] takes the same steps, with contact and joints.
//!
//! A step is the generalized Beta-m method with m = 1 and `β0 = 1/2`, with the conserving stress between both ends:
//!
//! ```text
//! x' = x + dt/2 (v + v'),    M (v' - v)/dt + α M (x' - x)/dt + Σ ∫ P(F, F') : ∇N dV = f
//! ```
//!
//! State is `(x, v)` alone. Without decay, energy and angular momentum of a free body are those it began with, to the tolerance of
//! the iterations; with decay vibrations die and rotations go on. For small strains that is the trapezoidal rule.
//!
//! | file | owns |
//! |---|---|
//! | `motion` | positions and velocities, their energy and momenta |
//! | `settings` | tolerance, decay, how hard to try |
//! | `equation` | the residual of a step or of an equilibrium |
//! | `newton` | the iteration on one factor, renewed when it converges slowly |
//! | `balance` | the rigid motion that iterations leave |
//! | `turn` | the mean rotation of a body, by which a factor is turned |
//! | `stepper` | [`LargeStepper`]: a step, in halves where it is not found |
//! | `equilibrium` | [`LoadStepper`]: equilibrium under loads that grow, in smaller increments where it is not found |
//! | `load_case` | a load case gone through in increments |
//! | `increments` | how far these go |
//! | `contact` | [`ContactStepper`]: equilibrium between rigid obstacles, with Coulomb's friction |
//! | `continuation` | [`PathStepper`]: equilibrium along a path, past limit points and onto paths that cross |
//! | `error` | [`LargeError`] |

mod balance;
mod contact;
mod continuation;
mod equation;
mod equilibrium;
mod error;
mod increments;
mod load_case;
mod motion;
mod newton;
mod settings;
mod stepper;
mod turn;

pub use contact::{ContactCase, ContactPoint, ContactStepper, Obstacle};
pub use continuation::{
    BranchPoint, FollowerForce, LimitPoint, PathCase, PathEnd, PathPoint, PathReport, PathSettings,
    PathStepper,
};
pub(crate) use equation::{Equation, Evaluation, Inertia};
pub use equilibrium::LoadStepper;
pub use error::LargeError;
pub use load_case::{LoadCase, LoadReport};
pub use motion::WorldMotion;
pub(crate) use newton::{MOST_CUTS, SLOWEST, largest_row_sum};
pub use settings::LargeSettings;
pub(crate) use stepper::most_growth;
pub use stepper::{LargeStepper, StepWork};

#[cfg(doc)]
use crate::fe::{finite_strain::FiniteStrainModel, material::hyperelastic::HyperelasticSolid};
