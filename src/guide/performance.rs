//! What a step costs, and how to make it cost less.
//!
//! `cargo bench` times whole steps beside rapier's own soft bodies on the same meshes in the same run, `cargo bench --bench piles` piles beside rapier alone,
//! and `cargo bench --bench growth` how a step grows with the number of bodies. Run them on your machine: ratios move less between machines than times do.
//!
//! | what costs | why | what to do |
//! |---|---|---|
//! | bodies of large strain | some factorizations a step while they change shape | [`small_strain`](crate::body::FlexBodyBuilder::small_strain) for what is stiff |
//! | meshes finer than needed | a step of a body of small strain grows as `n log n` with its nodes, one of large strain as its factorization | cells of a fifth of what bends |
//! | many contacts in one island | they are one problem, solved to the end | let piles sleep; keep apart by groups what need not meet |
//! | soft bodies crushed far | contact changes while they fold | stiffer materials, shorter steps |
//! | debug builds | | `[profile.dev.package."*"] opt-level = 3` |
//!
//! What sleeps costs next to nothing, and bodies that do not touch cost what each costs alone. [`StepReport::n_factorizations`], [`n_newton`], [`n_parts`] and, with
//! the feature `timing`, [`times`] tell where a step went:
//!
//! ```
//! use foil2d::prelude::*;
//! use foil2d::rapier::prelude::*;
//!
//! let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
//! world.insert_collider(ColliderBuilder::cuboid(5.0, 0.5).translation(Vector::new(0.0, -0.5)), None);
//! let rubber = LinearElastic::plane_stress(1e7, 0.3).density(1000.0).rayleigh(2e-3);
//! let block = FlexBodyBuilder::rectangle([1.0, 1.0], [8, 8]).material(rubber).small_strain();
//! flex_bodies.insert(block, &mut world)?;
//! let mut flex = FlexPipeline::new();
//! for _ in 0..30 {
//!     flex.step(&mut world, &mut flex_bodies)?;
//! }
//! let report = flex.step(&mut world, &mut flex_bodies)?;
//! assert!(report.n_newton() <= 4 && report.n_parts() == 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`StepReport::n_factorizations`]: crate::pipeline::StepReport::n_factorizations
//! [`n_newton`]: crate::pipeline::StepReport::n_newton
//! [`n_parts`]: crate::pipeline::StepReport::n_parts
//! [`times`]: crate::pipeline::StepReport::times
