//! What rapier's soft bodies are made of.

use foil2d::fe::mesh::Mesh;
use foil2d::rapier::math::Real;
use foil2d::rapier::prelude::*;

/// Collision radius of a particle (m).
pub const RADIUS: f64 = 1e-3;

/// How rapier solves for the elasticity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SoftModel {
    /// Constraints, its default.
    Constraints,
    /// Finite elements, at most 20 conjugate-gradient iterations: its default.
    Fem,
    /// Finite elements with that cap lifted to 2000.
    ConvergedFem,
    /// The same with a tolerance of 1e-8 instead of 1e-5, which `f32` does not reach.
    TightFem,
}

impl SoftModel {
    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Constraints => "Constraints",
            Self::Fem => "Fem",
            Self::ConvergedFem => "converged Fem",
            Self::TightFem => "Fem to 1e-8",
        }
    }

    /// Rapier's solver for it.
    pub fn solver(self) -> SoftBodySolver {
        if self == Self::Constraints {
            SoftBodySolver::Constraints
        } else {
            SoftBodySolver::Fem
        }
    }

    /// Tells a world how far to iterate.
    pub fn set_up(self, world: &mut PhysicsWorld) {
        let fem = &mut world.integration_parameters.soft_bodies.fem;
        if matches!(self, Self::ConvergedFem | Self::TightFem) {
            fem.max_linear_iterations = 2000;
        }
        if self == Self::TightFem {
            fem.linear_tolerance = 1e-8;
        }
    }
}

/// Rapier's law is that of plane strain: these moduli make it plane stress.
pub fn material(young: f64, poisson: f64, is_damped: bool) -> SoftBodyMaterial {
    let young = young * (1.0 + 2.0 * poisson) / (1.0 + poisson).powi(2);
    SoftBodyMaterial {
        young_modulus: young as Real,
        poisson_ratio: (poisson / (1.0 + poisson)) as Real,
        elastic_damping_ratio: if is_damped { 1.0 } else { 0.0 },
        ..SoftBodyMaterial::default()
    }
}

/// A third of every triangle's mass at each corner (kg).
pub fn masses(mesh: &Mesh, density: f64) -> Vec<Real> {
    let mut masses = vec![0.0; mesh.n_nodes()];
    for cell in mesh.cells() {
        let [a, b, c] = [0, 1, 2].map(|corner| mesh.nodes()[cell.nodes[corner]]);
        let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
        for &node in cell.nodes {
            masses[node] += density * area / 3.0;
        }
    }
    masses.iter().map(|&mass| mass as Real).collect()
}
