//! Stiffness: symmetric, of rank `2n - 3`, blind to rigid motion, exact for constant stress.

use super::specimen::{Specimen, THICKNESS};
use super::{ConformanceFailure, agree, at_most, equal, largest, succeeds, worst};
use crate::fe::element::kinematics::jacobian;
use crate::fe::material::Material;
use nalgebra::DMatrix;

pub fn check(specimen: &Specimen) -> Result<(), ConformanceFailure> {
    let k = stiffness(specimen)?;
    check_symmetry(&k)?;
    check_rigid_motion(specimen, &k)?;
    check_spectrum(&k)?;
    for gradient in DISPLACEMENT_GRADIENTS {
        check_patch(specimen, &k, gradient)?;
    }
    Ok(())
}

/// `du_i/dx_j` (-): a stretch along each axis, a simple shear, and a mixture with rotation.
const DISPLACEMENT_GRADIENTS: [[[f64; 2]; 2]; 4] = [
    [[1e-3, 0.0], [0.0, 0.0]],
    [[0.0, 0.0], [0.0, 1e-3]],
    [[0.0, 1e-3], [0.0, 0.0]],
    [[0.7e-3, -0.2e-3], [0.9e-3, -0.4e-3]],
];

/// The stiffness of a specimen as a matrix (N/m).
pub fn stiffness(specimen: &Specimen) -> Result<DMatrix<f64>, ConformanceFailure> {
    let n_dofs = 2 * specimen.nodes.len();
    // Filled with rubbish first: outputs are to be overwritten.
    let mut k = vec![1.0; n_dofs * n_dofs];
    succeeds(
        specimen
            .element
            .stiffness(&specimen.nodes, &specimen.material, THICKNESS, &mut k),
    )?;
    Ok(DMatrix::from_row_slice(n_dofs, n_dofs, &k))
}

fn check_symmetry(k: &DMatrix<f64>) -> Result<(), ConformanceFailure> {
    agree(
        "the stiffness is symmetric",
        k.transpose().as_slice(),
        k.as_slice(),
        1e-13,
    )
}

fn check_rigid_motion(specimen: &Specimen, k: &DMatrix<f64>) -> Result<(), ConformanceFailure> {
    let motions: [fn([f64; 2]) -> [f64; 2]; 3] = [|_| [1.0, 0.0], |_| [0.0, 1.0], |[x, y]| [-y, x]];
    for motion in motions {
        let u = field(specimen, motion);
        let size = largest(k.as_slice()) * largest(&u);
        at_most(
            "rigid motion costs no force",
            largest(&multiply(k, &u)) / size,
            1e-12,
        )?;
    }
    Ok(())
}

/// Three zero eigenvalues, the rigid motions, and the others well above them: no spurious mode.
fn check_spectrum(k: &DMatrix<f64>) -> Result<(), ConformanceFailure> {
    let eigenvalues = k.clone().symmetric_eigenvalues();
    let most = largest(eigenvalues.as_slice());
    let least = eigenvalues.iter().copied().fold(f64::INFINITY, f64::min);
    at_most("no eigenvalue is negative", -least / most, 1e-12)?;
    let zeros = eigenvalues.iter().filter(|value| **value < 1e-6 * most);
    equal(
        "exactly three eigenvalues are zero",
        zeros.count() as f64,
        3.0,
        0.0,
    )
}

/// Nodal forces of a linear displacement field are those of its constant stress, `t oint N_a sigma n ds`.
fn check_patch(
    specimen: &Specimen,
    k: &DMatrix<f64>,
    gradient: [[f64; 2]; 2],
) -> Result<(), ConformanceFailure> {
    let u = field(specimen, |x| {
        gradient.map(|row| row[0] * x[0] + row[1] * x[1])
    });
    let strain = [
        gradient[0][0],
        gradient[1][1],
        gradient[0][1] + gradient[1][0],
    ];
    let stress = specimen.material.stress(strain);
    agree(
        "patch test: nodal forces are those of the constant stress",
        &multiply(k, &u),
        &boundary_forces(specimen, stress),
        1e-12,
    )?;
    let element = specimen.element;
    let mut strains = vec![[0.0; 3]; element.quadrature().len()];
    succeeds(element.point_strains(&specimen.nodes, &specimen.material, &u, &mut strains))?;
    for (point, at_point) in element.quadrature().iter().zip(&strains) {
        agree(
            "patch test: the strain is constant",
            at_point,
            &strain,
            1e-12,
        )?;
        let again = element.strain(&specimen.nodes, &specimen.material, &u, point.at);
        let same = succeeds(again)?
            .iter()
            .zip(at_point)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, worst);
        at_most(
            "strain and point_strains agree",
            same / largest(&strain),
            1e-13,
        )?;
    }
    Ok(())
}

/// The nodal forces (N) of a constant stress (Pa), by integrals over the edges only.
fn boundary_forces(specimen: &Specimen, [xx, yy, xy]: [f64; 3]) -> Vec<f64> {
    let mut force = vec![0.0; 2 * specimen.nodes.len()];
    for_each_edge_point(specimen, |shape, _, [dx, dy]| {
        // The outward normal times the length of a counter-clockwise piece (dx, dy) is (dy, -dx).
        let traction = [xx * dy - xy * dx, xy * dy - yy * dx];
        for (pair, value) in force.chunks_exact_mut(2).zip(shape) {
            pair[0] += THICKNESS * value * traction[0];
            pair[1] += THICKNESS * value * traction[1];
        }
    });
    force
}

/// Visits three Gauss points per edge (degree 5) with shape functions, position and directed length (m).
pub fn for_each_edge_point(specimen: &Specimen, mut visit: impl FnMut(&[f64], [f64; 2], [f64; 2])) {
    let rule = [
        (0.5 - 0.15f64.sqrt(), 5.0 / 18.0),
        (0.5, 8.0 / 18.0),
        (0.5 + 0.15f64.sqrt(), 5.0 / 18.0),
    ];
    let (element, nodes) = (specimen.element, &specimen.nodes);
    let reference = element.reference_nodes();
    let (mut shape, mut gradient) = (vec![0.0; nodes.len()], vec![[0.0; 2]; nodes.len()]);
    for corner in 0..element.n_corners() {
        let start = reference[corner];
        let end = reference[(corner + 1) % element.n_corners()];
        for (s, weight) in rule {
            let at = [0, 1].map(|i| start[i] + s * (end[i] - start[i]));
            element.shape(at, &mut shape);
            element.shape_gradient(at, &mut gradient);
            let j = jacobian(nodes, &gradient);
            let piece =
                j.map(|row| weight * (row[0] * (end[0] - start[0]) + row[1] * (end[1] - start[1])));
            let position = [0, 1].map(|i| shape.iter().zip(nodes).map(|(n, x)| n * x[i]).sum());
            visit(&shape, position, piece);
        }
    }
}

/// Nodal values, interleaved, of a displacement field of position.
fn field(specimen: &Specimen, motion: impl Fn([f64; 2]) -> [f64; 2]) -> Vec<f64> {
    specimen.nodes.iter().flat_map(|&x| motion(x)).collect()
}

fn multiply(k: &DMatrix<f64>, u: &[f64]) -> Vec<f64> {
    (0..u.len())
        .map(|row| {
            u.iter()
                .enumerate()
                .map(|(column, u)| k[(row, column)] * u)
                .sum()
        })
        .collect()
}
