//! Steps of bodies that flow: every joule is kinetic, stored or dissipated, and nothing is turned.

use super::support::{KINDS, Metal, plate};
use foil2d::body::Pin;
use foil2d::fe::finite_strain::FiniteStrainModel;
use foil2d::fe::material::hyperelastic::J2Plasticity;
use foil2d::fe::mesh::CellKind;
use foil2d::large::{LargeSettings, LargeStepper, WorldMotion};

const METAL: Metal = Metal {
    young: 1e6,
    poisson: 0.3,
    y: 5e3,
    h: 2e4,
};

/// A plate that spins and is being stretched so fast that it flows.
fn thrown(model: &FiniteStrainModel, spin: f64, stretch: f64) -> WorldMotion {
    let mut motion = WorldMotion::at_rest(model);
    let nodes = motion
        .position
        .chunks_exact(2)
        .zip(motion.velocity.chunks_exact_mut(2));
    for (x, v) in nodes {
        let (x, y) = (x[0] - 0.5, x[1] - 0.25);
        v[0] = -spin * y + stretch * x + 0.4;
        v[1] = spin * x - 0.5 * stretch * y + 3.0 * stretch * x * y;
    }
    motion
}

#[test]
fn a_spinning_plate_that_flows_keeps_its_energy_account_and_its_momenta() {
    for kind in KINDS {
        let model = plate([1.0, 0.5], [4, 2], kind, METAL.law());
        let mut motion = thrown(&model, 5.0, 4.0);
        let settings = LargeSettings::conserving().with_tolerance(1e-11);
        let mut stepper = LargeStepper::new(model.clone(), settings).expect("settings");
        let load = vec![0.0; model.n_dofs()];
        let energy = motion.kinetic_energy(&model);
        let [momentum, spin] = [motion.momentum(&model).x, motion.angular_momentum(&model)];
        let mut dissipated = 0.0;
        for _ in 0..120 {
            let report = stepper
                .step(1.0 / 240.0, &load, &mut motion)
                .expect("a step");
            assert!(report.flowed >= 0.0);
            dissipated += report.flowed;
            let stored = model.energy_after(&motion.position, stepper.flowed());
            // What is committed lies within the yield surface.
            assert!(stored.dissipated < 1e-9 * energy);
            let account = motion.kinetic_energy(&model) + stored.stored + dissipated;
            assert!(
                (account / energy - 1.0).abs() < 1e-9,
                "{kind:?}: {account} of {energy}"
            );
            assert!((motion.angular_momentum(&model) / spin - 1.0).abs() < 1e-10);
            assert!((motion.momentum(&model).x / momentum - 1.0).abs() < 1e-10);
        }
        assert!(
            dissipated > 0.1 * energy,
            "{kind:?}: {dissipated} of {energy}"
        );
    }
}

/// The same plate seen turned by a radian moves turned by a radian.
#[test]
fn flow_is_the_same_seen_from_another_side() {
    let model = plate([1.0, 0.5], [4, 2], CellKind::Tri6, METAL.law());
    let (sin, cos) = 1f64.sin_cos();
    let turn = |dofs: &[f64]| -> Vec<f64> {
        let turned = dofs
            .chunks_exact(2)
            .flat_map(|v| [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1]]);
        turned.collect()
    };
    let run = |is_turned: bool| {
        let mut motion = thrown(&model, 5.0, 4.0);
        if is_turned {
            motion.position = turn(&motion.position);
            motion.velocity = turn(&motion.velocity);
        }
        let settings = LargeSettings::damped(0.9).with_tolerance(1e-11);
        let mut stepper = LargeStepper::new(model.clone(), settings).expect("settings");
        let load = vec![0.0; model.n_dofs()];
        for _ in 0..30 {
            stepper
                .step(1.0 / 240.0, &load, &mut motion)
                .expect("a step");
        }
        let strains: Vec<f64> = stepper.flowed().iter().map(|point| point.strain).collect();
        (motion.position, strains)
    };
    let (plain, seen) = (run(false), run(true));
    for (a, b) in turn(&plain.0).iter().zip(&seen.0) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
    assert!(plain.1.iter().any(|&strain| strain > 0.01));
    for (a, b) in plain.1.iter().zip(&seen.1) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
}

/// Halving the step halves what is left of the error: where flow changes its direction its map is one of the end.
#[test]
fn steps_through_flow_are_of_first_order() {
    let model = plate([1.0, 0.5], [2, 1], CellKind::Tri6, METAL.law());
    let run = |n: usize| {
        let mut motion = thrown(&model, 2.0, 2.0);
        let settings = LargeSettings::conserving().with_tolerance(1e-11);
        let mut stepper = LargeStepper::new(model.clone(), settings).expect("settings");
        let load = vec![0.0; model.n_dofs()];
        for _ in 0..n {
            stepper
                .step(0.02 / n as f64, &load, &mut motion)
                .expect("a step");
        }
        motion.position
    };
    let finest = run(1024);
    let errors = [32, 64, 128].map(|n| {
        let pairs = run(n).into_iter().zip(&finest).map(|(a, b)| (a - b).abs());
        pairs.fold(0.0, f64::max)
    });
    let ratios = [errors[0] / errors[1], errors[1] / errors[2]];
    assert!(ratios.iter().all(|ratio| *ratio > 1.8), "{errors:?}");
}

/// A step that is not found leaves motion and flow as they were.
#[test]
fn a_step_that_fails_lets_nothing_flow() {
    let model = plate([1.0, 0.5], [4, 2], CellKind::Tri6, METAL.law());
    let mut motion = thrown(&model, 5.0, 4.0);
    let settings = LargeSettings {
        max_iterations: 4,
        max_cutbacks: 1,
        ..LargeSettings::conserving()
    };
    let mut stepper = LargeStepper::new(model.clone(), settings).expect("settings");
    let load = vec![0.0; model.n_dofs()];
    for _ in 0..8 {
        stepper
            .step(1.0 / 2000.0, &load, &mut motion)
            .expect("a short step");
    }
    let before = (motion.clone(), stepper.flowed().to_vec());
    assert!(before.1.iter().any(|point| point.strain > 0.0));
    stepper
        .step(0.2, &load, &mut motion)
        .expect_err("a step far too long");
    assert_eq!((motion, stepper.flowed().to_vec()), before);
}

/// A bar that is held at one end and let go after it has flowed swings about a longer one.
#[test]
fn what_has_flowed_stays() {
    let law = J2Plasticity::plane_strain(1e6, 0.3, 5e3).with_hardening(1e4);
    let model = plate([1.0, 0.2], [5, 1], CellKind::Tri6, law);
    let mut motion = WorldMotion::at_rest(&model);
    let mut stepper =
        LargeStepper::new(model.clone(), LargeSettings::damped(0.5)).expect("settings");
    stepper.pin_where(|[x, _]| x == 0.0, Pin::both());
    let mut load = vec![0.0; model.n_dofs()];
    let ends: Vec<usize> = (0..model.n_nodes())
        .filter(|&node| model.rest_positions()[2 * node] == 1.0)
        .collect();
    for &node in &ends {
        load[2 * node] = 1.3 * 5e3 * 0.2 / ends.len() as f64;
    }
    let mut shortest = f64::INFINITY;
    for step in 0..400 {
        if step == 100 {
            load.fill(0.0);
        }
        stepper.step(1e-3, &load, &mut motion).expect("a step");
        if step > 200 {
            shortest = shortest.min(motion.position[2 * ends[0]]);
        }
    }
    assert!(shortest > 1.05, "{shortest}");
}
