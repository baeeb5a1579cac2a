//! From a scene to a world.

mod checks;
mod flexible;
mod joints;
mod material;
mod nodes;
mod rigid;

pub use nodes::nearest;

use super::names::Names;
use super::problem::Problem;
use super::scene::{Integrator, SceneFile};
use super::shape::Shaped;
use super::source::Source;
use foil2d::prelude::*;
use foil2d::rapier::math::Real;
use foil2d::rapier::prelude::*;
use std::collections::BTreeMap;

/// A world that is ready to be stepped.
pub struct Built {
    pub world: PhysicsWorld,
    pub flex_bodies: FlexBodySet,
    pub flex: FlexPipeline,
    pub names: Names,
    /// Meshes and groups of nodes of the flexible bodies, by name.
    shaped: BTreeMap<String, Shaped>,
    /// Nodes that the bodies yet to be inserted may have.
    nodes_left: usize,
}

/// Builds the world of a scene.
pub fn build(source: &Source) -> Result<Built, Problem> {
    checks::check_world(source)?;
    let spec = &source.scene.world;
    let integrator = match spec.integrator.get() {
        Integrator::Damped => {
            let damped = Beta2::damped(*spec.decay.get());
            damped.map_err(|error| source.problem(&spec.decay, error))?
        }
        Integrator::Trapezoidal => Beta2::trapezoidal(),
        Integrator::CentralDifference => Beta2::central_difference(),
    };
    let mut world = PhysicsWorld::new();
    world.gravity = vector(spec.gravity.get().0);
    world.integration_parameters.dt = *spec.dt.get() as Real;
    let flex = FlexPipeline::new().with_integrator(integrator);
    let mut built = Built {
        world,
        flex_bodies: FlexBodySet::new(),
        flex: match spec.refuse_unsolved {
            true => flex.refusing_unsolved(),
            false => flex,
        },
        names: Names::default(),
        shaped: BTreeMap::new(),
        nodes_left: spec.most_nodes,
    };
    for rigid in &source.scene.rigid {
        rigid::insert(&mut built, source, rigid)?;
    }
    for body in &source.scene.flexible {
        flexible::insert(&mut built, source, body)?;
    }
    for joint in &source.scene.joint {
        joints::join(&mut built, source, joint)?;
    }
    for attachment in &source.scene.attachment {
        joints::attach(&mut built, source, attachment)?;
    }
    Ok(built)
}

/// Steps that a scene asks for.
pub fn n_steps(scene: &SceneFile) -> usize {
    (scene.world.duration.get() / scene.world.dt.get()).round() as usize
}

/// Vectors of rapier.
fn vector([x, y]: [f64; 2]) -> Vector {
    Vector::new(x as Real, y as Real)
}
