//! The quadratic triangle: `N_corner = l (2 l - 1)`, `N_midside = 4 l_i l_j` in area coordinates `l`.

use super::Element;
use super::quadrature::{QuadraturePoint, TRIANGLE_3, TRIANGLE_7};
use crate::fe::record::ElementRecord;

/// The six-node triangle, of linear strain; its sides may be curved.
///
/// The three-point rule integrates the stiffness of a straight-sided cell exactly and leaves no spurious
/// mode; the seven-point rule does the same for its mass.
///
/// ```text
///  eta
///   2
///   | \
///   5   4
///   |     \
///   0 - 3 - 1  xi
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tri6;

impl Element for Tri6 {
    fn record(&self) -> ElementRecord {
        ElementRecord::Tri6
    }

    fn name(&self) -> &'static str {
        "Tri6"
    }

    fn n_corners(&self) -> usize {
        3
    }

    fn reference_nodes(&self) -> &'static [[f64; 2]] {
        &[
            [0.0, 0.0],
            [1.0, 0.0],
            [0.0, 1.0],
            [0.5, 0.0],
            [0.5, 0.5],
            [0.0, 0.5],
        ]
    }

    fn edges(&self) -> &'static [&'static [usize]] {
        &[&[0, 3, 1], &[1, 4, 2], &[2, 5, 0]]
    }

    fn quadrature(&self) -> &'static [QuadraturePoint] {
        &TRIANGLE_3
    }

    fn mass_quadrature(&self) -> &'static [QuadraturePoint] {
        &TRIANGLE_7
    }

    fn shape(&self, [xi, eta]: [f64; 2], shape: &mut [f64]) {
        let zeta = 1.0 - xi - eta;
        shape.copy_from_slice(&[
            zeta * (2.0 * zeta - 1.0),
            xi * (2.0 * xi - 1.0),
            eta * (2.0 * eta - 1.0),
            4.0 * zeta * xi,
            4.0 * xi * eta,
            4.0 * eta * zeta,
        ]);
    }

    fn shape_gradient(&self, [xi, eta]: [f64; 2], shape_gradient: &mut [[f64; 2]]) {
        let zeta = 1.0 - xi - eta;
        shape_gradient.copy_from_slice(&[
            [1.0 - 4.0 * zeta, 1.0 - 4.0 * zeta],
            [4.0 * xi - 1.0, 0.0],
            [0.0, 4.0 * eta - 1.0],
            [4.0 * (zeta - xi), -4.0 * xi],
            [4.0 * eta, 4.0 * xi],
            [-4.0 * eta, 4.0 * (zeta - eta)],
        ]);
    }
}
