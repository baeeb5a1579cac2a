//! Bodies that bend far, and bodies that do not.
//!
//! | | large strain, the default | [`small_strain`](crate::body::FlexBodyBuilder::small_strain) |
//! |---|---|---|
//! | bends, stretches, folds | as far as it likes | strains of a few percent, in one frame that turns with the body; pins hold the frame of what they hold, so weld what is to turn with its support |
//! | meets itself | yes | no |
//! | step | a nonlinear one: a factorization now and then | linear: one factorization for ever |
//! | integrator | energy–momentum, the decay of the pipeline's member | any member of Beta-2, explicit ones too |
//! | materials | with a [law for large strains](crate::fe::material::Material::large_law); without one [refused](crate::body::BuildError::NoLargeLaw) | any |
//!
//! A body of small strain that is bent further is another body than you mean, and the report says so:
//!
//! ```
//! use foil2d::prelude::*;
//! use foil2d::rapier::prelude::*;
//!
//! let bent = |is_small: bool| -> Result<(f64, usize), Box<dyn std::error::Error>> {
//!     let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
//!     let rubber = LinearElastic::plane_stress(1e6, 0.3).density(1000.0).rayleigh(2e-2);
//!     let strip = FlexBodyBuilder::rectangle([1.0, 0.05], [20, 1])
//!         .material(rubber)
//!         .pin_where(|[x, _]| x == 0.0, Pin::both());
//!     let strip = if is_small { strip.small_strain() } else { strip };
//!     let strip = flex_bodies.insert(strip, &mut world)?;
//!     let mut flex = FlexPipeline::new();
//!     for _ in 0..600 {
//!         flex.step(&mut world, &mut flex_bodies)?;
//!     }
//!     // How long its upper side has become.
//!     let side: Vec<[f64; 2]> = (21..42).map(|node| flex_bodies[strip].position(node)).collect();
//!     let length = side.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])).sum();
//!     Ok((length, flex.report().overbent().len()))
//! };
//! // It hangs down from its clamp, about as long as it was.
//! let (length, n_overbent) = bent(false)?;
//! assert!((0.98..1.1).contains(&length) && n_overbent == 0);
//! // Small strains do not know of turns: the strip is drawn out as it sinks.
//! let (length, n_overbent) = bent(true)?;
//! assert!(length > 1.5 && n_overbent == 1);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Laws
//!
//! | law | for |
//! |---|---|
//! | [`LinearElastic`](crate::fe::material::LinearElastic) | Hooke's at small strains; neo-Hookean with the same moduli beyond |
//! | [`Corotated`](crate::fe::material::hyperelastic::Corotated) | what is stiff and bends far |
//! | [`StableNeoHookean`](crate::fe::material::hyperelastic::StableNeoHookean) | what is soft, and may be crushed flat: it recovers from being turned inside out |
//! | [`NeoHookean`](crate::fe::material::hyperelastic::NeoHookean) | what must never turn inside out |
//! | [`MooneyRivlin`](crate::fe::material::hyperelastic::MooneyRivlin), [`Gent`](crate::fe::material::hyperelastic::Gent) | rubber, by what it was measured at |
//! | [`NeoHookeanSheet`](crate::fe::material::hyperelastic::NeoHookeanSheet), [`MooneyRivlinSheet`](crate::fe::material::hyperelastic::MooneyRivlinSheet) | thin sheets, free to change their thickness |
//! | [`J2Plasticity`](crate::fe::material::hyperelastic::J2Plasticity) | metals that yield: what has flowed stays |
//! | [`StVenantKirchhoff`](crate::fe::material::hyperelastic::StVenantKirchhoff) | comparisons |
//!
//! Rubber and metal that flows all but keep their volume, and some cells lock then: three-node triangles do, and eight-node quadrilaterals of `Corotated` and
//! `StVenantKirchhoff`; six-node triangles, four-node quadrilaterals, and eight-node ones of the other laws do not.
//!
//! Regions of one body may have materials of their own,
//! [`FlexBodyBuilder::region_material`](crate::body::FlexBodyBuilder::region_material), and holes an
//! [`inner_pressure`](crate::body::FlexBodyBuilder::inner_pressure), constant or of a gas that is shut in: tyres and balloons.
//!
//! # Strings and membranes: tension from the start
//!
//! Thin bodies carry across by the tension along them: a string, a rope bridge, a trampoline. [`FlexBodyBuilder::pre_stretch`](crate::body::FlexBodyBuilder::pre_stretch)
//! builds them under it, so that nothing has to be drawn apart first. The mesh is what stands in the world; free of stress the body is shorter, and its density,
//! thickness and moduli are of that shape.
//!
//! ```
//! use foil2d::prelude::*;
//! use foil2d::rapier::prelude::*;
//!
//! let mut world = PhysicsWorld::new();
//! let mut flex_bodies = FlexBodySet::new();
//! // A line of 4 m and 2 cm, with 2 kPa of tension in it, between two walls.
//! let line = FlexBodyBuilder::rectangle([4.0, 0.02], [40, 1])
//!     .material(LinearElastic::plane_stress(1e6, 0.3).density(10.0))
//!     .pre_stretch(PreStretch::by_stress([2e3, 0.0]))
//!     .pin_where(|[x, _]| x == 0.0 || x == 4.0, Pin::both());
//! let line = flex_bodies.insert(line, &mut world)?;
//! FlexPipeline::new().step(&mut world, &mut flex_bodies)?;
//! let pull: f64 = [40, 81].iter().map(|&node| flex_bodies[line].reaction(node)[0]).sum();
//! assert!((pull / (2e3 * 0.02) - 1.0).abs() < 0.01);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | given | the body is |
//! |---|---|
//! | `[1.05, 1.0]` | stretched so along the x and the y of its mesh |
//! | [`PreStretch::along_x`](crate::body::PreStretch::along_x)`(1.05)` | stretched so along x, with free sides, which contract as the law says |
//! | [`PreStretch::by_stress`](crate::body::PreStretch::by_stress)`([2e5, 0.0])` | under that stress (Pa) |
//!
//! Stretches below one press: a strip that is pressed by more than its buckling load gives way at the first touch. Bodies of small strain have no stiffness by
//! tension, so that `.small_strain()` is refused with it; what a material does not bear, or flows at, is refused too.
//!
//! # Laws of your own
//!
//! A law of your own is an `impl` of [`Hyperelastic`](crate::fe::material::hyperelastic::Hyperelastic), and
//! [`conformance::check_law`](crate::fe::material::hyperelastic::conformance::check_law) tests it.
