//! Mass: `sum_ab m_ab = rho t A`, its centre is the cell's, lumped masses are positive, body force is `b t A`.

use super::specimen::{DENSITY, Specimen, THICKNESS};
use super::statics::for_each_edge_point;
use super::{ConformanceFailure, agree, at_most, equal, succeeds};
use nalgebra::DMatrix;

pub fn check(specimen: &Specimen) -> Result<(), ConformanceFailure> {
    let (area, centroid) = area_and_centroid(specimen);
    let total = DENSITY * THICKNESS * area;
    let own = succeeds(specimen.element.area(&specimen.nodes))?;
    equal("the area is that within the edges", own, area, 1e-13 * area)?;
    let n = specimen.nodes.len();
    let mass = consistent_mass(specimen)?;
    let sum: f64 = mass.iter().sum();
    equal("consistent mass sums to rho t A", sum, total, 1e-13 * total)?;
    let transposed: Vec<f64> = (0..n * n).map(|i| mass[(i % n) * n + i / n]).collect();
    agree("consistent mass is symmetric", &transposed, &mass, 1e-14)?;
    let spectrum = DMatrix::from_row_slice(n, n, &mass).symmetric_eigenvalues();
    at_most(
        "consistent mass is positive definite",
        -spectrum.min() / spectrum.max(),
        -1e-4,
    )?;
    let rows: Vec<f64> = mass.chunks_exact(n).map(|row| row.iter().sum()).collect();
    check_centre(specimen, &rows, total, centroid)?;
    let lumped = lumped_mass(specimen)?;
    let sum: f64 = lumped.iter().sum();
    equal("lumped mass sums to rho t A", sum, total, 1e-13 * total)?;
    let least = lumped.iter().copied().fold(f64::INFINITY, f64::min);
    at_most("lumped masses are positive", -least / total, -1e-6)?;
    check_body_force(specimen, &rows)
}

/// A cell with straight sides turns about the origin with the polar moment `sum_ab x_a . m_ab x_b = int rho t |x|^2 dA`.
///
/// By Green's theorem the integral is `rho t oint (x^3 dy - y^3 dx) / 3`. Curved sides raise its degree beyond the rules
/// that their elements use, so that they have no exact answer to be held to.
pub fn check_polar_moment(specimen: &Specimen) -> Result<(), ConformanceFailure> {
    let mut expected = 0.0;
    for_each_edge_point(specimen, |_, [x, y], [dx, dy]| {
        expected += DENSITY * THICKNESS * (x.powi(3) * dy - y.powi(3) * dx) / 3.0;
    });
    let mass = consistent_mass(specimen)?;
    let (nodes, n) = (&specimen.nodes, specimen.nodes.len());
    let found: f64 = (0..n * n)
        .map(|i| (nodes[i / n], nodes[i % n], mass[i]))
        .map(|(a, b, mass)| mass * (a[0] * b[0] + a[1] * b[1]))
        .sum();
    equal(
        "the polar moment of the consistent mass is the cell's",
        found,
        expected,
        1e-12 * expected,
    )
}

/// The consistent mass of a specimen (kg), row-major.
pub fn consistent_mass(specimen: &Specimen) -> Result<Vec<f64>, ConformanceFailure> {
    let n = specimen.nodes.len();
    let mut mass = vec![1.0; n * n];
    let nodes = &specimen.nodes;
    let result = specimen
        .element
        .consistent_mass(nodes, DENSITY, THICKNESS, &mut mass);
    succeeds(result)?;
    Ok(mass)
}

/// The lumped masses of a specimen (kg).
pub fn lumped_mass(specimen: &Specimen) -> Result<Vec<f64>, ConformanceFailure> {
    let mut mass = vec![1.0; specimen.nodes.len()];
    let nodes = &specimen.nodes;
    let result = specimen
        .element
        .lumped_mass(nodes, DENSITY, THICKNESS, &mut mass);
    succeeds(result)?;
    Ok(mass)
}

fn check_centre(
    specimen: &Specimen,
    rows: &[f64],
    total: f64,
    centroid: [f64; 2],
) -> Result<(), ConformanceFailure> {
    for direction in 0..2 {
        let moment: f64 = rows
            .iter()
            .zip(&specimen.nodes)
            .map(|(m, x)| m * x[direction])
            .sum();
        equal(
            "the centre of the consistent mass is the centroid",
            moment / total,
            centroid[direction],
            1e-12,
        )?;
    }
    Ok(())
}

/// A uniform body force is the mass matrix times a uniform acceleration.
fn check_body_force(specimen: &Specimen, rows: &[f64]) -> Result<(), ConformanceFailure> {
    let acceleration = [0.4, -9.81];
    let mut force = vec![1.0; 2 * rows.len()];
    succeeds(specimen.element.body_force(
        &specimen.nodes,
        THICKNESS,
        acceleration.map(|a| DENSITY * a),
        &mut force,
    ))?;
    let expected: Vec<f64> = rows
        .iter()
        .flat_map(|m| acceleration.map(|a| m * a))
        .collect();
    agree(
        "a uniform body force is consistent mass times acceleration",
        &force,
        &expected,
        1e-12,
    )
}

/// Area (m^2) and centroid (m) by Green's theorem: `A = oint x dy`, `A x_c = oint x^2/2 dy`, `A y_c = -oint y^2/2 dx`.
fn area_and_centroid(specimen: &Specimen) -> (f64, [f64; 2]) {
    let (mut area, mut moment) = (0.0, [0.0; 2]);
    for_each_edge_point(specimen, |_, [x, y], [dx, dy]| {
        area += x * dy;
        moment[0] += 0.5 * x * x * dy;
        moment[1] -= 0.5 * y * y * dx;
    });
    (area, moment.map(|part| part / area))
}
