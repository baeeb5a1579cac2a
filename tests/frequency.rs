//! The largest natural frequency: Lanczos against a dense eigenvalue solver and the bar's closed form, and a safe bound.

#[path = "modes/exact.rs"]
mod exact;

use foil2d::fe::frequency::{FrequencyError, frequency_bound, largest_frequency};
use foil2d::fe::material::LinearElastic;
use foil2d::fe::mesh::{CellKind, Mesh, generate};
use foil2d::fe::model::{MassKind, Model, ModelDescription};
use std::sync::Arc;

fn model(mesh: Mesh, poisson: f64, mass_kind: MassKind, massless: Vec<bool>) -> Model {
    Model::assemble(ModelDescription {
        rest_positions: mesh.nodes().iter().flatten().copied().collect(),
        placed_positions: Vec::new(),
        mesh: Arc::new(mesh),
        elements: Vec::new(),
        material: Arc::new(LinearElastic::plane_stress(YOUNG, poisson).density(DENSITY)),
        regions: Vec::new(),
        thickness: 0.1,
        mass_kind,
        massless,
        held: Vec::new(),
    })
    .expect("a sound mesh")
}

const YOUNG: f64 = 2e6;
const DENSITY: f64 = 1200.0;

fn rectangle(size: [f64; 2], divisions: [usize; 2], kind: CellKind) -> Mesh {
    generate::rectangle(size, divisions, kind).expect("a sound rectangle")
}

/// The largest frequency by dense matrices.
fn dense(model: &Model, is_fixed: &[bool]) -> f64 {
    let squares = exact::dense(model, is_fixed);
    squares.last().expect("a free dof").sqrt()
}

/// Lanczos to 1e-9 against the dense solver, and the bound above but not above `largest_ratio` times the frequency.
///
/// That ratio depends on whether neighbours can follow the stiffest motion of a cell: 1 for a bar, below 1.25 on regular
/// meshes, more where cells of many shapes meet.
#[track_caller]
fn check(model: &Model, is_fixed: &[bool], largest_ratio: f64) {
    let exact = dense(model, is_fixed);
    let found = largest_frequency(model, is_fixed, 1e-9).expect("it converges");
    assert!(
        (found.frequency - exact).abs() < 1e-9 * exact,
        "{found:?} beside {exact}"
    );
    assert!(found.error <= 1e-9 * exact);
    let bound = frequency_bound(model, is_fixed).expect("sound cells");
    assert!(bound >= exact, "bound {bound} below {exact}");
    assert!(bound <= largest_ratio * exact, "{bound} against {exact}");
}

const KINDS: [CellKind; 3] = [CellKind::Tri3, CellKind::Quad4, CellKind::Tri6];
const MASSES: [MassKind; 2] = [MassKind::Lumped, MassKind::Consistent];

#[test]
fn free_bodies_of_every_element_and_mass_agree_with_a_dense_solver() {
    for kind in KINDS {
        for mass in MASSES {
            let body = model(rectangle([1.0, 0.6], [5, 3], kind), 0.3, mass, Vec::new());
            check(&body, &[], 1.25);
            let bound = frequency_bound(&body, &[]).expect("sound cells");
            assert_eq!(body.largest_frequency(), bound);
        }
    }
}

#[test]
fn pinned_bodies_are_no_stiffer_than_free_ones_and_agree_with_a_dense_solver() {
    for mass in MASSES {
        let mesh = rectangle([1.0, 0.6], [4, 3], CellKind::Quad4);
        let is_fixed: Vec<bool> = mesh
            .nodes()
            .iter()
            .flat_map(|x| [x[0] == 0.0, x[0] == 0.0 || x[1] == 0.0])
            .collect();
        let body = model(mesh, 0.3, mass, Vec::new());
        check(&body, &is_fixed, 1.25);
        let [held, free] = [&is_fixed[..], &[]].map(|flags| {
            let found = largest_frequency(&body, flags, 1e-9);
            found.expect("it converges").frequency
        });
        assert!(held <= free * (1.0 + 1e-12));
    }
}

#[test]
fn distorted_cells_keep_the_bound_above() {
    let mesh = generate::disc(1.0, 0.35, CellKind::Quad4).expect("a disc");
    // Nodal masses may be shared so that the bound falls; consistent ones may not.
    for (mass, largest_ratio) in [(MassKind::Lumped, 1.25), (MassKind::Consistent, 1.4)] {
        check(
            &model(mesh.clone(), 0.3, mass, Vec::new()),
            &[],
            largest_ratio,
        );
    }
}

#[test]
fn massless_nodes_follow_quasi_statically_and_do_not_make_the_frequency_infinite() {
    let mesh = rectangle([1.0, 1.0], [6, 6], CellKind::Quad4);
    let on_side = |x: &[f64; 2]| x[1] == 0.0 || x[0] == 1.0;
    let massless: Vec<bool> = mesh.nodes().iter().map(on_side).collect();
    let body = model(mesh, 0.3, MassKind::Lumped, massless);
    check(&body, &[], 1.4);
    // With inertia kept at the contact boundary there would be no finite frequency there.
    assert_eq!(body.largest_frequency(), f64::INFINITY);
}

/// A strip of `n` cells of length `h` that only moves along x; Poisson's ratio 0 makes it a bar.
fn bar(n: usize, mass: MassKind, hold_left: bool) -> (Model, Vec<bool>) {
    let mesh = rectangle([2.0, 2.0], [n, 1], CellKind::Quad4);
    let is_fixed = mesh
        .nodes()
        .iter()
        .flat_map(|x| [hold_left && x[0] == 0.0, true])
        .collect();
    (model(mesh, 0.0, mass, Vec::new()), is_fixed)
}

#[test]
fn the_bar_has_its_textbook_frequencies() {
    // ω² = (c/h)² 2 (1 - cos θ) / m(θ), with m = 1 for lumped masses and (2 + cos θ)/3 for consistent ones; θ = π for the free
    // bar, (2n - 1) π / 2n for one held at an end. The held bar with consistent masses is left out: there the highest mode of
    // the strip bends, with the top running against the bottom, and is 1e-4 above that of the bar.
    let n = 8;
    let wave = (YOUNG / DENSITY).sqrt() / (2.0 / n as f64);
    let held = std::f64::consts::PI * (2 * n - 1) as f64 / (2 * n) as f64;
    let free = std::f64::consts::PI;
    for (mass, hold_left, angle, inertia, cell) in [
        (MassKind::Lumped, false, free, 1.0, 2.0),
        (MassKind::Lumped, true, held, 1.0, 2.0),
        (
            MassKind::Consistent,
            false,
            free,
            1.0 / 3.0,
            f64::sqrt(12.0),
        ),
    ] {
        let exact = wave * (2.0 * (1.0 - f64::cos(angle)) / inertia).sqrt();
        let (body, is_fixed) = bar(n, mass, hold_left);
        let found = largest_frequency(&body, &is_fixed, 1e-10).expect("it converges");
        assert!(
            (found.frequency - exact).abs() < 1e-10 * exact,
            "{found:?} beside {exact}"
        );
        // The bound is that of one cell, 2 c/h or sqrt(12) c/h, which the free bar reaches.
        let bound = frequency_bound(&body, &is_fixed).expect("sound cells");
        assert!(
            (bound - cell * wave).abs() < 1e-12 * bound,
            "{bound} beside {}",
            cell * wave
        );
    }
}

#[test]
fn a_large_mesh_takes_no_more_products_than_a_small_one_needs() {
    let body = model(
        rectangle([1.0, 1.0], [60, 60], CellKind::Quad4),
        0.3,
        MassKind::Lumped,
        Vec::new(),
    );
    let found = largest_frequency(&body, &[], 1e-2).expect("it converges");
    assert!(found.n_products <= 60, "{found:?}");
    let bound = frequency_bound(&body, &[]).expect("sound cells");
    assert!(found.frequency <= bound && bound < 1.15 * found.frequency);
}

#[test]
fn a_body_with_no_free_dof_has_no_frequency() {
    let body = model(
        rectangle([1.0, 1.0], [2, 2], CellKind::Quad4),
        0.3,
        MassKind::Lumped,
        Vec::new(),
    );
    let is_fixed = vec![true; body.n_dofs()];
    let found = largest_frequency(&body, &is_fixed, 1e-6).expect("nothing to do");
    assert_eq!((found.frequency, found.n_products), (0.0, 0));
    assert_eq!(frequency_bound(&body, &is_fixed), Ok(0.0));
}

#[test]
fn a_tolerance_out_of_range_is_refused() {
    let body = model(
        rectangle([1.0, 1.0], [2, 2], CellKind::Quad4),
        0.3,
        MassKind::Lumped,
        Vec::new(),
    );
    for bad in [0.0, -1.0, f64::NAN, 1.0] {
        let error = largest_frequency(&body, &[], bad).expect_err("out of range");
        assert!(matches!(error, FrequencyError::Tolerance(_)));
    }
}
