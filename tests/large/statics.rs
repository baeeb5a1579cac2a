//! Equilibria with known answers.

use super::frame::frame;
use super::support::{KINDS, describe, laws, nodes_where, plate};
use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel};
use foil2d::fe::material::hyperelastic::Corotated;
use foil2d::fe::mesh::CellKind;
use foil2d::large::{LargeError, LargeSettings, LoadCase, LoadStepper};
use std::sync::Arc;

fn flags(model: &FiniteStrainModel, dofs: impl IntoIterator<Item = usize>) -> Vec<bool> {
    let mut is_held = vec![false; model.n_dofs()];
    dofs.into_iter().for_each(|dof| is_held[dof] = true);
    is_held
}

/// A strip of h/L = 1/100, ν = 0, clamped at x = 0: the deflection, the shortening and the positions under a load.
struct Strip {
    model: Arc<FiniteStrainModel>,
    is_held: Vec<bool>,
    tip: usize,
}

const YOUNG: f64 = 1.2e7;
const HEIGHT: f64 = 0.01;
/// `E h³/12` of a strip 1 m thick (N m²).
const BENDING: f64 = YOUNG * HEIGHT * HEIGHT * HEIGHT / 12.0;

impl Strip {
    /// T6, 50 x 1, of one of the four laws.
    fn new(law: usize) -> Self {
        Self::of_cells(law, CellKind::Tri6, [50, 1])
    }

    fn of_cells(law: usize, kind: CellKind, divisions: [usize; 2]) -> Self {
        let law = Arc::clone(&laws(YOUNG, 0.0)[law]);
        let model = plate([1.0, HEIGHT], divisions, kind, law);
        let clamped = nodes_where(&model, |[x, _]| x == 0.0);
        let is_held = flags(&model, clamped.into_iter().flat_map(|n| [2 * n, 2 * n + 1]));
        let middle = |[x, y]: [f64; 2]| x == 1.0 && (y - 0.5 * HEIGHT).abs() < 1e-12;
        let tip = nodes_where(&model, middle)[0];
        Self {
            model: Arc::new(model),
            is_held,
            tip,
        }
    }

    /// `[w/L, u/L]` of the tip under a load, and the load steps that failed.
    fn bend(&self, load: &[f64], n_increments: usize) -> ([f64; 2], usize) {
        self.bend_within(40, load, n_increments)
    }

    /// The same with so many iterations to an increment.
    fn bend_within(
        &self,
        max_iterations: usize,
        load: &[f64],
        n_increments: usize,
    ) -> ([f64; 2], usize) {
        let settings = LargeSettings {
            max_iterations,
            ..LargeSettings::conserving().with_tolerance(1e-9)
        };
        let mut solver = LoadStepper::new(Arc::clone(&self.model), settings).expect("settings");
        let mut x = self.model.rest_positions().to_vec();
        let case = LoadCase {
            from: &vec![0.0; load.len()],
            to: load,
            is_held: &self.is_held,
            places: &x.clone(),
            n_increments,
        };
        let report = solver
            .solve(case, &mut x)
            .expect("the strip finds its equilibrium");
        assert!(report.residual <= 1e-9);
        let rest = self.model.rest_positions();
        let (tip_x, tip_y) = (2 * self.tip, 2 * self.tip + 1);
        let moved = [rest[tip_y] - x[tip_y], rest[tip_x] - x[tip_x]];
        (moved, report.n_cutbacks)
    }
}

/// Benchmark B40: the elastica under a tip load α = P L²/EI.
///
/// ```text
///  |=========  P        w/L, u/L by elliptic integrals; a strip's shear and stretch differ from the rod's
///  |         \ v        by some (h/L)²
/// ```
#[test]
fn a_clamped_strip_bends_like_the_elastica() {
    let known = [
        (1.0, [0.301720774, 0.056433236]),
        (2.0, [0.493457480, 0.160641721]),
        (5.0, [0.713791524, 0.387628361]),
        (10.0, [0.810609025, 0.554995598]),
    ];
    for law in [0, 3] {
        let strip = Strip::new(law);
        for (alpha, expected) in known {
            let mut load = vec![0.0; strip.model.n_dofs()];
            load[2 * strip.tip + 1] = -alpha * BENDING;
            let (found, _) = strip.bend(&load, 8);
            for (found, expected) in found.into_iter().zip(expected) {
                let error = found / expected - 1.0;
                println!("law {law} alpha {alpha}: {:+.4} %", 100.0 * error);
                assert!(error.abs() < 5e-4, "law {law}, alpha {alpha}: {error:e}");
            }
        }
    }
}

/// The same of quadrilaterals, whose hourglass modes bend: chords of 50 and 100 cells to a curve, some (L/n)² short of it.
#[test]
fn a_strip_of_quadrilaterals_bends_like_the_elastica() {
    let known = [
        (1.0, [0.301720774, 0.056433236]),
        (10.0, [0.810609025, 0.554995598]),
    ];
    for (alpha, expected) in known {
        let errors = [50, 100].map(|n| {
            let strip = Strip::of_cells(2, CellKind::Quad4, [n, 2]);
            let mut load = vec![0.0; strip.model.n_dofs()];
            load[2 * strip.tip + 1] = -alpha * BENDING;
            let (found, _) = strip.bend(&load, 8);
            let pairs = found.into_iter().zip(expected);
            let errors = pairs.map(|(found, expected)| (found / expected - 1.0).abs());
            errors.fold(0.0, f64::max)
        });
        println!("alpha {alpha}: {errors:?}");
        assert!(
            errors[0] < 2e-3 && errors[1] < 0.5 * errors[0],
            "{errors:?}"
        );
    }
}

/// Benchmark B41: the same strip under its own weight, q L³/EI = 10.
#[test]
fn a_clamped_strip_hangs_down_like_the_elastica_under_its_own_weight() {
    let strip = Strip::new(0);
    let mass: f64 = strip.model.masses().iter().sum();
    let per_mass = 10.0 * BENDING / mass;
    let masses = strip.model.masses().iter();
    let load: Vec<f64> = masses.flat_map(|mass| [0.0, -per_mass * mass]).collect();
    let (found, _) = strip.bend(&load, 8);
    for (found, expected) in found.into_iter().zip([0.700199716, 0.343646239]) {
        let error = found / expected - 1.0;
        println!("{:+.4} %", 100.0 * error);
        // The mass of a cell sits at its nodes: some (1/50)² of the load acts elsewhere.
        assert!(error.abs() < 5e-4, "{error:e}");
    }
}

/// Benchmark B43: a column between two pins, pressed together until its ends have turned by 20° to 80°.
///
/// ```text
///  P -> o-----------o <- P        ends move in by 1 - chord/L; P/Pcr by elliptic integrals
/// ```
#[test]
fn a_buckled_column_bears_the_load_of_the_elastica() {
    let known = [
        (0.969730907, 1.01539687, 0.109706521),
        (0.881203512, 1.06366327, 0.211120170),
        (0.741019606, 1.15171962, 0.296603823),
        (0.559395919, 1.29388932, 0.359748552),
    ];
    let law = Arc::clone(&laws(YOUNG, 0.0)[0]);
    let model = Arc::new(plate([1.0, HEIGHT], [50, 1], CellKind::Tri6, law));
    let at = |x: f64| {
        let is_there = |[a, b]: [f64; 2]| (a - x).abs() < 1e-9 && (b - 0.5 * HEIGHT).abs() < 1e-9;
        nodes_where(&model, is_there)[0]
    };
    let (left, middle, right) = (at(0.0), at(0.5), at(1.0));
    let is_held = flags(&model, [2 * left, 2 * left + 1, 2 * right, 2 * right + 1]);
    let zeros = vec![0.0; model.n_dofs()];
    // A thousandth of the critical load pushes the column to its side and is taken off as it buckles.
    let critical = std::f64::consts::PI.powi(2) * BENDING;
    let mut push = zeros.clone();
    push[2 * middle + 1] = 1e-3 * critical;
    let settings = LargeSettings::conserving().with_tolerance(1e-9);
    let mut solver = LoadStepper::new(Arc::clone(&model), settings).expect("settings");
    let mut x = model.rest_positions().to_vec();
    let mut places = x.clone();
    let mut press = |chord: f64, from: &[f64], to: &[f64], x: &mut [f64]| {
        places[2 * right] = chord;
        let case = LoadCase {
            from,
            to,
            is_held: &is_held,
            places: &places,
            n_increments: 10,
        };
        solver
            .solve(case, x)
            .expect("the column is pressed together");
        -solver.reaction()[2 * right] / critical
    };
    press(1.0, &zeros, &push, &mut x);
    let mut from = &push;
    for (chord, load, deflection) in known {
        let found = press(chord, from, &zeros, &mut x);
        from = &zeros;
        let bent = x[2 * middle + 1] - 0.5 * HEIGHT;
        println!(
            "P/Pcr {:+.4} %, deflection {:+.4} %",
            100.0 * (found / load - 1.0),
            100.0 * (bent / deflection - 1.0)
        );
        // The strip's compression P/EA = 8e-5 and its shear of twice that.
        assert!((found / load - 1.0).abs() < 5e-4, "{found} for {load}");
        assert!(
            (bent / deflection - 1.0).abs() < 2e-3,
            "{bent} for {deflection}"
        );
    }
}

/// Benchmark B44, Lee's frame: pushed down at 24 from its corner until it snaps.
///
/// ```text
///        24  | P                EI = 1440, both ends hinged; load under the displacement v, limit load 1.855875
///   .--------v-----------o      of rods that do not stretch, at v = 48.735
///   |
///   |          120
///   o
/// ```
#[test]
fn lees_frame_bears_its_limit_load() {
    let thick: f64 = 0.2;
    let law = Corotated::plane_strain(12.0 * 1440.0 / thick.powi(3), 0.0);
    let description = FiniteStrainDescription::new(frame(thick, 60).expect("a frame"), law, 1.0);
    let model = Arc::new(FiniteStrainModel::assemble(description).expect("the frame is a body"));
    let at = |x: f64, y: f64| {
        let is_there = |[a, b]: [f64; 2]| (a - x).abs() < 1e-9 && (b - y).abs() < 1e-9;
        nodes_where(&model, is_there)[0]
    };
    let (foot, end, loaded) = (at(0.0, 0.0), at(120.0, 120.0), at(24.0, 120.0));
    let held = [2 * foot, 2 * foot + 1, 2 * end, 2 * end + 1, 2 * loaded + 1];
    let is_held = flags(&model, held);
    let zeros = vec![0.0; model.n_dofs()];
    let settings = LargeSettings::conserving().with_tolerance(1e-9);
    let mut solver = LoadStepper::new(Arc::clone(&model), settings).expect("settings");
    let mut x = model.rest_positions().to_vec();
    let mut places = x.clone();
    let mut push = |v: f64| {
        places[2 * loaded + 1] = 120.0 - v;
        let case = LoadCase {
            from: &zeros,
            to: &zeros,
            is_held: &is_held,
            places: &places,
            n_increments: 5,
        };
        solver
            .solve(case, &mut x)
            .expect("the frame is pushed down");
        (-solver.reaction()[2 * loaded + 1], x[2 * loaded] - 24.0)
    };
    // The corner, 1/1200 of a leg on either side of its centre, bends less than a rod would where the moment is large.
    for (v, expected) in [
        (10.0, 0.96440),
        (20.0, 1.34620),
        (30.0, 1.59553),
        (40.0, 1.78095),
    ] {
        let (found, _) = push(v);
        println!("v = {v}: {:+.3} %", 100.0 * (found / expected - 1.0));
        assert!(
            (found / expected - 1.0).abs() < 4e-3,
            "{v}: {found} for {expected}"
        );
    }
    let mut limit = (0.0, 0.0, 0.0);
    for k in 0..20 {
        let v = 47.0 + 0.2 * f64::from(k);
        let (found, u) = push(v);
        if found > limit.0 {
            limit = (found, v, u);
        }
    }
    println!(
        "limit {limit:?}: {:+.3} %",
        100.0 * (limit.0 / 1.855875 - 1.0)
    );
    assert!((limit.0 / 1.855875 - 1.0).abs() < 4e-3, "{}", limit.0);
    assert!(
        (limit.1 - 48.735).abs() < 0.3 && (limit.2 - 26.881).abs() < 0.3,
        "{limit:?}"
    );
}

/// A load that is too large for one increment is halved until it is not, and ends at the same place.
#[test]
fn load_increments_that_are_not_found_are_halved() {
    let strip = Strip::new(0);
    let mut load = vec![0.0; strip.model.n_dofs()];
    load[2 * strip.tip + 1] = -10.0 * BENDING;
    let (found, n_cutbacks) = strip.bend_within(11, &load, 1);
    let (expected, _) = strip.bend(&load, 16);
    assert!(n_cutbacks > 0);
    for (found, expected) in found.into_iter().zip(expected) {
        // A residual of 1e-9 of the load, times a compliance that falls with the deflection.
        assert!((found - expected).abs() < 1e-8, "{found} for {expected}");
    }
}

/// A plate whose whole boundary goes straight to where it is turned by a radian and stretched: all of it is affine there, however thin its cells are and
/// however few the increments, and none is cut. What is inside goes along, or cells at the boundary would turn over.
#[test]
fn what_is_held_all_around_goes_along() {
    for kind in KINDS {
        for (aspect, n_increments) in [(0.03, 1), (1.0, 1), (10.0, 4), (30.0, 30)] {
            let law = Arc::clone(&laws(1e6, 0.3)[2]);
            let model = plate([aspect, 1.0], [4, 4], kind, law);
            let rest = model.rest_positions().to_vec();
            let is_held: Vec<bool> = (0..rest.len())
                .map(|dof| model.mesh().boundary().is_boundary(dof / 2))
                .collect();
            let (cos, sin) = (1.01 * 1f64.cos(), 1.01 * 1f64.sin());
            let turned = |x: &[f64]| [cos * x[0] - sin * x[1], sin * x[0] + cos * x[1]];
            let places: Vec<f64> = rest.chunks_exact(2).flat_map(turned).collect();
            let zeros = vec![0.0; rest.len()];
            let case = LoadCase {
                from: &zeros,
                to: &zeros,
                is_held: &is_held,
                places: &places,
                n_increments,
            };
            let mut positions = rest;
            let mut stepper =
                LoadStepper::new(model, LargeSettings::conserving()).expect("settings");
            let report = stepper
                .solve(case, &mut positions)
                .expect("an affine place");
            assert_eq!(report.n_cutbacks, 0, "{kind:?}, {aspect}, {n_increments}");
            for (x, place) in positions.iter().zip(&places) {
                let off = (x - place).abs();
                assert!(
                    off < 1e-6 * aspect.max(1.0),
                    "{kind:?}, {aspect}, {n_increments}: {off:e} m"
                );
            }
        }
    }
}

/// Benchmark B45: a neo-Hookean block in plane strain, pulled or pressed by rollers along x, its sides free.
///
/// `W = μ/2 (I1 - 3) - μ ln J + λ/2 ln² J`, E = 1, ν = .3: nominal stress P/E at the stretch λ1.
#[test]
fn a_neo_hookean_block_has_the_digits_of_homogeneous_strain() {
    let known = [
        (0.5, -1.084407463),
        (0.7, -0.4584239232),
        (1.3, 0.2672962551),
        (2.0, 0.6745973555),
    ];
    for kind in KINDS {
        for (stretch, expected) in known {
            let law = Arc::clone(&laws(1.0, 0.3)[2]);
            let model = plate([1.0, 1.0], [3, 3], kind, law);
            let (stress, side) = pull(model, stretch);
            println!("{kind:?} {stretch}: {:e}", stress / expected - 1.0);
            assert!(
                (stress / expected - 1.0).abs() < 1e-8,
                "{kind:?} {stretch}: {stress}"
            );
            if stretch == 0.5 {
                assert!((side - 1.288304972).abs() < 1e-8, "{side}");
            }
        }
    }
}

/// The nominal stress of a unit block of this stretch along x, and its stretch along y.
pub fn pull(model: FiniteStrainModel, stretch: f64) -> (f64, f64) {
    let left = nodes_where(&model, |[x, _]| x == 0.0);
    let right = nodes_where(&model, |[x, _]| x == 1.0);
    let lower = nodes_where(&model, |[_, y]| y == 0.0);
    let upper = nodes_where(&model, |[_, y]| y == 1.0);
    let sides = left.iter().chain(&right).map(|node| 2 * node);
    let is_held = flags(&model, sides.chain(lower.iter().map(|node| 2 * node + 1)));
    let mut places = model.rest_positions().to_vec();
    right.iter().for_each(|node| places[2 * node] = stretch);
    let zeros = vec![0.0; model.n_dofs()];
    let settings = LargeSettings::conserving().with_tolerance(1e-11);
    let mut positions = model.rest_positions().to_vec();
    let mut solver = LoadStepper::new(model, settings).expect("settings");
    let case = LoadCase {
        from: &zeros,
        to: &zeros,
        is_held: &is_held,
        places: &places,
        n_increments: 4,
    };
    solver
        .solve(case, &mut positions)
        .expect("homogeneous strain is found");
    let force = right.iter().map(|node| solver.reaction()[2 * node]).sum();
    (force, positions[2 * upper[0] + 1])
}

/// A block that is pushed up and held by nothing has no equilibrium: that is an error, and nothing has moved.
#[test]
fn an_equilibrium_that_does_not_exist_is_an_error_that_leaves_the_body() {
    let description = describe(
        [1.0, 1.0],
        [2, 2],
        CellKind::Tri3,
        Arc::clone(&laws(1e5, 0.3)[2]),
    );
    let model = FiniteStrainModel::assemble(description).expect("a good body");
    let zeros = vec![0.0; model.n_dofs()];
    let mut load = zeros.clone();
    load[1] = 10.0;
    let mut positions = model.rest_positions().to_vec();
    let case = LoadCase {
        from: &zeros,
        to: &load,
        is_held: &vec![false; model.n_dofs()],
        places: &zeros,
        n_increments: 1,
    };
    let rest = positions.clone();
    let mut solver = LoadStepper::new(model, LargeSettings::conserving()).expect("settings");
    let error = solver
        .solve(case, &mut positions)
        .expect_err("nothing holds the body");
    assert_eq!(error, LargeError::Singular { factor: 0.0 }, "{error}");
    assert_eq!(positions, rest);
}

/// One solver serves cases that hold other dofs: what is held in the second one does not move by what the first has left behind.
#[test]
fn a_solver_takes_cases_that_hold_other_dofs() {
    let law = Arc::clone(&laws(1e5, 0.3)[3]);
    let model = plate([1.0, 1.0], [2, 2], CellKind::Tri6, law);
    let lower = nodes_where(&model, |[_, y]| y == 0.0);
    let left = nodes_where(&model, |[x, _]| x == 0.0);
    let zeros = vec![0.0; model.n_dofs()];
    let rest = model.rest_positions().to_vec();
    let mut load = zeros.clone();
    let corner = nodes_where(&model, |[x, y]| x == 1.0 && y == 1.0)[0];
    load[2 * corner] = 1e3;
    let settings = LargeSettings::conserving().with_tolerance(1e-10);
    let shared = Arc::new(model);
    let solve = |solver: &mut LoadStepper, held: &[usize]| {
        let mut x = rest.clone();
        let case = LoadCase {
            from: &zeros,
            to: &load,
            is_held: &flags(
                &shared,
                held.iter().flat_map(|node| [2 * node, 2 * node + 1]),
            ),
            places: &rest,
            n_increments: 2,
        };
        solver.solve(case, &mut x).expect("the block leans over");
        x
    };
    let mut used = LoadStepper::new(Arc::clone(&shared), settings).expect("settings");
    solve(&mut used, &lower);
    let mut new = LoadStepper::new(Arc::clone(&shared), settings).expect("settings");
    assert_eq!(solve(&mut used, &left), solve(&mut new, &left));
}
