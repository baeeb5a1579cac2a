//! The equations of the source, and where each is computed.
//!
//! The source is an appendix, "Solution of contact problems using Lagrange multipliers": the restrained equation of motion, multipliers, a step of the
//! Beta-2 method with both, and ADINA's modification of it.
//!
//! | equation | says | computed in |
//! |---|---|---|
//! | (C.1) | `M ẍ + Q(x, ẋ) = R`: motion under internal and external forces | `Q = C ẋ + K x` of small strain: [`fe::model`](crate::fe::model); `Q` of large strain: [`fe::finite_strain`](crate::fe::finite_strain); of your own: [`nonlinear`](crate::nonlinear) |
//! | (C.2) | `G (x + D) = 0`: restraints of what touches | gaps and rows of `G`: [`constraint::contact`](crate::constraint::contact), of joints: [`constraint::joint`](crate::constraint::joint); between what: [`coupling`](crate::coupling), from rapier |
//! | (C.3) | `M ẍ + Q + Gᵀ λ = R`: multipliers are the forces of contact | [`kkt`](crate::kkt), with `λ = -p`: `p` presses |
//! | (C.4a), (C.4b) | the same at the end of a step, with `C = α M + β K` | [`fe::material::Rayleigh`](crate::fe::material::Rayleigh), [`system`](crate::system) |
//! | (C.5) | the increment of a step and its multipliers, one linear system | weights `q0, q1, q2, b0, b1, b2`: [`integrator::Beta2`](crate::integrator::Beta2); the first row, by one factor of `M + b1 C + b0 K`: [`system`](crate::system); the multipliers, with `p >= 0`, `g >= 0`, `p g = 0` and Coulomb's cone: [`linalg::cone`](crate::linalg::cone), [`linalg::complementarity`](crate::linalg::complementarity) |
//! | C.4, methods 1 to 3 | linear acceleration, constant acceleration, central difference | [`Beta2::linear_acceleration`](crate::integrator::Beta2::linear_acceleration), [`trapezoidal`](crate::integrator::Beta2::trapezoidal), [`central_difference`](crate::integrator::Beta2::central_difference) |
//! | C.4, generalized Beta-m | the family that Beta-2 belongs to | [`integrator::BetaM`](crate::integrator::BetaM) |
//! | C.5 | ADINA's restrained functions | [`kkt::ConstraintFunction`](crate::kkt::ConstraintFunction) |
//!
//! # What (C.5) says
//!
//! `Δx` in (C.5) multiplies the mass without a weight and everything else with its own: it is the increment of the acceleration, and the step ends at
//! `x = q0 + b0 Δx`, `ẋ = q1 + b1 Δx`, `ẍ = q2 + Δx`.
//!
//! ```
//! use foil2d::integrator::Beta2;
//! let weights = Beta2::trapezoidal().weights(0.1);
//! assert!((weights.b0 - 0.5 * 0.01 * 0.5).abs() < 1e-18 && (weights.b1 - 0.1 * 0.5).abs() < 1e-18);
//! ```
//!
//! # Where the source is silent
//!
//! | question | answer |
//! |---|---|
//! | inequalities: contact pushes only, friction is bounded | complementarity and Coulomb's cone, solved to the end of a Newton method on a sparse factor |
//! | `G` depends on where things are | passes: measure, assemble, respond, until what was measured at the end is what was assumed |
//! | impacts: velocities jump | a velocity stage with the same rows, and surfaces whose mass is moved inside, so that an impact conserves energy |
//! | large strains | the member `m = 1` of Beta-m with the stress that conserves energy and angular momentum, see [`large`](crate::large) |
//! | what passes through within a step | a feasible path: times of impact, and a certificate that nothing overlaps at the end |
