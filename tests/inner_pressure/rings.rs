//! Rings under pressure: radii with known answers, and rings that fly.

use super::support::{KINDS, ring, soft_ring};
use foil2d::fe::finite_strain::{FiniteStrainDescription, FiniteStrainModel, InnerPressure};
use foil2d::fe::material::hyperelastic::StableNeoHookean;
use foil2d::fe::mesh::generate::{self, PolygonOptions};
use foil2d::fe::mesh::{CellKind, Mesh};
use foil2d::large::{LargeSettings, LargeStepper, LoadCase, LoadReport, LoadStepper, WorldMotion};
use std::sync::Arc;

/// Mean radius (m) of the nodes whose undeformed radius is this (m).
fn radius(model: &FiniteStrainModel, at: &[f64], rest: f64) -> f64 {
    let pairs = model
        .rest_positions()
        .chunks_exact(2)
        .zip(at.chunks_exact(2));
    let found: Vec<f64> = pairs
        .filter(|(at_rest, _)| (at_rest[0].hypot(at_rest[1]) - rest).abs() < 1e-9)
        .map(|(_, at)| at[0].hypot(at[1]))
        .collect();
    found.iter().sum::<f64>() / found.len() as f64
}

/// Finds the equilibrium of a ring from near `at` (m); its rigid motions are held at three dofs of nodes on its axes.
fn inflate(model: &FiniteStrainModel, n_around: usize, at: &mut [f64]) -> LoadReport {
    let n = model.n_dofs();
    let mut is_held = vec![false; n];
    // Nodes on the x axis keep their height, one on the y axis its side.
    for node in [0, n_around / 2] {
        is_held[2 * node + 1] = true;
    }
    is_held[2 * (n_around / 4)] = true;
    let zero = vec![0.0; n];
    let case = LoadCase {
        from: &zero,
        to: &zero,
        is_held: &is_held,
        places: model.rest_positions(),
        n_increments: 1,
    };
    let settings = LargeSettings::conserving().with_tolerance(1e-9);
    let mut stepper = LoadStepper::new(model.clone(), settings).expect("settings");
    stepper.solve(case, at).expect("an equilibrium")
}

fn inflated(model: &FiniteStrainModel, n_around: usize) -> (Vec<f64>, LoadReport) {
    let mut at = model.rest_positions().to_vec();
    let report = inflate(model, n_around, &mut at);
    (at, report)
}

/// Lamé's thick cylinder in plane strain: `u(Ri) = p Ri (1 - ν²)/E [(Ro² + Ri²)/(Ro² - Ri²) + ν/(1 - ν)]`. Tri6 with curved sides take the circle for parabolas
/// and come within 1e-4; quadrilaterals see a polygon, whose error falls with the square of its sides.
#[test]
fn a_thick_ring_widens_as_lame_says() {
    let (young, poisson, p) = (1e6, 0.3, 10.0);
    let ([inner, outer], lateral) = ([0.2, 0.4], 1.0 - poisson * poisson);
    let shape = (outer * outer + inner * inner) / (outer * outer - inner * inner);
    let expected = p * inner * lateral / young * (shape + poisson / (1.0 - poisson));
    let error = |kind, divisions: [usize; 2]| {
        let pressure = InnerPressure::constant(p);
        let model = ring([inner, outer], divisions, kind, poisson, pressure);
        let n_around = divisions[0];
        let (at, _) = inflated(&model, n_around);
        (radius(&model, &at, inner) - inner) / expected - 1.0
    };
    let [coarse, fine] = [
        error(CellKind::Quad4, [24, 4]),
        error(CellKind::Quad4, [48, 8]),
    ];
    assert!(
        coarse.abs() < 0.02 && fine.abs() < 0.3 * coarse.abs(),
        "{coarse:e} {fine:e}"
    );
    let curved = error(CellKind::Tri6, [24, 3]);
    assert!(curved.abs() < 3e-4, "{curved:e}");
}

/// A ring of a thirtieth of its radius: `u = p r²/(E' h)` of thin walls, with the mean radius, to the order of the thickness; Lamé to 1 %.
#[test]
fn a_thin_ring_widens_as_hoop_stress_says() {
    let (young, poisson, p, inner, outer) = (1e6, 0.3, 1.0, 0.295, 0.305);
    let pressure = InnerPressure::constant(p);
    let model = ring([inner, outer], [96, 1], CellKind::Tri6, poisson, pressure);
    let (at, _) = inflated(&model, 96);
    let (mean, wall) = (0.3, outer - inner);
    let thin = p * inner * mean * (1.0 - poisson * poisson) / (young * wall);
    let found = radius(&model, &at, inner) - inner;
    assert!((found / thin - 1.0).abs() < 0.02, "{found:e} {thin:e}");
    let shape = (outer * outer + inner * inner) / (outer * outer - inner * inner);
    let lame = p * inner * (1.0 - poisson * poisson) / young * (shape + poisson / (1.0 - poisson));
    assert!((found / lame - 1.0).abs() < 1e-3, "{found:e} {lame:e}");
}

/// The thick cylinder of a compressible neo-Hookean material, E = 1 MPa, ν = .45, radii .2 and .4 m, in plane strain: `dP_rr/dR + (P_rr - P_θθ)/R = 0` with `P_rr = -p r/R` at
/// the inner and 0 at the outer radius, by shooting with an eighth-order Runge–Kutta method (relative tolerance 1e-12): 2e5 Pa bring the radii to .4150911789 and .5448595930 m,
/// twice the inner one at rest.
#[test]
fn a_thick_ring_of_rubber_is_blown_up_as_its_equation_says() {
    let [inner, outer] = [0.415_091_178_920_162_5, 0.544_859_593_028_310_7];
    let n_around = 32;
    let errors = |through: usize| {
        let make = |p: f64| {
            let pressure = InnerPressure::constant(p);
            ring(
                [0.2, 0.4],
                [n_around, through],
                CellKind::Tri6,
                0.45,
                pressure,
            )
        };
        let mut at = make(0.0).rest_positions().to_vec();
        for pressure in [5e4, 1e5, 1.5e5, 1.8e5, 2e5] {
            inflate(&make(pressure), n_around, &mut at);
        }
        let model = make(0.0);
        [
            radius(&model, &at, 0.2) / inner - 1.0,
            radius(&model, &at, 0.4) / outer - 1.0,
        ]
    };
    let [coarse, fine] = [2, 3].map(errors);
    assert!(coarse.iter().all(|error| error.abs() < 2e-4), "{coarse:?}");
    assert!(fine.iter().all(|error| error.abs() < 5e-5), "{fine:?}");
}

/// A gas finds the equilibrium that a constant pressure has, if that is the pressure it has then; it takes no more iterations, as the matrix knows of it.
#[test]
fn a_gas_is_in_equilibrium_where_its_pressure_is() {
    for kind in KINDS {
        // Soft and at little pressure above that outside: the gas is a hundred times as stiff as the ring.
        let gas = InnerPressure::isothermal(3e3);
        let make = |pressure| ring([0.3, 0.305], [48, 1], kind, 0.3, pressure);
        let (at, report) = inflated(&make(gas), 48);
        let p = make(gas).hole_pressure(0, &at).expect("a hole");
        assert!(p > 0.0 && p < 3e3, "{kind:?} {p}");
        let (again, _) = inflated(&make(InnerPressure::constant(p)), 48);
        let far = at.iter().zip(&again).map(|(a, b)| (a - b).abs());
        assert!(far.fold(0.0, f64::max) < 1e-8, "{kind:?}");
        assert!(report.n_iterations < 12, "{kind:?} {report:?}");
    }
}

/// Energy with the work of constant pressures taken out.
struct Kept {
    energy: f64,
    angular: f64,
    momentum: f64,
    n_iterations: usize,
}

/// A ring that spins at 3 rad/s, flies and is being stretched, for 400 steps of 1/120 s.
fn fly(model: &FiniteStrainModel) -> Kept {
    let mut motion = WorldMotion::at_rest(model);
    for (x, v) in motion
        .position
        .chunks_exact(2)
        .zip(motion.velocity.chunks_exact_mut(2))
    {
        v[0] = 1.0 - 3.0 * x[1] + 2.0 * x[0];
        v[1] = 0.5 + 3.0 * x[0] - 1.0 * x[1];
    }
    let start = motion.clone();
    let energy = |motion: &WorldMotion| {
        motion.energy(model) - model.pressure_work(&start.position, &motion.position)
    };
    let (first, spin, momentum) = (
        energy(&motion),
        motion.angular_momentum(model),
        motion.momentum(model),
    );
    let settings = LargeSettings::conserving().with_tolerance(1e-12);
    let mut stepper = LargeStepper::new(model.clone(), settings).expect("settings");
    let load = vec![0.0; model.n_dofs()];
    let mut kept = Kept {
        energy: 0.0,
        angular: 0.0,
        momentum: 0.0,
        n_iterations: 0,
    };
    let (mut least, mut most) = (f64::INFINITY, 0.0f64);
    for step in 0..400 {
        let work = stepper
            .step(1.0 / 120.0, &load, &mut motion)
            .unwrap_or_else(|error| panic!("step {step}: {error}"));
        kept.n_iterations += work.n_iterations;
        kept.energy = kept.energy.max((energy(&motion) / first - 1.0).abs());
        kept.angular = kept
            .angular
            .max((motion.angular_momentum(model) / spin - 1.0).abs());
        let change = (motion.momentum(model) - momentum).norm() / momentum.norm();
        kept.momentum = kept.momentum.max(change);
        let area = model.hole_area(0, &motion.position).expect("a hole");
        (least, most) = (least.min(area), most.max(area));
    }
    // It breathes.
    assert!(most > 1.02 * least, "{least} {most}");
    kept
}

#[test]
fn a_ring_under_pressure_keeps_its_energy_and_both_momenta() {
    let pressures = [
        InnerPressure::constant(0.0),
        InnerPressure::constant(2e4),
        InnerPressure::isothermal(2e4),
        InnerPressure::adiabatic(2e4, 1.4),
        InnerPressure::adiabatic(8e4, 1.4),
    ];
    for kind in KINDS {
        for pressure in pressures {
            let kept = fly(&soft_ring(kind, pressure));
            let name = format!("{kind:?} {pressure:?}");
            assert!(kept.energy < 1e-9, "{name}: energy {:e}", kept.energy);
            assert!(kept.angular < 1e-9, "{name}: spin {:e}", kept.angular);
            assert!(
                kept.momentum < 1e-10,
                "{name}: momentum {:e}",
                kept.momentum
            );
            assert!(
                kept.n_iterations < 400 * 30,
                "{name}: {}",
                kept.n_iterations
            );
        }
    }
}

type Map = dyn Fn([f64; 2]) -> [f64; 2];

/// A ring with a hole aside, turned and mirrored: the same motion, turned and mirrored.
#[test]
fn no_direction_is_special() {
    let outline: Vec<[f64; 2]> = (0..10).map(|k| polar(0.4, k, 10)).collect();
    let hole: Vec<[f64; 2]> = (0..8)
        .map(|k| {
            let [x, y] = polar(0.25, k, 8);
            [x + 0.05, y - 0.02]
        })
        .collect();
    let mesh = generate::polygon(&outline, &[hole], &PolygonOptions::new(0.15)).expect("a ring");
    let mesh = mesh.to_tri6().expect("a ring of curved cells");
    let run = |map: &Map, mirrors: bool| {
        let law = StableNeoHookean::plane_strain(1e6, 0.4);
        let mut description = FiniteStrainDescription::new(mesh.clone(), law, 1000.0);
        description.pressures = vec![InnerPressure::adiabatic(1e5, 1.4)];
        if mirrors {
            let nodes = mesh.nodes().iter().map(|&at| map(at)).collect();
            // A mirrored cell runs the other way round: its corners 1 and 2, and the sides beside them, change places.
            let cells: Vec<[usize; 6]> = (mesh.cells())
                .map(|cell| [0, 2, 1, 5, 4, 3].map(|k| cell.nodes[k]))
                .collect();
            let mesh = Mesh::from_cells(nodes, CellKind::Tri6, &cells).expect("a mirrored mesh");
            description.mesh = Arc::new(mesh);
        }
        let places = mesh.nodes().iter().flat_map(|&at| map(at));
        description.rest_positions = places.collect();
        let model = FiniteStrainModel::assemble(description).expect("a body");
        let mut motion = WorldMotion::at_rest(&model);
        let settings = LargeSettings::conserving().with_tolerance(1e-11);
        let mut stepper = LargeStepper::new(model.clone(), settings).expect("settings");
        let load = vec![0.0; model.n_dofs()];
        for step in 0..60 {
            let outcome = stepper.step(1.0 / 240.0, &load, &mut motion);
            outcome.unwrap_or_else(|error| panic!("step {step}: {error}"));
        }
        motion.position
    };
    let plain = run(&|at| at, false);
    let moved = plain.chunks_exact(2).zip(mesh.nodes());
    let far = moved.map(|(now, at)| (now[0] - at[0]).hypot(now[1] - at[1]));
    assert!(far.fold(0.0, f64::max) > 0.01);
    let turn = |[x, y]: [f64; 2]| [0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y];
    let mirror = |[x, y]: [f64; 2]| [-x, y];
    for mirrors in [false, true] {
        let map: &Map = if mirrors { &mirror } else { &turn };
        let found = run(map, mirrors);
        for (found, plain) in found.chunks_exact(2).zip(plain.chunks_exact(2)) {
            let expected = map([plain[0], plain[1]]);
            let apart = (found[0] - expected[0]).hypot(found[1] - expected[1]);
            assert!(apart < 1e-9, "mirrored {mirrors}: {apart:e} m");
        }
    }
}

fn polar(radius: f64, k: usize, n: usize) -> [f64; 2] {
    let (sin, cos) = (std::f64::consts::TAU * k as f64 / n as f64).sin_cos();
    [radius * cos, radius * sin]
}
