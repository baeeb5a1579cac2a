//! What a step costs, and how to make it cost less.
//!
//! `cargo bench` times whole steps beside rapier's own soft bodies on the same meshes in the same run, `cargo bench --bench piles` piles beside rapier alone,
//! and `cargo bench --bench growth` how a step grows with the number of bodies. Run them on your machine: ratios move less between machines than times do.
//!
//! # Beside rapier's own soft bodies
//!
//! Medians of whole steps on the same nodes, as multiples of a body of small strain of `Quad4` cells, from one run of `cargo bench` on two cores with other work beside it: read them to
//! one digit. rapier's `Fem` is conjugate gradients with the default cap on iterations; *converged* is without it, as it takes to reach the same deflection.
//!
//! | scene | degrees of freedom | `Constraints` | `Fem` | `Fem`, converged |
//! |---|---|---|---|---|
//! | cantilever, swinging | 126 | 9 | 11 | 16 |
//! | cantilever, swinging | 1,458 | 26 | 27 | 109 |
//! | cantilever, swinging | 8,442 | 26 | 26 | 221 |
//! | block, in the air | 578 | 11 | 20 | 34 |
//! | block, in the air | 8,450 | 7 | 7 | 39 |
//! | block, on the floor | 578 | 4 | 9 | 13 |
//! | block, on the floor | 8,450 | 4 | 38 | 347 |
//!
//! That is for small strains: one factor serves for ever here, while rapier's soft bodies stand large strains at that price. Bodies of large strain take 1 to 6 times as long as
//! ones of small strain, see [`limits`](super::limits). Piles of tens of soft bodies take longer than rapier's.
//!
//! # What costs
//!
//! | what costs | why | what to do |
//! |---|---|---|
//! | bodies of large strain | some factorizations a step while they change shape | [`small_strain`](crate::body::FlexBodyBuilder::small_strain) for what is stiff |
//! | meshes finer than needed | a step of a body of small strain grows as `n log n` with its nodes, one of large strain as its factorization | cells of a fifth of what bends |
//! | many contacts in one island | they are one problem, solved to the end | let piles sleep; keep apart by groups what need not meet |
//! | soft bodies crushed far | contact changes while they fold | stiffer materials, shorter steps |
//! | debug builds | | `[profile.dev.package."*"] opt-level = 3` |
//!
//! What a step will cost is told before it by [`doctor::ExpectedCost`](crate::doctor::ExpectedCost), in operations and to a factor of a few.
//! What sleeps costs next to nothing, and bodies that do not touch cost what each costs alone. [`StepReport::n_factorizations`], [`n_newton`], [`n_parts`], [`n_tried`] and, with
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
//! assert!(report.n_newton() <= 4 && report.n_parts() == 1 && report.n_tried() == 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`StepReport::n_factorizations`]: crate::pipeline::StepReport::n_factorizations
//! [`n_newton`]: crate::pipeline::StepReport::n_newton
//! [`n_parts`]: crate::pipeline::StepReport::n_parts
//! [`n_tried`]: crate::pipeline::StepReport::n_tried
//! [`times`]: crate::pipeline::StepReport::times
