//! Bodies that are crushed, pulled and thrown about, and steps that are not found.

use super::support::{laws, nodes_where, plate};
use foil2d::body::Pin;
use foil2d::fe::mesh::CellKind;
use foil2d::large::{LargeError, LargeSettings, LargeStepper, StepWork, WorldMotion};
use std::sync::Arc;

const DT: f64 = 1.0 / 60.0;

/// What 120 steps took, after the plates have stopped.
#[derive(Debug, Default)]
struct Outcome {
    total: StepWork,
    worst_inverted: usize,
    n_inverted: usize,
    /// Kinetic energy at the end over the largest on the way (-).
    rest: f64,
}

/// A block 1 x 1 m, E = 1e5, ν = .3, whose ends are held by plates that bring it to `height` in `n_frames` steps of 1/60 s.
///
/// ```text
///   ===========   plate, moves
///   |         |
///   |  T6     |   16 x 16 nodes' squares
///   ===========   plate, rests
/// ```
fn press(law: usize, height: f64, n_frames: usize) -> Result<Outcome, LargeError> {
    let law = Arc::clone(&laws(1e5, 0.3)[law]);
    let model = plate([1.0, 1.0], [8, 8], CellKind::Tri6, law);
    let upper = nodes_where(&model, |[_, y]| y == 1.0);
    let load = vec![0.0; model.n_dofs()];
    let mut motion = WorldMotion::at_rest(&model);
    let mut stepper = LargeStepper::new(model.clone(), LargeSettings::default())?;
    stepper.pin_where(|[_, y]| y == 0.0 || y == 1.0, Pin::both());
    let mut outcome = Outcome::default();
    let mut most_kinetic: f64 = 0.0;
    for frame in 1..=n_frames + 120 {
        let goal = 1.0 + (height - 1.0) * (frame.min(n_frames) as f64 / n_frames as f64);
        for node in &upper {
            let dof = 2 * node + 1;
            motion.velocity[dof] = (goal - motion.position[dof]) / DT;
        }
        let work = stepper.step(DT, &load, &mut motion)?;
        outcome.total.n_iterations += work.n_iterations;
        outcome.total.n_factorizations += work.n_factorizations;
        outcome.total.n_definite += work.n_definite;
        outcome.total.n_cutbacks += work.n_cutbacks;
        outcome.worst_inverted = outcome.worst_inverted.max(stepper.n_inverted());
        most_kinetic = most_kinetic.max(motion.kinetic_energy(&model));
    }
    outcome.n_inverted = stepper.n_inverted();
    outcome.rest = motion.kinetic_energy(&model) / most_kinetic;
    Ok(outcome)
}

fn report(name: &str, outcome: &Outcome, n_steps: usize) {
    let per_step = |count: usize| count as f64 / n_steps as f64;
    println!(
        "{name}: {:.1} iterations, {:.2} factors a step, {} cutbacks, {} definite, {} inverted at worst, {} at the end, at rest to {:.1e}",
        per_step(outcome.total.n_iterations),
        per_step(outcome.total.n_factorizations),
        outcome.total.n_cutbacks,
        outcome.total.n_definite,
        outcome.worst_inverted,
        outcome.n_inverted,
        outcome.rest
    );
}

#[test]
fn a_block_is_crushed_to_three_tenths() {
    for (law, name) in [
        (3, "stable neo-Hookean"),
        (0, "corotated"),
        (2, "neo-Hookean"),
    ] {
        let outcome = press(law, 0.3, 30).unwrap_or_else(|error| panic!("{name}: {error}"));
        report(name, &outcome, 150);
        assert!(outcome.n_inverted <= 8, "{name}: {}", outcome.n_inverted);
        if law == 2 {
            assert_eq!(outcome.worst_inverted, 0);
        }
    }
}

#[test]
fn a_block_is_crushed_faster_than_sound() {
    for (law, name) in [(3, "stable neo-Hookean"), (0, "corotated")] {
        let outcome = press(law, 0.3, 3).unwrap_or_else(|error| panic!("{name}: {error}"));
        report(name, &outcome, 123);
        assert!(outcome.n_inverted <= 8, "{name}: {}", outcome.n_inverted);
    }
}

/// With the tangent of the decay in the matrix a stretch by three takes less than a factor a step; without it takes 12 to 55.
#[test]
fn a_block_is_pulled_to_three_times_its_height_on_few_factors() {
    for (law, name) in [
        (3, "stable neo-Hookean"),
        (0, "corotated"),
        (2, "neo-Hookean"),
    ] {
        let outcome = press(law, 3.0, 30).unwrap_or_else(|error| panic!("{name}: {error}"));
        report(name, &outcome, 150);
        assert_eq!(outcome.total.n_cutbacks, 0, "{name}");
        assert!(outcome.total.n_factorizations < 150, "{name}");
        assert_eq!(outcome.worst_inverted, 0, "{name}");
    }
}

/// Nodes are thrown up to an eighth of the block's height, twice the distance of nodes, from where they belong.
#[test]
fn a_body_whose_cells_are_turned_inside_out_recovers() {
    for (law, name) in [(3, "stable neo-Hookean"), (0, "corotated")] {
        let law = Arc::clone(&laws(1e5, 0.3)[law]);
        let model = plate([1.0, 1.0], [8, 8], CellKind::Tri6, law);
        let mut motion = WorldMotion::at_rest(&model);
        let mut seed = 7_u64;
        for x in &mut motion.position {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            *x += 0.25 * ((seed >> 33) as f64 / 2.0_f64.powi(31) - 0.5);
        }
        let load = vec![0.0; model.n_dofs()];
        let start = motion.energy(&model);
        let mut outcome = Outcome::default();
        let mut stepper =
            LargeStepper::new(model.clone(), LargeSettings::default()).expect("settings");
        for step in 0..120 {
            let work = stepper
                .step(DT, &load, &mut motion)
                .unwrap_or_else(|error| panic!("{name}, step {step}: {error}"));
            outcome.total.n_iterations += work.n_iterations;
            outcome.total.n_factorizations += work.n_factorizations;
            outcome.total.n_definite += work.n_definite;
            outcome.total.n_cutbacks += work.n_cutbacks;
            outcome.worst_inverted = outcome.worst_inverted.max(stepper.n_inverted());
            assert!(
                motion.energy(&model) <= start * (1.0 + 1e-5),
                "{name}, step {step}"
            );
        }
        outcome.n_inverted = stepper.n_inverted();
        report(name, &outcome, 120);
        assert_eq!(outcome.n_inverted, 0, "{name}");
    }
}

/// What stops a step names its place and leaves the motion, bit by bit.
#[test]
fn a_step_that_is_not_found_names_the_culprit_and_changes_nothing() {
    let fast = |law: usize, settings: LargeSettings| {
        let law = Arc::clone(&laws(1e5, 0.3)[law]);
        let model = plate([1.0, 1.0], [4, 4], CellKind::Tri6, law);
        let upper = nodes_where(&model, |[_, y]| y == 1.0);
        let load = vec![0.0; model.n_dofs()];
        let mut motion = WorldMotion::at_rest(&model);
        upper
            .iter()
            .for_each(|node| motion.velocity[2 * node + 1] = -57.0);
        let before = motion.clone();
        let mut stepper = LargeStepper::new(model, settings).expect("settings");
        stepper.pin_where(|[_, y]| y == 0.0 || y == 1.0, Pin::both());
        let outcome = stepper.step(DT, &load, &mut motion);
        if outcome.is_err() {
            assert_eq!(motion, before);
        }
        outcome
    };
    let settings = LargeSettings::default();
    let no_cutback = LargeSettings {
        max_cutbacks: 0,
        ..settings
    };
    // The plate ends .05 m above the lower one; the guess, with all other nodes at rest, has cells inside out.
    match fast(2, no_cutback) {
        Err(LargeError::Inadmissible(inadmissible)) => {
            assert!(
                inadmissible.jacobian <= 0.0 && inadmissible.cell < 32,
                "{inadmissible}"
            );
            assert!(inadmissible.to_string().contains("neo-Hookean"));
        }
        other => panic!("{other:?}"),
    }
    let few = LargeSettings {
        max_iterations: 2,
        ..no_cutback
    };
    match fast(3, few) {
        Err(LargeError::NotConverged {
            iterations: 2,
            node,
            residual,
            limit,
        }) => {
            assert!(node < 81 && residual > limit);
        }
        other => panic!("{other:?}"),
    }
    let cheap = LargeSettings {
        budget: 5,
        ..settings
    };
    match fast(3, cheap) {
        Err(LargeError::Budget { iterations, .. }) => assert!(iterations >= 5),
        other => panic!("{other:?}"),
    }
    let work = fast(3, settings).expect("the stable law finds the step in parts");
    println!("{work:?}");
}

#[test]
fn wrong_input_is_refused_before_the_step() {
    let law = Arc::clone(&laws(1e5, 0.3)[3]);
    let model = plate([1.0, 1.0], [1, 1], CellKind::Tri3, law);
    let refused = |change: &dyn Fn(&mut LargeSettings)| {
        let mut settings = LargeSettings::default();
        change(&mut settings);
        LargeStepper::new(model.clone(), settings)
            .err()
            .map(|error| error.to_string())
            .unwrap_or_default()
    };
    assert!(refused(&|_| ()).is_empty());
    assert!(refused(&|s| s.tolerance = 0.0).contains("tolerance is 0"));
    assert!(refused(&|s| s.decay = -1.0).contains("decay is -1"));
    assert!(refused(&|s| s.decay = f64::NAN).contains("NaN"));
    assert!(refused(&|s| s.max_iterations = 0).contains("iterations is 0"));
    assert!(refused(&|s| s.max_cutbacks = 60).contains("cutbacks is 60"));

    let mut stepper = LargeStepper::new(model.clone(), LargeSettings::default()).expect("settings");
    let load = vec![0.0; model.n_dofs()];
    let mut motion = WorldMotion::at_rest(&model);
    assert_eq!(
        stepper.step(0.0, &load, &mut motion),
        Err(LargeError::StepLength(0.0))
    );
    let short = stepper.step(DT, &load[1..], &mut motion);
    assert!(matches!(
        short,
        Err(LargeError::Length {
            found: 7,
            expected: 8,
            ..
        })
    ));
    motion.velocity[5] = f64::NAN;
    let wrong = stepper.step(DT, &load, &mut motion);
    assert_eq!(
        wrong,
        Err(LargeError::NotFinite {
            name: "the velocity",
            node: 2
        })
    );
}
