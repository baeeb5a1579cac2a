//! What every element must satisfy, ours or a user's: interpolation, rigid motion, patch test, mass, objectivity.
//!
//! ```
//! use foil2d::fe::element::{Quad4, conformance::check_element};
//!
//! assert_eq!(check_element(&Quad4), Ok(()));
//! ```

mod basis;
mod inertia;
mod invariance;
mod specimen;
mod statics;

pub use crate::fe::material::conformance::ConformanceFailure;

use super::{Element, ElementError, MAX_NODES, MAX_POINTS};
use crate::fe::material::conformance::at_most;
use specimen::Specimen;

/// Runs every check on a distorted cell with straight sides and, if there are midside nodes, on a curved one.
///
/// | group | checks |
/// |---|---|
/// | basis | partition of unity, one at its own node and zero at the others, gradient against finite differences |
/// | statics | symmetry, no force under rigid motion, exactly three zero eigenvalues, patch test, strain |
/// | inertia | total mass, its centre and polar moment, positive masses, body force, area |
/// | invariance | numbering, translation, rotation, mirror image, unit of length, thickness, inverted cells |
///
/// # Errors
/// The first check that fails, with what was measured and what is allowed.
pub fn check_element(element: &dyn Element) -> Result<(), ConformanceFailure> {
    check_sizes(element)?;
    basis::check(element)?;
    let straight = Specimen::straight(element);
    check_cell(&straight)?;
    inertia::check_polar_moment(&straight)?;
    if element.n_nodes() > element.n_corners() {
        check_cell(&straight.curved())?;
    }
    Ok(())
}

fn check_cell(specimen: &Specimen) -> Result<(), ConformanceFailure> {
    statics::check(specimen)?;
    inertia::check(specimen)?;
    invariance::check(specimen)
}

fn check_sizes(element: &dyn Element) -> Result<(), ConformanceFailure> {
    let (n_nodes, n_corners) = (element.n_nodes(), element.n_corners());
    let counted = |count: usize| count as f64;
    equal(
        "there is one reference position per node",
        counted(n_nodes),
        counted(element.reference_nodes().len()),
        0.0,
    )?;
    at_most(
        "the number of nodes fits the stack buffers",
        counted(n_nodes),
        counted(MAX_NODES),
    )?;
    at_most(
        "the number of quadrature points fits the stack buffers",
        counted(element.quadrature().len()),
        counted(MAX_POINTS),
    )?;
    at_most(
        "a cell has three or four corners",
        (counted(n_corners) - 3.5).abs(),
        0.5,
    )?;
    let edges = element.edges();
    equal(
        "there are as many edges as corners",
        counted(edges.len()),
        counted(n_corners),
        0.0,
    )?;
    for (index, edge) in edges.iter().enumerate() {
        let ends = (edge.first().copied(), edge.last().copied());
        let wrong = ends != (Some(index), Some((index + 1) % n_corners));
        at_most(
            "edge i runs from corner i to the next",
            f64::from(u8::from(wrong)),
            0.0,
        )?;
    }
    Ok(())
}

/// Passes if `measured` is within `tolerance` of `expected`; reports the two numbers.
fn equal(
    check: &'static str,
    measured: f64,
    expected: f64,
    tolerance: f64,
) -> Result<(), ConformanceFailure> {
    if (measured - expected).abs() <= tolerance {
        return Ok(());
    }
    Err(ConformanceFailure {
        check,
        measured,
        allowed: expected,
    })
}

/// Passes if two vectors agree to `tolerance` times the largest entry of the second.
fn agree(
    check: &'static str,
    measured: &[f64],
    expected: &[f64],
    tolerance: f64,
) -> Result<(), ConformanceFailure> {
    let difference = measured
        .iter()
        .zip(expected)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, worst);
    at_most(check, difference / largest(expected), tolerance)
}

/// The larger of two magnitudes; NaN wins, so that it cannot hide.
fn worst(a: f64, b: f64) -> f64 {
    if a >= b { a } else { b }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().map(|value| value.abs()).fold(0.0, worst)
}

/// Turns an element's own error on a valid cell into a failed check.
fn succeeds<T>(result: Result<T, ElementError>) -> Result<T, ConformanceFailure> {
    result.map_err(|_| ConformanceFailure {
        check: "a valid cell gives no error",
        measured: f64::NAN,
        allowed: 0.0,
    })
}
