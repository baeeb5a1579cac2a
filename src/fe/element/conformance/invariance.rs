//! What may not depend on the observer: numbering, position, orientation, handedness, unit of length.

use super::inertia::{consistent_mass, lumped_mass};
use super::specimen::{Specimen, THICKNESS};
use super::statics::stiffness;
use super::{ConformanceFailure, agree, at_most};

// A dozen operations on numbers of size one, and cancellation by the distance moved (a factor 10).
const ALLOWED: f64 = 1e-12;

pub fn check(specimen: &Specimen) -> Result<(), ConformanceFailure> {
    check_renumbering(specimen)?;
    let turned = Isometry::turn(0.7, [3.0, -2.0]);
    check_isometry(specimen, turned, None, TURN_CHECKS)?;
    let mirror = Isometry::mirror(0.4);
    let order = specimen.mirrored_numbering();
    check_isometry(specimen, mirror, Some(order), MIRROR_CHECKS)?;
    check_scaling(specimen)?;
    check_inverted(specimen, mirror)
}

const TURN_CHECKS: [&str; 2] = [
    "the stiffness turns and moves with the cell",
    "the mass is the same for a turned and moved cell",
];
const MIRROR_CHECKS: [&str; 2] = [
    "the stiffness of a mirrored cell is the mirrored stiffness",
    "the mass of a mirrored cell is the same",
];

/// `x' = A x + b` with an orthogonal `A`.
#[derive(Clone, Copy)]
struct Isometry {
    matrix: [[f64; 2]; 2],
    shift: [f64; 2],
}

impl Isometry {
    const IDENTITY: Self = Self {
        matrix: [[1.0, 0.0], [0.0, 1.0]],
        shift: [0.0; 2],
    };

    fn turn(angle: f64, shift: [f64; 2]) -> Self {
        let (s, c) = angle.sin_cos();
        let matrix = [[c, -s], [s, c]];
        Self { matrix, shift }
    }

    /// Reflection about the line through the origin at `angle`.
    fn mirror(angle: f64) -> Self {
        let (s, c) = (2.0 * angle).sin_cos();
        let matrix = [[c, s], [s, -c]];
        Self {
            matrix,
            shift: [0.0; 2],
        }
    }

    fn apply(&self, x: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|i| self.matrix[i][0] * x[0] + self.matrix[i][1] * x[1] + self.shift[i])
    }
}

fn check_renumbering(specimen: &Specimen) -> Result<(), ConformanceFailure> {
    const CHECKS: [&str; 2] = [
        "the stiffness does not depend on which corner is first",
        "the mass does not depend on which corner is first",
    ];
    let order = specimen.cyclic_numbering();
    check_isometry(specimen, Isometry::IDENTITY, Some(order), CHECKS)
}

/// Node `i` of the image is the image of node `order[i]`; its matrices must be those of the original, moved along.
fn check_isometry(
    specimen: &Specimen,
    motion: Isometry,
    order: Option<Vec<usize>>,
    [of_stiffness, of_mass]: [&'static str; 2],
) -> Result<(), ConformanceFailure> {
    let n = specimen.nodes.len();
    let order = order.unwrap_or_else(|| (0..n).collect());
    let moved: Vec<[f64; 2]> = order
        .iter()
        .map(|&old| motion.apply(specimen.nodes[old]))
        .collect();
    let image = specimen.with_nodes(moved);
    let (k, k_image) = (stiffness(specimen)?, stiffness(&image)?);
    let mut expected = k_image.clone();
    for row in 0..2 * n {
        for column in 0..2 * n {
            let (a, b) = (order[row / 2], order[column / 2]);
            let (left, right) = (motion.matrix[row % 2], motion.matrix[column % 2]);
            let term = |i: usize, j: usize| left[i] * k[(2 * a + i, 2 * b + j)] * right[j];
            expected[(row, column)] = term(0, 0) + term(0, 1) + term(1, 0) + term(1, 1);
        }
    }
    agree(
        of_stiffness,
        k_image.as_slice(),
        expected.as_slice(),
        ALLOWED,
    )?;
    let mass = consistent_mass(specimen)?;
    let expected: Vec<f64> = (0..n * n)
        .map(|i| mass[order[i / n] * n + order[i % n]])
        .collect();
    agree(of_mass, &consistent_mass(&image)?, &expected, ALLOWED)?;
    let lumped = lumped_mass(specimen)?;
    let expected: Vec<f64> = order.iter().map(|&old| lumped[old]).collect();
    agree(of_mass, &lumped_mass(&image)?, &expected, ALLOWED)
}

/// In millimetres, with Young's modulus as it was: the same stiffness, and a million times the mass.
fn check_scaling(specimen: &Specimen) -> Result<(), ConformanceFailure> {
    const SCALE: f64 = 1000.0;
    let grown = specimen
        .nodes
        .iter()
        .map(|x| x.map(|part| SCALE * part))
        .collect();
    let large = specimen.with_nodes(grown);
    let k = stiffness(specimen)?;
    agree(
        "the stiffness does not depend on the cell's size",
        stiffness(&large)?.as_slice(),
        k.as_slice(),
        ALLOWED,
    )?;
    let mass: Vec<f64> = consistent_mass(&large)?
        .iter()
        .map(|m| m / (SCALE * SCALE))
        .collect();
    agree(
        "the mass grows with the square of the cell's size",
        &mass,
        &consistent_mass(specimen)?,
        ALLOWED,
    )
}

/// A clockwise cell must be refused by everything that integrates over it.
fn check_inverted(specimen: &Specimen, mirror: Isometry) -> Result<(), ConformanceFailure> {
    let nodes: Vec<[f64; 2]> = specimen.nodes.iter().map(|&x| mirror.apply(x)).collect();
    let n = nodes.len();
    let (element, material) = (specimen.element, &specimen.material);
    let mut matrix = vec![0.0; 4 * n * n];
    let accepted = [
        element
            .stiffness(&nodes, material, THICKNESS, &mut matrix)
            .is_ok(),
        element
            .consistent_mass(&nodes, 1.0, THICKNESS, &mut matrix[..n * n])
            .is_ok(),
        element
            .lumped_mass(&nodes, 1.0, THICKNESS, &mut matrix[..n])
            .is_ok(),
        element
            .body_force(&nodes, THICKNESS, [0.0; 2], &mut matrix[..2 * n])
            .is_ok(),
        element.area(&nodes).is_ok(),
    ];
    let count = accepted.iter().filter(|accepted| **accepted).count();
    at_most("an inverted cell is refused", count as f64, 0.0)
}
