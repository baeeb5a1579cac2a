//! Rapier's own soft body on the same triangles.

use crate::measure::{Burst, Clock, Outcome, Side, median};
use crate::scene::{DENSITY, POISSON, Phase, Scene};
pub use crate::soft_law::SoftModel;
use crate::soft_law::{RADIUS, masses, material};
use foil2d::fe::mesh::{CellKind, Mesh, MeshError};
use foil2d::rapier::math::Real;
use foil2d::rapier::prelude::*;

/// The models to compare with in a scene.
pub fn models(scene: &Scene) -> Vec<SoftModel> {
    let mut models = vec![
        SoftModel::Constraints,
        SoftModel::Fem,
        SoftModel::ConvergedFem,
    ];
    if scene.is_clamped() {
        models.push(SoftModel::TightFem);
    }
    models
}

/// One scene with a soft body.
pub struct SoftSide {
    scene: Scene,
    model: SoftModel,
    world: PhysicsWorld,
    body: SoftBodyHandle,
    tip: usize,
}

impl SoftSide {
    pub fn new(scene: &Scene, model: SoftModel) -> Result<Self, MeshError> {
        let mesh = scene.mesh(CellKind::Tri3)?;
        let mut world = scene.world();
        model.set_up(&mut world);
        let body = world.insert_soft_body(builder(scene, model, &mesh));
        Ok(Self {
            scene: *scene,
            model,
            world,
            body,
            tip: scene.tip(&mesh),
        })
    }
}

impl SoftSide {
    /// Whether the body touches the floor.
    fn is_touching(&self) -> bool {
        let heights = self.world.soft_bodies[self.body].particle_positions();
        heights.map(|p| f64::from(p.y)).fold(f64::MAX, f64::min) < 1.5 * RADIUS
    }
}

impl Side for SoftSide {
    fn label(&self) -> String {
        format!("rapier {}", self.model.name())
    }

    fn n_warm_up(&self) -> usize {
        let n_steps = self.scene.n_warm_up;
        match (self.scene.phase, self.model) {
            // It lies still soon after its 27 steps of fall, and its steps are long.
            (Phase::Landed, SoftModel::ConvergedFem) => n_steps / 3,
            _ => n_steps,
        }
    }

    fn advance(&mut self, n_steps: usize) -> Outcome<()> {
        for _ in 0..n_steps {
            self.world.step();
        }
        Ok(())
    }

    fn burst(&mut self, n_steps: usize, clock: &Clock) -> Outcome<Option<Burst>> {
        let mut whole = Vec::with_capacity(n_steps);
        for _ in 0..n_steps {
            let (time, ()) = clock.time(|| self.world.step());
            if self.scene.phase != Phase::Landed || self.is_touching() {
                whole.push(time);
            }
        }
        Ok(median(&mut whole).map(|whole| Burst {
            whole,
            rapier: None,
        }))
    }

    fn tip_deflection(&self) -> f64 {
        let tip = self.world.soft_bodies[self.body].particle_position(self.tip);
        0.5 * self.scene.size[1] - f64::from(tip.y)
    }
}

fn builder(scene: &Scene, model: SoftModel, mesh: &Mesh) -> SoftBodyBuilder {
    let [x0, y0] = scene.origin();
    let place = |&[x, y]: &[f64; 2]| Vector::new((x0 + x) as Real, (y0 + y) as Real);
    let cells = mesh
        .cells()
        .map(|cell| [0, 1, 2].map(|corner| cell.nodes[corner] as u32));
    let builder = SoftBodyBuilder::new(mesh.nodes().iter().map(place).collect())
        .cells(cells.collect())
        .masses(masses(mesh, DENSITY))
        .cell_model(SoftBodyCellModel::Corotational)
        .material(material(scene.young, POISSON, !scene.is_clamped()))
        .solver(model.solver())
        .particle_radius(RADIUS as Real)
        .can_sleep(false);
    if !scene.is_clamped() {
        return builder;
    }
    let is_clamped = |&node: &u32| mesh.nodes()[node as usize][0] == 0.0;
    // Nothing is near: without a surface it is cheaper.
    builder
        .pinned_particles((0..mesh.n_nodes() as u32).filter(is_clamped))
        .no_surface_collider()
}
