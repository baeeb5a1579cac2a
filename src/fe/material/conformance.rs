//! What every material must satisfy: `sigma = dW/d eps`, `D = d sigma/d eps`, `D` symmetric and positive definite.

use super::Material;

/// A conformance check that did not hold.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("conformance check failed: {check}: measured {measured:e}, allowed {allowed:e}")]
pub struct ConformanceFailure {
    /// The sentence that should be true.
    pub check: &'static str,
    /// What was measured; NaN if an error or a value that is not finite came back.
    pub measured: f64,
    /// The largest value allowed or, where the sentence names a number, that number.
    pub allowed: f64,
}

/// Passes if `measured <= allowed`; NaN fails.
///
/// # Errors
/// [`ConformanceFailure`] with the three arguments.
pub fn at_most(check: &'static str, measured: f64, allowed: f64) -> Result<(), ConformanceFailure> {
    if measured <= allowed {
        return Ok(());
    }
    Err(ConformanceFailure {
        check,
        measured,
        allowed,
    })
}

// Central differences over a step of 1e-4 of the strain size: truncation 1e-8, rounding 1e-12, so that
// 1e-6 leaves two digits for laws that are far from linear over `strain_size`.
const STEP: f64 = 1e-4;
const ALLOWED: f64 = 1e-6;

/// Checks a material at rest and at a spread of strains of about `strain_size` (-).
///
/// Choose `strain_size` well inside the range where the law is meant to be stable: 1e-3 for metals,
/// 0.1 for rubber.
///
/// # Errors
/// The first check that fails.
pub fn check_material(material: &dyn Material, strain_size: f64) -> Result<(), ConformanceFailure> {
    let rest = material.tangent([0.0; 3]);
    let stiffness = largest(rest.iter().flatten());
    let scale = stiffness * strain_size;
    let at_rest = largest(&material.stress([0.0; 3]));
    at_most("stress is zero at rest", at_rest / scale, 1e-12)?;
    let energy = material.energy_density([0.0; 3]).abs();
    at_most(
        "energy is zero at rest",
        energy / (scale * strain_size),
        1e-12,
    )?;
    for direction in DIRECTIONS {
        let strain = direction.map(|part| part * strain_size);
        check_derivatives(material, strain, strain_size, stiffness)?;
        check_tangent(material.tangent(strain))?;
        if material.is_linear() {
            let change = distance(&rest, &material.tangent(strain));
            at_most("a linear tangent is constant", change / stiffness, 1e-14)?;
        }
    }
    let speed = material.wave_speed();
    let bound = (stiffness / material.density()).sqrt();
    at_most(
        "the wave speed is of the order of sqrt(D / rho)",
        (speed / bound - 1.0).abs(),
        0.5,
    )
}

/// Unit-sized strains: rest, pulls and pushes along both axes, shears, and mixtures.
const DIRECTIONS: [[f64; 3]; 9] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, -1.0],
    [0.7, -0.3, 0.5],
    [-0.4, -0.6, -0.8],
    [0.5, 0.5, 0.2],
];

fn check_derivatives(
    material: &dyn Material,
    strain: [f64; 3],
    strain_size: f64,
    stiffness: f64,
) -> Result<(), ConformanceFailure> {
    let (stress, tangent) = (material.stress(strain), material.tangent(strain));
    let step = STEP * strain_size;
    for column in 0..3 {
        let (mut above, mut below) = (strain, strain);
        above[column] += step;
        below[column] -= step;
        let slope =
            (material.energy_density(above) - material.energy_density(below)) / (2.0 * step);
        let error = (slope - stress[column]).abs() / (stiffness * strain_size);
        at_most("stress is the derivative of the energy", error, ALLOWED)?;
        let (above, below) = (material.stress(above), material.stress(below));
        for row in 0..3 {
            let slope = (above[row] - below[row]) / (2.0 * step);
            let error = (slope - tangent[row][column]).abs() / stiffness;
            at_most("tangent is the derivative of the stress", error, ALLOWED)?;
        }
    }
    Ok(())
}

/// Symmetry, and positive pivots of Gauss elimination (which is positive definiteness).
fn check_tangent(tangent: [[f64; 3]; 3]) -> Result<(), ConformanceFailure> {
    let size = largest(tangent.iter().flatten());
    for (row, column) in [(0, 1), (0, 2), (1, 2)] {
        let skew = (tangent[row][column] - tangent[column][row]).abs() / size;
        at_most("tangent is symmetric", skew, 1e-12)?;
    }
    let mut left = tangent;
    for pivot in 0..3 {
        let value = left[pivot][pivot] / size;
        // Stated as a bound from above: the negative of the pivot stays below zero.
        at_most("tangent is positive definite", -value, -1e-12)?;
        let pivot_row = left[pivot];
        for row in left.iter_mut().skip(pivot + 1) {
            let factor = row[pivot] / pivot_row[pivot];
            for (entry, above) in row.iter_mut().zip(pivot_row) {
                *entry -= factor * above;
            }
        }
    }
    Ok(())
}

fn largest<'a>(values: impl IntoIterator<Item = &'a f64>) -> f64 {
    values
        .into_iter()
        .fold(0.0, |most: f64, value| most.max(value.abs()))
}

fn distance(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> f64 {
    a.iter()
        .flatten()
        .zip(b.iter().flatten())
        .fold(0.0, |most: f64, (x, y)| most.max((x - y).abs()))
}
