//! The doctor: what is likely a mistake in a world, before it is run and after.
//!
//! Nothing here is an error: what cannot be computed is refused where it is built or stepped. These are bodies that will be computed, but are probably not
//! those that were meant: meshes that lock, damping that creeps, bodies in each other.
//!
//! ```
//! use foil2d::doctor::{Finding, examine};
//! use foil2d::prelude::*;
//! use foil2d::rapier::prelude::*;
//!
//! let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
//! let mesh = foil2d::fe::mesh::generate::rectangle([2.0, 0.1], [40, 2], CellKind::Tri3)?;
//! let steel = LinearElastic::plane_stress(2.1e11, 0.3).density(7800.0);
//! let strip = flex_bodies.insert(FlexBodyBuilder::mesh(mesh).material(steel), &mut world)?;
//!
//! let flex = FlexPipeline::new();
//! let found = examine(&world, &flex_bodies, &flex.parameters);
//! assert!(matches!(found[..], [Finding::FewCells { body, .. }] if body == strip));
//! println!("{}", found[0]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | file | owns |
//! |---|---|
//! | `finding` | what is found, in words |
//! | `body` | one body: mesh, material, damping, size |
//! | `surroundings` | bodies and what is beside them, or heavier |
//! | `cost` | [`ExpectedCost`]: operations of a step, counted before it |
//! | `course` | [`Course`]: what a run was like |

mod body;
mod cost;
mod course;
mod finding;
mod surroundings;

pub use cost::{BodyCost, ExpectedCost};
pub use course::{Course, CourseReport};
pub use finding::Finding;

use crate::body::FlexBodySet;
use crate::pipeline::FlexParameters;
use crate::rapier::prelude::PhysicsWorld;

/// What is likely a mistake in a world that is about to be stepped, body by body in the order of the set.
///
/// It factorizes the stiffness of every body once: fit for the beginning of a run, not for every step.
pub fn examine(
    world: &PhysicsWorld,
    flex_bodies: &FlexBodySet,
    parameters: &FlexParameters,
) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (handle, found) in flex_bodies.iter() {
        let patient = body::Patient {
            handle,
            body: found,
            gravity: f64::from(world.gravity.length()),
            dt: f64::from(world.integration_parameters.dt),
            integrator: parameters.integrator,
        };
        patient.examine(&mut findings);
    }
    surroundings::examine(world, flex_bodies, &mut findings);
    findings
}
