//! Eigenvalues that occur more often than a block is wide, and motions that nothing resists and no position tells of.

use super::ModesError;
use super::pencil::Pencil;
use super::search::lowest;
use crate::fe::mass_matrix::MassMatrix;
use crate::linalg::block_matrix::BlockMatrix;

/// `n` chains of three masses that only springs along x and y hold together: `ω² = 0, 1, 3` twice for each.
fn chains(n: usize) -> (BlockMatrix, MassMatrix, Vec<f64>) {
    let cells: Vec<[usize; 2]> = (0..n)
        .flat_map(|k| [[3 * k, 3 * k + 1], [3 * k + 1, 3 * k + 2]])
        .collect();
    let mut stiffness = BlockMatrix::from_cells(3 * n, cells.iter().map(|cell| &cell[..]));
    for cell in &cells {
        let spring: Vec<f64> = (0..16)
            .map(|k| match (k / 4, k % 4) {
                (i, j) if i == j => 1.0,
                (i, j) if i % 2 == j % 2 => -1.0,
                _ => 0.0,
            })
            .collect();
        stiffness.add_cell(cell, &spring);
    }
    let positions = (0..3 * n).flat_map(|k| [k as f64, 0.3 * (k * k) as f64]);
    (
        stiffness,
        MassMatrix::Lumped(vec![1.0; 3 * n]),
        positions.collect(),
    )
}

#[test]
fn every_eigenvalue_is_found_as_often_as_it_occurs() -> Result<(), ModesError> {
    for n in [1, 4, 9] {
        let (stiffness, mass, positions) = chains(n);
        for n_modes in [2 * n, 2 * n + 1, 4 * n, 6 * n] {
            let pencil = Pencil::new(stiffness.clone(), &mass, &[]);
            let found = lowest(pencil, &positions, n_modes, 1e-11)?;
            assert_eq!(found.n_rigid, 2 * n, "{n} chains, {n_modes} modes");
            for (k, mode) in found.modes.iter().enumerate() {
                let expected = [0.0, 1.0, 3.0][k / (2 * n)];
                assert!(
                    (mode.square - expected).abs() < 1e-12,
                    "{n} {k}: {}",
                    mode.square
                );
            }
        }
    }
    Ok(())
}

/// A spring that pushes at one end of a chain makes two eigenvalues negative.
#[test]
fn what_is_not_stable_has_a_negative_square() -> Result<(), ModesError> {
    let (mut stiffness, mass, positions) = chains(1);
    stiffness.add_diagonal(0, [-0.5, -0.5]);
    let pencil = Pencil::new(stiffness, &mass, &[]);
    let found = lowest(pencil, &positions, 6, 1e-11)?;
    for (pair, mode) in found.modes.iter().enumerate() {
        let x = mode.square;
        // det of [[1/2 - x, -1, 0], [-1, 2 - x, -1], [0, -1, 1 - x]].
        let determinant = (0.5 - x) * ((2.0 - x) * (1.0 - x) - 1.0) - (1.0 - x);
        assert!(determinant.abs() < 1e-12, "{pair}: {x}");
    }
    assert!(found.modes[1].square < -0.1 && found.modes[2].square > 0.1);
    assert!(found.modes[0].growth() > 0.3 && found.modes[0].frequency() == 0.0);
    Ok(())
}
