//! The lowest natural frequencies of a body and their shapes: the smallest `ω²` of `K φ = ω² M φ`.
//!
//! The eigenvalues looked for are the largest of `(K + s M)⁻¹ M`, which block Lanczos finds in a few dozen solves with one factor
//! (Grimes, Lewis and Simon 1994). Vectors are kept orthogonal to all others, and a second search from another start looks for
//! what the first has missed, so that frequencies are found as often as they occur. Nodes without mass follow the others
//! quasi-statically, as `K φ = 0` in their rows.
//!
//! What a body does without resistance has the frequency 0 and not what rounding makes of it: rigid motions that nothing holds are known
//! beforehand, and `φ·K φ` that is within the rounding of its terms is 0.
//!
//! | file | owns |
//! |---|---|
//! | `pencil` | `K`, `M`, and the factor of `K + s M` |
//! | `rigid` | motions that nothing resists, known by the positions |
//! | `krylov` | one search by block Lanczos |
//! | `search` | the shift, and searches until nothing is missed |

mod krylov;
mod pencil;
mod rigid;
mod search;
#[cfg(test)]
mod tests;

use super::finite_strain::{FiniteStrainModel, Form, Inadmissible, Linearization};
use super::mass_matrix::MassMatrix;
use super::model::Model;
use crate::linalg::cholesky::CholeskyError;
use pencil::Pencil;
use thiserror::Error;

/// Why natural modes cannot be computed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ModesError {
    /// No shift makes `K + s M` positive definite.
    #[error("the stiffness of the body cannot be factorized with any share of its mass added: {0}")]
    Factor(#[from] CholeskyError),
    /// There are not so many modes.
    #[error("{asked} modes were asked for, but only {available} dofs are free and carry mass")]
    TooMany {
        /// Modes asked for.
        asked: usize,
        /// Modes there are.
        available: usize,
    },
    /// The vectors allowed do not hold the modes to the tolerance.
    #[error(
        "{n_found} of {asked} modes were found after {n_solves} solves: allow a larger tolerance, or ask for fewer"
    )]
    NotConverged {
        /// Modes found to the tolerance.
        n_found: usize,
        /// Modes asked for.
        asked: usize,
        /// Solves with the factor.
        n_solves: usize,
    },
    /// The tolerance is not a sound number.
    #[error("the tolerance is {0}: give a relative one between 1e-14 and 0.1")]
    Tolerance(f64),
    /// There is not one finite position per dof.
    #[error("{found} finite positions were given for {expected} dofs")]
    Positions {
        /// Finite numbers given.
        found: usize,
        /// Numbers needed.
        expected: usize,
    },
    /// A cell is where its law has no energy.
    #[error(transparent)]
    Inadmissible(#[from] Inadmissible),
}

/// One natural mode.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// `ω²` (rad²/s²): exactly 0 for what nothing resists, negative where a deformed body is not stable.
    pub square: f64,
    /// Distance of `square` from the nearest eigenvalue at most (rad²/s²), the rounding of `φ·K φ` included.
    pub error: f64,
    /// The shape, interleaved, with `φ·M φ = 1` (1/√kg); zero at held dofs. Its largest entry is positive.
    pub shape: Vec<f64>,
}

impl Mode {
    /// The angular frequency (rad/s), 0 where the body is not stable.
    pub fn frequency(&self) -> f64 {
        self.square.max(0.0).sqrt()
    }

    /// The rate at which the mode grows where the body is not stable (1/s), else 0.
    pub fn growth(&self) -> f64 {
        (-self.square).max(0.0).sqrt()
    }
}

/// The lowest modes of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    /// Ascending.
    pub modes: Vec<Mode>,
    /// Modes with frequency 0: rigid motions that nothing holds, and mechanisms.
    pub n_rigid: usize,
    /// Solves with the factor that it took.
    pub n_solves: usize,
    /// Factorizations.
    pub n_factorizations: usize,
}

impl Modes {
    /// All angular frequencies (rad/s), ascending.
    pub fn frequencies(&self) -> Vec<f64> {
        self.modes.iter().map(Mode::frequency).collect()
    }
}

/// The `n_modes` lowest natural modes of a body of small strain.
///
/// - `is_fixed`: one flag per dof, or empty for a body that is not held.
/// - `tolerance`: known relative error of `ω² + s`, with a shift `s` about the lowest `ω²` above 0, at which a mode counts as found; 1e-10 is
///   reached as soon as 1e-6, nearly.
///
/// ```
/// use foil2d::fe::mesh::generate;
/// use foil2d::fe::modes::lowest_modes;
/// use foil2d::prelude::*;
///
/// // A free bar of length 1 m: three rigid motions, then the first bending.
/// let mesh = generate::rectangle([1.0, 0.05], [20, 1], CellKind::Tri6)?;
/// let body = FlexBodyBuilder::mesh(mesh)
///     .small_strain()
///     .material(LinearElastic::plane_stress(1e6, 0.3).density(1000.0))
///     .build()?;
/// let modes = lowest_modes(body.model(), &[], 4, 1e-10)?;
/// assert_eq!(modes.n_rigid, 3);
/// let slender = 22.3733 * 0.05 * (1e6f64 / 1000.0 / 12.0).sqrt();
/// assert!((modes.modes[3].frequency() / slender - 1.0).abs() < 0.02);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`ModesError`], if there are not so many modes, the tolerance is out of range or not reached, or no factor exists.
///
/// # Panics
/// If `is_fixed` is neither empty nor one flag per dof.
pub fn lowest_modes(
    model: &Model,
    is_fixed: &[bool],
    n_modes: usize,
    tolerance: f64,
) -> Result<Modes, ModesError> {
    let pencil = Pencil::new(model.stiffness().clone(), model.mass(), is_fixed);
    search::lowest(pencil, model.rest_positions(), n_modes, tolerance)
}

/// The `n_modes` lowest modes of small vibrations about a deformed state of a body of large strain, its stress included: a string's
/// are those of its tension.
///
/// The state should be an equilibrium under dead loads, with the held dofs at rest. Shapes are in the world's axes.
///
/// - `positions`: where the nodes are (m).
/// - `is_held`, `tolerance`: as for [`lowest_modes`].
///
/// # Errors
/// [`ModesError`], as for [`lowest_modes`], and if a cell is where its law has no energy.
///
/// # Panics
/// If `is_held` is neither empty nor one flag per dof.
pub fn lowest_modes_at(
    model: &FiniteStrainModel,
    positions: &[f64],
    is_held: &[bool],
    n_modes: usize,
    tolerance: f64,
) -> Result<Modes, ModesError> {
    let (found, expected) = (positions.len(), model.n_dofs());
    let n_finite = positions.iter().filter(|x| x.is_finite()).count();
    if found != expected || n_finite != expected {
        return Err(ModesError::Positions {
            found: n_finite,
            expected,
        });
    }
    let mut deformation = model.deformation(positions);
    let mut residual = vec![0.0; expected];
    let form = Form::Equilibrium;
    model.subtract_force(form, positions, &mut deformation, &mut residual)?;
    let mut tangent = model.new_matrix();
    let kind = Linearization::Consistent;
    model.add_tangent(form, kind, &deformation, &mut tangent);
    let mass = MassMatrix::Lumped(model.masses().to_vec());
    let pencil = Pencil::new(tangent, &mass, is_held);
    search::lowest(pencil, positions, n_modes, tolerance)
}
