//! A body at large strain in world coordinates: `f = Σ ∫ P : ∇N dV`, `K = ∂f/∂x'`, in the undeformed geometry.
//!
//! The gradient of deformation at a quadrature point is `F = Σ_a x_a ⊗ dN_a/dX`, taken from *differences* of coordinates within
//! a cell, so that it does not lose digits far from the origin. Stresses are those of a [`Hyperelastic`] law,
//!
//! ```text
//! equilibrium       P = 2 W_t F + W_J cof F
//! energy-momentum   P = 2 a F½ + b cof F½ + χ/2 (2 μ F½ (E' - E) + λ (J' - J) cof F½),    E = (FᵀF - I)/2
//! ```
//!
//! where the first two terms conserve energy and angular momentum of a step from `F` to `F'` exactly (see
//! [`hyperelastic`](crate::fe::material::hyperelastic)), and the third, with Lamé's constants `λ` and `μ` at rest, makes
//! vibrations decay: it takes `χ/2 (2 μ (E' - E) : (E' - E) + λ (J' - J)²) ≥ 0` from them, and nothing from rotations. What keeps its volume
//! is resisted by `μ` alone, however little the material gives way to pressure: `tr E` changes then too, at any strain that is not small.
//! For small strains that is the stiffness part `χ dt/2` of Rayleigh damping.
//!
//! | file | owns |
//! |---|---|
//! | `point` | stress and moduli at one quadrature point |
//! | `cells` | cells of one node count, and their kernels |
//! | `one_cell` | what a cell takes from its nodes, and gives to forces and matrix |
//! | `deformed` | gradients and what has flowed, at the quadrature points |
//! | `flow` | bodies whose law flows: the same kernels after what has flowed, and its commitment |
//! | `hourglass` | the modes that the one point of a four-node cell does not see |
//! | `dilatation` | areas of eight-node cells, smoothed so that they do not lock |
//! | `description` | what a body is assembled from |
//! | `pressure` | a constant pressure, a gas that is shut in |
//! | `lanes` | the kernels of laws that do not flow, four cells side by side |
//! | `hole` | holes of the body under pressure |
//! | `linearization` | which matrix stands for the derivative of the forces |
//! | `model` | the assembled body |
//! | `solid` | law and density of a region |
//! | `stress` | Cauchy's stress and stretches |
//! | `treatment` | what is done so that cells do not lock |
//!
//! Tri3 and Tri6 take their usual fields, so does an element of the user's own. [`Quad4`](crate::fe::element::Quad4) takes its mean gradient, and its hourglass
//! modes resist as its inner modes let them at small strain. [`Quad8`](crate::fe::element::Quad8) takes what resists a change of volume from a linear fit.

mod cells;
mod deformed;
mod description;
mod dilatation;
mod flow;
mod guard;
mod hole;
mod hourglass;
mod lanes;
mod linearization;
mod model;
mod one_cell;
mod point;
mod pressure;
mod solid;
mod stress;
mod treatment;

pub use deformed::Deformation;
pub use description::{FiniteStrainDescription, FiniteStrainError};
pub use flow::FlowEnergy;
pub use linearization::Linearization;
pub use model::FiniteStrainModel;
pub use point::Form;
pub use pressure::{ATMOSPHERE, InnerPressure, PressureError};
pub use solid::Solid;

#[cfg(doc)]
use crate::fe::material::hyperelastic::Hyperelastic;

/// A cell where the law has no energy.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "cell {cell} has det F = {jacobian:e}, where the {law} law has no energy: shorten the step or take more increments, or take a law that \
     admits it, such as the stable neo-Hookean one"
)]
pub struct Inadmissible {
    /// The cell.
    pub cell: usize,
    /// Its `det F` at a quadrature point or a node (-).
    pub jacobian: f64,
    /// Name of the law.
    pub law: &'static str,
}
