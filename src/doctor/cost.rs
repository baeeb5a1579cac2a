//! What a step is expected to cost, counted before one is taken.
//!
//! | | operations |
//! |---|---|
//! | a factorization | `Σ l²` over the lengths `l` of the columns of the factor (George, Liu 1981) |
//! | a solve | 4 for each entry of the factor |
//! | forces of all cells | at each point `8 n` for the gradient of `n` nodes, as many for the force, and the law |
//! | their tangent | at each point a 2 by 2 block for each of `n²` pairs, and the law |
//! | a contact problem of `m` nodes | `m³/3`, each time one comes or goes |
//!
//! How often each is done in a step is what steps of bodies at rest and in motion were seen to take, and holds to a factor of a few.

use crate::body::{FlexBody, FlexBodyHandle, FlexBodySet};
use crate::fe::mesh::CellKind;
use crate::linalg::cholesky::BlockCholesky;
use std::fmt;

/// Operations of a law at a point: invariants, stress, and its pair.
const LAW: f64 = 100.0;

/// Operations of a pair of nodes of the tangent at a point.
const PAIR: f64 = 24.0;

/// Iterations of a force and a solve in a step of a body of large strain that moves.
const ITERATIONS: f64 = 6.0;

/// Contact problems in a step, each with so many nodes that come or go.
const PASSES: f64 = 3.0;
const CHANGES: f64 = 3.0;

/// What one body costs.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyCost {
    /// The body.
    pub body: FlexBodyHandle,
    /// Two for each node.
    pub n_dofs: usize,
    /// Cells of the mesh.
    pub n_cells: usize,
    /// Nodes that may touch.
    pub n_surface: usize,
    /// Whether it is of large strain, and factorized anew as it moves; one of small strain is factorized once.
    pub is_large: bool,
    /// Entries kept of the factor.
    pub n_entries: usize,
    /// Operations of a factorization.
    pub factorization: f64,
    /// Operations of a solve.
    pub solve: f64,
    /// Operations of the forces of all cells, and of their tangent.
    pub forces: f64,
    /// Operations of the tangent of all cells.
    pub tangent: f64,
}

/// What a step of all bodies costs, of those that are awake.
///
/// ```
/// use foil2d::doctor::ExpectedCost;
/// use foil2d::prelude::*;
/// use foil2d::rapier::prelude::*;
///
/// let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
/// let rubber = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
/// let block = FlexBodyBuilder::rectangle([1.0, 1.0], [40, 40]).material(rubber);
/// flex_bodies.insert(block, &mut world)?;
/// let cost = ExpectedCost::of(&flex_bodies);
/// println!("{cost}");
/// // A fifth of its surface on the floor, at 2e9 operations a second.
/// let seconds = cost.step(0.2) / 2e9;
/// assert!(seconds > 1e-4 && seconds < 1e-1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExpectedCost {
    /// Body by body, in the order of the set.
    pub bodies: Vec<BodyCost>,
}

impl BodyCost {
    fn of(handle: FlexBodyHandle, body: &FlexBody) -> Self {
        let (model, mesh) = (body.model(), body.mesh());
        let factor = match body.large() {
            Some(large) => BlockCholesky::analyze(&large.new_matrix()),
            None => BlockCholesky::analyze(model.stiffness()),
        };
        let (mut forces, mut tangent) = (0.0, 0.0);
        for cell in mesh.cells() {
            let n_points = match cell.kind {
                // Quadrilaterals of four nodes take their mean gradient.
                CellKind::Tri3 | CellKind::Quad4 => 1.0,
                CellKind::Tri6 => 3.0,
                CellKind::Quad8 => 4.0,
            };
            let n_nodes = cell.nodes.len() as f64;
            forces += n_points * (16.0 * n_nodes + LAW);
            tangent += n_points * (PAIR * n_nodes * n_nodes + LAW);
        }
        Self {
            body: handle,
            n_dofs: 2 * body.n_nodes(),
            n_cells: mesh.n_cells(),
            n_surface: mesh.boundary().nodes().len(),
            is_large: body.large().is_some(),
            n_entries: factor.n_nonzeros(),
            factorization: factor.n_operations(),
            solve: 4.0 * factor.n_nonzeros() as f64,
            forces,
            tangent,
        }
    }

    /// Operations of a step in which this share of its surface touches (-).
    pub fn step(&self, share: f64) -> f64 {
        let n_touching = share.clamp(0.0, 1.0) * self.n_surface as f64;
        let problem = n_touching.powi(3) / 3.0;
        if !self.is_large && n_touching == 0.0 {
            return self.forces + self.solve;
        }
        if !self.is_large {
            // Answers of nodes are kept as long as the factor is.
            return self.forces + self.solve + PASSES * (2.0 * self.solve + CHANGES * problem);
        }
        let apart = ExpectedCost::FACTORIZATIONS * (self.factorization + self.tangent)
            + ITERATIONS * (self.forces + self.solve);
        if n_touching == 0.0 {
            return apart;
        }
        // Every new factor answers anew, along x and y of every node that touches; every pass finds the body's equilibrium.
        let answers = ExpectedCost::FACTORIZATIONS * 2.0 * n_touching * self.solve;
        let passes = PASSES * (ITERATIONS * (self.forces + self.solve) + CHANGES * problem);
        apart + answers + passes
    }
}

impl ExpectedCost {
    /// Factorizations in a step of a body of large strain that changes its shape. One that hardly does keeps its factor and what follows from it, and costs a tenth.
    pub const FACTORIZATIONS: f64 = 2.0;

    /// Lays out the factor of every body, without computing it.
    pub fn of(flex_bodies: &FlexBodySet) -> Self {
        let bodies = flex_bodies.iter();
        Self {
            bodies: bodies
                .map(|(handle, body)| BodyCost::of(handle, body))
                .collect(),
        }
    }

    /// Operations of a step in which this share of all surfaces touches (-): 0 for bodies in the air, a quarter for blocks on a floor.
    ///
    /// Divided by what a core does of them in a second, some 2e9 to 6e9, it is the time of a step, to a factor of a few; bodies that rest cost less.
    pub fn step(&self, share: f64) -> f64 {
        self.bodies.iter().map(|body| body.step(share)).sum()
    }
}

impl fmt::Display for ExpectedCost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for body in &self.bodies {
            writeln!(
                f,
                "{:?}: {} dofs, {} cells, a factor of {} entries; a step of {:.1e} operations in the air, {:.1e} with a quarter of its surface touching",
                body.body,
                body.n_dofs,
                body.n_cells,
                body.n_entries,
                body.step(0.0),
                body.step(0.25),
            )?;
        }
        write!(
            f,
            "a step of all: {:.1e} to {:.1e} operations; a core does some 1e9 to 1e10 in a second",
            self.step(0.0),
            self.step(0.25),
        )
    }
}
