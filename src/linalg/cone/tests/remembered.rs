//! Solvers that are recorded and made again.

use super::piles::pile;
use super::*;

fn bits(answer: &Answer) -> Vec<u64> {
    let numbers = answer.p.as_flattened().iter();
    let numbers = numbers.chain(&answer.slip).chain(&answer.a);
    numbers.map(|number| number.to_bits()).collect()
}

/// Loads that change a little, so that factors are corrected, or much; rows that move by next to nothing, and matrices that do.
#[test]
fn a_solver_made_again_goes_on_bit_for_bit() {
    let mut scene = pile(4, 5, |_| 1.0, 0.3);
    let mut random = Random(11);
    let [mut straight, mut resumed] = [(); 2].map(|()| ConeSolver::default());
    let n = scene.rows.len();
    let (mut p, mut slip) = (vec![[0.0; 2]; n], vec![0.0; n]);
    let (mut n_kept, mut n_made, mut n_corrected) = (0, 0, 0);
    for turn in 0..120 {
        match turn % 6 {
            0 => scene.load.iter_mut().for_each(|load| {
                *load += 2.0 * random.within(-1.0, 1.0);
            }),
            1 => scene.entries.iter_mut().for_each(|entry| {
                entry.normal[0] *= 1.0 + 1e-7 * random.within(-1.0, 1.0);
            }),
            2 => scene.matrix.add_diagonal(0, [1e-7; 2]),
            // One body is pushed and let go.
            3 => scene.load[8] += 6.0,
            4 => scene.load[8] -= 6.0,
            _ => {}
        }
        let expected = solve_with(&mut straight, &scene, &p, &slip);
        let found = solve_with(&mut resumed, &scene, &p, &slip);
        assert!(bits(&expected) == bits(&found), "turn {turn}");
        let counts = |answer: &Answer| {
            let outcome = answer.outcome;
            (outcome.n_factorizations, outcome.used_interior_point)
        };
        assert_eq!(counts(&expected), counts(&found), "turn {turn}");
        n_kept += usize::from(counts(&found).0 == 0);
        n_made += usize::from(counts(&found).0 > 0);
        n_corrected += usize::from(resumed.system.n_changes > counts(&found).0);
        let record = resumed.record();
        resumed = match ConeSolver::remembered(&record, &scene.matrix) {
            Some(solver) => solver,
            None => panic!("the record is of this matrix"),
        };
        (p, slip) = (expected.p, expected.slip);
    }
    assert!(
        n_kept.min(n_made).min(n_corrected) > 9,
        "{n_kept} with the factor at hand, {n_made} with new ones, {n_corrected} with corrected ones"
    );
}

/// What does not fit the matrix, or itself, is told.
#[test]
fn records_of_other_matrices_are_refused() {
    let scene = pile(2, 3, |_| 1.0, 0.0);
    let mut solver = ConeSolver::default();
    let n = scene.rows.len();
    solve_with(&mut solver, &scene, &vec![[0.0; 2]; n], &vec![0.0; n]);
    let record = solver.record();
    assert!(ConeSolver::remembered(&record, &scene.matrix).is_some());
    let other = pile(2, 2, |_| 1.0, 0.0);
    assert!(ConeSolver::remembered(&record, &other.matrix).is_none());
}
