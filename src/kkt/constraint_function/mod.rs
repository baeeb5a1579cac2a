//! The constraint function method of ADINA (section C.5 of the source; Bathe and Chaudhary 1985; Eterovic and Bathe 1991), a
//! modification of the method of Lagrange multipliers.
//!
//! Instead of `g >= 0`, `λ >= 0`, `g λ = 0` and Coulomb's cone, every contact obeys two smooth equations,
//!
//! ```text
//! w(g, λ) = (g + λ)/2 - sqrt(((g - λ)/2)² + ε_N) = 0        that is, g λ = ε_N
//! v(u̇, τ) = 0   with   τ + v - (2/π) atan((u̇ - v)/ε_T) = 0  that is, τ = (2/π) atan(u̇/ε_T)
//! ```
//!
//! with the ratio `τ = t/(μ λ)` of the friction force to its limit, and full Newton iterations solve them together with (C.5). Here
//! bodies are linear in the multipliers, so each iteration eliminates their increments: what is left is the Jacobian
//! `diag(∂w/∂g) b0 W + diag(∂w/∂λ)` of the multipliers alone, with the Delassus matrix `W`.
//!
//! Gaps and slips are divided by a length `ℓ`, forces by a force `F`, both the problem's own in every step: `ℓ` is the
//! overlap or slip that contact has to prevent in this step, `F = ℓ/(b0 max W_ii)` what prevents it. So the result depends neither
//! on units nor on the size of things.
//!
//! Signs: `λ` is the pressing force `p >= 0` of the other files; friction acts against the slip, `t = -μ p τ`.
//!
//! | file | owns |
//! |---|---|
//! | `functions` | `w`, `v` and their derivatives |
//! | `newton` | the Jacobian, a Newton step and its line search |
//!
//! `kkt/smooth` iterates with them, and knows what follows when that fails.

mod functions;
mod newton;

pub(super) use newton::{Newton, Scale};

use thiserror::Error;

/// How the laws of contact are enforced in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum ContactMethod {
    /// Lagrange multipliers with exact complementarity and Coulomb's cone.
    #[default]
    Lagrange,
    /// The constraint functions of ADINA: for comparison.
    ConstraintFunction(ConstraintFunction),
}

/// Settings of the constraint function method.
///
/// ```
/// use foil2d::kkt::{ConstraintFunction, ContactMethod};
/// use foil2d::prelude::*;
/// let as_printed = ConstraintFunction::new(1e-12, 1e-3)?.without_line_search();
/// let flex = FlexPipeline::new().with_contact_method(ContactMethod::ConstraintFunction(as_printed));
/// assert_eq!(flex.report().n_substituted(), 0);
/// # Ok::<(), foil2d::kkt::EpsilonError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct ConstraintFunction {
    /// `[ε_N, ε_T]` (-).
    pub(super) epsilon: [f64; 2],
    pub(super) max_iterations: usize,
    pub(super) has_line_search: bool,
    pub(super) has_continuation: bool,
    /// `ℓ` (m) and `F` (N) where they are not the step's own.
    pub(super) scale: Option<[f64; 2]>,
}

/// An `ε` that makes no constraint function.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error(
    "{name} is {value}: give a positive number up to 1, such as 1e-12 for eps_N and 1e-9 for eps_T"
)]
pub struct EpsilonError {
    /// Which one.
    pub name: &'static str,
    /// What was given.
    pub value: f64,
}

impl Default for ConstraintFunction {
    /// `ε_N = 1e-12`, `ε_T = 1e-9` (Newton's iterations hardly notice; with 1e-3 a body creeps visibly), 50 iterations, with line search and continuation.
    fn default() -> Self {
        Self {
            epsilon: [1e-12, 1e-9],
            max_iterations: 50,
            has_line_search: true,
            has_continuation: true,
            scale: None,
        }
    }
}

impl ConstraintFunction {
    /// The method with these `ε_N` and `ε_T` (-).
    ///
    /// A contact carries `g p = ε_N ℓ F`, and a sticking one slips by `ε_T ℓ tan(π τ/2)` in every step.
    ///
    /// # Errors
    /// If one is not within (0, 1].
    pub fn new(epsilon_n: f64, epsilon_t: f64) -> Result<Self, EpsilonError> {
        for (name, value) in [("eps_N", epsilon_n), ("eps_T", epsilon_t)] {
            if !(value > 0.0 && value <= 1.0) {
                return Err(EpsilonError { name, value });
            }
        }
        Ok(Self {
            epsilon: [epsilon_n, epsilon_t],
            ..Self::default()
        })
    }

    /// Divides by this length (m) and force (N) in every step, as a program does that knows neither: with `[1.0, 1.0]` the `ε` have
    /// the units of the model.
    ///
    /// # Panics
    /// If one is not a positive number.
    pub fn with_scale(mut self, length: f64, force: f64) -> Self {
        let is_positive = |value: f64| value > 0.0 && value.is_finite();
        assert!(
            is_positive(length) && is_positive(force),
            "a scale needs a positive length and force, not {length} m and {force} N"
        );
        self.scale = Some([length, force]);
        self
    }

    /// Most iterations of a step before it counts as failed.
    pub fn with_max_iterations(mut self, n: usize) -> Self {
        self.max_iterations = n;
        self
    }

    /// Takes every Newton step in full.
    pub fn without_line_search(mut self) -> Self {
        self.has_line_search = false;
        self
    }

    /// Tries no second time, from large `ε` to small, where the iterations fail.
    pub fn without_continuation(mut self) -> Self {
        self.has_continuation = false;
        self
    }
}
