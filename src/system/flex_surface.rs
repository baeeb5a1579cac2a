//! Nodes without mass in an implicit step with stiffness damping: they follow the others, `K_ss u_s = f_s + Gᵀp - K_sm u_m`.
//!
//! With `u_s = e + E u_m`, `E = -K_ss⁻¹ K_sm`, the energy falls apart into that of the masses and `½ e·K_ss e`: a spring under the contact
//! force. Damped by `β K` too, this spring would be a dashpot between the contact and the mass behind it, whose force has no limit in an impact and which
//! holds the shape that the surface had when the contact opened. So damping acts on `E u_m`, on what the masses do, and not on `e`. The rows of the
//! masses are then those of (C.5) as printed, `A` and its factor too, with
//!
//! ```text
//! w_s = E (u_m + β u̇_m) + e,    u_s = E u_m + e
//! ```
//!
//! for what the stiffness acts on and for where the nodes are.

use super::flex_block::FlexBlock;
use super::massless_surface::MasslessSurface;
use crate::fe::model::Model;
use crate::linalg::cholesky::{BlockCholesky, CholeskyError};
use crate::math::{Mat2, Vec2, add_node_vec, node_vec, set_node_vec};

/// The massless nodes of a damped body, with the factor of `K_ss`.
#[derive(Debug)]
pub(super) struct FollowingSurface {
    nodes: MasslessSurface,
    factor: BlockCholesky,
}

impl FollowingSurface {
    /// Factorizes `K_ss`.
    ///
    /// # Errors
    /// If it is not positive definite.
    pub fn new(model: &Model, is_fixed: &[bool]) -> Result<Self, CholeskyError> {
        let (nodes, stiffness) = MasslessSurface::new(model, is_fixed);
        let mut factor = BlockCholesky::analyze(&stiffness);
        factor.factorize(&stiffness)?;
        Ok(Self { nodes, factor })
    }

    /// Makes [`FollowingSurface::flexibility`] known from `node`.
    pub fn prepare(&mut self, node: usize, is_fixed: &[bool]) {
        self.nodes.prepare(node, is_fixed, &mut self.factor);
    }

    /// Displacement of one massless node by a force at another, in the frame (m/N); zero between others.
    pub fn flexibility(&self, at: usize, from: usize) -> Mat2 {
        self.nodes.flexibility(at, from)
    }

    /// Writes the entries of the massless nodes so that `force` balances there, in the frame.
    fn relax(
        &mut self,
        model: &Model,
        is_fixed: &[bool],
        dofs: &mut [f64],
        force: impl Fn(usize) -> Vec2,
    ) {
        for &node in &self.nodes.nodes {
            for dof in [2 * node, 2 * node + 1] {
                if !is_fixed[dof] {
                    dofs[dof] = 0.0;
                }
            }
        }
        for (slot, &node) in self.nodes.nodes.iter().enumerate() {
            let [x, y] = model.stiffness().multiply_node(node, dofs);
            let mut force = force(node) - Vec2::new(x, y);
            for axis in 0..2 {
                if is_fixed[2 * node + axis] {
                    force[axis] = 0.0;
                }
            }
            set_node_vec(&mut self.nodes.local, slot, force);
        }
        self.factor.solve_in_place(&mut self.nodes.local);
        for (slot, &node) in self.nodes.nodes.iter().enumerate() {
            add_node_vec(dofs, node, node_vec(&self.nodes.local, slot));
        }
    }
}

impl FlexBlock {
    /// Moves the massless nodes of a damped body to where they balance under the forces of the iterate.
    pub(super) fn follow_displacements(&mut self) {
        let Self {
            surface,
            model,
            is_fixed,
            displacement,
            force,
            contact_force,
            turn,
            ..
        } = self;
        if let Some(surface) = surface {
            let back = turn.transpose();
            surface.relax(model, is_fixed, displacement, |node| {
                back * (node_vec(force, node) + node_vec(contact_force, node))
            });
        }
    }

    /// Whether a dof is one of a massless node of a damped body.
    pub(super) fn is_following(&self, dof: usize) -> bool {
        self.model.rayleigh().stiffness > 0.0 && self.model.is_massless(dof / 2)
    }

    /// Gives the massless nodes of a damped body the rates of those that they follow.
    pub(super) fn follow_rates(&mut self) {
        let Self {
            surface,
            model,
            is_fixed,
            rate,
            ..
        } = self;
        if let Some(surface) = surface {
            surface.relax(model, is_fixed, rate, |_| Vec2::zeros());
        }
    }
}
