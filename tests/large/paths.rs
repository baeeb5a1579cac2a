//! Equilibria along paths: past limit points, with forces that turn with the body, and what is refused.

use super::frame::frame;
use super::support::{laws, nodes_where, plate};
use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel, Form};
use foil2d::fe::material::hyperelastic::Corotated;
use foil2d::fe::mesh::{CellKind, Mesh};
use foil2d::large::{
    FollowerForce, LargeError, LargeSettings, LoadCase, LoadStepper, PathCase, PathEnd,
    PathSettings, PathStepper,
};
use std::sync::Arc;

fn flags(n_dofs: usize, dofs: &[usize]) -> Vec<bool> {
    let mut is_held = vec![false; n_dofs];
    dofs.iter().for_each(|&dof| is_held[dof] = true);
    is_held
}

fn node_at(model: &FiniteStrainModel, [x, y]: [f64; 2]) -> usize {
    let is_there = |[a, b]: [f64; 2]| (a - x).hypot(b - y) < 1e-9 * (1.0 + x.hypot(y));
    nodes_where(model, is_there)[0]
}

fn exactly() -> PathSettings {
    PathSettings {
        tolerance: 1e-10,
        ..PathSettings::default()
    }
}

/// A block of St. Venant and Kirchhoff's law pressed by a dead load, its sides guided: `P = E λ (λ² - 1)/2` to the digits, beyond the least
/// load -.1924500897 E at λ = 1/√3 and on while it falls.
///
/// It is one cell long: of several, each could go on alone from there.
#[test]
fn a_pressed_block_passes_its_limit_load() {
    for kind in [CellKind::Tri3, CellKind::Quad4] {
        let model = plate([1.0, 1.0], [1, 3], kind, Arc::clone(&laws(1.0, 0.0)[1]));
        let rest = model.rest_positions().to_vec();
        let right = nodes_where(&model, |[x, _]| x == 1.0);
        let left = nodes_where(&model, |[x, _]| x == 0.0);
        let guided = (0..model.n_nodes()).map(|node| 2 * node + 1);
        let held: Vec<usize> = left.iter().map(|node| 2 * node).chain(guided).collect();
        // The load of the pressed side as its nodes feel a uniform stress.
        let pressed: Vec<usize> = right.iter().map(|node| 2 * node).collect();
        let mut load = vec![0.0; rest.len()];
        let mut deformation = model.deformation(&rest);
        let stretched: Vec<f64> = rest
            .chunks_exact(2)
            .flat_map(|p| [1.5 * p[0], p[1]])
            .collect();
        model
            .subtract_force(Form::Equilibrium, &stretched, &mut deformation, &mut load)
            .expect("no cell is turned over");
        let whole: f64 = pressed.iter().map(|&dof| load[dof]).sum();
        for (dof, load) in load.iter_mut().enumerate() {
            *load = if pressed.contains(&dof) {
                -*load / whole
            } else {
                0.0
            };
        }
        let case = PathCase::dead(load, flags(rest.len(), &held), &rest);
        let settings = PathSettings {
            tolerance: 1e-12,
            first: 0.02,
            ..PathSettings::default()
        };
        let mut path = PathStepper::new(model, case, &rest, settings).expect("a case");
        let dof = pressed[0];
        for stretch in [0.9, 0.7, 0.5, 0.3, 0.1] {
            let end = PathEnd::Place {
                dof,
                place: stretch,
            };
            let point = path.follow(end).expect("the block is pressed");
            let expected = 0.5 * stretch * (1.0 - stretch * stretch);
            let error = point.factor / expected - 1.0;
            assert!(error.abs() < 1e-9, "{kind:?} {stretch}: {error:e}");
            assert_eq!(point.is_stable, stretch > 0.578);
            assert_eq!(point.rate > 0.0, stretch > 0.578);
            assert_eq!(point.n_limit_points, usize::from(stretch < 0.577));
        }
        let [limit] = path.limit_points() else {
            panic!("one limit point: {}", path.limit_points().len());
        };
        let error = limit.factor / 0.192_450_089_729_875_25 - 1.0;
        println!("{kind:?}: limit {error:e}, {:?}", path.report());
        assert!(limit.is_maximum && error.abs() < 1e-10, "{error:e}");
        let place = limit.positions[dof] * 3f64.sqrt() - 1.0;
        assert!(place.abs() < 1e-5, "{place:e}");
        assert!(path.report().residual <= 1e-12);
    }
}

/// Lee's frame under a load 24 from its corner, EI = 1440.
struct Lee {
    path: PathStepper,
    loaded: usize,
}

fn lee(unit: f64, renumber: bool) -> Lee {
    let thick: f64 = 0.2;
    let mut mesh = frame(thick, 60).expect("a frame");
    if renumber {
        mesh = reversed(&mesh);
    }
    let nodes = mesh.nodes().iter().map(|x| x.map(|x| unit * x));
    let cells: Vec<&[usize]> = mesh.cells().map(|cell| cell.nodes).collect();
    let mesh = Mesh::from_cells(nodes.collect(), CellKind::Tri6, &cells).expect("a frame");
    let law = Corotated::plane_strain(12.0 * 1440.0 / thick.powi(3), 0.0);
    let description = FiniteStrainDescription::new(mesh, law, 1.0);
    let model = FiniteStrainModel::assemble(description).expect("the frame is a body");
    let at = |x: f64, y: f64| node_at(&model, [unit * x, unit * y]);
    let (foot, end, loaded) = (at(0.0, 0.0), at(120.0, 120.0), at(24.0, 120.0));
    let held = [2 * foot, 2 * foot + 1, 2 * end, 2 * end + 1];
    let rest = model.rest_positions().to_vec();
    let mut load = vec![0.0; rest.len()];
    load[2 * loaded + 1] = -unit;
    let case = PathCase::dead(load, flags(rest.len(), &held), &rest);
    let path = PathStepper::new(model, case, &rest, PathSettings::default()).expect("a case");
    Lee { path, loaded }
}

fn reversed(mesh: &Mesh) -> Mesh {
    let n = mesh.n_nodes();
    let nodes: Vec<[f64; 2]> = mesh.nodes().iter().rev().copied().collect();
    let cells = mesh.cells().map(|cell| {
        let nodes = cell.nodes.iter().map(|node| n - 1 - node);
        nodes.collect::<Vec<usize>>()
    });
    let cells: Vec<Vec<usize>> = cells.collect();
    Mesh::from_cells(nodes, CellKind::Tri6, &cells).expect("a mesh")
}

/// Benchmark B44 by the load itself: up to the limit load 1.855875 of rods that do not stretch, down to a negative one, and up again.
#[test]
fn lees_frame_snaps_through_and_back() {
    let Lee { mut path, loaded } = lee(1.0, false);
    for (v, expected) in [
        (10.0, 0.96440),
        (20.0, 1.34620),
        (30.0, 1.59553),
        (40.0, 1.78095),
    ] {
        let end = PathEnd::Place {
            dof: 2 * loaded + 1,
            place: 120.0 - v,
        };
        let point = path.follow(end).expect("the frame gives way");
        let error = point.factor / expected - 1.0;
        println!("v = {v}: {:+.3} %", 100.0 * error);
        assert!(error.abs() < 4e-3 && point.is_stable);
    }
    // The load falls, turns, and grows beyond what it was.
    let point = path.follow(PathEnd::Factor(3.0)).expect("and comes back");
    assert!(point.rate > 0.0 && point.is_stable);
    println!("{:?}", path.report());
    let [upper, lower] = path.limit_points() else {
        panic!("two limit points: {}", path.limit_points().len());
    };
    let place = |positions: &[f64]| {
        [
            positions[2 * loaded] - 24.0,
            120.0 - positions[2 * loaded + 1],
        ]
    };
    let [u, v] = place(&upper.positions);
    println!("limit {:.6} at {v:.4}, {u:.4}", upper.factor);
    // Of such rods, by shooting: -.942128 at 90.211, 58.200.
    assert!((lower.factor / -0.942128 - 1.0).abs() < 1.2e-2);
    println!("least {:.6} at {:?}", lower.factor, place(&lower.positions));
    assert!(upper.is_maximum && !lower.is_maximum && lower.factor < 0.0);
    assert!((upper.factor / 1.855875 - 1.0).abs() < 4e-3);
    assert!(
        (v - 48.735).abs() < 0.15 && (u - 26.881).abs() < 0.15,
        "{u} {v}"
    );
}

#[test]
fn units_and_numbers_do_not_change_a_path() {
    let [plain, scaled, renumbered] = [(1.0, false), (1e-3, false), (1.0, true)].map(|(u, r)| {
        let Lee { mut path, .. } = lee(u, r);
        for _ in 0..12 {
            path.advance().expect("the frame gives way");
        }
        (path.point().factor, path.report().n_iterations)
    });
    // Rounding of positions bends a leg of 600 times its thickness by some 1e-6 of its length.
    for other in [scaled, renumbered] {
        let error = (other.0 / plain.0 - 1.0).abs();
        assert!(error < 3e-5 && other.1 == plain.1, "{other:?} {plain:?}");
    }
}

const YOUNG: f64 = 1.2e7;
const HEIGHT: f64 = 0.01;
const BENDING: f64 = YOUNG * HEIGHT * HEIGHT * HEIGHT / 12.0;

/// A strip of h/L = 1/100, clamped at x = 0, and its tip.
fn strip() -> (FiniteStrainModel, Vec<bool>, usize) {
    let law = Arc::clone(&laws(YOUNG, 0.0)[0]);
    let model = plate([1.0, HEIGHT], [50, 1], CellKind::Tri6, law);
    let clamped = nodes_where(&model, |[x, _]| x == 0.0);
    let dofs: Vec<usize> = clamped
        .into_iter()
        .flat_map(|n| [2 * n, 2 * n + 1])
        .collect();
    let tip = node_at(&model, [1.0, 0.5 * HEIGHT]);
    let is_held = flags(model.n_dofs(), &dofs);
    (model, is_held, tip)
}

/// Benchmark B42: a force that stays normal to the tip of a strip, P L²/EI = 1, 2, 4, 8.
#[test]
fn a_strip_coils_up_under_a_force_that_turns_with_its_tip() {
    let (model, is_held, tip) = strip();
    let ends = [0.0, HEIGHT].map(|y| node_at(&model, [1.0, y]));
    let rest = model.rest_positions().to_vec();
    let case = PathCase {
        followers: vec![FollowerForce {
            node: tip,
            line: ends,
            // The line goes up the end of the strip: along it is normal to the strip.
            force: [BENDING, 0.0],
        }],
        ..PathCase::dead(vec![0.0; rest.len()], is_held, &rest)
    };
    let mut path = PathStepper::new(model, case, &rest, exactly()).expect("a case");
    for (load, expected) in [
        (1.0, [0.935645669, 0.320641995, 0.495884642]),
        (2.0, [0.767362192, 0.573839063, 0.968238803]),
        (4.0, [0.342745786, 0.786168426, 1.776435814]),
        (8.0, [-0.073862981, 0.633592114, 2.756554078]),
    ] {
        let point = path.follow(PathEnd::Factor(load)).expect("the strip bends");
        assert_eq!(point.factor, load);
        let x = path.positions();
        let across = [0, 1].map(|k| x[2 * ends[1] + k] - x[2 * ends[0] + k]);
        let angle = (-across[0]).atan2(across[1]);
        let found = [x[2 * tip], x[2 * tip + 1] - 0.5 * HEIGHT, angle];
        for (found, expected) in found.into_iter().zip(expected) {
            println!(
                "{load}: {found:.6} for {expected:.6}, {:+.1e}",
                found - expected
            );
            // The strip's stretch and shear, (h/L)² of what it is long.
            assert!(
                (found - expected).abs() < 5e-4,
                "{load}: {found} {expected}"
            );
        }
    }
    println!("{:?}", path.report());
}

/// Displacement control is a path of places, and gives what the load stepper gives.
#[test]
fn places_along_a_path_are_displacement_control() {
    let (model, mut is_held, tip) = strip();
    let model = Arc::new(model);
    is_held[2 * tip + 1] = true;
    let rest = model.rest_positions().to_vec();
    let mut places = rest.clone();
    places[2 * tip + 1] -= 0.7;
    let case = PathCase::places(places.clone(), is_held.clone());
    let mut path = PathStepper::new(Arc::clone(&model), case, &rest, exactly()).expect("a case");
    path.follow(PathEnd::Factor(1.0))
        .expect("the tip is pulled down");
    let settings = LargeSettings::conserving().with_tolerance(1e-11);
    let mut solver = LoadStepper::new(model, settings).expect("settings");
    let zeros = vec![0.0; rest.len()];
    let mut positions = rest.clone();
    let case = LoadCase {
        from: &zeros,
        to: &zeros,
        is_held: &is_held,
        places: &places,
        n_increments: 10,
    };
    solver
        .solve(case, &mut positions)
        .expect("the tip is pulled down");
    for (found, expected) in path.positions().iter().zip(&positions) {
        assert!((found - expected).abs() < 1e-8, "{found} {expected}");
    }
    let [found, expected] = [path.reaction(), solver.reaction()].map(|r| r[2 * tip + 1]);
    assert!((found / expected - 1.0).abs() < 1e-7, "{found} {expected}");
}

/// A straight column goes on being straight beyond its critical load, and the path tells that it would not stay so.
#[test]
fn a_straight_column_is_told_to_be_unstable_beyond_its_critical_load() {
    let (model, is_held, _) = strip();
    let rest = model.rest_positions().to_vec();
    let critical = std::f64::consts::PI.powi(2) * BENDING / 4.0;
    let mut load = vec![0.0; rest.len()];
    // Simpson's shares of a uniform pressure.
    for (y, share) in [(0.0, 1.0), (0.5 * HEIGHT, 4.0), (HEIGHT, 1.0)] {
        load[2 * node_at(&model, [1.0, y])] = -critical * share / 6.0;
    }
    let case = PathCase::dead(load, is_held, &rest);
    let mut path = PathStepper::new(model, case, &rest, exactly()).expect("a case");
    let mut turned = Vec::new();
    let mut before = 0.0;
    while path.point().factor < 2.0 {
        let was_stable = path.point().is_stable;
        let end = path.point().factor + 0.02;
        let point = path
            .follow(PathEnd::Factor(end))
            .expect("the column is pressed");
        if was_stable && !point.is_stable {
            turned.push((before, point.factor));
        }
        before = point.factor;
        assert_eq!(point.n_limit_points, 0);
    }
    let [(below, above)] = turned[..] else {
        panic!("{turned:?}");
    };
    assert!(below < 1.005 && above > 0.995, "{below} {above}");
}

/// A straight column of a mesh with its symmetry: its path crosses the bent one at Euler's load `π²EI/4L²`, but for its shear and its shortening, both of the order of
/// (h/L)² = 4e-4. Over there it is stable, on both sides alike, and at an end slope of 40° under the load of the elastica, 1.06366327 Euler's.
#[test]
fn a_straight_column_is_led_onto_its_bent_path_at_eulers_load() {
    let model = plate(
        [1.0, 0.02],
        [30, 1],
        CellKind::Quad8,
        Arc::clone(&laws(12.0 / 0.02f64.powi(3), 0.0)[0]),
    );
    let rest = model.rest_positions().to_vec();
    let is_held: Vec<bool> = rest
        .chunks_exact(2)
        .flat_map(|x| [x[0] == 0.0; 2])
        .collect();
    let critical = std::f64::consts::PI.powi(2) / 4.0;
    let mut load = vec![0.0; rest.len()];
    for (y, share) in [(0.0, 1.0), (0.01, 4.0), (0.02, 1.0)] {
        load[2 * node_at(&model, [1.0, y])] = -critical * share / 6.0;
    }
    let tip = node_at(&model, [1.0, 0.01]);
    let corners = [0.0, 0.02].map(|y| node_at(&model, [1.0, y]));
    let case = PathCase::dead(load, is_held, &rest);
    let mut path = PathStepper::new(model, case, &rest, exactly()).expect("a case");
    let branch = path.follow_to_branch().expect("a crossing");
    assert!((branch.factor - 1.0).abs() < 1e-3, "{}", branch.factor);
    assert!(path.limit_points().is_empty());
    let [along, across] = [0, 1].map(|axis| branch.mode[2 * tip + axis].abs());
    assert!(across > 0.99 && along < 1e-3, "{along} {across}");
    let refused = path.switch(&branch, 0.0).expect_err("no deflection");
    assert!(matches!(refused, LargeError::Setting { .. }));
    let mut factors = Vec::new();
    for side in [1.0, -1.0] {
        let mut path = path.clone();
        let point = path.switch(&branch, 0.05 * side).expect("the bent path");
        assert!(point.is_stable && point.factor > branch.factor && point.rate > 0.0);
        // Half of a column between hinges, bent to 40° at its end.
        let place = 0.01 + side * 2.0 * 0.211120170;
        let point = path
            .follow(PathEnd::Place {
                dof: 2 * tip + 1,
                place,
            })
            .expect("it bends on");
        factors.push(point.factor);
        let x = path.positions();
        let turned = (x[2 * corners[1]] - x[2 * corners[0]]).abs() / 0.02;
        assert!((turned.asin().to_degrees() - 40.0).abs() < 0.1, "{turned}");
    }
    assert!((factors[0] / 1.06366327 - 1.0).abs() < 1e-3, "{factors:?}");
    assert!((factors[0] - factors[1]).abs() < 1e-7, "{factors:?}");
}

/// The more slender a column, the farther from its crossing rounding turns the tangent of its path onto the other one: wherever increments end, it is
/// found, and the bent path goes on from there.
#[test]
fn the_crossing_of_a_slender_column_is_found_by_increments_of_any_length() {
    for (thickness, n_cells) in [(0.02, 30), (0.005, 80)] {
        let model = plate(
            [1.0, thickness],
            [n_cells, 2],
            CellKind::Quad4,
            Arc::clone(&laws(12.0 / f64::powi(thickness, 3), 0.0)[0]),
        );
        let rest = model.rest_positions().to_vec();
        let is_held: Vec<bool> = rest
            .chunks_exact(2)
            .flat_map(|x| [x[0] == 0.0; 2])
            .collect();
        let mut load = vec![0.0; rest.len()];
        for (y, share) in [(0.0, 0.25), (0.5 * thickness, 0.5), (thickness, 0.25)] {
            load[2 * node_at(&model, [1.0, y])] = -std::f64::consts::PI.powi(2) / 4.0 * share;
        }
        for k in 0..25 {
            let first = 0.02 + 0.004 * f64::from(k);
            let case = PathCase::dead(load.clone(), is_held.clone(), &rest);
            let settings = PathSettings {
                first,
                ..PathSettings::default()
            };
            let mut path = PathStepper::new(model.clone(), case, &rest, settings).expect("a case");
            let branch = path.follow_to_branch();
            let branch = branch.unwrap_or_else(|error| panic!("{thickness} m, {first}: {error}"));
            assert!(
                (branch.factor - 1.0).abs() < 2e-3,
                "{thickness} m, {first}: {}",
                branch.factor
            );
            let bent = path.switch(&branch, 0.05).expect("the bent path");
            assert!(bent.is_stable, "{thickness} m, {first}");
        }
    }
}

#[test]
fn what_leads_nowhere_is_refused_and_nothing_moves() {
    let (model, is_held, tip) = strip();
    let model = Arc::new(model);
    let rest = model.rest_positions().to_vec();
    let n_dofs = rest.len();
    let mut load = vec![0.0; n_dofs];
    load[2 * tip + 1] = -BENDING;
    let dead = || PathCase::dead(load.clone(), is_held.clone(), &rest);
    let refused = |case: PathCase, settings: PathSettings| match PathStepper::new(
        Arc::clone(&model),
        case,
        &rest,
        settings,
    ) {
        Ok(_) => panic!("not refused"),
        Err(error) => error,
    };
    let plain = PathSettings::default();
    let free = PathCase::dead(load.clone(), vec![false; n_dofs], &rest);
    let error = refused(free, plain);
    assert!(matches!(error, LargeError::Singular { .. }), "{error}");
    let still = PathCase::dead(vec![0.0; n_dofs], is_held.clone(), &rest);
    assert_eq!(refused(still, plain), LargeError::Still);
    let short = PathCase::dead(vec![0.0; 4], is_held.clone(), &rest);
    assert!(matches!(refused(short, plain), LargeError::Length { .. }));
    for settings in [
        PathSettings {
            tolerance: 0.0,
            ..plain
        },
        PathSettings {
            first: 0.0,
            ..plain
        },
        PathSettings {
            longest: f64::NAN,
            ..plain
        },
        PathSettings {
            max_iterations: 0,
            ..plain
        },
        PathSettings {
            max_cutbacks: 99,
            ..plain
        },
    ] {
        assert!(matches!(
            refused(dead(), settings),
            LargeError::Setting { .. }
        ));
    }
    for line in [[tip, tip], [tip, 9999]] {
        let followers = vec![FollowerForce {
            node: tip,
            line,
            force: [1.0, 0.0],
        }];
        let case = PathCase {
            followers,
            ..dead()
        };
        assert_eq!(refused(case, plain), LargeError::Follower { index: 0 });
    }
    let settings = PathSettings {
        max_increments: 3,
        ..plain
    };
    let mut path = PathStepper::new(Arc::clone(&model), dead(), &rest, settings).expect("a case");
    let error = path
        .follow(PathEnd::Factor(-1.0))
        .expect_err("the load grows");
    assert!(matches!(
        error,
        LargeError::Unreached {
            n_increments: 3,
            ..
        }
    ));
    // One iteration is not enough for any increment.
    let settings = PathSettings {
        max_iterations: 1,
        max_cutbacks: 2,
        tolerance: 1e-12,
        ..plain
    };
    let mut path = PathStepper::new(model, dead(), &rest, settings).expect("a case");
    let error = path.advance().expect_err("too few iterations");
    assert!(matches!(error, LargeError::NotConverged { .. }), "{error}");
    assert_eq!(path.positions(), rest);
    assert_eq!(path.point().factor, 0.0);
}
