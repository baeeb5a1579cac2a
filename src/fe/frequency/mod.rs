//! The largest natural frequency of a body: the largest `ω²` of `K φ = ω² M φ`, which bounds the step of a conditionally
//! stable integrator.
//!
//! [`frequency_bound`] is safe and cheap: by Irons' theorem no frequency of a body exceeds the largest one of its cells taken
//! apart. [`largest_frequency`] finds the frequency itself by Lanczos' iteration on `M⁻¹ K`; it approaches from below, and is
//! what to compare the bound with.
//!
//! Nodes without mass follow the others quasi-statically: they are condensed out, `K_mm - K_ms K_ss⁻¹ K_sm`. Condensation
//! only takes stiffness away, so for the bound they may as well be held.

mod lanczos;

use super::mass_matrix::MassMatrix;
use super::model::{Model, ModelError};
use crate::linalg::cholesky::{BlockCholesky, CholeskyError};
use crate::math::rounding;
use lanczos::{Operator, iterate};
use nalgebra::{Cholesky, DMatrix, SymmetricEigen};
use thiserror::Error;

/// Why a largest frequency cannot be computed.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum FrequencyError {
    /// The stiffness of massless nodes, or the consistent mass, cannot be factorized.
    #[error("the inner solve of the frequency iteration failed: {0}")]
    Factor(#[from] CholeskyError),
    /// The tolerance was not reached.
    #[error(
        "the largest frequency is near {estimate} rad/s, known to {error} rad/s after {n_products} products: allow a larger tolerance, or use the bound"
    )]
    NotConverged {
        /// The best estimate (rad/s).
        estimate: f64,
        /// Its error estimate (rad/s).
        error: f64,
        /// Products with the stiffness matrix.
        n_products: usize,
    },
    /// The tolerance is not a sound number.
    #[error("the tolerance is {0}: give a relative one between 1e-12 and 0.5")]
    Tolerance(f64),
}

/// The largest natural frequency as Lanczos' iteration found it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LargestFrequency {
    /// The frequency (rad/s); the true largest one is not below it, apart from rounding.
    pub frequency: f64,
    /// Distance to the nearest natural frequency at most (rad/s).
    pub error: f64,
    /// Products with the stiffness matrix that it took.
    pub n_products: usize,
}

/// An upper bound (rad/s) of all natural frequencies: the largest one of a single cell (Irons).
///
/// `ω² = (Σ φᵀk φ)/(Σ φᵀm φ) <= max_c (φᵀk φ)/(φᵀm φ)` for any masses of cells that add up to that of the body. A consistent
/// mass is that of the cells; nodal masses are shared among the cells around the node in proportion to what they lumped there
/// or to their stiffness, whichever gives the lower bound. Massless nodes are held.
///
/// - `is_fixed`: one flag per dof, or empty for a body that is not held.
///
/// # Errors
/// If an element cannot evaluate its matrices, which the assembly of the model would have reported.
///
/// # Panics
/// If `is_fixed` is neither empty nor one flag per dof.
pub fn frequency_bound(model: &Model, is_fixed: &[bool]) -> Result<f64, ModelError> {
    assert_flags(model, is_fixed);
    let is_held =
        |dof: usize| is_fixed.get(dof).copied().unwrap_or(false) || model.is_massless(dof / 2);
    let factor = mass_changes(model)?;
    let mut largest = [0.0f64; 2];
    let mut shared = Vec::new();
    model.for_each_cell(|nodes, stiffness, mass| {
        let cell = Cell {
            nodes,
            stiffness,
            free: (0..2 * nodes.len())
                .filter(|&dof| !is_held(2 * nodes[dof / 2] + dof % 2))
                .collect(),
        };
        if let MassMatrix::Lumped(total) = model.mass() {
            let by_mass = nodes.iter().zip(mass).map(|(&node, m)| m * factor[node]);
            shared.clear();
            shared.extend(by_mass);
            cell.raise(&mut largest[0], &shared);
            let by_stiffness = nodes.iter().enumerate().map(|(slot, &node)| {
                let whole = model.stiffness().block(node, node).map_or(1.0, trace);
                total[node] * cell.node_stiffness(slot) / whole
            });
            shared.clear();
            shared.extend(by_stiffness);
            cell.raise(&mut largest[1], &shared);
        } else {
            cell.raise(&mut largest[0], mass);
            largest[1] = largest[0];
        }
    })?;
    Ok((largest[0].min(largest[1]) * (1.0 + MARGIN)).sqrt())
}

/// What an eigenvalue of a cell may exceed the largest one before it is computed: far above its rounding.
const MARGIN: f64 = rounding::SUM;

/// Factor per node from the mass its cells lumped there to the mass it has now; empty for a consistent mass.
fn mass_changes(model: &Model) -> Result<Vec<f64>, ModelError> {
    let MassMatrix::Lumped(now) = model.mass() else {
        return Ok(Vec::new());
    };
    let mut lumped = vec![0.0; now.len()];
    model.for_each_cell(|nodes, _, mass| {
        for (&node, mass) in nodes.iter().zip(mass) {
            lumped[node] += mass;
        }
    })?;
    Ok(now
        .iter()
        .zip(lumped)
        .map(|(now, lumped)| now / lumped)
        .collect())
}

/// A cell by itself.
struct Cell<'a> {
    nodes: &'a [usize],
    /// Row-major (N/m).
    stiffness: &'a [f64],
    /// Local dofs that may move.
    free: Vec<usize>,
}

impl Cell<'_> {
    fn entry(&self, row: usize, column: usize) -> f64 {
        self.stiffness[2 * self.nodes.len() * row + column]
    }

    /// Trace of the diagonal block of a local node (N/m).
    fn node_stiffness(&self, slot: usize) -> f64 {
        self.entry(2 * slot, 2 * slot) + self.entry(2 * slot + 1, 2 * slot + 1)
    }

    /// Raises `largest` to the largest `ω²` with nodal masses, shape `(n)`, or a mass matrix, shape `(n, n)`.
    fn raise(&self, largest: &mut f64, mass: &[f64]) {
        let n_free = self.free.len();
        if n_free == 0 {
            return;
        }
        let stiffness = DMatrix::from_fn(n_free, n_free, |i, j| {
            self.entry(self.free[i], self.free[j])
        });
        let n_nodes = self.nodes.len();
        let mass = DMatrix::from_fn(n_free, n_free, |i, j| {
            let (a, b) = (self.free[i], self.free[j]);
            if a % 2 != b % 2 {
                0.0
            } else if mass.len() > n_nodes {
                mass[a / 2 * n_nodes + b / 2]
            } else if i == j {
                mass[a / 2]
            } else {
                0.0
            }
        });
        // If λ m - k is positive definite, so that all eigenvalues are below λ: most cells of a mesh, at a fifth of the cost.
        let limit = *largest * (1.0 + MARGIN);
        if limit > 0.0 && Cholesky::new(&mass * limit - &stiffness).is_some() {
            return;
        }
        *largest = largest.max(largest_eigenvalue(stiffness, mass));
    }
}

fn trace(block: &[f64; 4]) -> f64 {
    block[0] + block[3]
}

/// The largest `λ` of `k φ = λ m φ`, infinite if `m` is not positive definite.
fn largest_eigenvalue(mut k: DMatrix<f64>, m: DMatrix<f64>) -> f64 {
    const MOST_ITERATIONS: usize = 1000;
    let Some(factor) = Cholesky::new(m) else {
        return f64::INFINITY;
    };
    // L⁻¹ k L⁻ᵀ, the second solve on the transpose.
    factor.l_dirty().solve_lower_triangular_mut(&mut k);
    k.transpose_mut();
    factor.l_dirty().solve_lower_triangular_mut(&mut k);
    let trace = k.trace();
    // Eigenvalues of a stiffness are not negative: their sum bounds the largest.
    SymmetricEigen::try_new(k, f64::EPSILON, MOST_ITERATIONS)
        .map_or(trace, |eigen| eigen.eigenvalues.max())
}

/// The largest natural frequency, by Lanczos' iteration on `M⁻¹ K` from a fixed random start.
///
/// The iteration ends when the frequency is known to `tolerance` (relative): some 30 to 100 products with `K`, whatever the
/// number of dofs. Rigid motion does no harm. A consistent mass and massless nodes each need one factorization.
///
/// - `is_fixed`: one flag per dof, or empty for a body that is not held.
///
/// # Errors
/// [`FrequencyError`], if the tolerance is out of range or not reached, or if a factorization fails.
///
/// # Panics
/// If `is_fixed` is neither empty nor one flag per dof.
pub fn largest_frequency(
    model: &Model,
    is_fixed: &[bool],
    tolerance: f64,
) -> Result<LargestFrequency, FrequencyError> {
    assert_flags(model, is_fixed);
    if !(1e-12..=0.5).contains(&tolerance) {
        return Err(FrequencyError::Tolerance(tolerance));
    }
    let mut pencil = Pencil::new(model, is_fixed)?;
    let found = iterate(&mut pencil, tolerance);
    let frequency = found.eigenvalue.max(0.0).sqrt();
    // `|√a - √b| = |a - b| / (√a + √b)`, and at worst b = 0.
    let error = if frequency > 0.0 {
        found.error / frequency
    } else {
        0.0
    };
    if !found.is_converged {
        return Err(FrequencyError::NotConverged {
            estimate: frequency,
            error,
            n_products: found.n_products,
        });
    }
    Ok(LargestFrequency {
        frequency,
        error,
        n_products: found.n_products,
    })
}

fn assert_flags(model: &Model, is_fixed: &[bool]) {
    assert!(
        is_fixed.is_empty() || is_fixed.len() == model.n_dofs(),
        "{} flags were given for {} dofs",
        is_fixed.len(),
        model.n_dofs()
    );
}

/// `M⁻¹ K` on the dofs that carry mass and are free.
struct Pencil<'a> {
    model: &'a Model,
    /// Dofs that are held or carry no mass; the vectors of the iteration vanish there.
    is_left_out: Vec<bool>,
    /// Factor of the stiffness of massless dofs, if there are any.
    massless: Option<BlockCholesky>,
    /// Factor of a consistent mass.
    mass: Option<BlockCholesky>,
    is_follower: Vec<bool>,
    work: Vec<f64>,
}

impl<'a> Pencil<'a> {
    fn new(model: &'a Model, is_fixed: &[bool]) -> Result<Self, CholeskyError> {
        let n_dofs = model.n_dofs();
        let fixed = |dof: usize| is_fixed.get(dof).copied().unwrap_or(false);
        let is_follower: Vec<bool> = (0..n_dofs)
            .map(|dof| model.is_massless(dof / 2) && !fixed(dof))
            .collect();
        let is_left_out: Vec<bool> = (0..n_dofs)
            .map(|dof| fixed(dof) || is_follower[dof])
            .collect();
        let massless = if is_follower.contains(&true) {
            let mut stiffness = model.stiffness().clone();
            let others: Vec<bool> = is_follower.iter().map(|follows| !follows).collect();
            stiffness.constrain(&others);
            let mut factor = BlockCholesky::analyze(&stiffness);
            factor.factorize(&stiffness)?;
            Some(factor)
        } else {
            None
        };
        let mass = match model.mass() {
            MassMatrix::Lumped(_) => None,
            MassMatrix::Consistent(mass) => {
                let mut mass = mass.clone();
                mass.constrain(&is_left_out);
                let mut factor = BlockCholesky::analyze(&mass);
                factor.factorize(&mass)?;
                Some(factor)
            }
        };
        Ok(Self {
            model,
            is_left_out,
            massless,
            mass,
            is_follower,
            work: vec![0.0; n_dofs],
        })
    }

    /// Moves massless dofs to where the others put them: `x_s = -K_ss⁻¹ K_sm x_m`.
    fn condense(&mut self, x: &[f64]) {
        self.work.copy_from_slice(x);
        let Some(factor) = &mut self.massless else {
            return;
        };
        let mut force = vec![0.0; x.len()];
        self.model.stiffness().multiply(x, &mut force);
        for (force, &follows) in force.iter_mut().zip(&self.is_follower) {
            if !follows {
                *force = 0.0;
            }
        }
        factor.solve_in_place(&mut force);
        for (work, force) in self.work.iter_mut().zip(&force) {
            *work -= force;
        }
    }
}

impl Operator for Pencil<'_> {
    fn n_dofs(&self) -> usize {
        self.model.n_dofs()
    }

    fn is_left_out(&self, dof: usize) -> bool {
        self.is_left_out[dof]
    }

    fn inner(&self, x: &[f64], y: &[f64]) -> f64 {
        self.model.mass().inner(x, y)
    }

    fn apply(&mut self, x: &[f64], y: &mut [f64]) {
        self.condense(x);
        self.model.stiffness().multiply(&self.work, y);
        for (y, &left_out) in y.iter_mut().zip(&self.is_left_out) {
            if left_out {
                *y = 0.0;
            }
        }
        match (self.model.mass(), &mut self.mass) {
            (_, Some(factor)) => factor.solve_in_place(y),
            (MassMatrix::Lumped(mass), _) => {
                for (dof, y) in y.iter_mut().enumerate() {
                    if !self.is_left_out[dof] {
                        *y /= mass[dof / 2];
                    }
                }
            }
            (MassMatrix::Consistent(_), None) => {}
        }
    }
}
