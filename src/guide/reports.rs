//! What a step tells, and what to do about it.
//!
//! [`FlexPipeline::step`](crate::pipeline::FlexPipeline::step) returns an error where something is wrong with what it was given; nothing has then been
//! changed, and the text names who it is and what to do. Otherwise it returns a [`StepReport`](crate::pipeline::StepReport).
//!
//! # Was it solved?
//!
//! | [`quality`](crate::pipeline::StepReport::quality) | means | do |
//! |---|---|---|
//! | `Solved` | all laws hold to the residuals told, in one piece or in [parts](crate::pipeline::StepReport::n_parts) | |
//! | `Cut` | with gaps that miss the laws by up to a hundredth of an edge, a contact that has slid off within the step, or joints that contradict each other left open | nothing, or look at [`unsolved`](crate::pipeline::StepReport::unsolved) |
//! | `Unfinished` | the budget ran out: bodies were stopped where nothing overlaps, or wait | shorten the step, look at who is named |
//!
//! [`FlexPipeline::refusing_unsolved`](crate::pipeline::FlexPipeline::refusing_unsolved) makes an unsolved step an error and leaves the world as it was.
//!
//! ```
//! use foil2d::pipeline::Quality;
//! use foil2d::prelude::*;
//! use foil2d::rapier::prelude::*;
//!
//! let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
//! world.insert_collider(ColliderBuilder::cuboid(5.0, 0.5).translation(Vector::new(0.0, -0.5)), None);
//! let rubber = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
//! let ball = FlexBodyBuilder::disc(0.3, 0.1).material(rubber).translation([0.0, 0.5]);
//! let ball = flex_bodies.insert(ball, &mut world)?;
//! let mut flex = FlexPipeline::new();
//! let brought = 9.81 * flex_bodies[ball].mass() * 0.2;
//! let mut highest: f64 = 0.0;
//! for _ in 0..120 {
//!     let report = flex.step(&mut world, &mut flex_bodies)?;
//!     assert_eq!(report.quality(), Quality::Solved);
//!     assert!(report.gap_violation() < 1e-6);
//!     let energy = flex_bodies[ball].energy();
//!     highest = highest.max(energy.kinetic + energy.elastic);
//! }
//! assert!(highest < 1.01 * brought, "no impact makes energy");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Does it balance?
//!
//! [`StepReport::energy`](crate::pipeline::StepReport::energy) has kinetic, elastic and potential energy of the islands of the step where it ends, and what has been dissipated since the pipeline was made;
//! [`momentum`](crate::pipeline::StepReport::momentum) and [`angular_momentum`](crate::pipeline::StepReport::angular_momentum) hold to rounding where
//! nothing acts from outside.
//!
//! # What is odd
//!
//! | | tells |
//! |---|---|
//! | [`insertion_notes`](crate::pipeline::StepReport::insertion_notes) | bodies put into each other, pins that choose no node: once |
//! | [`overbent`](crate::pipeline::StepReport::overbent) | bodies of small strain that are bent beyond it |
//! | [`self_crossing`](crate::pipeline::StepReport::self_crossing) | bodies whose pins were put so that they cross themselves |
//! | [`gap_violation`](crate::pipeline::StepReport::gap_violation), [`slip_violation`](crate::pipeline::StepReport::slip_violation), [`joint_violation`](crate::pipeline::StepReport::joint_violation) | how far the end of the step is from each law |
//! | [`quarantined_flex_bodies`](crate::pipeline::StepReport::quarantined_flex_bodies) | bodies taken out of the world, as their motion would not have been finite |
