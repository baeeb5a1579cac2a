//! Flexible bodies in an app that exists.
//!
//! # The step
//!
//! [`FlexPipeline::step`](crate::pipeline::FlexPipeline::step) takes the place of rapier's step, and is rapier's step where no flexible body is. It takes rapier's
//! `PhysicsWorld`, or, by [`step_split`](crate::pipeline::FlexPipeline::step_split), rapier's sets one by one, as older programs hold them. Everything
//! else stays: queries, events, hooks, joints, sensors, snapshots of rapier's own.
//!
//! ```
//! use foil2d::prelude::*;
//! use foil2d::rapier::prelude::*;
//!
//! struct App {
//!     world: PhysicsWorld,
//!     flex_bodies: FlexBodySet,
//!     flex: FlexPipeline,
//!     behind: f64,
//! }
//!
//! impl App {
//!     /// Steps of equal length, however long frames are.
//!     fn frame(&mut self, seconds: f64) -> Result<(), Box<dyn std::error::Error>> {
//!         let dt = f64::from(self.world.integration_parameters.dt);
//!         self.behind += seconds.min(0.1);
//!         while self.behind >= dt {
//!             self.flex.step(&mut self.world, &mut self.flex_bodies)?;
//!             self.behind -= dt;
//!         }
//!         Ok(())
//!     }
//! }
//!
//! let mut app = App {
//!     world: PhysicsWorld::new(),
//!     flex_bodies: FlexBodySet::new(),
//!     flex: FlexPipeline::new(),
//!     behind: 0.0,
//! };
//! let rubber = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
//! let block = FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).material(rubber);
//! let block = app.flex_bodies.insert(block, &mut app.world)?;
//! app.frame(0.05)?;
//!
//! // What to draw: the edges of the mesh between the positions of its nodes.
//! let body = &app.flex_bodies[block];
//! for [from, to] in body.mesh().edges() {
//!     let _line = (body.position(from), body.position(to));
//! }
//! // What the mouse is on.
//! assert!(body.contains([0.5, 0.5]));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Verbs
//!
//! | in rapier | here |
//! |---|---|
//! | `set_translation`, `set_position` | [`FlexBodySet::set_position`](crate::body::FlexBodySet::set_position): of the centre of mass, the angle from where the body was built; not of pinned bodies |
//! | `set_linvel`, `set_angvel`, `apply_impulse`, `apply_torque_impulse` | the same on [`FlexBody`](crate::body::FlexBody); at a point and at a node too |
//! | `add_force` | [`FlexBody::set_nodal_force`](crate::body::FlexBody::set_nodal_force), [`set_body_force`](crate::body::FlexBody::set_body_force): they last until set anew |
//! | `set_enabled` | [`FlexBodySet::set_enabled`](crate::body::FlexBodySet::set_enabled) |
//! | `set_body_type` | pins in the builder, [`set_pin_displacement`](crate::body::FlexBody::set_pin_displacement) moves them |
//! | an impulse joint | an [`AttachmentBuilder`](crate::body::AttachmentBuilder): pin, weld or spring to the world, a rigid or a flexible body |
//! | `remove` | [`FlexBodySet::remove`](crate::body::FlexBodySet::remove) |
//!
//! The collider of a flexible body, [`FlexBody::collider_handle`](crate::body::FlexBody::collider_handle), is what rapier's queries and events name;
//! [`FlexBodySet::of_collider`](crate::body::FlexBodySet::of_collider) tells whose it is, and [`FlexBodySet::pick`](crate::body::FlexBodySet::pick) which node. Its rigid body is a
//! carrier: leave its pose, its velocity and its type alone, put no joints and no other colliders on it, and remove the body by
//! [`FlexBodySet::remove`](crate::body::FlexBodySet::remove), not through rapier (what is gone already, `forget`). Impulses and forces given to the carrier go nowhere:
//! [`FlexBody`](crate::body::FlexBody) takes them.
//!
//! That collider is the outline of the body. Points and rays from inside, and shapes that lie inside, meet nothing there:
//! [`FlexBody::contains`](crate::body::FlexBody::contains) knows better. A sensor smaller than the body that crosses it hears of its rims, going in and coming out.
//!
//! # Events
//!
//! [`step_with_events`](crate::pipeline::FlexPipeline::step_with_events) takes rapier's hooks and event handler. Hooks may set friction, restitution and the velocity of belts, and let contacts
//! through; what else they do costs guarantees, see [limits](super::limits). A body that is to make events asks for them by
//! [`active_events`](crate::body::FlexBodyBuilder::active_events), as colliders do:
//!
//! ```
//! use foil2d::prelude::*;
//! use foil2d::rapier::prelude::*;
//! use std::sync::mpsc::channel;
//!
//! let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
//! let floor = world.insert_collider(ColliderBuilder::cuboid(5.0, 0.5).translation(Vector::new(0.0, -0.5)), None);
//! let rubber = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
//! let block = FlexBodyBuilder::rectangle([0.5, 0.5], [4, 4])
//!     .material(rubber)
//!     .translation([0.0, 0.2])
//!     .active_events(ActiveEvents::COLLISION_EVENTS);
//! let block = flex_bodies.insert(block, &mut world)?;
//!
//! let (sender, collisions) = channel();
//! let handler = ChannelEventCollector::new(sender, channel().0, channel().0);
//! let mut flex = FlexPipeline::new();
//! for _ in 0..30 {
//!     flex.step_with_events(&mut world, &mut flex_bodies, &(), &handler)?;
//! }
//! // The body falls for 0.2 s and lands.
//! let first = collisions.try_iter().next().ok_or("nothing has landed")?;
//! let other = if first.collider1() == floor { first.collider2() } else { first.collider1() };
//! assert!(first.started() && flex_bodies.of_collider(other) == Some(block));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Sleep
//!
//! What rests falls asleep with rapier's islands and costs nothing; a touch, a change of load or of what is near wakes it. [`StepReport::n_asleep`](crate::pipeline::StepReport::n_asleep) tells how many
//! bodies sleep, [`FlexBody::wake_up`](crate::body::FlexBody::wake_up) wakes one, and [`can_sleep`](crate::body::FlexBodyBuilder::can_sleep)`(false)` keeps one awake.
//!
//! # When a step fails
//!
//! A step that returns a [`StepError`](crate::pipeline::StepError) has changed nothing but the report, which is that of no step then (checksums of snapshots count it): mend what the text names, or leave it out, and step again. A body whose motion would not be finite leaves the world
//! instead ([`quarantined_flex_bodies`](crate::pipeline::StepReport::quarantined_flex_bodies)), and the rest goes on.
//!
//! # Saving
//!
//! With the feature `serde-serialize`, `pipeline::Snapshot` saves a world with its flexible bodies through any binary serde format, and goes on bit for bit.
//! Rapier's own snapshots do not know of flexible bodies.
