//! Shape functions: `sum N_a = 1`, `N_a(xi_b) = delta_ab`, `dN` is the derivative of `N`.

use super::{ConformanceFailure, at_most, equal, worst};
use crate::fe::element::Element;

pub fn check(element: &dyn Element) -> Result<(), ConformanceFailure> {
    check_nodes(element)?;
    for at in sample_points(element) {
        check_sums(element, at)?;
        check_gradient(element, at)?;
    }
    check_weights(element)
}

fn check_nodes(element: &dyn Element) -> Result<(), ConformanceFailure> {
    let mut shape = vec![0.0; element.n_nodes()];
    for (node, &at) in element.reference_nodes().iter().enumerate() {
        element.shape(at, &mut shape);
        for (other, &value) in shape.iter().enumerate() {
            let expected = f64::from(u8::from(node == other));
            equal(
                "a shape function is one at its node and zero at the others",
                value,
                expected,
                1e-14,
            )?;
        }
    }
    Ok(())
}

fn check_sums(element: &dyn Element, at: [f64; 2]) -> Result<(), ConformanceFailure> {
    let n = element.n_nodes();
    let (mut shape, mut gradient) = (vec![0.0; n], vec![[0.0; 2]; n]);
    element.shape(at, &mut shape);
    element.shape_gradient(at, &mut gradient);
    equal("shape functions sum to one", shape.iter().sum(), 1.0, 1e-14)?;
    for direction in 0..2 {
        let sum: f64 = gradient.iter().map(|row| row[direction]).sum();
        equal("shape gradients sum to zero", sum, 0.0, 1e-13)?;
    }
    Ok(())
}

/// Central differences with step 1e-5 are exact for quadratics but for rounding, about 1e-16 / 1e-5 = 1e-11;
/// cubics add 1e-10.
fn check_gradient(element: &dyn Element, at: [f64; 2]) -> Result<(), ConformanceFailure> {
    const STEP: f64 = 1e-5;
    let n = element.n_nodes();
    let mut gradient = vec![[0.0; 2]; n];
    element.shape_gradient(at, &mut gradient);
    let (mut above, mut below) = (vec![0.0; n], vec![0.0; n]);
    for direction in 0..2 {
        let (mut ahead, mut behind) = (at, at);
        ahead[direction] += STEP;
        behind[direction] -= STEP;
        element.shape(ahead, &mut above);
        element.shape(behind, &mut below);
        let error = (0..n)
            .map(|a| ((above[a] - below[a]) / (2.0 * STEP) - gradient[a][direction]).abs())
            .fold(0.0, worst);
        at_most(
            "the shape gradient is the derivative of the shape functions",
            error,
            1e-8,
        )?;
    }
    Ok(())
}

/// Both rules must give the reference cell the same area, which is half or all of the corners' parallelogram.
fn check_weights(element: &dyn Element) -> Result<(), ConformanceFailure> {
    let corners = &element.reference_nodes()[..element.n_corners()];
    let area: f64 = (0..corners.len())
        .map(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
            0.5 * (a[0] * b[1] - a[1] * b[0])
        })
        .sum();
    for rule in [element.quadrature(), element.mass_quadrature()] {
        let sum: f64 = rule.iter().map(|point| point.weight).sum();
        equal(
            "quadrature weights sum to the reference area",
            sum,
            area,
            1e-14 * area,
        )?;
    }
    Ok(())
}

/// The centre and points a third of the way from it to every corner and beyond.
fn sample_points(element: &dyn Element) -> Vec<[f64; 2]> {
    let corners = &element.reference_nodes()[..element.n_corners()];
    let n = corners.len() as f64;
    let centre = [0, 1].map(|i| corners.iter().map(|corner| corner[i]).sum::<f64>() / n);
    let mut points = vec![centre];
    for corner in corners {
        for part in [0.37, 0.81] {
            points.push([0, 1].map(|i| centre[i] + part * (corner[i] - centre[i])));
        }
    }
    points
}
