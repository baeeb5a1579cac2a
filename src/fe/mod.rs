//! Finite elements: from a mesh and a material to `K u = f` and `M a = f`, one cell at a time.
//!
//! | module | owns |
//! |---|---|
//! | [`mesh`] | nodes, cells, boundary |
//! | [`material`] | `sigma(eps)`, its tangent and its energy |
//! | [`element`] | `k = int B^T D B t dA`, `m = int rho N^T N t dA` |
//! | [`mass_matrix`] | `M` and its moments |
//! | [`model`] | `K`, `M` and stresses of one body |
//! | [`finite_strain`] | internal force and tangent of one body at large strain, in world coordinates |
//! | [`mass`] | nodal masses with an inertia-free contact boundary |
//! | [`frequency`] | the largest natural frequency, which bounds the step of explicit integration |
//! | [`modes`] | the lowest natural frequencies and their shapes |
//! | [`record`] | names of elements and materials in snapshots |
//! | [`recovery`] | stresses at points and, smoothed, at nodes |
//!
//! SI units throughout; the strain order is `[e_xx, e_yy, g_xy]` with engineering shear.

use crate::math::judged::Judged;

/// What is left of something that must not vanish, mass, bending or area, relative to what it has (-): a tenth, so that what grows with its
/// inverse, frequencies by its root, stays within sight.
pub(crate) const LEAST_LEFT: Judged = Judged::new("fe::LEAST_LEFT", 0.1);

pub mod element;
pub mod finite_strain;
pub mod frequency;
pub mod mass;
pub mod mass_matrix;
mod massless;
pub mod material;
pub mod mesh;
pub mod model;
mod model_description;
#[cfg(feature = "serde-serialize")]
pub(crate) mod model_record;
pub mod modes;
pub mod record;
pub mod recovery;
