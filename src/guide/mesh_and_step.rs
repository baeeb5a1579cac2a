//! Which mesh, which step, which damping, which integrator.
//!
//! # Mesh
//!
//! | cells | bending | for |
//! |---|---|---|
//! | [`CellKind::Quad4`] | right with one cell across | rectangles and rings: what [`FlexBodyBuilder::rectangle`] and [`annulus`](crate::body::FlexBodyBuilder::annulus) make |
//! | [`CellKind::Tri6`] | right with one cell across | any outline: what [`FlexBodyBuilder::disc`] and [`polygon`](crate::body::FlexBodyBuilder::polygon) make |
//! | [`CellKind::Tri3`] | too stiff: the tip of a cantilever goes 37 % less far with two cells across | pictures, and meshes that have to be those of other programs |
//!
//! Contact is led by the nodes of the surface, so what shall wrap around a corner needs nodes there. Beyond that, cells of a fifth of what the
//! body bends over are enough for a percent. [`Mesh`](crate::fe::mesh::Mesh) takes nodes and cells of your own and refuses, with the cell named, what
//! cannot be computed.
//!
//! # Step
//!
//! Steps are rapier's, `world.integration_parameters.dt`. The default integrator is stable at any; what a step does not resolve dies out, and
//! equilibria are right. A vibration is resolved by some twenty steps a period.
//!
//! # Damping
//!
//! | you know | say |
//! |---|---|
//! | the ratio `ξ` at the frequency `ω` (rad/s) | `.rayleigh(2.0 * ξ / ω)` of the material: grows with the frequency |
//! | ratios at two frequencies | `.damping(Rayleigh::from_ratios(..)?)` |
//! | drag, for all motion | `.rayleigh_mass(rate)`: velocities fall by `exp(-rate t)` |
//!
//! Without any, the default integrator damps a vibration of `ω` with a ratio of about `.013 ω dt`, in bodies of small strain `.026 ω dt`.
//!
//! # Integrator
//!
//! | | conserves | stable | for |
//! |---|---|---|---|
//! | `Beta2::damped(0.9)?`, the default | momentum | at any step | everything that touches |
//! | `Beta2::trapezoidal()` | energy too | at any step | vibrations, where steps resolve impacts |
//! | `Beta2::linear_acceleration()` | | below a critical step, of bodies of small strain with [`ContactInertia::Kept`](crate::body::ContactInertia::Kept) | comparisons |
//! | `Beta2::central_difference()` | energy in the mean | below a critical step, told when exceeded | waves, in bodies of [`small_strain`](crate::body::FlexBodyBuilder::small_strain) |
//!
//! The member is chosen for the pipeline, [`FlexPipeline::with_integrator`], and holds for bodies of small strain; those of large strain
//! take energy–momentum steps, with the decay of the member for what vibrates fast.
//!
//! ```
//! use foil2d::prelude::*;
//! use foil2d::rapier::prelude::*;
//! // A free bar that has been stretched keeps its energy for a thousand steps.
//! let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
//! world.gravity = Vector::ZERO;
//! world.integration_parameters.dt = 1e-4;
//! let rubber = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
//! let stretching: Vec<[f64; 2]> = (0..2 * 11).map(|node| [0.5 * (node % 11) as f64 / 10.0, 0.0]).collect();
//! let bar = FlexBodyBuilder::rectangle([1.0, 0.1], [10, 1]).material(rubber).velocities(stretching);
//! let bar = flex_bodies.insert(bar, &mut world)?;
//! let mut flex = FlexPipeline::new().with_integrator(Beta2::trapezoidal());
//! let before = flex_bodies[bar].energy();
//! for _ in 0..1000 {
//!     flex.step(&mut world, &mut flex_bodies)?;
//! }
//! let after = flex_bodies[bar].energy();
//! let total = |energy: foil2d::body::BodyEnergy| energy.kinetic + energy.elastic;
//! assert!((total(after) / total(before) - 1.0).abs() < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`CellKind::Quad4`]: crate::fe::mesh::CellKind::Quad4
//! [`CellKind::Tri6`]: crate::fe::mesh::CellKind::Tri6
//! [`CellKind::Tri3`]: crate::fe::mesh::CellKind::Tri3
//! [`FlexBodyBuilder::rectangle`]: crate::body::FlexBodyBuilder::rectangle
//! [`FlexBodyBuilder::disc`]: crate::body::FlexBodyBuilder::disc
//! [`FlexPipeline::with_integrator`]: crate::pipeline::FlexPipeline::with_integrator
