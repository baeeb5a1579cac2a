//! Coming from rapier's own soft bodies.
//!
//! | | rapier's soft body | flexible body |
//! |---|---|---|
//! | stiffness | moduli as far as the iterations go (`Constraints`), or as the solver's tolerance (`Fem`) | moduli |
//! | mass | of particles | density times area, any thickness |
//! | cells | triangles of three nodes | of three and six nodes, quadrilaterals |
//! | contact | soft, of the skin | multipliers: no overlap, forces in newtons |
//! | tells | | stresses, forces, energy, how well it was solved |
//! | tears, creeps, ropes of springs | yes | no |
//! | costs | less in piles of many soft bodies | less for single bodies and for stiff ones |
//!
//! [`FlexBodyBuilder::from_soft_body`](crate::body::FlexBodyBuilder::from_soft_body) makes a flexible body of a `SoftBodyBuilder` whose cells have moduli,
//! with its mass, pins, damping and surface, and names what it cannot take along;
//! [`AttachmentBuilder::of_soft_body`](crate::body::AttachmentBuilder::of_soft_body) what holds it to rigid bodies.
//!
//! ```
//! use foil2d::coupling::SoftBodyError;
//! use foil2d::prelude::*;
//! use foil2d::rapier::prelude::*;
//!
//! let jelly = SoftBodyBuilder::grid(Vector::new(0.0, 1.0), Vector::new(0.5, 0.3), 8, 6);
//! // Rapier's default cells keep areas and distances, and have no moduli.
//! let refused = FlexBodyBuilder::from_soft_body(&jelly, CellKind::Tri6);
//! assert_eq!(refused.err(), Some(SoftBodyError::NoModulus));
//!
//! let mut jelly = jelly.cell_model(SoftBodyCellModel::NeoHookean);
//! jelly.material.young_modulus = 5e4;
//! let (mut world, mut flex_bodies) = (PhysicsWorld::new(), FlexBodySet::new());
//! flex_bodies.insert(FlexBodyBuilder::from_soft_body(&jelly, CellKind::Tri6)?, &mut world)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Soft bodies of rapier live on beside flexible ones: these meet them as bodies whose motion is given.
