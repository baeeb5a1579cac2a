//! What acts on a flexible body in a step besides contact, and what of it is late.

use super::shape::Shape;
use crate::body::{AppliedLoad, Frame};
use crate::math::{Vec2, is_held};
use crate::system::step::FlexLoad;

/// Loads of a step.
#[derive(Clone, Debug, Default)]
pub(super) struct Loads {
    /// Those of the step.
    pub own: AppliedLoad,
    /// They are late by `1 - β1` of a step of this length (s).
    pub lag: f64,
    /// What is late to come in the step, less what would have been late to it, as a mean force (N); empty where loads are what they were.
    pub late: Vec<f64>,
    /// Applied nodal forces, gravity included (N).
    pub force: Vec<f64>,
    /// Their resultant; of free bodies alone (N).
    pub total: Vec2,
    /// Gravity and other forces per mass; `None` if forces act on single nodes (m/s²).
    pub uniform: Option<Vec2>,
    /// Displacements of the pinned dofs (m).
    pub prescribed: Vec<f64>,
}

impl Loads {
    pub fn new(n_dofs: usize) -> Self {
        Self {
            force: vec![0.0; n_dofs],
            prescribed: vec![0.0; n_dofs],
            ..Self::default()
        }
    }

    /// Begins a step; `lag` as the last one has left it (s).
    pub fn begin(&mut self, shape: &Shape, load: &FlexLoad<'_>, lag: f64) {
        for &dof in &shape.fixed_dofs {
            self.prescribed[dof] = load.prescribed[dof];
        }
        self.own.assign(load.force, load.gravity);
        self.lag = lag;
        self.late.clear();
        for (node, mass) in shape.arms.node_mass.iter().enumerate() {
            for axis in 0..2 {
                let dof = 2 * node + axis;
                self.force[dof] = load.force[dof] + mass * load.gravity[axis];
            }
        }
        // Only the balances of a free body ask for these.
        if shape.kind == Frame::Free {
            let is_uniform = load.force.iter().all(|force| *force == 0.0);
            self.uniform = is_uniform.then_some(load.gravity);
            self.total = sum_of(load.force) + shape.arms.mass * load.gravity;
        }
    }

    /// Whether the loads alone would send a body beyond what can be held within `dt` (s). What acts on pins moves nothing.
    pub fn is_too_much(&self, shape: &Shape, dt: f64) -> bool {
        let loads = self.force.iter().zip(&shape.is_fixed);
        let most = loads.fold(0.0f64, |most, (force, &is_fixed)| {
            if is_fixed {
                most
            } else {
                most.max(force.abs())
            }
        });
        !is_held(dt * most / shape.arms.mass)
    }

    /// Kinetic energy that they would give within `dt` (s) to a body of this mass (kg) at rest, if nothing held it (J).
    pub fn energy(&self, dt: f64, mass: f64) -> f64 {
        let nodes = self.force.chunks_exact(2).chain(self.late.chunks_exact(2));
        let total: Vec2 = nodes.map(|force| Vec2::new(force[0], force[1])).sum();
        0.5 * (dt * total).norm_squared() / mass
    }
}

/// Sum of nodal vectors.
fn sum_of(dofs: &[f64]) -> Vec2 {
    dofs.chunks_exact(2).map(|v| Vec2::new(v[0], v[1])).sum()
}
