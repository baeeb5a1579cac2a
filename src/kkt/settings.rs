//! What a solve is asked for, and why there may be none.

use super::constraint_function::ContactMethod;
use crate::linalg::complementarity::{ComplementarityError, Method};
use crate::linalg::cone::ConeError;
use thiserror::Error;

/// Why an island cannot be solved.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum KktError {
    /// A rigid body is too light for the springs that an explicit body meets it with.
    #[error(
        "rigid block {block} is so light that on the surface of an explicit flexible body it vibrates faster than the step of {dt} s resolves: shorten the step below {critical} s, make the body heavier, keep the inertia of the surface (`ContactInertia::Kept`), or choose beta0 > 0"
    )]
    LightPartner {
        /// Its index among the blocks of the island; whoever gathered the island knows its handle.
        block: usize,
        /// The step asked for (s).
        dt: f64,
        /// The longest stable step (s).
        critical: f64,
    },
    /// The contact problem holds numbers that are not finite.
    #[error(transparent)]
    Contact(#[from] ComplementarityError),
    /// The sparse contact problem holds numbers that are not finite.
    #[error(transparent)]
    Cone(#[from] ConeError),
}

/// How impacts are treated. Whether a body's contact boundary carries inertia is chosen per body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub enum ImpactTreatment {
    /// Velocity impulses between masses and on impacts shorter than the step, and no energy from contact: stable at any
    /// step and mesh.
    #[default]
    Stabilized,
    /// (C.5) as printed, multipliers enter the stored acceleration. Unstable on impact: for comparison only.
    Plain,
    /// Velocities and accelerations of masses in contact are projected so that they stay in contact (Hughes et al. 1976;
    /// Laursen and Love 2002): [`Stabilized`](Self::Stabilized) without its energy stage.
    Projected,
    /// The contact forces of a step act on its end alone and are no part of the acceleration that the next step starts from
    /// (Kane et al. 1999): loses energy at impact and gains none afterwards. The velocity of a node that stays in contact
    /// changes sign with every step, and its force swings with it, without growing. Contacts through nodes without mass are
    /// quasi-static as ever.
    ImplicitForces,
}

/// Settings of a solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolveSettings {
    /// Step length (s), of the part that is solved.
    pub dt: f64,
    /// Length of the whole step (s).
    pub whole: f64,
    /// What a multiplier moves, over `A⁻¹` (s²): the Beta-2 weight `b0`, or `dt²` for the forward increment.
    pub b0: f64,
    /// Beta-2 weight `b1` (s).
    pub b1: f64,
    /// Whether multipliers act wholly within the step, so that none goes on.
    pub is_within: bool,
    /// Whether `β0 = 0`, so that multipliers act at the forward increment.
    pub is_explicit: bool,
    /// Whether steps that are too long for a partner are taken all the same.
    pub insists: bool,
    /// What is done on impact.
    pub impact: ImpactTreatment,
    /// How the laws of contact are enforced.
    pub contact: ContactMethod,
    /// The solver that contact problems are given to first.
    pub solver: Method,
    /// Approach velocity below which restitution is ignored (m/s).
    pub restitution_threshold: f64,
    /// Most Newton iterations.
    pub max_newton: usize,
    /// Whether what is not solved is cut into halves, so that where it ends does not matter.
    pub may_be_cut: bool,
    /// What counts as one unit of length in the scene (m).
    pub length_unit: f64,
}

impl SolveSettings {
    /// How long the last step's forces in stored accelerations act on in this one (s).
    pub(super) fn late(&self) -> f64 {
        match self.is_explicit {
            true => 0.0,
            false => self.dt - self.b1,
        }
    }
}
