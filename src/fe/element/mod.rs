//! Elements: `k = int B^T D B t dA`, `m = int rho N^T N t dA`, `f = int N^T b t dA` over one cell.
//!
//! An element is a set of shape functions on a reference cell with two quadrature rules; the trait
//! [`Element`] derives the rest. A new element is one file like [`tri3`](self::Tri3)'s and one line in the
//! conformance test: [`conformance::check_element`] judges ours and a user's alike.
//!
//! Displacements and forces of a cell are interleaved, `[x0, y0, x1, y1, ...]`, in the order of its nodes.
//! Nodes run counter-clockwise: corners first, then one midside node per edge, then interior nodes.

pub mod conformance;
pub mod kinematics;
mod linear_fit;
mod quad4;
mod quad8;
pub mod quadrature;
mod tri3;
mod tri6;

pub(crate) use linear_fit::LinearFit;
pub use quad4::Quad4;
pub use quad8::Quad8;
pub use quadrature::QuadraturePoint;
pub use tri3::Tri3;
pub use tri6::Tri6;

use crate::fe::material::Material;
use crate::fe::record::ElementRecord;
use std::fmt::Debug;
use std::sync::Arc;

/// The most nodes an element may have: its matrices live on the stack.
pub const MAX_NODES: usize = 9;

/// The most quadrature points an element may have.
pub const MAX_POINTS: usize = 16;

/// A cell that has no element matrices.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ElementError {
    /// The map from the reference cell folds over, collapses, or has coordinates that are not finite.
    #[error(
        "{element} cell: Jacobian determinant {value:e} m^2 at natural point ({}, {}): \
         list its nodes counter-clockwise and keep it convex, with midside nodes near the middle",
        .at[0], .at[1]
    )]
    NonPositiveJacobian {
        /// The element's name.
        element: &'static str,
        /// The natural coordinates of the point (-).
        at: [f64; 2],
        /// The determinant there (m^2 per unit of natural area).
        value: f64,
    },
    /// The incompatible modes cannot be condensed out.
    #[error(
        "{element} cell: pivot {pivot:e} while condensing its inner modes: \
         the material's tangent must be finite and positive definite at rest (see `Material::validate`)"
    )]
    SingularModes {
        /// The element's name.
        element: &'static str,
        /// The pivot that should have been positive (N/m).
        pivot: f64,
    },
}

/// A finite element of the plane.
///
/// Outputs are overwritten, never added to. `nodes` are the undeformed positions (m) of the cell's nodes,
/// `thickness` is (m).
///
/// # Panics
/// The provided methods panic if a slice does not have the stated length, or if the element has more than
/// [`MAX_NODES`] nodes or [`MAX_POINTS`] stiffness points.
pub trait Element: Send + Sync + Debug {
    /// The name used in messages.
    fn name(&self) -> &'static str;

    /// What a snapshot writes of the element; bodies with one that is [`ElementRecord::Unknown`] cannot be saved.
    fn record(&self) -> ElementRecord {
        ElementRecord::Unknown
    }

    /// The number of corners, 3 or 4; the corners are the first nodes.
    fn n_corners(&self) -> usize;

    /// The natural coordinates of the nodes (-).
    fn reference_nodes(&self) -> &'static [[f64; 2]];

    /// The local nodes of each edge in order along it, counter-clockwise, midside nodes included.
    fn edges(&self) -> &'static [&'static [usize]];

    /// The rule for stiffness and stress; its weights sum to the area of the reference cell.
    fn quadrature(&self) -> &'static [QuadraturePoint];

    /// The rule for mass and body force, which ask for a higher degree.
    fn mass_quadrature(&self) -> &'static [QuadraturePoint];

    /// Writes the shape functions `N_a` (-) at natural coordinates `at`, shape `(n)`.
    fn shape(&self, at: [f64; 2], shape: &mut [f64]);

    /// Writes the natural gradient `dN_a/dxi` (-) at natural coordinates `at`, shape `(n, 2)`.
    fn shape_gradient(&self, at: [f64; 2], shape_gradient: &mut [[f64; 2]]);

    /// The number of nodes, n.
    fn n_nodes(&self) -> usize {
        self.reference_nodes().len()
    }

    /// Writes the stiffness at rest `k = sum_q B^T D(0) B det J w t` (N/m), row-major, shape `(2n, 2n)`.
    ///
    /// # Errors
    /// [`ElementError::NonPositiveJacobian`] at the first quadrature point where the cell is inverted.
    fn stiffness(
        &self,
        nodes: &[[f64; 2]],
        material: &dyn Material,
        thickness: f64,
        stiffness: &mut [f64],
    ) -> Result<(), ElementError> {
        kinematics::stiffness(self, nodes, material, thickness, stiffness)
    }

    /// Writes the consistent mass `m = sum_q rho N^T N det J w t` (kg), row-major, shape `(n, n)`.
    ///
    /// The mass of the x and of the y displacements is the same: the `(2n, 2n)` matrix is `m_ab I`.
    ///
    /// # Errors
    /// As for [`Element::stiffness`].
    fn consistent_mass(
        &self,
        nodes: &[[f64; 2]],
        density: f64,
        thickness: f64,
        mass: &mut [f64],
    ) -> Result<(), ElementError> {
        kinematics::consistent_mass(self, nodes, density * thickness, mass)
    }

    /// Writes the lumped nodal masses (kg), shape `(n)`.
    ///
    /// Row sums of the consistent mass where all nodes are corners; otherwise its diagonal scaled to the
    /// cell's mass (Hinton, Rock, Zienkiewicz 1976), since row sums of quadratic elements are not positive.
    ///
    /// # Errors
    /// As for [`Element::stiffness`].
    fn lumped_mass(
        &self,
        nodes: &[[f64; 2]],
        density: f64,
        thickness: f64,
        mass: &mut [f64],
    ) -> Result<(), ElementError> {
        kinematics::lumped_mass(self, nodes, density, thickness, mass)
    }

    /// Writes the nodal forces (N) of a constant force per volume (N/m^3), interleaved, shape `(2n)`.
    ///
    /// # Errors
    /// As for [`Element::stiffness`].
    fn body_force(
        &self,
        nodes: &[[f64; 2]],
        thickness: f64,
        force_per_volume: [f64; 2],
        force: &mut [f64],
    ) -> Result<(), ElementError> {
        kinematics::body_force(self, nodes, thickness, force_per_volume, force)
    }

    /// The strain `[e_xx, e_yy, g_xy]` (-) at natural coordinates `at`, from displacements (m) of shape `(2n)`.
    ///
    /// The material matters only to elements with inner modes, whose amplitudes follow from it.
    ///
    /// # Errors
    /// As for [`Element::stiffness`].
    fn strain(
        &self,
        nodes: &[[f64; 2]],
        material: &dyn Material,
        displacement: &[f64],
        at: [f64; 2],
    ) -> Result<[f64; 3], ElementError> {
        let _ = material;
        kinematics::strain(self, nodes, displacement, at)
    }

    /// Writes the strains at the points of [`Element::quadrature`] (-), shape `(n_points)`.
    ///
    /// # Errors
    /// As for [`Element::stiffness`].
    fn point_strains(
        &self,
        nodes: &[[f64; 2]],
        material: &dyn Material,
        displacement: &[f64],
        strains: &mut [[f64; 3]],
    ) -> Result<(), ElementError> {
        assert_eq!(
            strains.len(),
            self.quadrature().len(),
            "one strain per quadrature point"
        );
        for (point, strain) in self.quadrature().iter().zip(strains) {
            *strain = self.strain(nodes, material, displacement, point.at)?;
        }
        Ok(())
    }

    /// The area of the cell (m^2).
    ///
    /// # Errors
    /// As for [`Element::stiffness`].
    fn area(&self, nodes: &[[f64; 2]]) -> Result<f64, ElementError> {
        kinematics::area(self, nodes)
    }
}

/// The element the library uses for cells of `n_nodes` nodes: 3, 4, 6 or 8.
pub fn default_element(n_nodes: usize) -> Option<Arc<dyn Element>> {
    match n_nodes {
        3 => Some(Arc::new(Tri3)),
        4 => Some(Arc::new(Quad4)),
        6 => Some(Arc::new(Tri6)),
        8 => Some(Arc::new(Quad8)),
        _ => None,
    }
}
