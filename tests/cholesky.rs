//! Node-block matrices and their Cholesky factors, against dense algebra.

use foil2d::linalg::block_matrix::BlockMatrix;
use foil2d::linalg::cholesky::{BlockCholesky, CholeskyError};
use nalgebra::{DMatrix, DVector};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// Counts the allocations of each thread, so that tests running side by side do not disturb each
/// other.
struct Counting;

thread_local! {
    static N_ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: every call is passed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let _ = N_ALLOCATIONS.try_with(|count| count.set(count.get() + 1));
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn allocations_during(work: impl FnOnce()) -> usize {
    let before = N_ALLOCATIONS.with(Cell::get);
    work();
    N_ALLOCATIONS.with(Cell::get) - before
}

/// Numbers in (-1, 1) that are the same in every run (Knuth's 64-bit congruential generator).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, length: usize) -> Vec<f64> {
        (0..length).map(|_| self.next()).collect()
    }

    fn permutation(&mut self, length: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..length).collect();
        for k in (1..length).rev() {
            order.swap(k, ((self.next() + 1.0) / 2.0 * (k + 1) as f64) as usize);
        }
        order
    }
}

struct Mesh {
    points: Vec<[f64; 2]>,
    triangles: Vec<[usize; 3]>,
}

/// `nx × ny` quads of unit size, scaled by `size`, split into triangles, inner corners moved by up
/// to `jitter`.
fn mesh(nx: usize, ny: usize, size: [f64; 2], jitter: f64, random: &mut Random) -> Mesh {
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..=nx {
        for j in 0..=ny {
            let [x, y] = [
                i as f64 + jitter * random.next(),
                j as f64 + jitter * random.next(),
            ];
            points.push([x * size[0], y * size[1]]);
        }
    }
    let node = |i: usize, j: usize| i * (ny + 1) + j;
    for i in 0..nx {
        for j in 0..ny {
            let [a, b, c, d] = [
                node(i, j),
                node(i + 1, j),
                node(i + 1, j + 1),
                node(i, j + 1),
            ];
            let halves = if (i + j) % 2 == 0 {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [b, c, d]]
            };
            triangles.extend(halves);
        }
    }
    Mesh { points, triangles }
}

/// The stiffness of a linear plane-stress triangle with E = 1, ν = 0.3.
fn triangle_stiffness(corners: [[f64; 2]; 3]) -> [f64; 36] {
    let [[x0, y0], [x1, y1], [x2, y2]] = corners;
    let twice_area = (x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0);
    let gradient = [[y1 - y2, x2 - x1], [y2 - y0, x0 - x2], [y0 - y1, x1 - x0]];
    let [d0, d1, d2] = [1.0 / 0.91, 0.3 / 0.91, 0.5 / 1.3];
    let mut stiffness = [0.0; 36];
    for (a, [ax, ay]) in gradient.into_iter().enumerate() {
        for (b, [bx, by]) in gradient.into_iter().enumerate() {
            let block = [
                [ax * d0 * bx + ay * d2 * by, ax * d1 * by + ay * d2 * bx],
                [ay * d1 * bx + ax * d2 * by, ay * d0 * by + ax * d2 * bx],
            ];
            for (i, row) in block.into_iter().enumerate() {
                for (j, value) in row.into_iter().enumerate() {
                    stiffness[(2 * a + i) * 6 + 2 * b + j] = value / (2.0 * twice_area);
                }
            }
        }
    }
    stiffness
}

/// Stiffness plus `mass` on every diagonal entry, with nodes renumbered: `number[k]` is the new
/// name of node `k`.
fn assemble(mesh: &Mesh, number: &[usize], mass: f64) -> BlockMatrix {
    let cells: Vec<[usize; 3]> = mesh
        .triangles
        .iter()
        .map(|cell| cell.map(|node| number[node]))
        .collect();
    let mut matrix = BlockMatrix::from_cells(mesh.points.len(), cells.iter().map(|cell| &cell[..]));
    for (cell, renamed) in mesh.triangles.iter().zip(&cells) {
        matrix.add_cell(
            renamed,
            &triangle_stiffness(cell.map(|node| mesh.points[node])),
        );
    }
    (0..matrix.n_nodes()).for_each(|node| matrix.add_diagonal(node, [mass, mass]));
    matrix
}

fn in_order(mesh: &Mesh) -> Vec<usize> {
    (0..mesh.points.len()).collect()
}

fn dense(matrix: &BlockMatrix) -> DMatrix<f64> {
    DMatrix::from_fn(matrix.n_dofs(), matrix.n_dofs(), |row, column| {
        matrix
            .block(row / 2, column / 2)
            .map_or(0.0, |block| block[row % 2 * 2 + column % 2])
    })
}

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values
        .into_iter()
        .fold(0.0, |largest, value| value.abs().max(largest))
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    largest(a.iter().zip(b).map(|(a, b)| a - b))
}

fn solved(matrix: &BlockMatrix, load: &[f64]) -> Vec<f64> {
    let mut cholesky = BlockCholesky::analyze(matrix);
    cholesky.factorize(matrix).unwrap();
    let mut x = load.to_vec();
    cholesky.solve_in_place(&mut x);
    x
}

#[test]
fn a_matrix_holds_the_sum_of_its_cells_and_multiplies_like_a_dense_one() {
    let mut random = Random(1);
    let body = mesh(7, 4, [1.0, 1.0], 0.3, &mut random);
    let number = random.permutation(body.points.len());
    let matrix = assemble(&body, &number, 0.5);
    let dense = dense(&matrix);

    let mut sum = DMatrix::identity(matrix.n_dofs(), matrix.n_dofs()) * 0.5;
    for cell in &body.triangles {
        let stiffness = triangle_stiffness(cell.map(|node| body.points[node]));
        for i in 0..6 {
            for j in 0..6 {
                let dof = |k: usize| 2 * number[cell[k / 2]] + k % 2;
                sum[(dof(i), dof(j))] += stiffness[6 * i + j];
            }
        }
    }
    // Up to eight cells meet in an entry of order ten, and the mass comes last here and first
    // there.
    assert!(difference(dense.as_slice(), sum.as_slice()) < 1e-14);
    assert!(difference(dense.as_slice(), dense.transpose().as_slice()) < 1e-14);
    for node in 0..matrix.n_nodes() {
        assert!(matrix.neighbours(node).is_sorted() && matrix.block(node, node).is_some());
    }

    let x = random.vector(matrix.n_dofs());
    let expected = &dense * DVector::from_column_slice(&x);
    let mut y = vec![f64::NAN; matrix.n_dofs()];
    matrix.multiply(&x, &mut y);
    // Sums of 18 products of order one, in another order: some ten rounding errors.
    assert!(difference(&y, expected.as_slice()) < 1e-14);
    matrix.multiply_add(-1.0, &x, &mut y);
    assert!(largest(y) < 1e-14);
    let [fx, fy] = matrix.multiply_node(5, &x);
    assert!((fx - expected[10]).abs() < 1e-14 && (fy - expected[11]).abs() < 1e-14);
}

#[test]
fn scaling_and_adding_keep_the_pattern_and_act_block_by_block() {
    let mut random = Random(2);
    let stiffness = assemble(
        &mesh(3, 3, [1.0, 1.0], 0.2, &mut random),
        &(0..16).collect::<Vec<_>>(),
        0.0,
    );
    let mut effective = stiffness.clone();
    effective.fill_zero();
    assert_eq!(largest(dense(&effective).iter().copied()), 0.0);
    effective.assign_scaled(3.0, &stiffness);
    effective.add_scaled(-2.0, &stiffness);
    // 3 k and 2 k are each within half a rounding error of 3 |k|.
    assert!(difference(dense(&effective).as_slice(), dense(&stiffness).as_slice()) < 1e-15);
}

#[test]
fn random_bodies_are_solved_as_by_dense_cholesky() {
    let mut random = Random(3);
    for (nx, ny) in [(1, 1), (1, 2), (9, 1), (4, 4), (20, 2), (11, 7), (13, 12)] {
        let body = mesh(nx, ny, [1.0, 1.0], 0.3, &mut random);
        let number = random.permutation(body.points.len());
        let matrix = assemble(&body, &number, 0.01);
        let load = random.vector(matrix.n_dofs());
        let x = solved(&matrix, &load);
        let expected = dense(&matrix)
            .cholesky()
            .unwrap()
            .solve(&DVector::from_column_slice(&load));
        // Stiffness of order ten over mass 0.01: a condition of 1e3 to 1e4 times 1e-16.
        let error = difference(&x, expected.as_slice()) / expected.amax();
        assert!(error < 1e-12, "{nx} x {ny}: {error:e}");
    }
}

#[test]
fn bodies_that_do_not_touch_and_nodes_without_cells_share_one_factor() {
    let mut random = Random(4);
    let body = mesh(3, 2, [1.0, 1.0], 0.2, &mut random);
    let one = assemble(&body, &in_order(&body), 0.1);
    let n = body.points.len();
    // Two copies of the body, their nodes alternating, and a last node all by itself.
    let cells: Vec<[usize; 3]> = [0, 1]
        .iter()
        .flat_map(|copy| {
            body.triangles
                .iter()
                .map(move |cell| cell.map(|node| 2 * node + copy))
        })
        .collect();
    let mut both = BlockMatrix::from_cells(2 * n + 1, cells.iter().map(|cell| &cell[..]));
    for (k, cell) in cells.iter().enumerate() {
        let corners = body.triangles[k % body.triangles.len()].map(|node| body.points[node]);
        both.add_cell(cell, &triangle_stiffness(corners));
    }
    (0..2 * n).for_each(|node| both.add_diagonal(node, [0.1, 0.1]));
    both.add_diagonal(2 * n, [2.0, 4.0]);

    let load = random.vector(2 * n);
    let alone = solved(&one, &load);
    let mut double = vec![1.0; 4 * n + 2];
    for (node, force) in load.chunks(2).enumerate() {
        double[4 * node..4 * node + 4].copy_from_slice(&[force[0], force[1], -force[0], -force[1]]);
    }
    let together = solved(&both, &double);
    for (node, x) in alone.chunks(2).enumerate() {
        // Another order of elimination, a condition of 1e3.
        let expected = [x[0], x[1], -x[0], -x[1]];
        assert!(difference(&together[4 * node..4 * node + 4], &expected) < 1e-12);
    }
    // 1 / sqrt(2) squared: two roundings.
    assert!(difference(&together[4 * n..], &[0.5, 0.25]) < 1e-15);

    let mut nothing = BlockCholesky::analyze(&BlockMatrix::from_cells(0, std::iter::empty()));
    assert_eq!(
        nothing.factorize(&BlockMatrix::from_cells(0, std::iter::empty())),
        Ok(())
    );
    nothing.solve_in_place(&mut []);
    nothing.solve_many_in_place(&mut [], 3);
}

#[test]
fn the_numbering_of_the_nodes_does_not_change_the_solution() {
    let mut random = Random(5);
    let body = mesh(12, 5, [1.0, 1.0], 0.3, &mut random);
    let load = random.vector(2 * body.points.len());
    let x = solved(&assemble(&body, &in_order(&body), 0.01), &load);
    let number = random.permutation(body.points.len());
    let mut renumbered = load.clone();
    for (node, &name) in number.iter().enumerate() {
        renumbered[2 * name..2 * name + 2].copy_from_slice(&load[2 * node..2 * node + 2]);
    }
    let y = solved(&assemble(&body, &number, 0.01), &renumbered);
    for (node, &name) in number.iter().enumerate() {
        // A condition of 1e4 times 1e-16, on solutions of order 100.
        assert!(difference(&x[2 * node..2 * node + 2], &y[2 * name..2 * name + 2]) < 1e-10);
    }
}

#[test]
fn any_number_of_right_hand_sides_at_once_gives_what_one_by_one_gives() {
    let mut random = Random(6);
    let body = mesh(17, 6, [1.0, 1.0], 0.3, &mut random);
    let matrix = assemble(&body, &random.permutation(body.points.len()), 0.1);
    let n = matrix.n_dofs();
    let mut cholesky = BlockCholesky::analyze(&matrix);
    cholesky.factorize(&matrix).unwrap();
    for n_columns in [0, 1, 2, 7, 8, 9, 19] {
        let mut columns = random.vector(n * n_columns);
        // Some unit vectors and a column of zeros, which the blocked kernel may pass over.
        for (k, column) in columns
            .chunks_mut(n)
            .enumerate()
            .filter(|(k, _)| k % 3 == 1)
        {
            column.fill(0.0);
            column[(7 * k) % n] = if k == 4 { 0.0 } else { 1.0 };
        }
        let mut expected = columns.clone();
        expected
            .chunks_mut(n)
            .for_each(|column| cholesky.solve_in_place(column));
        cholesky.solve_many_in_place(&mut columns, n_columns);
        // The same products summed in another order; solutions of order ten, a condition of 1e3.
        assert!(
            difference(&columns, &expected) < 1e-11,
            "{n_columns} columns"
        );
    }
}

#[test]
fn a_selected_node_gets_what_it_gets_in_a_whole_solve() {
    let mut random = Random(8);
    let body = mesh(17, 6, [1.0, 1.0], 0.3, &mut random);
    let matrix = assemble(&body, &random.permutation(body.points.len()), 0.1);
    let n = matrix.n_dofs();
    let mut cholesky = BlockCholesky::analyze(&matrix);
    cholesky.factorize(&matrix).unwrap();
    for nodes in [vec![], vec![3], vec![0, 5, 41], (0..n / 2).collect()] {
        for n_columns in [1, 2, 5, 8, 11] {
            let mut whole = random.vector(n * n_columns);
            let mut part = whole.clone();
            cholesky.solve_many_in_place(&mut whole, n_columns);
            let selection = cholesky.select(nodes.iter().copied());
            cholesky.solve_many_for(&selection, &mut part, n_columns);
            // The same operations in the same order: the same bits.
            for (whole, part) in whole.chunks(n).zip(part.chunks(n)) {
                for &node in &nodes {
                    assert_eq!(part[2 * node..2 * node + 2], whole[2 * node..2 * node + 2]);
                }
            }
        }
    }
}

#[test]
fn fixed_dofs_keep_their_right_hand_side_and_leave_the_rest_of_the_system_alone() {
    let mut random = Random(7);
    let body = mesh(6, 3, [1.0, 1.0], 0.2, &mut random);
    let mut matrix = assemble(&body, &in_order(&body), 0.0);
    let n = matrix.n_dofs();
    let free_body = dense(&matrix);
    // The left end is clamped, and one more node may only slide along x.
    let is_fixed: Vec<bool> = (0..n).map(|dof| dof < 8 || dof == 31).collect();
    matrix.constrain(&is_fixed);
    let constrained = dense(&matrix);
    for i in 0..n {
        for j in 0..n {
            let kept = if is_fixed[i] || is_fixed[j] {
                f64::from(i == j)
            } else {
                free_body[(i, j)]
            };
            assert_eq!(constrained[(i, j)], kept, "entry ({i}, {j})");
        }
    }

    let load = random.vector(n);
    let x = solved(&matrix, &load);
    let free: Vec<usize> = (0..n).filter(|&dof| !is_fixed[dof]).collect();
    let reduced = DMatrix::from_fn(free.len(), free.len(), |i, j| free_body[(free[i], free[j])]);
    let reduced_load = DVector::from_fn(free.len(), |i, _| load[free[i]]);
    let expected = reduced.cholesky().unwrap().solve(&reduced_load);
    for (&dof, value) in free.iter().zip(expected.iter()) {
        // A stubby cantilever, condition 1e3 to 1e4, deflections of order 100.
        assert!((x[dof] - value).abs() < 1e-12 * expected.amax());
    }
    assert!(
        (0..n)
            .filter(|&dof| is_fixed[dof])
            .all(|dof| x[dof] == load[dof])
    );
}

/// Diagonal blocks are inverted, which could cost digits where plain substitution would not.
#[test]
fn a_slender_beam_is_solved_with_a_residual_at_rounding_level() {
    let mut random = Random(8);
    // 1000 : 1 in shape, so that bending is about 1e6 times softer than stretching.
    let body = mesh(500, 2, [2.0, 0.5], 0.0, &mut random);
    let mut matrix = assemble(&body, &in_order(&body), 0.0);
    let n = matrix.n_dofs();
    matrix.constrain(&(0..n).map(|dof| dof < 6).collect::<Vec<_>>());
    let load: Vec<f64> = (0..n)
        .map(|dof| f64::from(dof >= 6 && dof % 2 == 1))
        .collect();
    let x = solved(&matrix, &load);
    let mut residual = load.clone();
    matrix.multiply_add(-1.0, &x, &mut residual);
    let norm = (0..matrix.n_nodes())
        .map(|node| {
            matrix
                .row_blocks(node)
                .iter()
                .map(|b| largest(b.iter().copied()))
                .sum::<f64>()
        })
        .fold(0.0, f64::max);
    let backward_error = largest(residual) / (norm * largest(x.iter().copied()) + 1.0);
    // The a-priori bound for Cholesky grows with the bandwidth; what is seen is about one rounding
    // error.
    assert!(backward_error < 1e-15, "{backward_error:e}");
}

#[test]
fn a_matrix_that_is_not_positive_definite_is_named_by_its_node_and_leaves_the_factor_usable() {
    let mut random = Random(9);
    let body = mesh(8, 3, [1.0, 1.0], 0.2, &mut random);
    let good = assemble(&body, &random.permutation(body.points.len()), 0.1);
    let load = random.vector(good.n_dofs());
    let expected = solved(&good, &load);
    let mut cholesky = BlockCholesky::analyze(&good);
    for bad_node in 0..good.n_nodes() {
        let mut bad = good.clone();
        // All other nodes stay positive definite among themselves, so that only this pivot can
        // fail.
        bad.add_diagonal(bad_node, [0.0, -100.0]);
        match cholesky.factorize(&bad) {
            Err(CholeskyError::NotPositiveDefinite {
                node,
                pivot,
                diagonal,
            }) => {
                assert_eq!(node, bad_node);
                assert!(pivot < diagonal && diagonal < 0.0);
            }
            other => panic!("node {bad_node}: {other:?}"),
        }
        let mut x = load.clone();
        cholesky.factorize(&good).unwrap();
        cholesky.solve_in_place(&mut x);
        assert_eq!(x, expected, "a failure must leave no trace");
    }
    let mut poisoned = good.clone();
    poisoned.add_diagonal(3, [f64::NAN, 0.0]);
    assert!(matches!(
        cholesky.factorize(&poisoned),
        Err(CholeskyError::NotPositiveDefinite { .. })
    ));
    assert_eq!(cholesky.n_factorizations(), good.n_nodes());
}

#[test]
fn what_is_made_anew_where_values_have_changed_is_made_anew_to_the_last_bit() {
    let mut random = Random(12);
    let body = mesh(20, 6, [1.0, 0.3], 0.2, &mut random);
    let mut matrix = assemble(&body, &random.permutation(body.points.len()), 0.1);
    let load = random.vector(matrix.n_dofs());
    let mut cholesky = BlockCholesky::analyze(&matrix);
    let mut check = |matrix: &BlockMatrix| {
        let mut x = load.clone();
        cholesky.refactorize(matrix).unwrap();
        cholesky.solve_in_place(&mut x);
        assert_eq!(x, solved(matrix, &load));
    };
    check(&matrix);
    check(&matrix);
    // One node, then many, then a coupling without its nodes.
    for n_changed in [1, 1, 3, 40] {
        for k in 0..n_changed {
            let node = (17 * k + 5 * n_changed) % matrix.n_nodes();
            matrix.add_diagonal(node, [1.0 + k as f64, 0.5]);
        }
        check(&matrix);
    }
    let node = matrix.n_nodes() / 2;
    let other = matrix.neighbours(node).iter().map(|&other| other as usize);
    let other = other.max().unwrap();
    matrix.add_cell(&[node, other], &[0.01; 16]);
    check(&matrix);
    // A failure leaves nothing that a later call would keep, nor does a factor that was made as a whole.
    let mut bad = matrix.clone();
    bad.add_diagonal(node, [0.0, -1e6]);
    assert!(cholesky.refactorize(&bad).is_err());
    for is_whole in [false, true] {
        let mut x = load.clone();
        if is_whole {
            let mut heavier = matrix.clone();
            heavier.add_diagonal(node, [3.0, 3.0]);
            cholesky.factorize(&heavier).unwrap();
        }
        cholesky.refactorize(&matrix).unwrap();
        cholesky.solve_in_place(&mut x);
        assert_eq!(x, solved(&matrix, &load));
    }
}

#[test]
fn a_body_free_to_move_rigidly_is_refused_and_a_held_one_is_not() {
    let mut random = Random(10);
    for (nx, ny) in [(1, 1), (5, 5), (40, 4), (30, 30)] {
        let body = mesh(nx, ny, [0.1, 0.1], 0.2, &mut random);
        let mut stiffness = assemble(&body, &in_order(&body), 0.0);
        let mut cholesky = BlockCholesky::analyze(&stiffness);
        let outcome = cholesky.factorize(&stiffness);
        assert!(
            matches!(outcome, Err(CholeskyError::NotPositiveDefinite { .. })),
            "{nx} x {ny}"
        );
        // One pinned node leaves the rotation; one more support takes it.
        let n = stiffness.n_dofs();
        stiffness.constrain(&(0..n).map(|dof| dof < 2).collect::<Vec<_>>());
        assert!(
            cholesky.factorize(&stiffness).is_err(),
            "{nx} x {ny} turns about its pin"
        );
        stiffness.constrain(&(0..n).map(|dof| dof < 4).collect::<Vec<_>>());
        assert_eq!(cholesky.factorize(&stiffness), Ok(()), "{nx} x {ny}");
    }
}

#[test]
fn a_matrix_of_another_pattern_is_refused() {
    let mut random = Random(11);
    let [small, large] =
        [(2, 2), (3, 2)].map(|(nx, ny)| mesh(nx, ny, [1.0, 1.0], 0.0, &mut random));
    let [a, b] = [&small, &large].map(|body| assemble(body, &in_order(body), 1.0));
    let mut cholesky = BlockCholesky::analyze(&a);
    let mismatch = CholeskyError::PatternMismatch {
        analysed: 9,
        found: 12,
    };
    assert_eq!(cholesky.factorize(&b), Err(mismatch));
    // Built anew from the same cells, it is the same pattern.
    assert_eq!(
        cholesky.factorize(&assemble(&small, &in_order(&small), 2.0)),
        Ok(())
    );
}

#[test]
#[should_panic(expected = "factorize a matrix")]
fn solving_without_a_factor_is_the_callers_mistake() {
    let mut random = Random(12);
    let body = mesh(1, 1, [1.0, 1.0], 0.0, &mut random);
    let matrix = assemble(&body, &in_order(&body), 1.0);
    BlockCholesky::analyze(&matrix).solve_in_place(&mut [0.0; 8]);
}

#[test]
fn the_factor_holds_the_matrix_and_its_fill_and_not_much_more() {
    let mut random = Random(13);
    let body = mesh(40, 40, [1.0, 1.0], 0.0, &mut random);
    let matrix = assemble(&body, &random.permutation(body.points.len()), 1.0);
    let n_nodes = matrix.n_nodes();
    let n_lower: usize = (0..n_nodes)
        .map(|node| 2 * matrix.neighbours(node).len() + 1)
        .sum();
    let n_nonzeros = BlockCholesky::analyze(&matrix).n_nonzeros();
    // Minimum degree keeps about 7.75 n log2(n) on a square of nine-point stars (George, Liu); a
    // bandwidth of 41 nodes would cost 82 per dof.
    assert!(
        n_nonzeros > n_lower && n_nonzeros < 40 * 2 * n_nodes,
        "{n_nonzeros} entries"
    );
}

#[test]
fn refactorizing_multiplying_and_solving_allocate_nothing() {
    let mut random = Random(14);
    let body = mesh(30, 6, [1.0, 1.0], 0.2, &mut random);
    let number = random.permutation(body.points.len());
    let nodes = body.triangles[0].map(|node| number[node]);
    let mut matrix = assemble(&body, &number, 0.1);
    let stiffness = matrix.clone();
    let n = matrix.n_dofs();
    let mut cholesky = BlockCholesky::analyze(&matrix);
    let mut columns = random.vector(11 * n);
    let (x, mut y) = (random.vector(n), vec![0.0; n]);
    let is_fixed: Vec<bool> = (0..n).map(|dof| dof < 4).collect();
    let cell = triangle_stiffness(body.triangles[0].map(|node| body.points[node]));

    assert_eq!(
        allocations_during(|| drop(vec![0u8; 100])),
        1,
        "the counter works"
    );
    let n_allocations = allocations_during(|| {
        for _ in 0..3 {
            matrix.fill_zero();
            matrix.assign_scaled(0.5, &stiffness);
            matrix.add_cell(&nodes, &cell);
            matrix.constrain(&is_fixed);
            matrix.multiply(&x, &mut y);
            assert_eq!(cholesky.factorize(&matrix), Ok(()));
            cholesky.solve_in_place(&mut y);
            cholesky.solve_many_in_place(&mut columns, 11);
        }
        matrix.add_diagonal(9, [-100.0, 0.0]);
        assert!(cholesky.factorize(&matrix).is_err());
    });
    assert_eq!(n_allocations, 0);
    assert_eq!(cholesky.n_factorizations(), 3);
}
