//! What touches what, with which forces, at which distance.
//!
//! Rapier finds the pairs: its broad and narrow phase, its groups, collision types and hooks, set for a flexible body by the builder or by
//! [`FlexBody::set_contact_settings`]. What then touches a flexible body, and all that touches or is joined to that without being fixed, is one island,
//! solved in one system: contact forces are Lagrange multipliers, no stiffness is invented, and nothing overlaps but by rounding.
//!
//! # Distance
//!
//! Surfaces with an inside, and other flexible bodies, are touched at a distance of zero, or of the sum of both contact skins. Terrain without
//! thickness, polylines and height fields, and the body itself are met [`FlexBody::contact_offset`] earlier, a hundredth of the shortest edge of the surface.
//! Bodies go from where they are to where they will be along a path on which nothing passes through anything, however fast.
//!
//! # Friction and restitution
//!
//! Coulomb's law with rapier's coefficients and rules to combine them; sticking is sticking, so what rests on a slope below the angle of friction
//! stays:
//!
//! ```
//! use foil2d::prelude::*;
//! use foil2d::rapier::prelude::*;
//!
//! // A slope of 20 degrees, by gravity; tan 20° = .364.
//! let slide = |friction: f64| -> Result<f64, Box<dyn std::error::Error>> {
//!     let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
//!     let (sin, cos) = 20.0_f32.to_radians().sin_cos();
//!     world.gravity = Vector::new((9.81 * sin).into(), (-9.81 * cos).into());
//!     world.insert_collider(ColliderBuilder::cuboid(50.0, 0.5).translation(Vector::new(0.0, -0.5)), None);
//!     let rubber = LinearElastic::plane_stress(1e7, 0.3).density(1000.0).rayleigh(2e-3);
//!     let block = FlexBodyBuilder::rectangle([0.5, 0.5], [4, 4]).material(rubber).friction(friction)
//!         .friction_combine_rule(CoefficientCombineRule::Min);
//!     let block = flex_bodies.insert(block, &mut world)?;
//!     let mut flex = FlexPipeline::new();
//!     for _ in 0..60 {
//!         flex.step(&mut world, &mut flex_bodies)?;
//!     }
//!     Ok(flex_bodies[block].centre_of_mass()[0] - 0.25)
//! };
//! assert!(slide(0.4)?.abs() < 0.01, "it sticks");
//! // Half a second squared of (sin - μ cos) g.
//! let expected = 0.5 * 9.81 * (0.342 - 0.2 * 0.940);
//! assert!((slide(0.2)? / expected - 1.0).abs() < 0.05, "it slides");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! What rebounds from a flexible body does so by the body's elasticity; Newton's coefficient acts in impacts that are shorter than the step.
//!
//! # Forces
//!
//! | | where |
//! |---|---|
//! | every contact, its place, normal, gap, force, and whether it sticks | [`StepReport::contacts`], [`contacts_of`](crate::pipeline::StepReport::contacts_of) one participant |
//! | what acts on a body or collider together | [`StepReport::force_on`] |
//! | what acts on a node | [`FlexBody::contact_force`], [`contact_pressure`](crate::body::FlexBody::contact_pressure) |
//! | supports | [`FlexBody::reaction`] |
//! | joints and attachments | [`StepReport::joints`] |
//!
//! In rapier, `ContactForceEvent`s of such pairs tell the same forces, once a step.
//!
//! [`FlexBody::set_contact_settings`]: crate::body::FlexBody::set_contact_settings
//! [`FlexBody::contact_offset`]: crate::body::FlexBody::contact_offset
//! [`FlexBody::contact_force`]: crate::body::FlexBody::contact_force
//! [`FlexBody::reaction`]: crate::body::FlexBody::reaction
//! [`StepReport::contacts`]: crate::pipeline::StepReport::contacts
//! [`StepReport::force_on`]: crate::pipeline::StepReport::force_on
//! [`StepReport::joints`]: crate::pipeline::StepReport::joints
