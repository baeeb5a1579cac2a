//! The map from the reference cell and what follows from it: `J = dx/dxi`, `dN/dx = J^-T dN/dxi`, `eps = B u`.

use super::{Element, ElementError, MAX_NODES};
use crate::fe::material::Material;

/// Writes the gradient `dN_a/dx` (1/m), shape `(n, 2)`, at natural coordinates `at`; returns `det J` (m^2).
///
/// # Errors
/// [`ElementError::NonPositiveJacobian`] if `det J` is not positive beyond its own rounding.
pub fn physical_gradient<E: Element + ?Sized>(
    element: &E,
    nodes: &[[f64; 2]],
    at: [f64; 2],
    gradient: &mut [[f64; 2]],
) -> Result<f64, ElementError> {
    element.shape_gradient(at, gradient);
    let [[xx, xy], [yx, yy]] = jacobian(nodes, gradient);
    let determinant = xx * yy - xy * yx;
    // A collapsed cell has a determinant of either sign made of rounding alone.
    let rounding = 8.0 * f64::EPSILON * ((xx * yy).abs() + (xy * yx).abs());
    if !(determinant > rounding && determinant.is_finite()) {
        return Err(ElementError::NonPositiveJacobian {
            element: element.name(),
            at,
            value: determinant,
        });
    }
    let scale = 1.0 / determinant;
    for row in gradient.iter_mut() {
        let [along_xi, along_eta] = *row;
        *row = [
            scale * (along_xi * yy - along_eta * yx),
            scale * (along_eta * xx - along_xi * xy),
        ];
    }
    Ok(determinant)
}

/// The Jacobian `J_ij = dx_i/dxi_j` (m) from natural gradients, shape `(n, 2)`.
///
/// Positions are taken relative to the first node, so that cells far from the origin lose no digits.
pub fn jacobian(nodes: &[[f64; 2]], shape_gradient: &[[f64; 2]]) -> [[f64; 2]; 2] {
    assert_eq!(
        nodes.len(),
        shape_gradient.len(),
        "one position per node of the element"
    );
    let mut jacobian = [[0.0; 2]; 2];
    for (node, natural) in nodes.iter().zip(shape_gradient) {
        for (row, (x, origin)) in jacobian.iter_mut().zip(node.iter().zip(&nodes[0])) {
            row[0] += (x - origin) * natural[0];
            row[1] += (x - origin) * natural[1];
        }
    }
    jacobian
}

/// The strain `[e_xx, e_yy, g_xy]` (-) of displacements (m, interleaved) with gradients `dN/dx` (1/m).
pub fn strain_from_gradient(gradient: &[[f64; 2]], displacement: &[f64]) -> [f64; 3] {
    let mut strain = [0.0; 3];
    for ([x, y], u) in gradient.iter().zip(displacement.chunks_exact(2)) {
        strain[0] += x * u[0];
        strain[1] += y * u[1];
        strain[2] += y * u[0] + x * u[1];
    }
    strain
}

/// Adds `factor B^T D B` to a row-major matrix of `2 gradient.len()` rows, keeping it exactly symmetric.
///
/// `tangent` is `D` (Pa), symmetric; `factor` is `det J w t` (m^3).
pub fn add_stiffness(
    gradient: &[[f64; 2]],
    tangent: &[[f64; 3]; 3],
    factor: f64,
    stiffness: &mut [f64],
) {
    let n_dofs = 2 * gradient.len();
    assert_eq!(
        stiffness.len(),
        n_dofs * n_dofs,
        "the matrix has two rows and two columns per node"
    );
    for column in 0..n_dofs {
        let b = strain_of_dof(gradient, column);
        let stress = tangent.map(|row| factor * dot(row, b));
        for row in column..n_dofs {
            let value = dot(strain_of_dof(gradient, row), stress);
            stiffness[row * n_dofs + column] += value;
            if row != column {
                stiffness[column * n_dofs + row] += value;
            }
        }
    }
}

/// Column `dof` of the strain–displacement matrix `B` (1/m).
fn strain_of_dof(gradient: &[[f64; 2]], dof: usize) -> [f64; 3] {
    let [x, y] = gradient[dof / 2];
    if dof.is_multiple_of(2) {
        [x, 0.0, y]
    } else {
        [0.0, y, x]
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// [`Element::stiffness`] for any element without inner modes.
pub(super) fn stiffness<E: Element + ?Sized>(
    element: &E,
    nodes: &[[f64; 2]],
    material: &dyn Material,
    thickness: f64,
    stiffness: &mut [f64],
) -> Result<(), ElementError> {
    let n = n_nodes(element);
    let mut buffer = [[0.0; 2]; MAX_NODES];
    let gradient = &mut buffer[..n];
    let tangent = material.tangent([0.0; 3]);
    stiffness.fill(0.0);
    for point in element.quadrature() {
        let determinant = physical_gradient(element, nodes, point.at, gradient)?;
        let factor = determinant * point.weight * thickness;
        add_stiffness(gradient, &tangent, factor, stiffness);
    }
    Ok(())
}

/// [`Element::strain`] for any element without inner modes.
pub(super) fn strain<E: Element + ?Sized>(
    element: &E,
    nodes: &[[f64; 2]],
    displacement: &[f64],
    at: [f64; 2],
) -> Result<[f64; 3], ElementError> {
    let n = n_nodes(element);
    assert_eq!(displacement.len(), 2 * n, "two displacements per node");
    let mut buffer = [[0.0; 2]; MAX_NODES];
    let gradient = &mut buffer[..n];
    physical_gradient(element, nodes, at, gradient)?;
    Ok(strain_from_gradient(gradient, displacement))
}

/// [`Element::consistent_mass`], with the mass per area `density * thickness` (kg/m^2).
pub(super) fn consistent_mass<E: Element + ?Sized>(
    element: &E,
    nodes: &[[f64; 2]],
    mass_per_area: f64,
    mass: &mut [f64],
) -> Result<(), ElementError> {
    let n = n_nodes(element);
    assert_eq!(mass.len(), n * n, "the mass matrix has one row per node");
    mass.fill(0.0);
    for_each_mass_point(element, nodes, |shape, area| {
        for (row, entries) in mass.chunks_exact_mut(n).enumerate() {
            for (entry, column) in entries.iter_mut().zip(shape) {
                *entry += mass_per_area * area * (shape[row] * column);
            }
        }
    })
}

/// [`Element::lumped_mass`].
pub(super) fn lumped_mass<E: Element + ?Sized>(
    element: &E,
    nodes: &[[f64; 2]],
    density: f64,
    thickness: f64,
    mass: &mut [f64],
) -> Result<(), ElementError> {
    let n = n_nodes(element);
    assert_eq!(mass.len(), n, "one lumped mass per node");
    let mut buffer = [0.0; MAX_NODES * MAX_NODES];
    let consistent = &mut buffer[..n * n];
    element.consistent_mass(nodes, density, thickness, consistent)?;
    let rows = consistent.chunks_exact(n);
    if n == element.n_corners() {
        for (lumped, row) in mass.iter_mut().zip(rows) {
            *lumped = row.iter().sum();
        }
        return Ok(());
    }
    for (node, (lumped, row)) in mass.iter_mut().zip(rows).enumerate() {
        *lumped = row[node];
    }
    let total: f64 = consistent.iter().sum();
    let scale = total / mass.iter().sum::<f64>();
    mass.iter_mut().for_each(|lumped| *lumped *= scale);
    Ok(())
}

/// [`Element::body_force`].
pub(super) fn body_force<E: Element + ?Sized>(
    element: &E,
    nodes: &[[f64; 2]],
    thickness: f64,
    force_per_volume: [f64; 2],
    force: &mut [f64],
) -> Result<(), ElementError> {
    assert_eq!(force.len(), 2 * n_nodes(element), "two forces per node");
    force.fill(0.0);
    for_each_mass_point(element, nodes, |shape, area| {
        for (pair, value) in force.chunks_exact_mut(2).zip(shape) {
            pair[0] += force_per_volume[0] * thickness * area * value;
            pair[1] += force_per_volume[1] * thickness * area * value;
        }
    })
}

/// [`Element::area`].
pub(super) fn area<E: Element + ?Sized>(
    element: &E,
    nodes: &[[f64; 2]],
) -> Result<f64, ElementError> {
    let mut total = 0.0;
    for_each_mass_point(element, nodes, |_, area| total += area)?;
    Ok(total)
}

/// Calls `visit` with the shape functions and the area `det J w` (m^2) of every mass quadrature point.
fn for_each_mass_point<E: Element + ?Sized>(
    element: &E,
    nodes: &[[f64; 2]],
    mut visit: impl FnMut(&[f64], f64),
) -> Result<(), ElementError> {
    let n = n_nodes(element);
    let mut gradient = [[0.0; 2]; MAX_NODES];
    let mut shape = [0.0; MAX_NODES];
    for point in element.mass_quadrature() {
        let determinant = physical_gradient(element, nodes, point.at, &mut gradient[..n])?;
        element.shape(point.at, &mut shape[..n]);
        visit(&shape[..n], determinant * point.weight);
    }
    Ok(())
}

fn n_nodes<E: Element + ?Sized>(element: &E) -> usize {
    let n = element.n_nodes();
    assert!(n <= MAX_NODES, "an element has at most {MAX_NODES} nodes");
    n
}
