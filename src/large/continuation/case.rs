//! What changes along a path, where it ends, and how far its increments go.

use super::follower::FollowerForce;
use crate::fe::finite_strain::FiniteStrainModel;
use crate::large::LargeError;
use crate::large::stepper::require_finite;

/// Loads and held dofs along a path.
#[derive(Clone, Debug, PartialEq)]
pub struct PathCase {
    /// Nodal loads at the load factor 0 (N), under which the body is in equilibrium where the path begins.
    pub from: Vec<f64>,
    /// Nodal loads at the load factor 1 (N).
    pub to: Vec<f64>,
    /// Which dofs are held.
    pub is_held: Vec<bool>,
    /// Where held dofs are at the load factor 1 (m), coming from where they are at the beginning; other entries are not read.
    pub places: Vec<f64>,
    /// Forces that turn with the body, nothing at the load factor 0.
    pub followers: Vec<FollowerForce>,
}

impl PathCase {
    /// Dead loads (N) that grow from nothing, with held dofs that stay where they are at the beginning.
    pub fn dead(load: Vec<f64>, is_held: Vec<bool>, beginning: &[f64]) -> Self {
        Self {
            from: vec![0.0; load.len()],
            to: load,
            is_held,
            places: beginning.to_vec(),
            followers: Vec::new(),
        }
    }

    /// Held dofs that go to their places (m) without loads: control by displacement.
    pub fn places(places: Vec<f64>, is_held: Vec<bool>) -> Self {
        Self {
            from: vec![0.0; places.len()],
            to: vec![0.0; places.len()],
            is_held,
            places,
            followers: Vec::new(),
        }
    }

    pub(super) fn check(&self, model: &FiniteStrainModel) -> Result<(), LargeError> {
        let n_dofs = model.n_dofs();
        require_finite("the load at the factor 0", &self.from, n_dofs)?;
        require_finite("the load at the factor 1", &self.to, n_dofs)?;
        require_finite("the places", &self.places, n_dofs)?;
        if self.is_held.len() != n_dofs {
            return Err(LargeError::Length {
                name: "the list of held dofs",
                found: self.is_held.len(),
                expected: n_dofs,
            });
        }
        for (index, follower) in self.followers.iter().enumerate() {
            let [from, to] = follower.line;
            let n_nodes = model.n_nodes();
            let is_there = [follower.node, from, to].iter().all(|&node| node < n_nodes);
            if !is_there || from == to || !follower.force.iter().all(|f| f.is_finite()) {
                return Err(LargeError::Follower { index });
            }
        }
        Ok(())
    }
}

/// Where to stop on a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathEnd {
    /// At this load factor (-).
    Factor(f64),
    /// Where a dof is at this place (m).
    Place {
        /// The dof, `2 node` for x and `2 node + 1` for y.
        dof: usize,
        /// The place.
        place: f64,
    },
}

impl PathEnd {
    /// By how much the end is not reached, with a sign.
    pub(super) fn ahead(self, positions: &[f64], factor: f64) -> f64 {
        match self {
            Self::Factor(end) => end - factor,
            Self::Place { dof, place } => place - positions[dof],
        }
    }
}

/// How far increments of a path go, and how exactly they are solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSettings {
    /// Residual over the largest load or reaction that ends the iterations (-).
    pub tolerance: f64,
    /// The first increment of the load factor (-).
    pub first: f64,
    /// The longest increment: root mean square of displacements over the radius of gyration (-).
    pub longest: f64,
    /// Iterations of one increment at most.
    pub max_iterations: usize,
    /// How often an increment may be halved.
    pub max_cutbacks: usize,
    /// Increments on the way to one end at most.
    pub max_increments: usize,
}

impl Default for PathSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-8,
            first: 0.05,
            longest: 0.1,
            max_iterations: 12,
            max_cutbacks: 12,
            max_increments: 1000,
        }
    }
}

impl PathSettings {
    pub(super) fn check(&self) -> Result<(), LargeError> {
        let refuse = |name, value, range| Err(LargeError::Setting { name, value, range });
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            return refuse("the tolerance", self.tolerance, "(0, 1)");
        }
        if !(self.first != 0.0 && self.first.is_finite()) {
            return refuse("the first increment", self.first, "the numbers but 0");
        }
        if !(self.longest > 0.0 && self.longest.is_finite()) {
            return refuse("the longest increment", self.longest, "(0, infinity)");
        }
        if self.max_iterations == 0 {
            return refuse("the number of iterations", 0.0, "[1, infinity)");
        }
        if self.max_cutbacks > 40 {
            let value = self.max_cutbacks as f64;
            return refuse("the number of cutbacks", value, "[0, 40]");
        }
        Ok(())
    }
}
