//! Flexible bodies in rapier's testbed, in macroquad and in Bevy.
//!
//! Three crates in the repository show how flexible bodies come into apps that others have made. Each is a crate of its own, so that
//! nothing of them is a dependency of this one:
//!
//! | crate | is | with |
//! |---|---|---|
//! | `demos/testbed` | three scenes in rapier's testbed | `rapier_testbed2d` 0.36, `kiss3d` 0.45 |
//! | `demos/drag` | bodies to drag with the mouse | `macroquad` 0.4 |
//! | `demos/bevy` | a plugin beside `bevy_rapier2d`, with tests that need no window | `bevy` 0.20, `bevy_rapier2d` 0.37 |
//!
//! All of them have to agree with this crate on one version of rapier, 0.36: `cargo tree -i rapier2d` must list one.
//!
//! # A loop of rapier
//!
//! Where an app says `world.step()`, it says `flex.step(&mut world, &mut flex_bodies)?` instead, see [`embedding`](super::embedding).
//! Three things differ from rigid bodies in what is around the step: where bodies are, what is drawn, and what the mouse holds.
//!
//! # What is drawn
//!
//! The nodes of a body move, its pose says nothing. Cells are drawn as triangles about their first corner; which nodes they join is the same
//! in all frames:
//!
//! ```
//! use foil2d::body::FlexBody;
//! use foil2d::prelude::*;
//! use foil2d::rapier::prelude::*;
//!
//! /// Where the nodes are (m).
//! fn vertices(body: &FlexBody) -> Vec<[f32; 2]> {
//!     let nodes = 0..body.n_nodes();
//!     nodes.map(|node| body.position(node).map(|x| x as f32)).collect()
//! }
//!
//! /// Nodes of the triangles that fill the body, counter-clockwise.
//! fn triangles(body: &FlexBody) -> Vec<[usize; 3]> {
//!     let mut triangles = Vec::new();
//!     for cell in body.mesh().cells() {
//!         let corners = cell.corners();
//!         let pairs = corners[1..].windows(2);
//!         triangles.extend(pairs.map(|pair| [corners[0], pair[0], pair[1]]));
//!     }
//!     triangles
//! }
//!
//! let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
//! let rubber = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
//! let block = FlexBodyBuilder::rectangle([2.0, 1.0], [8, 4]).material(rubber);
//! let block = flex_bodies.insert(block, &mut world)?;
//! let body = &flex_bodies[block];
//! let (places, filled) = (vertices(body), triangles(body));
//! let area = |[a, b, c]: [usize; 3]| {
//!     let edge = |to: usize| [0, 1].map(|k| places[to][k] - places[a][k]);
//!     let (one, other) = (edge(b), edge(c));
//!     0.5 * (one[0] * other[1] - one[1] * other[0])
//! };
//! let whole: f32 = filled.into_iter().map(area).sum();
//! assert!((whole - 2.0).abs() < 1e-5, "they fill the block: {whole} m^2");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`FlexBody::von_mises`](crate::body::FlexBody::von_mises) gives a stress for every vertex: `demos/drag` colours by it. With the feature
//! `debug-render`, `pipeline::FlexDebugRender` draws meshes, stresses and forces by any backend of rapier's debug renderer: `demos/testbed` has one
//! of eight lines.
//!
//! # What the mouse holds
//!
//! A rigid body is a carrier of each flexible one. It has no place to be pulled by, so a joint to it holds nothing. The mouse holds
//! the nearest node by a spring instead, as `demos/drag` does. Where a viewer makes the joint, as rapier's testbed, the joint is replaced before the
//! step:
//!
//! ```
//! use foil2d::prelude::*;
//! use foil2d::rapier::prelude::*;
//!
//! /// Replaces joints that viewers put on flexible bodies by springs of the nodes nearest to them.
//! fn hold_by_nodes(
//!     world: &mut PhysicsWorld,
//!     flex_bodies: &mut FlexBodySet,
//! ) -> Result<(), Box<dyn std::error::Error>> {
//!     let grabbed = world.impulse_joints.iter().find_map(|(handle, joint)| {
//!         let mut bodies = flex_bodies.iter();
//!         let (body, _) = bodies.find(|(_, body)| body.rigid_body_handle() == joint.body2())?;
//!         Some((handle, joint.body1(), body))
//!     });
//!     if let Some((joint, mouse, body)) = grabbed {
//!         world.impulse_joints.remove(joint, true);
//!         let at = world.bodies[mouse].translation();
//!         let node = flex_bodies[body].pick([at.x.into(), at.y.into()]).node;
//!         let mass = flex_bodies[body].mass();
//!         let spring = AttachmentBuilder::spring_damper(body, 150.0 * mass, 15.0 * mass)
//!             .node(node)
//!             .rest_length(0.0)
//!             .at_point([0.0, 0.0])
//!             .to_rigid_body(mouse);
//!         flex_bodies.attach(spring, &world.bodies)?;
//!     }
//!     Ok(())
//! }
//!
//! let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
//! let rubber = LinearElastic::plane_stress(1e6, 0.3).density(1000.0).rayleigh(1e-2);
//! let block = FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).material(rubber);
//! let block = flex_bodies.insert(block, &mut world)?;
//! // What a viewer does on a click at the upper right corner.
//! let mouse = RigidBodyBuilder::kinematic_position_based().translation(Vector::new(1.0, 1.0));
//! let mouse = world.insert_body(mouse);
//! let carrier = flex_bodies[block].rigid_body_handle();
//! world.insert_impulse_joint(mouse, carrier, SpringJointBuilder::new(0.0, 10.0, 1.0));
//! let mut flex = FlexPipeline::new();
//! for _ in 0..300 {
//!     hold_by_nodes(&mut world, &mut flex_bodies)?;
//!     flex.step(&mut world, &mut flex_bodies)?;
//! }
//! let hangs = flex_bodies[block].position(24)[1];
//! assert!((hangs - (1.0 - 9.81 / 150.0)).abs() < 0.05, "by its corner, {hangs} m");
//! // When the viewer removes the body of the mouse, the spring goes with it.
//! world.remove_body(mouse);
//! flex.step(&mut world, &mut flex_bodies)?;
//! assert_eq!(flex_bodies.iter_attachments().count(), 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Snapshots that a viewer takes are rapier's own and do not know of flexible bodies.
//!
//! # Bevy
//!
//! `bevy_rapier2d` keeps rapier's sets in components of one entity, all of them public, and its plugin can leave out its step. So flexible bodies
//! need one system: the plugin is added with `PhysicsSet::{SyncBackend, Writeback}` alone, and a system in `PhysicsSet::StepSimulation` hands the
//! sets to [`FlexPipeline::step_split`](crate::pipeline::FlexPipeline::step_split). Without Bevy around them, the components and the system are:
//!
//! ```
//! use foil2d::prelude::*;
//! use foil2d::rapier::prelude::*;
//!
//! /// The components `RapierContextSimulation`, `RapierContextColliders`, `RapierContextJoints` and `RapierRigidBodySet`.
//! #[derive(Default)]
//! struct Context {
//!     pipeline: PhysicsPipeline,
//!     parameters: IntegrationParameters,
//!     islands: IslandManager,
//!     broad_phase: BroadPhaseBvh,
//!     narrow_phase: NarrowPhase,
//!     ccd_solver: CCDSolver,
//!     colliders: ColliderSet,
//!     impulse_joints: ImpulseJointSet,
//!     multibody_joints: MultibodyJointSet,
//!     bodies: RigidBodySet,
//!     soft_bodies: SoftBodySet,
//! }
//!
//! fn step(
//!     context: &mut Context,
//!     flex: &mut FlexPipeline,
//!     flex_bodies: &mut FlexBodySet,
//! ) -> Result<(), Box<dyn std::error::Error>> {
//!     flex.step_split(
//!         flex_bodies,
//!         &mut context.pipeline,
//!         Vector::new(0.0, -9.81),
//!         &context.parameters,
//!         &mut context.islands,
//!         &mut context.broad_phase,
//!         &mut context.narrow_phase,
//!         &mut context.bodies,
//!         &mut context.colliders,
//!         &mut context.impulse_joints,
//!         &mut context.multibody_joints,
//!         &mut context.soft_bodies,
//!         &mut context.ccd_solver,
//!         &(),
//!         &(),
//!     )?;
//!     Ok(())
//! }
//!
//! let (mut context, mut flex_bodies) = (Context::default(), FlexBodySet::new());
//! let rubber = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
//! let block = FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).material(rubber);
//! let block = flex_bodies.insert_with_sets(block, &mut context.bodies, &mut context.colliders)?;
//! // By the bits of an entity bevy_rapier2d knows whose body and collider they are.
//! let (entity, body) = (7, &flex_bodies[block]);
//! context.bodies[body.rigid_body_handle()].user_data = entity;
//! context.colliders[body.collider_handle()].user_data = entity;
//! let start = flex_bodies[block].centre_of_mass()[1];
//! let mut flex = FlexPipeline::new();
//! for _ in 0..60 {
//!     step(&mut context, &mut flex, &mut flex_bodies)?;
//! }
//! let fallen = start - flex_bodies[block].centre_of_mass()[1];
//! assert!((fallen - 0.5 * 9.81).abs() < 0.1, "{fallen} m in a second");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! `demos/bevy` is that, in some 500 lines to take along. What else it sees to:
//!
//! - Events go through a handler of its own into Bevy's messages: the handler of `bevy_rapier2d` cannot be had from outside. Neither can its hooks.
//! - `TimestepMode` is kept in all three forms, and rigid bodies with `TransformInterpolation` are drawn between steps.
//!   Where nodes are is a component written after each step.
//! - `length_unit` stays 1: flexible bodies are in the world's own units, metres here. Scale by the camera.
//!
//! ```toml
//! [dependencies]
//! bevy = "0.20"
//! bevy_rapier2d = "0.37"     # of rapier2d 0.36; the plugin's 0.36 asks for a rapier2d before 0.35
//! foil2d = "0.1"
//! ```
//!
//! # A browser
//!
//! The crate compiles for `wasm32-unknown-unknown` and runs there. Tried with rustc 1.97.1 under Node 20, in `f32` worlds with the features
//! `serde-serialize`, `debug-render`, `json`, `svg` and `png`: a cantilever, contact with rigid and flexible bodies, large strain, a snapshot
//! that goes on bit for bit, and pictures. `demos/drag` runs in Chromium 156; its commands are in `demos/README.md`.
//!
//! - Last digits are not those of a native build without `enhanced-determinism`: of four scenes of 240 steps the cantilever was the same to the
//!   last bit, and the others agreed to eleven digits or more in the places that were compared.
//! - Steps take several times as long as natively.
//! - With the feature `timing` all times are zero, as there is no clock.
//! - There are no files: functions of [`io`](crate::io) that read or write them return errors. Those that return text or bytes, such as
//!   [`still`](fn@crate::io::still), do not need any.
//! - `f64` worlds and the features `enhanced-determinism`, `timing`, `parallel` and `cli` were not run there, and neither were functions with files.
