//! A first beam.
//!
//! A rapier world, a set of flexible bodies and a pipeline that steps both:
//!
//! ```
//! use foil2d::prelude::*;
//! use foil2d::rapier::prelude::*;
//!
//! let mut world = PhysicsWorld::new();
//! let mut flex_bodies = FlexBodySet::new();
//! let mut flex = FlexPipeline::new();
//!
//! // A steel strip of 1 m by 2 cm, 5 cm wide, clamped at its left end.
//! let steel = LinearElastic::plane_stress(2.1e11, 0.3).density(7800.0).rayleigh(1e-3);
//! let strip = FlexBodyBuilder::rectangle([1.0, 0.02], [20, 2])
//!     .material(steel)
//!     .thickness(0.05)
//!     .pin_where(|[x, _]| x == 0.0, Pin::both());
//! let strip = flex_bodies.insert(strip, &mut world)?;
//!
//! for _ in 0..600 {
//!     flex.step(&mut world, &mut flex_bodies)?;
//! }
//!
//! // Nodes are numbered along x, row by row: the last of the first row is the lower corner of the tip.
//! let sag = -flex_bodies[strip].displacement(20)[1];
//!
//! // The beam of Euler and Bernoulli: q L⁴ / (8 E I), with q = ρ g A.
//! let load = 7800.0 * 9.81 * 0.02 * 0.05;
//! let inertia = 0.05 * 0.02_f64.powi(3) / 12.0;
//! let expected = load / (8.0 * 2.1e11 * inertia);
//! assert!((sag / expected - 1.0).abs() < 0.01);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Units are those you choose, as long as they agree: metres, kilograms, seconds, newtons and pascals here. Everything that the crate returns is
//! `f64`, whatever precision rapier has.
//!
//! Rigid bodies, colliders and joints are rapier's, and are stepped by the same call: where they touch a flexible body, or are joined or stacked
//! to what does, they are solved with it.
//!
//! ```
//! use foil2d::prelude::*;
//! use foil2d::rapier::prelude::*;
//!
//! let mut world = PhysicsWorld::new();
//! let mut flex_bodies = FlexBodySet::new();
//! let mut flex = FlexPipeline::new();
//! let rubber = LinearElastic::plane_stress(1e6, 0.45).density(1100.0).rayleigh(5e-3);
//! let mat = FlexBodyBuilder::rectangle([2.0, 0.2], [20, 2]).material(rubber).translation([-1.0, 0.0]);
//! let mat = flex_bodies.insert(mat, &mut world)?;
//! world.insert_collider(ColliderBuilder::cuboid(5.0, 0.5).translation(Vector::new(0.0, -0.5)), None);
//! let ball = RigidBodyBuilder::dynamic().translation(Vector::new(0.0, 0.6));
//! world.insert(ball, ColliderBuilder::ball(0.2).density(500.0));
//!
//! for _ in 0..240 {
//!     let report = flex.step(&mut world, &mut flex_bodies)?;
//!     assert!(report.gap_violation() < 1e-5, "nothing is in anything");
//! }
//!
//! // What presses the mat from below is its weight and the ball's.
//! let weight = 9.81 * (flex_bodies[mat].mass() + 500.0 * std::f64::consts::PI * 0.04);
//! let from_below: f64 = flex.report().contacts().iter()
//!     .filter(|contact| contact.position[1] < 0.05)
//!     .map(|contact| contact.normal_force)
//!     .sum();
//! assert!((from_below / weight - 1.0).abs() < 0.01);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! In a debug build finite elements are slow. Let dependencies be optimized in yours:
//!
//! ```toml
//! [profile.dev.package."*"]
//! opt-level = 3
//! ```
