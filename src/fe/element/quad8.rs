//! The quadratic quadrilateral of the serendipity family: `N_corner = (1 + ξξ_a)(1 + ηη_a)(ξξ_a + ηη_a - 1)/4`,
//! `N_midside = (1 - ξ²)(1 + ηη_a)/2` or `(1 + ξξ_a)(1 - η²)/2`.

use super::kinematics;
use super::linear_fit::LinearFit;
use super::quadrature::{QuadraturePoint, SQUARE_9};
use super::{Element, ElementError};
use crate::fe::material::Material;
use crate::fe::record::ElementRecord;

/// The eight-node quadrilateral; its sides may be curved.
///
/// Three by three points integrate the stiffness and the mass of a parallelogram exactly and leave no spurious mode; two by two leave one. It
/// bends exactly where it is a parallelogram; other cells lose some of that.
///
/// Nine points ask for more volumes than eight nodes have where the material all but keeps its volume: what resists a change of volume is taken
/// from the best linear fit to it in the cell (`B̄` of Hughes 1980 with linear fits, Elguedj, Bazilevs, Calo, Hughes 2008; at large strain with the energy of
/// Simo, Taylor, Pister 1985). With the part `c` of the moduli that both normal stresses share,
///
/// ```text
/// k = ∫ B^T D B - c d^T d + c (Π d)^T (Π d),    d u = tr ε,    c = min(D_xxyy, 1/(i·D⁻¹ i)),    i = [1, 1]
/// ```
///
/// and the strains are those which by `D` have the stresses of that. At large strain so do laws that tell their
/// [`volumetric`](crate::fe::material::hyperelastic::Hyperelastic::volumetric) part; others lock.
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

    fn stiffness(
        &self,
        nodes: &[[f64; 2]],
        material: &dyn Material,
        thickness: f64,
        stiffness: &mut [f64],
    ) -> Result<(), ElementError> {
        kinematics::stiffness(self, nodes, material, thickness, stiffness)?;
        let shared = shared_modulus(&material.tangent([0.0; 3]));
        if shared <= 0.0 {
            return Ok(());
        }
        let fit = LinearFit::of(self, nodes, thickness)?;
        let mut smooth = [[0.0; N_DOFS]; 3];
        for point in self.quadrature() {
            let mut gradient = [[0.0; 2]; 8];
            let area = kinematics::physical_gradient(self, nodes, point.at, &mut gradient)?;
            let volume = area * point.weight * thickness;
            let own = gradient.as_flattened();
            add_product(-shared * volume, own, stiffness);
            for (row, mode) in smooth.iter_mut().zip(fit.modes(self, nodes, point.at)) {
                for (entry, own) in row.iter_mut().zip(own) {
                    *entry += volume * mode * own;
                }
            }
        }
        for row in &smooth {
            add_product(shared, row, stiffness);
        }
        Ok(())
    }

    fn strain(
        &self,
        nodes: &[[f64; 2]],
        material: &dyn Material,
        displacement: &[f64],
        at: [f64; 2],
    ) -> Result<[f64; 3], ElementError> {
        let strain = kinematics::strain(self, nodes, displacement, at)?;
        let tangent = material.tangent([0.0; 3]);
        let shared = shared_modulus(&tangent);
        if shared <= 0.0 {
            return Ok(strain);
        }
        let fit = LinearFit::of(self, nodes, 1.0)?;
        let mut smooth = 0.0;
        let modes = fit.modes(self, nodes, at);
        for point in self.quadrature() {
            let mut gradient = [[0.0; 2]; 8];
            let area = kinematics::physical_gradient(self, nodes, point.at, &mut gradient)?;
            let own = gradient.as_flattened().iter().zip(displacement);
            let growth: f64 = own.map(|(by, u)| by * u).sum();
            for (mode, there) in fit.modes(self, nodes, point.at).iter().zip(modes) {
                smooth += area * point.weight * mode * growth * there;
            }
        }
        let change = shared * (smooth - strain[0] - strain[1]);
        let softness = answer_to_pressure(&tangent);
        Ok([0, 1, 2].map(|k| strain[k] + change * softness[k]))
    }
}

/// Dofs of a cell.
const N_DOFS: usize = 16;

/// Adds `factor v vᵀ` to a row-major matrix, keeping it exactly symmetric.
fn add_product(factor: f64, v: &[f64], matrix: &mut [f64]) {
    for (row, own) in matrix.chunks_exact_mut(v.len()).zip(v) {
        for (entry, other) in row.iter_mut().zip(v) {
            *entry += factor * (own * other);
        }
    }
}

/// `D⁻¹ [1, 1, 0]` (1/Pa).
fn answer_to_pressure([[a, b, c], [_, d, e], [_, _, f]]: &[[f64; 3]; 3]) -> [f64; 3] {
    // Cofactors of the first two columns of a symmetric matrix.
    let first = [d * f - e * e, c * e - b * f, b * e - c * d];
    let second = [c * e - b * f, a * f - c * c, b * c - a * e];
    let determinant = a * first[0] + b * first[1] + c * first[2];
    [0, 1, 2].map(|k| (first[k] + second[k]) / determinant)
}

/// `c`: what of the moduli is a resistance to a change of volume alone, so that the rest stays positive semidefinite; Lamé's `λ` of isotropic
/// material (Pa).
fn shared_modulus(tangent: &[[f64; 3]; 3]) -> f64 {
    let [x, y, _] = answer_to_pressure(tangent);
    tangent[0][1].min(1.0 / (x + y))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a material with three pairs of moduli, and one of isotropic ones.
    #[test]
    fn what_is_left_beside_the_shared_modulus_is_definite() {
        let stiff = [[9.0, 4.0, 1.0], [4.0, 3.0, -0.5], [1.0, -0.5, 2.0]];
        let [x, y, z] = answer_to_pressure(&stiff);
        let back = stiff.map(|row| row[0] * x + row[1] * y + row[2] * z);
        for (found, due) in back.iter().zip([1.0, 1.0, 0.0]) {
            assert!((found - due).abs() < 1e-14);
        }
        let shared = shared_modulus(&stiff);
        assert!(shared < 4.0 && (shared * (x + y) - 1.0).abs() < 1e-14);
        let [[a, b, c], [_, d, e], [_, _, f]] = stiff;
        let (a, b, d) = (a - shared, b - shared, d - shared);
        let determinant = a * (d * f - e * e) - b * (b * f - c * e) + c * (b * e - c * d);
        assert!(a > 0.0 && determinant.abs() < 1e-12, "{determinant:e}");
        // λ = 3 and μ = 1.
        let plain = [[5.0, 3.0, 0.0], [3.0, 5.0, 0.0], [0.0, 0.0, 1.0]];
        assert!((shared_modulus(&plain) - 3.0).abs() < 1e-14);
    }
}
