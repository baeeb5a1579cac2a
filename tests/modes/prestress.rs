//! Vibrations about a deformed state: strings, columns on their way to buckling and beyond, bodies that have turned.

use super::support::{close, rectangle};
use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
use foil2d::fe::material::hyperelastic::{Corotated, StableNeoHookean};
use foil2d::fe::modes::{Mode, ModesError, lowest_modes, lowest_modes_at};
use foil2d::prelude::*;
use std::f64::consts::PI;

const YOUNG: f64 = 1e7;
const DENSITY: f64 = 1000.0;
const HEIGHT: f64 = 0.01;

/// A strip of L = 1 m and ν = 0, stretched as a whole and pulled by dead loads at its ends, whose sections are between rails and may turn.
struct Strip {
    model: FiniteStrainModel,
    is_held: Vec<bool>,
    positions: Vec<f64>,
    /// By which the ends are pulled (N): the law's `E (λ - 1)`.
    tension: f64,
}

fn strip(stretch: f64) -> Strip {
    let mesh = rectangle([1.0, HEIGHT], [40, 1], CellKind::Tri6);
    let law = Corotated::plane_strain(YOUNG, 0.0);
    let description = FiniteStrainDescription::new(mesh, law, DENSITY);
    let model = FiniteStrainModel::assemble(description).expect("a strip");
    let rest = model.rest_positions();
    let is_end = |p: &[f64]| p[0] == 0.0 || p[0] == 1.0;
    let is_middle = |p: &[f64]| is_end(p) && (p[1] - 0.5 * HEIGHT).abs() < 1e-9;
    let nodes = || rest.chunks_exact(2);
    Strip {
        is_held: nodes().flat_map(|p| [is_middle(p), is_end(p)]).collect(),
        positions: nodes().flat_map(|p| [stretch * p[0], p[1]]).collect(),
        tension: YOUNG * HEIGHT * (stretch - 1.0),
        model,
    }
}

/// `μ ω² (1 + q² h²/12λ²) = T q²/λ + EI q⁴/λ²` with `q = nπ/L` and μ of the strip unstretched: a section turns by `w'/λ`, which the
/// energy of the law gives.
///
/// The first term is `n/2ℓ √(T/μ')` with length and mass per length of the string as it is stretched.
fn string(strip: &Strip, stretch: f64, n: usize) -> f64 {
    let wave = (n as f64 * PI).powi(2);
    let bending = YOUNG * HEIGHT.powi(3) / 12.0;
    let stiffness = strip.tension * wave / stretch + bending * (wave / stretch).powi(2);
    let rotary = wave * (HEIGHT / stretch).powi(2) / 12.0;
    (stiffness / (DENSITY * HEIGHT * (1.0 + rotary))).sqrt()
}

#[test]
fn a_stretched_string_has_the_notes_of_its_tension() {
    for stretch in [1.05, 1.3] {
        let strip = strip(stretch);
        let found = lowest_modes_at(&strip.model, &strip.positions, &strip.is_held, 6, 1e-10)
            .expect("a string");
        assert_eq!(found.n_rigid, 0);
        let is_along = |mode: &&Mode| {
            let [x, y] = [0, 1].map(|k| mode.shape[k..].iter().step_by(2));
            let [x, y] = [x, y].map(|along| along.map(|v| v * v).sum::<f64>());
            x > y
        };
        let (along, across): (Vec<&Mode>, Vec<&Mode>) = found.modes.iter().partition(is_along);
        assert!(across.len() >= 4);
        for (k, mode) in across.into_iter().enumerate() {
            let n = k + 1;
            let line = DENSITY * HEIGHT / stretch;
            let plain = PI * n as f64 / stretch * (strip.tension / line).sqrt();
            let name = format!("stretch {stretch}, note {n}");
            // What shear gives way.
            let tolerance = 2e-5 * (n * n) as f64;
            close(
                &name,
                mode.frequency(),
                string(&strip, stretch, n),
                tolerance,
            );
            let bending = (PI * n as f64 * HEIGHT).powi(2) / (24.0 * (stretch - 1.0));
            close(&name, mode.frequency(), plain, 1.1 * bending);
        }
        // Along itself the string vibrates as at rest, as the law is linear in the stretch; ends held at points give way by a tenth of h.
        for (k, mode) in along.into_iter().enumerate() {
            let expected = PI * (k + 1) as f64 * (YOUNG / DENSITY).sqrt();
            close("along", mode.frequency(), expected, 2e-3);
        }
    }
}

/// Between pins, pressed together: `ω² = ω0² (1 - P/n² Pcr)`, below zero beyond the critical load for the first mode alone.
#[test]
fn a_pressed_column_vibrates_slower_until_it_buckles() {
    let critical = PI * PI * YOUNG * HEIGHT.powi(3) / 12.0;
    let modes = |strip: &Strip| {
        lowest_modes_at(&strip.model, &strip.positions, &strip.is_held, 3, 1e-10)
            .expect("a column")
            .modes
    };
    let at_rest = modes(&strip(1.0));
    for share in [0.5, 0.9, 2.0] {
        let pressed = modes(&strip(1.0 - share * critical / (YOUNG * HEIGHT)));
        for (k, (mode, rest)) in pressed.iter().zip(&at_rest).enumerate() {
            let n = (k + 1) as f64;
            let expected = rest.square * (1.0 - share / (n * n));
            let error = (mode.square - expected) / rest.square;
            println!("{share} {k}: {error:e}");
            // By the strain, 8e-5, and what shear takes off the critical load.
            assert!(error.abs() < 1e-3, "{share} {k}: {}", mode.square);
            assert_eq!(mode.growth() > 0.0, share > 1.0 && k == 0);
            assert_eq!(mode.frequency() == 0.0, share > 1.0 && k == 0);
        }
    }
}

/// A body that is turned and put far away has the modes that it has at rest, and those of its unstrained tangent three rigid ones.
#[test]
fn a_body_that_has_turned_has_the_modes_of_one_that_has_not() {
    let mesh = rectangle([1.0, 0.4], [6, 3], CellKind::Tri6);
    let law = StableNeoHookean::plane_strain(1e6, 0.3);
    let model = FiniteStrainModel::assemble(FiniteStrainDescription::new(mesh, law, DENSITY))
        .expect("a plate");
    let rest = model.rest_positions();
    let plain = lowest_modes_at(&model, rest, &[], 9, 1e-11).expect("a plate");
    let (sin, cos) = 2.1f64.sin_cos();
    let turned: Vec<f64> = rest
        .chunks_exact(2)
        .flat_map(|p| [5.0 + cos * p[0] - sin * p[1], sin * p[0] + cos * p[1] - 3.0])
        .collect();
    let other = lowest_modes_at(&model, &turned, &[], 9, 1e-11).expect("a plate");
    assert_eq!([plain.n_rigid, other.n_rigid], [3, 3]);
    for (plain, other) in plain.modes.iter().zip(&other.modes).skip(3) {
        close("turned", other.frequency(), plain.frequency(), 1e-9);
    }
}

#[test]
fn positions_that_are_none_are_refused() {
    let strip = strip(1.0);
    let mut positions = strip.positions.clone();
    positions[7] = f64::NAN;
    for bad in [&positions[..], &positions[..6]] {
        let error = lowest_modes_at(&strip.model, bad, &[], 3, 1e-9).expect_err("no positions");
        assert!(matches!(error, ModesError::Positions { .. }), "{error}");
    }
}

/// A body of the builder's, held by its pins: of large strain at rest as of small strain, and turned in its frame as well.
#[test]
fn a_body_knows_its_own_modes() {
    let builder = FlexBodyBuilder::mesh(rectangle([1.0, 0.2], [10, 2], CellKind::Tri6))
        .material(LinearElastic::plane_strain(1e6, 0.3).density(DENSITY))
        .contact_inertia(ContactInertia::Kept)
        .rotation(0.4)
        .pin_where(|[x, _]| x == 0.0, Pin::both());
    let small = builder.clone().small_strain().build().expect("a body");
    let large = builder.build().expect("a body");
    assert!(small.large().is_none() && large.large().is_some());
    let expected = lowest_modes(small.model(), small.fixed_dofs(), 6, 1e-10).expect("modes");
    assert_eq!(small.natural_modes(6, 1e-10).expect("modes"), expected);
    let found = large.natural_modes(6, 1e-10).expect("modes");
    for (found, expected) in found.modes.iter().zip(&expected.modes) {
        close("body", found.frequency(), expected.frequency(), 1e-9);
    }
}
