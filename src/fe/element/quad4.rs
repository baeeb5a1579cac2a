//! The four-node quadrilateral with incompatible modes (QM6): `u = sum N_a u_a + (1 - xi^2) a_1 + (1 - eta^2) a_2`.

use super::kinematics::{add_stiffness, jacobian, physical_gradient, strain_from_gradient};
use super::quadrature::{QuadraturePoint, SQUARE_4};
use super::{Element, ElementError};
use crate::fe::material::Material;
use crate::fe::record::ElementRecord;

/// The four-node quadrilateral with Wilson's incompatible modes as corrected by Taylor (QM6).
///
/// Two bubble-like modes, each with an x and a y amplitude, let the cell bend without shear locking. Their
/// gradients use the Jacobian of the cell's centre, `grad m = (det J0 / det J) J0^-T dm/dxi`, so that they do no
/// work on a constant stress and the patch test holds on distorted cells (Taylor, Beresford, Wilson 1976).
/// The four amplitudes are condensed out of the stiffness, and recovered for the strain. Mass and loads are
/// those of the plain bilinear element. Trapezoidal cells still lock in bending: keep cells near parallelograms.
///
/// ```text
///       eta
///   3 ---|--- 2
///   |    |    |
///   |    +----|-- xi      corners at (-1, -1), (1, -1), (1, 1), (-1, 1)
///   |         |
///   0 ------- 1
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Quad4;

const N_NODES: usize = 4;
/// The displacements of the nodes.
const N_OUTER: usize = 8;
/// Nodes and modes: a mode behaves like a node whose displacement is its amplitude.
const N_ENRICHED: usize = 6;
const N_DOFS: usize = 12;

const CORNERS: [[f64; 2]; N_NODES] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

impl Element for Quad4 {
    fn record(&self) -> ElementRecord {
        ElementRecord::Quad4
    }

    fn name(&self) -> &'static str {
        "Quad4"
    }

    fn n_corners(&self) -> usize {
        4
    }

    fn reference_nodes(&self) -> &'static [[f64; 2]] {
        &CORNERS
    }

    fn edges(&self) -> &'static [&'static [usize]] {
        &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]]
    }

    fn quadrature(&self) -> &'static [QuadraturePoint] {
        &SQUARE_4
    }

    fn mass_quadrature(&self) -> &'static [QuadraturePoint] {
        &SQUARE_4
    }

    fn shape(&self, [xi, eta]: [f64; 2], shape: &mut [f64]) {
        shape.copy_from_slice(&CORNERS.map(|[a, b]| 0.25 * (1.0 + a * xi) * (1.0 + b * eta)));
    }

    fn shape_gradient(&self, [xi, eta]: [f64; 2], shape_gradient: &mut [[f64; 2]]) {
        shape_gradient.copy_from_slice(
            &CORNERS.map(|[a, b]| [0.25 * a * (1.0 + b * eta), 0.25 * b * (1.0 + a * xi)]),
        );
    }

    fn stiffness(
        &self,
        nodes: &[[f64; 2]],
        material: &dyn Material,
        thickness: f64,
        stiffness: &mut [f64],
    ) -> Result<(), ElementError> {
        assert_eq!(
            stiffness.len(),
            N_OUTER * N_OUTER,
            "the stiffness of a Quad4 has 8 rows and columns"
        );
        let condensed = condensed_stiffness(nodes, material)?;
        for (row, entries) in stiffness.chunks_exact_mut(N_OUTER).enumerate() {
            for (column, entry) in entries.iter_mut().enumerate() {
                *entry = thickness * condensed[row * N_DOFS + column];
            }
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
        let enriched = recover_modes(nodes, material, displacement)?;
        let (gradient, _) = Centre::new(nodes)?.enriched_gradient(nodes, at)?;
        Ok(strain_from_gradient(&gradient, &enriched))
    }

    fn point_strains(
        &self,
        nodes: &[[f64; 2]],
        material: &dyn Material,
        displacement: &[f64],
        strains: &mut [[f64; 3]],
    ) -> Result<(), ElementError> {
        assert_eq!(
            strains.len(),
            SQUARE_4.len(),
            "one strain per quadrature point"
        );
        let enriched = recover_modes(nodes, material, displacement)?;
        let centre = Centre::new(nodes)?;
        for (point, strain) in SQUARE_4.iter().zip(strains) {
            let (gradient, _) = centre.enriched_gradient(nodes, point.at)?;
            *strain = strain_from_gradient(&gradient, &enriched);
        }
        Ok(())
    }
}

/// The Jacobian of the cell's centre, as its cofactors `det J0 J0^-1` (m).
struct Centre {
    cofactors: [[f64; 2]; 2],
}

impl Centre {
    fn new(nodes: &[[f64; 2]]) -> Result<Self, ElementError> {
        let mut gradient = [[0.0; 2]; N_NODES];
        physical_gradient(&Quad4, nodes, [0.0, 0.0], &mut gradient)?;
        Quad4.shape_gradient([0.0, 0.0], &mut gradient);
        let [[xx, xy], [yx, yy]] = jacobian(nodes, &gradient);
        Ok(Self {
            cofactors: [[yy, -xy], [-yx, xx]],
        })
    }

    /// The gradients (1/m) of the four shape functions and the two modes, and `det J` (m^2).
    fn enriched_gradient(
        &self,
        nodes: &[[f64; 2]],
        at: [f64; 2],
    ) -> Result<([[f64; 2]; N_ENRICHED], f64), ElementError> {
        let mut gradient = [[0.0; 2]; N_ENRICHED];
        let determinant = physical_gradient(&Quad4, nodes, at, &mut gradient[..N_NODES])?;
        for direction in 0..2 {
            let natural = -2.0 * at[direction] / determinant;
            let [x, y] = self.cofactors[direction];
            gradient[N_NODES + direction] = [natural * x, natural * y];
        }
        Ok((gradient, determinant))
    }
}

/// The stiffness per thickness (Pa) of nodes and modes, row-major `(12, 12)`, after eliminating the modes.
///
/// The leading 8 x 8 block is the condensed stiffness. Row `p >= 8` still holds the equation that was solved
/// for mode amplitude `p`, in terms of the unknowns before it.
fn condensed_stiffness(
    nodes: &[[f64; 2]],
    material: &dyn Material,
) -> Result<[f64; N_DOFS * N_DOFS], ElementError> {
    let tangent = material.tangent([0.0; 3]);
    let centre = Centre::new(nodes)?;
    let mut k = [0.0; N_DOFS * N_DOFS];
    for point in &SQUARE_4 {
        let (gradient, determinant) = centre.enriched_gradient(nodes, point.at)?;
        add_stiffness(&gradient, &tangent, determinant * point.weight, &mut k);
    }
    for pivot in (N_OUTER..N_DOFS).rev() {
        let value = k[pivot * N_DOFS + pivot];
        if !(value > 0.0 && value.is_finite()) {
            return Err(ElementError::SingularModes {
                element: Quad4.name(),
                pivot: value,
            });
        }
        for row in 0..pivot {
            for column in 0..pivot {
                let product = k[pivot * N_DOFS + row] * k[pivot * N_DOFS + column];
                k[row * N_DOFS + column] -= product / value;
            }
        }
    }
    Ok(k)
}

/// The displacements (m) of the nodes followed by the amplitudes (m) of the modes in equilibrium with them.
fn recover_modes(
    nodes: &[[f64; 2]],
    material: &dyn Material,
    displacement: &[f64],
) -> Result<[f64; N_DOFS], ElementError> {
    assert_eq!(displacement.len(), N_OUTER, "two displacements per node");
    let k = condensed_stiffness(nodes, material)?;
    let mut enriched = [0.0; N_DOFS];
    enriched[..N_OUTER].copy_from_slice(displacement);
    for mode in N_OUTER..N_DOFS {
        let row = &k[mode * N_DOFS..mode * N_DOFS + mode];
        let force: f64 = row.iter().zip(&enriched).map(|(k, u)| k * u).sum();
        enriched[mode] = -force / k[mode * N_DOFS + mode];
    }
    Ok(enriched)
}
