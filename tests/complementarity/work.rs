//! What a solve costs, counted and not timed.

use crate::support::{Case, Numbers, random_contacts};
use foil2d::linalg::complementarity::{Method, RowKind, Solver, Status};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    static N_ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

/// The system's allocator, counting per thread because tests run side by side.
struct Counting;

// SAFETY: every call is handed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        N_ALLOCATIONS.with(|count| count.set(count.get() + 1));
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// A long elastic surface: a contact moves its neighbours by an influence that decays with distance.
fn elastic_surface(n: usize, coefficient: Option<f64>) -> Case {
    let mut numbers = Numbers(3);
    let (stride, n_rows) = if coefficient.is_some() {
        (2, 2 * n)
    } else {
        (1, n)
    };
    let mut delassus = vec![0.0; n_rows * n_rows];
    let (mut free, mut rows) = (Vec::new(), Vec::new());
    for row in 0..n_rows {
        for column in 0..n_rows {
            let distance = (row / stride).abs_diff(column / stride) as f64;
            let influence = (-distance / 3.0).exp() + if distance == 0.0 { 0.5 } else { 0.0 };
            // a push sideways lifts the surface a little
            let share = if row % stride == column % stride {
                1.0
            } else {
                0.2
            };
            delassus[row * n_rows + column] = share * influence;
        }
        if row % stride == 0 {
            free.push(numbers.unit() - 0.8);
            rows.push(RowKind::Unilateral);
        } else {
            free.push(3.0);
            let coefficient = coefficient.expect("only frictional surfaces have tangents");
            rows.push(RowKind::Friction {
                normal: row - 1,
                coefficient,
            });
        }
    }
    Case {
        delassus,
        free,
        rows,
    }
}

#[test]
fn a_repeated_solve_takes_one_pivot() {
    for case in (0..20).map(|seed| random_contacts(seed, 8, 6, 0.3)) {
        let (mut multipliers, mut status, _) = case.solve();
        let before = multipliers.clone();
        let outcome = Solver::new().solve(&case.problem(), &mut multipliers, &mut status);
        let outcome = outcome.expect("the data is finite");
        assert_eq!((outcome.n_pivots, outcome.method), (1, Method::ActiveSet));
        assert_eq!(multipliers, before, "the same pivot gives the same bits");
    }
}

#[test]
fn a_load_that_changes_little_takes_one_pivot() {
    // unless a status changes, which a change of 1e-6 does for none of these
    for mut case in (0..20).map(|seed| random_contacts(seed, 8, 6, 0.3)) {
        let (mut multipliers, mut status, _) = case.solve();
        case.free.iter_mut().for_each(|free| *free *= 1.0 + 1e-6);
        let outcome = Solver::new().solve(&case.problem(), &mut multipliers, &mut status);
        assert_eq!(outcome.expect("the data is finite").n_pivots, 1);
    }
}

#[test]
fn a_warm_solver_does_not_allocate_whichever_way_it_goes() {
    let mut solver = Solver::new();
    let cases: Vec<Case> = (0..60)
        .map(|seed| random_contacts(seed, 5, 20, 0.8))
        .chain([elastic_surface(300, Some(0.4))])
        .collect();
    let mut found_by = [0; 3];
    for pass in 0..2 {
        for case in &cases {
            let n = case.rows.len();
            let (mut multipliers, mut status) = (vec![0.0; n], vec![Status::Open; n]);
            let before = N_ALLOCATIONS.with(Cell::get);
            let outcome = solver.solve(&case.problem(), &mut multipliers, &mut status);
            let n_allocations = N_ALLOCATIONS.with(Cell::get) - before;
            found_by[outcome.expect("the data is finite").method as usize] += 1;
            assert!(
                pass == 0 || n_allocations == 0,
                "{n_allocations} allocations"
            );
        }
    }
    assert!(
        found_by.iter().all(|&count| count > 0),
        "a fallback was not tried: {found_by:?}"
    );
}

#[test]
fn a_thousand_contacts_cost_far_less_than_one_factorization() {
    let n = 1000;
    let case = elastic_surface(n, None);
    let (mut multipliers, mut status, outcome) = case.solve();
    let n_closed = status
        .iter()
        .filter(|&&status| status == Status::Stick)
        .count();
    assert!(n_closed > 300, "only {n_closed} contacts are closed");
    assert!(outcome.residual <= 1e-11, "{outcome:?}");
    assert_eq!(
        (outcome.n_factorizations, outcome.method),
        (0, Method::ActiveSet)
    );
    // in units of n² multiplications: one factorization is n / 6, a pivot is 2 besides its products
    let work = outcome.n_products + 2 * outcome.n_pivots;
    assert!(3 * work <= n, "{work} products: {outcome:?}");
    let outcome = Solver::new().solve(&case.problem(), &mut multipliers, &mut status);
    let outcome = outcome.expect("the data is finite");
    assert_eq!(outcome.n_pivots, 1);
    assert!(
        outcome.n_products <= 50,
        "a warm start should nearly be the answer: {outcome:?}"
    );
}

#[test]
fn hundreds_of_sliding_contacts_need_no_factorization_either() {
    let case = elastic_surface(700, Some(0.4));
    let (_, status, outcome) = case.solve();
    let n_sliding = status
        .iter()
        .filter(|&&status| status == Status::SlipNegative)
        .count();
    assert!(n_sliding > 256, "only {n_sliding} contacts slide");
    assert!(outcome.residual <= 1e-11, "{outcome:?}");
    assert_eq!(
        (outcome.n_factorizations, outcome.method),
        (0, Method::ActiveSet)
    );
    assert!(outcome.n_products <= 300, "{outcome:?}");
}

#[test]
fn a_large_stiff_chain_falls_back_on_one_factorization() {
    // a tied chain of 400 masses: the condition number is about n², too much for conjugate gradients
    let n = 400;
    let mut delassus = vec![0.0; n * n];
    for row in 0..n {
        delassus[row * n + row] = if row == 0 { 1.0 } else { 2.0 };
        if row > 0 {
            delassus[row * n + row - 1] = -1.0;
            delassus[(row - 1) * n + row] = -1.0;
        }
    }
    let mut free = vec![0.0; n];
    free[0] = -1.0;
    let (multipliers, _, outcome) = Case {
        delassus,
        free,
        rows: vec![RowKind::Bilateral; n],
    }
    .solve();
    assert_eq!(outcome.n_factorizations, 1, "{outcome:?}");
    // each joint carries the masses above it
    for (layer, multiplier) in multipliers.iter().enumerate() {
        let above = (n - layer) as f64;
        assert!(
            (multiplier - above).abs() <= 1e-9 * above,
            "layer {layer}: {multiplier}"
        );
    }
}

#[test]
fn rows_that_contradict_each_other_by_rounding_are_not_swept_for_ever() {
    // A body of 1 kg between two walls that ask for 1e-7 m/s each, beside one that falls at 1 m/s: no answer closes both.
    let case = Case {
        delassus: vec![1.0, -1.0, 0.0, -1.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        free: vec![-1e-7, -1e-7, -1.0],
        rows: vec![RowKind::Unilateral; 3],
    };
    let (mut multipliers, mut status) = ([0.0; 3], [Status::Open; 3]);
    let outcome = Solver::new()
        .with_redundancy_tolerance(1e-12)
        .solve(&case.problem(), &mut multipliers, &mut status)
        .expect("the data is finite");
    assert!(
        outcome.residual > 1e-8 && outcome.residual < 1e-6,
        "{outcome:?}"
    );
    // Those that come before Lemke's method, and none after it.
    assert!(outcome.n_sweeps <= 50, "{outcome:?}");
}

#[test]
fn statuses_of_other_methods_settle_in_few_pivots_or_are_given_up() {
    let (mut n_rescued, mut total, mut most) = (0, 0, 0);
    for seed in 0..400 {
        let case = random_contacts(seed, 12, 40, 2.0);
        let (_, _, outcome) = case.solve();
        if outcome.n_lemke_pivots > 0 {
            n_rescued += 1;
            total += outcome.n_pivots;
            most = most.max(outcome.n_pivots);
        }
        assert!(outcome.residual <= 1e-9, "seed {seed}: {outcome:?}");
    }
    // The first run may take 20 and a quarter of the rows; then come the warm start, sweeps and paths. Few need rows that give way, of which a step
    // may take as much again.
    let once = 20 + 20 + 5 * 12;
    assert!(n_rescued > 3, "{n_rescued} problems needed other methods");
    assert!(
        total <= n_rescued * once,
        "{total} pivots for {n_rescued} problems"
    );
    assert!(most <= 3 * once, "{most} pivots");
}
