//! The state of a large body: positions and velocities of its nodes in the world.

use crate::fe::finite_strain::FiniteStrainModel;
use crate::math::{Vec2, cross, node_vec};

/// Positions and velocities, interleaved.
#[derive(Clone, Debug, PartialEq)]
pub struct WorldMotion {
    /// Positions in the world's axes (m).
    pub position: Vec<f64>,
    /// Velocities (m/s). A held dof moves with the velocity it has here, and keeps it.
    pub velocity: Vec<f64>,
}

impl WorldMotion {
    /// The undeformed body at rest.
    pub fn at_rest(model: &FiniteStrainModel) -> Self {
        Self {
            position: model.rest_positions().to_vec(),
            velocity: vec![0.0; model.n_dofs()],
        }
    }

    /// Kinetic energy (J).
    pub fn kinetic_energy(&self, model: &FiniteStrainModel) -> f64 {
        let squares = self
            .nodes(model)
            .map(|(mass, _, v)| mass * v.norm_squared());
        0.5 * squares.sum::<f64>()
    }

    /// Kinetic and stored energy (J) of a body that has not flowed, see [`FiniteStrainModel::energy_after`].
    pub fn energy(&self, model: &FiniteStrainModel) -> f64 {
        self.kinetic_energy(model) + model.elastic_energy(&self.position)
    }

    /// Momentum (kg m/s).
    pub fn momentum(&self, model: &FiniteStrainModel) -> Vec2 {
        self.nodes(model).map(|(mass, _, v)| mass * v).sum()
    }

    /// Centre of mass (m).
    pub fn centre(&self, model: &FiniteStrainModel) -> Vec2 {
        let mass: f64 = model.masses().iter().sum();
        // Relative to a node, so that no digits are lost far from the origin.
        let origin = node_vec(&self.position, 0);
        let moment: Vec2 = self
            .nodes(model)
            .map(|(mass, x, _)| mass * (x - origin))
            .sum();
        origin + moment / mass
    }

    /// Angular momentum about the centre of mass (kg m²/s).
    pub fn angular_momentum(&self, model: &FiniteStrainModel) -> f64 {
        let centre = self.centre(model);
        self.nodes(model)
            .map(|(mass, x, v)| mass * cross(x - centre, v))
            .sum()
    }

    fn nodes(&self, model: &FiniteStrainModel) -> impl Iterator<Item = (f64, Vec2, Vec2)> {
        let masses = model.masses().iter().enumerate();
        masses.map(|(node, &mass)| {
            let (x, v) = (
                node_vec(&self.position, node),
                node_vec(&self.velocity, node),
            );
            (mass, x, v)
        })
    }
}
