//! Equilibria and natural modes, without a world.
//!
//! [`LoadStepper`](crate::large::LoadStepper) leads a body of large strain through equilibria as loads and held nodes go where a
//! [`LoadCase`](crate::large::LoadCase) says:
//!
//! ```
//! use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
//! use foil2d::fe::material::hyperelastic::Corotated;
//! use foil2d::fe::mesh::{CellKind, generate::rectangle};
//! use foil2d::large::{LargeSettings, LoadCase, LoadStepper};
//!
//! // A strip of 1 m, clamped on its left, loaded at its end until it hangs.
//! let (length, height, young) = (1.0, 0.01, 1e7);
//! let mesh = rectangle([length, height], [50, 1], CellKind::Tri6)?;
//! let law = Corotated::plane_strain(young, 0.0);
//! let model = FiniteStrainModel::assemble(FiniteStrainDescription::new(mesh, law, 1000.0))?;
//! let mut places = model.rest_positions().to_vec();
//! let is_held: Vec<bool> = places.chunks(2).flat_map(|at| [at[0] == 0.0; 2]).collect();
//! let tip: Vec<usize> = (0..model.rest_positions().len() / 2).filter(|&node| places[2 * node] == length).collect();
//!
//! // Twice E I / L², shared by the nodes of the end face as a uniform traction is: corners a sixth, the middle two thirds.
//! let load = 2.0 * young * height.powi(3) / 12.0;
//! let none = vec![0.0; places.len()];
//! let mut at_end = none.clone();
//! for &node in &tip {
//!     let is_corner = places[2 * node + 1] == 0.0 || places[2 * node + 1] == height;
//!     at_end[2 * node + 1] = -load * if is_corner { 1.0 / 6.0 } else { 2.0 / 3.0 };
//! }
//! let rest = places.clone();
//! let case = LoadCase { from: &none, to: &at_end, is_held: &is_held, places: &rest, n_increments: 10 };
//! LoadStepper::new(model, LargeSettings::conserving().with_tolerance(1e-8))?.solve(case, &mut places)?;
//!
//! // The elastica: .493457 L down.
//! let middle = tip.iter().copied().find(|&node| rest[2 * node + 1] == 0.5 * height).expect("a midside node");
//! let sag = 0.5 * height - places[2 * middle + 1];
//! assert!((sag / 0.493457 - 1.0).abs() < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Load control knows nothing of limit loads, where bodies snap through: beyond one it fails, or lands on another equilibrium far away, so look at how far an increment went. [`PathStepper`](crate::large::PathStepper) follows the path of equilibria past such points, and tells limit points and
//! whether what it finds is stable. Its [`FollowerForce`](crate::large::FollowerForce)s turn with the body.
//!
//! Where another path crosses, as at the critical load of a column, [`follow_to_branch`](crate::large::PathStepper::follow_to_branch) stops, and
//! [`switch`](crate::large::PathStepper::switch) goes over to it.
//!
//! # Against rigid obstacles
//!
//! [`ContactStepper`](crate::large::ContactStepper) is load control for a body whose surface is kept out of half-planes, discs and segments, which may have friction and go
//! straight ways ([`Obstacle`](crate::large::Obstacle)):
//!
//! ```
//! use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
//! use foil2d::fe::material::hyperelastic::NeoHookean;
//! use foil2d::fe::mesh::{CellKind, generate::rectangle};
//! use foil2d::large::{ContactCase, ContactStepper, LargeSettings, LoadCase, Obstacle};
//!
//! // A block held above; a rough plate comes up by a tenth, and then goes 30 cm to the right.
//! let mesh = rectangle([1.0, 1.0], [8, 8], CellKind::Quad4)?;
//! let model = FiniteStrainModel::assemble(FiniteStrainDescription::new(mesh, NeoHookean::plane_strain(1e5, 0.3), 1000.0))?;
//! let rest = model.rest_positions().to_vec();
//! let is_held: Vec<bool> = rest.chunks(2).flat_map(|at| [at[1] == 1.0; 2]).collect();
//! let none = vec![0.0; rest.len()];
//! let load = LoadCase { from: &none, to: &none, is_held: &is_held, places: &rest, n_increments: 10 };
//!
//! let mut positions = rest.clone();
//! let mut stepper = ContactStepper::new(model, LargeSettings::default())?;
//! let mut plate = Obstacle::half_plane([0.0, 0.0], [0.0, 1.0]).with_friction(0.3);
//! for way in [[0.0, 0.1], [0.3, 0.0]] {
//!     plate = plate.moving_by(way);
//!     stepper.solve(ContactCase { load, obstacles: &[plate] }, &mut positions)?;
//!     plate = plate.moved();
//! }
//! let forces = stepper.reaction().chunks(2).fold([0.0, 0.0], |sum, force| [sum[0] + force[0], sum[1] + force[1]]);
//! assert!((forces[0] / (0.3 * forces[1]) - 1.0).abs() < 1e-4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! In a world, bodies at rest are in equilibrium with what touches them: let them settle, or sleep.
//!
//! # Natural modes
//!
//! [`FlexBody::natural_modes`](crate::body::FlexBody::natural_modes) tells the lowest frequencies and shapes of a body as it is pinned; of a body of large strain about where it is, so that a
//! string has the notes of its tension ([`pre_stretch`](crate::body::FlexBodyBuilder::pre_stretch)):
//!
//! ```
//! use foil2d::prelude::*;
//!
//! let strip = FlexBodyBuilder::rectangle([1.0, 0.02], [40, 2])
//!     .material(LinearElastic::plane_stress(2.1e11, 0.3).density(7800.0))
//!     .pin_where(|[x, _]| x == 0.0, Pin::both())
//!     .build()?;
//! let frequencies = strip.natural_modes(2, 1e-8)?.frequencies();
//! // A slender cantilever: 3.516 and 22.03 times √(E I/ρ A)/L².
//! let unit = 0.02 * (2.1e11_f64 / 7800.0 / 12.0).sqrt();
//! assert!((frequencies[0] / (3.516 * unit) - 1.0).abs() < 5e-3);
//! assert!((frequencies[1] / (22.03 * unit) - 1.0).abs() < 5e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
