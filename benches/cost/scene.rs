//! The scenes: a cantilever under its own weight, and a block that falls on a fixed floor, in the air and landed.

use foil2d::fe::mesh::{CellKind, Mesh, MeshError, generate};
use foil2d::rapier::math::Real;
use foil2d::rapier::prelude::*;

/// Time step (s).
pub const DT: f64 = 1.0 / 60.0;
/// Poisson's ratio (-), plane stress.
pub const POISSON: f64 = 0.3;
/// Density (kg/m³), at a thickness of 1 m.
pub const DENSITY: f64 = 1000.0;

/// What the body does while it is timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Clamped at x = 0, it swings about its static deflection, of small strain.
    Clamped,
    /// The same, of large strain.
    Bending,
    /// The same a hundred times as heavy: the tip goes down by .9 of the length.
    Swinging,
    /// It falls from 20 m and is timed before it lands.
    Falling,
    /// Dropped from 1 m, it has landed; steps count while it touches the floor.
    Landed,
}

/// One body in one world.
#[derive(Clone, Copy, Debug)]
pub struct Scene {
    pub phase: Phase,
    /// Quadrilaterals, or pairs of triangles, along x and y.
    pub divisions: [usize; 2],
    /// Width and height (m).
    pub size: [f64; 2],
    /// Young's modulus (Pa).
    pub young: f64,
    /// Gravity, downwards (m/s²).
    pub gravity: f64,
    /// Steps before the clock runs.
    pub n_warm_up: usize,
    /// Steps that may be timed before the phase is over.
    pub n_timed: usize,
}

/// All scenes, in the order of the report.
pub fn all() -> Vec<Scene> {
    let cantilevers = [[20, 2], [80, 8], [200, 20]].map(Scene::cantilever);
    let far = [Phase::Bending, Phase::Swinging]
        .into_iter()
        .flat_map(|phase| [[20, 2], [80, 8], [200, 20]].map(|n| Scene::beam(n, phase)));
    let blocks = [Phase::Falling, Phase::Landed]
        .into_iter()
        .flat_map(|phase| [16, 64].map(|n| Scene::block(n, phase)));
    cantilevers.into_iter().chain(far).chain(blocks).collect()
}

impl Scene {
    fn cantilever(divisions: [usize; 2]) -> Self {
        Self::beam(divisions, Phase::Clamped)
    }

    fn beam(divisions: [usize; 2], phase: Phase) -> Self {
        let is_far = phase == Phase::Swinging;
        Self {
            phase,
            divisions,
            size: [1.0, 0.1],
            young: 1e6,
            gravity: if is_far { 9.81 } else { 0.1 },
            // One second: half a period, where the tip is lowest; it falls that far in a third of the time.
            n_warm_up: if is_far { 20 } else { 60 },
            n_timed: usize::MAX,
        }
    }

    fn block(n: usize, phase: Phase) -> Self {
        Self {
            phase,
            divisions: [n, n],
            size: [1.0, 1.0],
            young: 1e7,
            gravity: 9.81,
            // A fall of 1 m takes 27 steps; the rest is for the first bounces.
            n_warm_up: if phase == Phase::Falling { 10 } else { 120 },
            // A fall of 20 m takes 121 steps.
            n_timed: if phase == Phase::Falling {
                100
            } else {
                usize::MAX
            },
        }
    }

    /// Number of dofs, two a node.
    pub fn n_dofs(&self) -> usize {
        2 * (self.divisions[0] + 1) * (self.divisions[1] + 1)
    }

    /// What the scene is called.
    pub fn name(&self) -> String {
        let [nx, ny] = self.divisions;
        let what = match self.phase {
            Phase::Clamped => "cantilever, free",
            Phase::Bending => "large strain, bending",
            Phase::Swinging => "large strain, swinging",
            Phase::Falling => "block, free",
            Phase::Landed => "block, in contact",
        };
        format!("{what}, {nx}x{ny}, {} dofs", self.n_dofs())
    }

    /// Where the lower left corner begins (m).
    pub fn origin(&self) -> [f64; 2] {
        match self.phase {
            Phase::Clamped | Phase::Bending | Phase::Swinging => [0.0, 0.0],
            Phase::Falling => [-0.5, 20.0],
            Phase::Landed => [-0.5, 1.0],
        }
    }

    /// Whether it is a cantilever.
    pub fn is_clamped(&self) -> bool {
        !matches!(self.phase, Phase::Falling | Phase::Landed)
    }

    /// Whether this crate's body is of large strain.
    pub fn is_large(&self) -> bool {
        matches!(self.phase, Phase::Bending | Phase::Swinging)
    }

    /// The mesh, with its lower left corner at zero; of any kind on the same nodes.
    pub fn mesh(&self, kind: CellKind) -> Result<Mesh, MeshError> {
        let divisions = match kind {
            CellKind::Tri6 => self.divisions.map(|n| n / 2),
            _ => self.divisions,
        };
        generate::rectangle(self.size, divisions, kind)
    }

    /// The middle of the cantilever's free end.
    pub fn tip(&self, mesh: &Mesh) -> usize {
        let [length, height] = self.size;
        let off = |&[x, y]: &[f64; 2]| (x - length).abs() + (y - 0.5 * height).abs();
        let nodes = mesh.nodes().iter().enumerate();
        let nearest = nodes.min_by(|a, b| off(a.1).total_cmp(&off(b.1)));
        nearest.map_or(0, |(node, _)| node)
    }

    /// A world without the body: gravity, the step, and the floor of a block.
    pub fn world(&self) -> PhysicsWorld {
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::new(0.0, -self.gravity as Real);
        world.integration_parameters.dt = DT as Real;
        if !self.is_clamped() {
            world.insert(
                RigidBodyBuilder::fixed(),
                ColliderBuilder::cuboid(50.0, 0.5).translation(Vector::new(0.0, -0.5)),
            );
        }
        world
    }
}
