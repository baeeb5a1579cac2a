//! The linear triangle: `N = (1 - xi - eta, xi, eta)`.

use super::Element;
use super::quadrature::{QuadraturePoint, TRIANGLE_1, TRIANGLE_3};
use crate::fe::record::ElementRecord;

/// The three-node triangle, of constant strain.
///
/// It locks in bending (a slender cantilever with two cells through its height sags 37 % too little) and near
/// incompressibility: use it as a reference, and [`Tri6`](super::Tri6) for results.
///
/// ```text
///  eta
///   2
///   | \
///   |   \
///   0 --- 1  xi
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tri3;

impl Element for Tri3 {
    fn record(&self) -> ElementRecord {
        ElementRecord::Tri3
    }

    fn name(&self) -> &'static str {
        "Tri3"
    }

    fn n_corners(&self) -> usize {
        3
    }

    fn reference_nodes(&self) -> &'static [[f64; 2]] {
        &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]
    }

    fn edges(&self) -> &'static [&'static [usize]] {
        &[&[0, 1], &[1, 2], &[2, 0]]
    }

    fn quadrature(&self) -> &'static [QuadraturePoint] {
        &TRIANGLE_1
    }

    fn mass_quadrature(&self) -> &'static [QuadraturePoint] {
        &TRIANGLE_3
    }

    fn shape(&self, [xi, eta]: [f64; 2], shape: &mut [f64]) {
        shape.copy_from_slice(&[1.0 - xi - eta, xi, eta]);
    }

    fn shape_gradient(&self, _at: [f64; 2], shape_gradient: &mut [[f64; 2]]) {
        shape_gradient.copy_from_slice(&[[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]]);
    }
}
