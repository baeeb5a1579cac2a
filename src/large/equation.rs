//! The residual of a step or of an equilibrium, `r(x') = f - M [c (x' - x - dt v) + α/dt (x' - x)] - f_int(x, x')`.

use crate::fe::finite_strain::{Deformation, FiniteStrainModel, Form, Inadmissible, Linearization};
use crate::linalg::block_matrix::BlockMatrix;

/// What multiplies the masses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Inertia {
    /// `c = 2/dt²`, or zero for equilibrium (1/s²).
    pub(crate) acceleration: f64,
    /// `α/dt`, of the damping's mass part (1/s²).
    pub(crate) drag: f64,
}

/// One equation for the positions `x'`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Equation<'a> {
    pub(crate) model: &'a FiniteStrainModel,
    pub(crate) form: Form,
    pub(crate) inertia: Inertia,
    /// Nodal loads (N).
    pub(crate) load: &'a [f64],
    /// Positions at the beginning of the step (m).
    pub(crate) start: &'a [f64],
    /// `x + dt v`, where the nodes would be without forces (m).
    pub(crate) coast: &'a [f64],
    pub(crate) is_held: &'a [bool],
    /// The residual may grow by this factor in one iteration: more, and the increment is cut.
    pub(crate) most_growth: f64,
}

/// A residual that was evaluated.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Evaluation {
    /// The largest entry (N); not finite where an entry is not.
    pub(crate) norm: f64,
    /// Where it is.
    pub(crate) node: usize,
    /// The largest load or inertia force, of equilibria also of reactions (N).
    pub(crate) scale: f64,
}

impl Equation<'_> {
    /// Writes the residual at `end`, zero at held dofs, whose reactions (N) are written instead to `reaction`.
    pub(crate) fn evaluate(
        &self,
        end: &[f64],
        deformation: &mut Deformation,
        residual: &mut [f64],
        reaction: &mut [f64],
    ) -> Result<Evaluation, Inadmissible> {
        let mut scale = self.apply_loads(end, residual);
        self.model
            .subtract_force(self.form, end, deformation, residual)?;
        let (mut norm, mut at): (f64, usize) = (0.0, 0);
        let dofs = residual.iter_mut().zip(reaction).zip(self.is_held);
        for (dof, ((residual, reaction), is_held)) in dofs.enumerate() {
            *reaction = 0.0;
            if *is_held {
                *reaction = -*residual;
                // Where held dofs alone deform a body there is no other force to compare with. In a step there is inertia, beside which
                // the couple of a clamp would be a poor measure.
                if self.form == Form::Equilibrium {
                    scale = scale.max(residual.abs());
                }
                *residual = 0.0;
            }
            let size = residual.abs();
            // What is not a number stays the largest.
            if size > norm || size.is_nan() {
                (norm, at) = (size, dof);
            }
        }
        Ok(Evaluation {
            norm,
            node: at / 2,
            scale,
        })
    }

    /// Writes loads less inertia forces; returns the largest of both at dofs that are free.
    fn apply_loads(&self, end: &[f64], residual: &mut [f64]) -> f64 {
        let Inertia { acceleration, drag } = self.inertia;
        let mut scale: f64 = 0.0;
        let nodes = residual
            .as_chunks_mut::<2>()
            .0
            .iter_mut()
            .zip(self.model.masses())
            .zip(end.as_chunks::<2>().0)
            .zip(self.coast.as_chunks::<2>().0)
            .zip(self.start.as_chunks::<2>().0)
            .zip(self.load.as_chunks::<2>().0)
            .zip(self.is_held.as_chunks::<2>().0);
        for ((((((residual, mass), end), coast), start), load), is_held) in nodes {
            for k in 0..2 {
                let inertia =
                    mass * (acceleration * (end[k] - coast[k]) + drag * (end[k] - start[k]));
                residual[k] = load[k] - inertia;
                let size = load[k].abs().max(inertia.abs());
                if !is_held[k] && size > scale {
                    scale = size;
                }
            }
        }
        scale
    }

    /// Writes `-∂r/∂x'` at the end last evaluated, with unit rows for held dofs.
    pub(crate) fn assemble(
        &self,
        kind: Linearization,
        deformation: &Deformation,
        matrix: &mut BlockMatrix,
    ) {
        matrix.fill_zero();
        self.model.add_tangent(self.form, kind, deformation, matrix);
        let factor = self.inertia.acceleration + self.inertia.drag;
        if factor > 0.0 {
            for (node, mass) in self.model.masses().iter().enumerate() {
                matrix.add_diagonal(node, [factor * mass; 2]);
            }
        }
        if self.is_held.contains(&true) {
            matrix.constrain(self.is_held);
        }
    }
}
