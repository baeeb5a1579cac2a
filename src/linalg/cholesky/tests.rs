use super::*;
use crate::math::sin_cos;
use faer::traits::pulp::{Scalar, WithSimd};

/// A strip of quads whose cells are arbitrary but positive definite.
fn strip(n_cells: usize) -> BlockMatrix {
    let cells: Vec<[usize; 4]> = (0..n_cells)
        .map(|k| [2 * k, 2 * k + 1, 2 * k + 2, 2 * k + 3])
        .collect();
    let n_nodes = 2 * n_cells + 2;
    let mut matrix = BlockMatrix::from_cells(n_nodes, cells.iter().map(|cell| &cell[..]));
    for (k, cell) in cells.iter().enumerate() {
        let vector: [f64; 8] = std::array::from_fn(|i| sin_cos((i + 3 * k) as f64).0);
        let outer: Vec<f64> = vector
            .iter()
            .flat_map(|a| vector.iter().map(move |b| a * b))
            .collect();
        matrix.add_cell(cell, &outer);
        cell.iter()
            .for_each(|&node| matrix.add_diagonal(node, [0.3, 0.2]));
    }
    matrix
}

/// Lockstep games and replays compare bits, so the instruction set must not show in them.
#[test]
fn the_widest_and_the_plainest_kernels_give_the_same_bits() {
    let matrix = strip(23);
    let mut wide = BlockCholesky::analyze(&matrix);
    assert_eq!(wide.factorize(&matrix), Ok(()));
    let mut plain = BlockCholesky::analyze(&matrix);
    let factorize = factor::Factorize {
        panels: &plain.panels,
        sources: &plain.sources,
        blocks: matrix.blocks(),
        values: plain.values.get_mut(),
        rows: &mut plain.rows,
        is_wanted: &[],
    };
    assert!(factorize.with_simd(Scalar::new()).is_ok());
    assert_eq!(wide.values.get(), plain.values.get());

    let load: Vec<f64> = (0..matrix.n_dofs())
        .map(|dof| sin_cos(dof as f64).1)
        .collect();
    let (mut x, mut y) = (load.clone(), load.clone());
    wide.solve_in_place(&mut x);
    let solve = solve::SolveFew::<1> {
        panels: &plain.panels,
        values: plain.values.get(),
        node_at: &plain.node_at,
        work: plain.vector.as_chunks_mut().0,
        columns: &mut y,
    };
    solve.with_simd(Scalar::new());
    assert_eq!(x, y);
    // A second right-hand side must not show either.
    let mut pair = [load.clone(), load].concat();
    wide.solve_many_in_place(&mut pair, 2);
    assert_eq!(pair, [y.clone(), y].concat());
}

/// Other panels keep what they hold, and it is what a whole factorization makes, to the last bit.
#[test]
fn a_part_made_anew_is_that_of_the_whole() {
    let mut matrix = strip(40);
    let mut part = BlockCholesky::analyze(&matrix);
    assert_eq!(part.factorize(&matrix), Ok(()));
    let selection = part.select([17, 18, 60]);
    let n_wanted = selection.is_wanted.iter().filter(|is| **is).count();
    assert!(0 < n_wanted && n_wanted < selection.is_wanted.len());
    let before = part.values.get().to_vec();
    for node in [17, 18, 60] {
        matrix.add_diagonal(node, [0.7, 1.1]);
    }
    assert_eq!(part.factorize_part(&selection, &matrix), Ok(()));
    let mut whole = BlockCholesky::analyze(&matrix);
    assert_eq!(whole.factorize(&matrix), Ok(()));
    assert_eq!(part.values.get(), whole.values.get());
    assert_ne!(part.values.get(), before);
}
