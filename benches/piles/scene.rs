//! The scenes: boxes poured on a plank in a bin, soft blocks poured into a bin.

use crate::side::{Flexible, Outcome, Rapier, Side};
use crate::soft_law::{RADIUS, SoftModel, masses, material};
use foil2d::fe::mesh::{CellKind, Mesh, generate};
use foil2d::prelude::*;
use foil2d::rapier::math::Real;
use foil2d::rapier::prelude::*;

/// Time step (s).
pub const DT: f64 = 1.0 / 60.0;
/// Side of a box and of a soft block (m).
const SIDE: f64 = 0.4;
/// From one to the next as they are poured (m).
const PITCH: f64 = 0.5;
/// Half the thickness of a wall (m).
const WALL: f64 = 0.25;
/// Poisson's ratio (-).
const POISSON: f64 = 0.3;
/// Density of soft blocks and of the plank, at a thickness of 1 m (kg/m³); boxes weigh half of that.
const DENSITY: f64 = 1000.0;
/// Cells along a side of a soft block.
const N_CELLS: usize = 6;
/// Thickness of the plank (m).
const PLANK: f64 = 0.15;

/// What is poured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// Rigid boxes on a plank.
    Boxes,
    /// Soft blocks of this Young's modulus (Pa).
    Soft(f64),
}

/// One pile.
#[derive(Clone, Copy, Debug)]
pub struct Scene {
    pub kind: Kind,
    /// Boxes, or soft blocks along a side of the pile.
    pub size: usize,
}

/// All scenes, in the order of the report.
pub fn all() -> Vec<Scene> {
    let boxes = [10, 20, 40, 100, 400, 1000].map(|size| Scene {
        kind: Kind::Boxes,
        size,
    });
    let soft = [3, 5, 10].into_iter().flat_map(|size| {
        [1e6, 1e7].map(|young| Scene {
            kind: Kind::Soft(young),
            size,
        })
    });
    boxes.into_iter().chain(soft).collect()
}

impl Scene {
    /// What the scene is called.
    pub fn name(&self) -> String {
        match self.kind {
            Kind::Boxes => format!("{} boxes on a plank", self.size),
            Kind::Soft(young) => format!("{0}x{0} soft blocks, E {young:.0e}", self.size),
        }
    }

    fn n_columns(&self) -> usize {
        match self.kind {
            Kind::Boxes => (self.size as f64).sqrt().round() as usize,
            Kind::Soft(_) => self.size,
        }
    }

    fn n_poured(&self) -> usize {
        match self.kind {
            Kind::Boxes => self.size,
            Kind::Soft(_) => self.size * self.size,
        }
    }

    /// Width of the bin (m).
    fn width(&self) -> f64 {
        PITCH * self.n_columns() as f64 + 0.1
    }

    /// Middle and turn of what is poured, `k` by `k` (m, rad).
    fn places(&self) -> impl Iterator<Item = ([f64; 2], f64)> {
        let (n_columns, left) = (self.n_columns(), 0.5 * (PITCH - self.width()) + 0.05);
        (0..self.n_poured()).map(move |k| {
            let (column, row) = ((k % n_columns) as f64, (k / n_columns) as f64);
            let at = [left + PITCH * column, 0.5 + 1.2 * PITCH * row];
            (at, 0.3 * (1.7 * k as f64).sin())
        })
    }

    /// Walls, and the floor of soft blocks or the supports of the plank, whose upper face is at zero.
    fn bin(&self) -> PhysicsWorld {
        let mut world = PhysicsWorld::new();
        world.integration_parameters.dt = DT as Real;
        let half = 0.5 * self.width();
        let mut fixed = |size: [f64; 2], at: [f64; 2]| {
            let shape = ColliderBuilder::cuboid(size[0] as Real, size[1] as Real);
            world.insert_collider(shape.translation(vector(at)).friction(0.5), None);
        };
        let height = 1.5 * PITCH * (self.n_poured() / self.n_columns() + 2) as f64;
        for x in [-half - WALL, half + WALL] {
            fixed([WALL, height], [x, height - 1.0]);
        }
        match self.kind {
            Kind::Soft(_) => fixed([half + 1.0, 0.5], [0.0, -0.5]),
            Kind::Boxes => {
                // Spans of about a metre, so that the plank carries any number of boxes alike.
                let n_spans = self.width().ceil() as usize;
                for support in 0..=n_spans {
                    let x = (half - 0.1) * (2.0 * support as f64 / n_spans as f64 - 1.0);
                    fixed([0.05, 0.2], [x, -PLANK - 0.2]);
                }
            }
        }
        world
    }

    /// Everyone who steps this scene, this crate first and who it is compared with second.
    pub fn sides(&self) -> Outcome<Vec<Box<dyn Side>>> {
        let mut sides: Vec<Box<dyn Side>> = Vec::new();
        match self.kind {
            Kind::Boxes => {
                sides.push(Box::new(self.boxes_on_flexible_plank()?));
                sides.push(Box::new(self.boxes_on_rigid_plank()));
            }
            Kind::Soft(young) => {
                sides.push(Box::new(self.flexible_blocks(young)?));
                for model in [
                    SoftModel::Constraints,
                    SoftModel::Fem,
                    SoftModel::ConvergedFem,
                ] {
                    sides.push(Box::new(self.rapier_blocks(young, model)?));
                }
                sides.push(Box::new(self.converted_blocks(young)?));
            }
        }
        Ok(sides)
    }

    fn pour_boxes(&self, world: &mut PhysicsWorld) {
        let half = (0.5 * SIDE) as Real;
        for (at, turn) in self.places() {
            let body = RigidBodyBuilder::dynamic()
                .translation(vector(at))
                .rotation(turn as Real)
                .can_sleep(false);
            let shape = ColliderBuilder::cuboid(half, half)
                .density(0.5 * DENSITY as Real)
                .friction(0.5);
            world.insert(body, shape);
        }
    }

    fn boxes_on_flexible_plank(&self) -> Outcome<Flexible> {
        let mut world = self.bin();
        let mut bodies = FlexBodySet::new();
        let length = self.width() - 0.02;
        let n_cells = (length / (PLANK / 3.0)).round() as usize;
        let plank = FlexBodyBuilder::rectangle([length, PLANK], [n_cells, 3])
            .small_strain()
            .material(elastic(2e9))
            .friction(0.5)
            .translation([-0.5 * length, -PLANK])
            .can_sleep(false);
        bodies.insert(plank, &mut world)?;
        self.pour_boxes(&mut world);
        Ok(Flexible::new("foil2d", world, bodies))
    }

    fn boxes_on_rigid_plank(&self) -> Rapier {
        let mut world = self.bin();
        let half = 0.5 * (self.width() - 0.02);
        let plank = RigidBodyBuilder::dynamic()
            .translation(vector([0.0, -0.5 * PLANK]))
            .can_sleep(false);
        let shape = ColliderBuilder::cuboid(half as Real, (0.5 * PLANK) as Real);
        world.insert(plank, shape.density(DENSITY as Real).friction(0.5));
        self.pour_boxes(&mut world);
        Rapier::new("rapier alone", world)
    }

    fn block() -> Outcome<Mesh> {
        let mesh = generate::rectangle([SIDE; 2], [N_CELLS; 2], CellKind::Tri3)?;
        Ok(mesh)
    }

    fn flexible_blocks(&self, young: f64) -> Outcome<Flexible> {
        let mut world = self.bin();
        let mut bodies = FlexBodySet::new();
        for (at, turn) in self.places() {
            let block = FlexBodyBuilder::mesh(Self::block()?)
                .small_strain()
                .material(elastic(young))
                .friction(0.5)
                .rotation(turn)
                .translation(corner(at, turn))
                .can_sleep(false);
            bodies.insert(block, &mut world)?;
        }
        Ok(Flexible::new("foil2d Tri3", world, bodies))
    }

    /// Rapier's own soft blocks, as described to rapier.
    fn soft_blocks(&self, young: f64, model: SoftModel) -> Outcome<Vec<SoftBodyBuilder>> {
        let mesh = Self::block()?;
        let cells: Vec<_> = mesh
            .cells()
            .map(|cell| [0, 1, 2].map(|corner| cell.nodes[corner] as u32))
            .collect();
        let blocks = self.places().map(|(at, turn)| {
            let [x0, y0] = corner(at, turn);
            let (sin, cos) = turn.sin_cos();
            let place =
                |&[x, y]: &[f64; 2]| vector([x0 + cos * x - sin * y, y0 + sin * x + cos * y]);
            SoftBodyBuilder::new(mesh.nodes().iter().map(place).collect())
                .cells(cells.clone())
                .masses(masses(&mesh, DENSITY))
                .cell_model(SoftBodyCellModel::Corotational)
                .material(material(young, POISSON, true))
                .solver(model.solver())
                .particle_radius(RADIUS as Real)
                .can_sleep(false)
        });
        Ok(blocks.collect())
    }

    fn rapier_blocks(&self, young: f64, model: SoftModel) -> Outcome<Rapier> {
        let mut world = self.bin();
        model.set_up(&mut world);
        for block in self.soft_blocks(young, model)? {
            world.insert_soft_body(block);
        }
        Ok(Rapier::new(model.name(), world))
    }

    /// The same descriptions, made flexible bodies: of large strain, with rapier's damping and skin.
    fn converted_blocks(&self, young: f64) -> Outcome<Flexible> {
        let mut world = self.bin();
        let mut bodies = FlexBodySet::new();
        for block in self.soft_blocks(young, SoftModel::Constraints)? {
            let block = FlexBodyBuilder::from_soft_body(&block, CellKind::Tri3)?;
            bodies.insert(block, &mut world)?;
        }
        Ok(Flexible::new("foil2d converted", world, bodies))
    }
}

/// Where the lower left corner of a block is whose middle is here (m).
fn corner([x, y]: [f64; 2], turn: f64) -> [f64; 2] {
    let (sin, cos) = turn.sin_cos();
    let half = 0.5 * SIDE;
    [x - half * (cos - sin), y - half * (sin + cos)]
}

fn elastic(young: f64) -> LinearElastic {
    LinearElastic::plane_stress(young, POISSON)
        .density(DENSITY)
        .rayleigh(2e-3)
}

fn vector([x, y]: [f64; 2]) -> Vector {
    Vector::new(x as Real, y as Real)
}
