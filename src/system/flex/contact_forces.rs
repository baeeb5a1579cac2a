//! The contact forces of an iterate on a flexible body.

use crate::math::{Vec2, add_node_vec, cross};

/// Contact forces on the nodes, and their sums.
#[derive(Clone, Debug, Default)]
pub(super) struct ContactForces {
    /// On the nodes, interleaved (N).
    pub nodal: Vec<f64>,
    pub is_used: bool,
    /// Their resultant (N).
    pub total: Vec2,
    /// Their moment about the centre, by the levers they were given with (N m).
    pub moment: f64,
    /// `Σ lever·force` of what holds the body and pulls at it: by as much a radian it turns the body back that it stretches, and on one that it
    /// presses (N m).
    pub stretch: f64,
}

impl ContactForces {
    pub fn new(n_dofs: usize) -> Self {
        Self {
            nodal: vec![0.0; n_dofs],
            ..Self::default()
        }
    }

    pub fn clear(&mut self) {
        if self.is_used {
            self.nodal.fill(0.0);
            self.is_used = false;
        }
        (self.total, self.moment, self.stretch) = (Vec2::zeros(), 0.0, 0.0);
    }

    /// Whether some node feels a force.
    pub fn presses(&self) -> bool {
        self.nodal.iter().any(|force| *force != 0.0)
    }

    /// Adds a force at a node (N) that acts at a lever from the centre (m).
    pub fn add(&mut self, node: usize, force: Vec2, lever: Vec2) {
        add_node_vec(&mut self.nodal, node, force);
        self.is_used = true;
        self.total += force;
        self.moment += cross(lever, force);
    }
}
