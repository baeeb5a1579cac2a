//! The quadratic quadrilateral of the serendipity family: `N_corner = (1 + ξξ_a)(1 + ηη_a)(ξξ_a + ηη_a - 1)/4`,
//! `N_midside = (1 - ξ²)(1 + ηη_a)/2` or `(1 + ξξ_a)(1 - η²)/2`.

use super::Element;
use super::quadrature::{QuadraturePoint, SQUARE_9};
use crate::fe::record::ElementRecord;

/// The eight-node quadrilateral; its sides may be curved.
///
/// Three by three points integrate the stiffness and the mass of a parallelogram exactly and leave no spurious mode; two by two leave one. It
/// bends exactly where it is a parallelogram; other cells lose some of that.
///
/// Nine points are more than its volumes can follow where the material all but keeps its volume: at `ν = .4999` a panel of Cook's on 4 × 4 cells
/// misses a seventh of its deflection, and stresses at the points scatter. [`Tri6`](super::Tri6) and [`Quad4`](super::Quad4) do not.
///
/// ```text
///       eta
///   3 --- 6 --- 2
///   |     |     |
///   7     +---  5  xi     corners at (-1, -1), (1, -1), (1, 1), (-1, 1)
///   |           |
///   0 --- 4 --- 1
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Quad8;

const NODES: [[f64; 2]; 8] = [
    [-1.0, -1.0],
    [1.0, -1.0],
    [1.0, 1.0],
    [-1.0, 1.0],
    [0.0, -1.0],
    [1.0, 0.0],
    [0.0, 1.0],
    [-1.0, 0.0],
];

impl Element for Quad8 {
    fn record(&self) -> ElementRecord {
        ElementRecord::Quad8
    }

    fn name(&self) -> &'static str {
        "Quad8"
    }

    fn n_corners(&self) -> usize {
        4
    }

    fn reference_nodes(&self) -> &'static [[f64; 2]] {
        &NODES
    }

    fn edges(&self) -> &'static [&'static [usize]] {
        &[&[0, 4, 1], &[1, 5, 2], &[2, 6, 3], &[3, 7, 0]]
    }

    fn quadrature(&self) -> &'static [QuadraturePoint] {
        &SQUARE_9
    }

    fn mass_quadrature(&self) -> &'static [QuadraturePoint] {
        &SQUARE_9
    }

    fn shape(&self, [xi, eta]: [f64; 2], shape: &mut [f64]) {
        for (value, [a, b]) in shape.iter_mut().zip(NODES) {
            let (along, across) = (1.0 + xi * a, 1.0 + eta * b);
            *value = if a == 0.0 {
                0.5 * (1.0 - xi * xi) * across
            } else if b == 0.0 {
                0.5 * along * (1.0 - eta * eta)
            } else {
                0.25 * along * across * (xi * a + eta * b - 1.0)
            };
        }
    }

    fn shape_gradient(&self, [xi, eta]: [f64; 2], shape_gradient: &mut [[f64; 2]]) {
        for (gradient, [a, b]) in shape_gradient.iter_mut().zip(NODES) {
            let (along, across) = (1.0 + xi * a, 1.0 + eta * b);
            *gradient = if a == 0.0 {
                [-xi * across, 0.5 * b * (1.0 - xi * xi)]
            } else if b == 0.0 {
                [0.5 * a * (1.0 - eta * eta), -eta * along]
            } else {
                [
                    0.25 * a * across * (2.0 * xi * a + eta * b),
                    0.25 * b * along * (xi * a + 2.0 * eta * b),
                ]
            };
        }
    }
}
