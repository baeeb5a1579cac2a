//! Small problems against every combination of statuses, solved independently.

use crate::support::{Case, Numbers, random_contacts};
use foil2d::linalg::complementarity::RowKind;
use nalgebra::{DMatrix, DVector};

/// Multipliers for given equations: `fixed[i]` is `Some((j, c))` if `p_i = c p_j` (or `0` for `c = 0`),
/// `None` if `w_i = 0`.
fn multipliers_of(case: &Case, fixed: &[Option<(usize, f64)>]) -> Option<Vec<f64>> {
    let n = case.rows.len();
    let mut matrix = DMatrix::from_row_slice(n, n, &case.delassus);
    let mut load = -DVector::from_column_slice(&case.free);
    for (row, law) in fixed.iter().enumerate() {
        if let Some((other, factor)) = *law {
            matrix.row_mut(row).fill(0.0);
            matrix[(row, other)] -= factor;
            matrix[(row, row)] += 1.0;
            load[row] = 0.0;
        }
    }
    matrix.lu().solve(&load).map(|p| p.as_slice().to_vec())
}

/// Whether every row obeys its law, to `tolerance`, written as the law reads.
fn obeys(case: &Case, multipliers: &[f64], tolerance: f64) -> bool {
    let velocities = case.velocities(multipliers);
    (0..case.rows.len()).all(|row| {
        let (p, w) = (multipliers[row], velocities[row]);
        match case.rows[row] {
            RowKind::Unilateral => p >= -tolerance && w >= -tolerance && (p * w).abs() <= tolerance,
            RowKind::Friction {
                normal,
                coefficient,
            } => {
                let bound = coefficient * multipliers[normal];
                // maximum dissipation: p w = -bound |w|
                p.abs() <= bound + tolerance && (p * w + bound * w.abs()).abs() <= tolerance
            }
            _ => unreachable!("only contacts are enumerated"),
        }
    })
}

fn distance(left: &[f64], right: &[f64]) -> f64 {
    left.iter()
        .zip(right)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

#[test]
fn frictionless_problems_have_the_one_answer_that_enumeration_finds() {
    for seed in 0..200 {
        let mut numbers = Numbers(seed);
        let n = 1 + (seed % 8) as usize;
        let factor = DMatrix::from_fn(n, n, |_, _| numbers.signed());
        let delassus = &factor * factor.transpose() + 0.05 * DMatrix::<f64>::identity(n, n);
        let case = Case {
            delassus: delassus.as_slice().to_vec(),
            free: (0..n).map(|_| numbers.signed()).collect(),
            rows: vec![RowKind::Unilateral; n],
        };
        let answer = (0_usize..1 << n).find_map(|closed| {
            let fixed: Vec<_> = (0..n)
                .map(|row| {
                    if closed >> row & 1 == 1 {
                        None
                    } else {
                        Some((row, 0.0))
                    }
                })
                .collect();
            multipliers_of(&case, &fixed).filter(|p| obeys(&case, p, 1e-12))
        });
        let answer = answer.expect("a positive definite problem has an answer");
        let (multipliers, _, outcome) = case.solve();
        // W >= 0.05, multipliers up to about 100: round-off times the condition number
        assert!(
            distance(&multipliers, &answer) <= 1e-11,
            "seed {seed}: {outcome:?}"
        );
    }
}

#[test]
fn three_frictional_contacts_have_one_of_the_answers_that_enumeration_finds() {
    let mut n_with_several = 0;
    for seed in 0..200 {
        let case = random_contacts(1_000 + seed, 4, 3, 0.8);
        let mut answers: Vec<Vec<f64>> = Vec::new();
        for combination in 0..64_usize {
            let mut fixed = Vec::new();
            for contact in 0..3 {
                let normal = 2 * contact;
                let RowKind::Friction { coefficient, .. } = case.rows[normal + 1] else {
                    unreachable!("rows alternate normal, tangent")
                };
                fixed.extend(match combination >> (2 * contact) & 3 {
                    0 => [Some((normal, 0.0)), Some((normal + 1, 0.0))],
                    1 => [None, None],
                    2 => [None, Some((normal, coefficient))],
                    _ => [None, Some((normal, -coefficient))],
                });
            }
            if let Some(answer) = multipliers_of(&case, &fixed)
                && obeys(&case, &answer, 1e-10)
                && answers.iter().all(|known| distance(known, &answer) > 1e-6)
            {
                answers.push(answer);
            }
        }
        let (multipliers, _, outcome) = case.solve();
        let nearest = answers.iter().map(|answer| distance(&multipliers, answer));
        let nearest = nearest.fold(f64::INFINITY, f64::min);
        let size = multipliers
            .iter()
            .fold(1.0_f64, |size, p| size.max(p.abs()));
        assert!(
            nearest <= 1e-9 * size,
            "seed {seed}: {nearest:e} from {answers:?}, {outcome:?}"
        );
        n_with_several += usize::from(answers.len() > 1);
    }
    // frictional problems of this size are nearly always unique, so that the comparison means something
    assert!(
        n_with_several <= 20,
        "{n_with_several} of 200 problems have several answers"
    );
}
