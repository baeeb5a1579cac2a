//! Steps that conserve what they should, and let only vibrations decay.

use super::support::{KINDS, dot, laws, nodes_where, plate};
use foil2d::body::Pin;
use foil2d::fe::finite_strain::FiniteStrainModel;
use foil2d::fe::mesh::CellKind;
use foil2d::large::{LargeSettings, LargeStepper, WorldMotion};
use std::sync::Arc;

const DT: f64 = 1.0 / 60.0;

/// A plate 1 x .5 m that spins at 5 rad/s and is being stretched at .08 /s.
fn spinning(young: f64, law: usize, kind: CellKind) -> (FiniteStrainModel, WorldMotion) {
    let divisions = match kind {
        CellKind::Tri6 => [4, 2],
        _ => [8, 4],
    };
    let law = Arc::clone(&laws(young, 0.3)[law]);
    let model = plate([1.0, 0.5], divisions, kind, law);
    let mut motion = WorldMotion::at_rest(&model);
    let nodes = motion
        .position
        .chunks_exact(2)
        .zip(motion.velocity.chunks_exact_mut(2));
    for (x, v) in nodes {
        let (x, y) = (x[0] - 0.5, x[1] - 0.25);
        v[0] = -5.0 * y + 0.08 * x;
        v[1] = 5.0 * x - 0.04 * y;
    }
    (model, motion)
}

struct Kept {
    /// Largest and last energy over the first (-).
    most_energy: f64,
    least_energy: f64,
    last_energy: f64,
    /// Change of angular momentum (-).
    angular: f64,
    /// Largest momentum over that of a corner's speed (-).
    momentum: f64,
    n_iterations: usize,
    n_factorizations: usize,
}

fn spin(
    (model, mut motion): (FiniteStrainModel, WorldMotion),
    settings: LargeSettings,
    n_steps: usize,
) -> Kept {
    let (energy, angular) = (motion.energy(&model), motion.angular_momentum(&model));
    let load = vec![0.0; model.n_dofs()];
    let mut kept = Kept {
        most_energy: 0.0,
        least_energy: f64::INFINITY,
        last_energy: 1.0,
        angular: 0.0,
        momentum: 0.0,
        n_iterations: 0,
        n_factorizations: 0,
    };
    let mass: f64 = model.masses().iter().sum();
    let mut stepper = LargeStepper::new(model.clone(), settings).expect("settings");
    for step in 0..n_steps {
        let work = stepper
            .step(DT, &load, &mut motion)
            .unwrap_or_else(|error| panic!("step {step}: {error}"));
        assert_eq!(work.n_cutbacks, 0, "step {step}");
        kept.last_energy = motion.energy(&model) / energy;
        kept.most_energy = kept.most_energy.max(kept.last_energy);
        kept.least_energy = kept.least_energy.min(kept.last_energy);
        kept.angular = kept
            .angular
            .max((motion.angular_momentum(&model) / angular - 1.0).abs());
        kept.momentum = kept
            .momentum
            .max(motion.momentum(&model).norm() / (2.5 * mass));
        kept.n_iterations += work.n_iterations;
        kept.n_factorizations += work.n_factorizations;
    }
    kept
}

/// Benchmark B46: the trapezoidal rule in world coordinates explodes here within 51 steps.
#[test]
fn a_spinning_plate_keeps_its_energy_and_its_angular_momentum() {
    for young in [1e6, 1e9] {
        for law in 0..4 {
            for kind in KINDS {
                // Coordinates of 1 m are known to 1e-16, which E = 1e9 makes some 1e-9 of the largest force.
                let tolerance = if young == 1e9 { 1e-9 } else { 1e-11 };
                let settings = LargeSettings::conserving().with_tolerance(tolerance);
                let kept = spin(spinning(young, law, kind), settings, 300);
                let of = format!("E = {young:e}, law {law}, {kind:?}");
                println!(
                    "{of}: energy [{:+.2e}, {:+.2e}], angular {:.1e}, momentum {:.1e}, {:.2} iterations, {:.2} factors",
                    kept.least_energy - 1.0,
                    kept.most_energy - 1.0,
                    kept.angular,
                    kept.momentum,
                    kept.n_iterations as f64 / 300.0,
                    kept.n_factorizations as f64 / 300.0
                );
                assert!(kept.most_energy - 1.0 < 1e-9, "{of}");
                assert!(1.0 - kept.least_energy < 1e-9, "{of}");
                assert!(kept.angular < 1e-11, "{of}: {:e}", kept.angular);
                assert!(kept.momentum < 1e-12, "{of}: {:e}", kept.momentum);
                // One factor turns with the body: without that, a body that turns by .08 rad a step renews it in each.
                assert!(kept.n_factorizations < 300, "{of}");
            }
        }
    }
}

/// With decay energy falls to that of the rigid motion and never rises; the spin goes on.
#[test]
fn decay_takes_the_vibrations_and_leaves_the_spin() {
    for young in [1e6, 1e9] {
        for law in [0, 3] {
            let settings = LargeSettings::damped(0.9).with_tolerance(1e-11);
            let (model, motion) = spinning(young, law, CellKind::Tri6);
            // Energy of the vibration is that of the stretching; the spinning body's stretch takes its part of what is left.
            let energy = motion.energy(&model);
            let rigid = 5.0 * motion.angular_momentum(&model) / 2.0;
            let kept = spin((model, motion), settings, 300);
            let expected = rigid / energy;
            println!(
                "E = {young:e}, law {law}: {:.6} of {expected:.6}, angular {:.1e}",
                kept.last_energy, kept.angular
            );
            assert!(
                kept.most_energy <= 1.0 + 1e-12,
                "{:e}",
                kept.most_energy - 1.0
            );
            assert!(kept.last_energy < 1.0 - 0.9 * (1.0 - expected));
            assert!(kept.last_energy > expected * (1.0 - 2e-2 * 1e6 / young) - 1e-9);
            assert!(kept.angular < 1e-11, "{:e}", kept.angular);
        }
    }
}

/// A stiff plate at rest stays there to the last digits, where no residual is small beside no load.
#[test]
fn a_stiff_body_at_rest_stays_at_rest() {
    let (model, _) = spinning(1e11, 0, CellKind::Tri6);
    let mut motion = WorldMotion::at_rest(&model);
    motion.position.iter_mut().for_each(|x| *x += 10.0);
    let start = motion.position.clone();
    let load = vec![0.0; model.n_dofs()];
    let mut stepper = LargeStepper::new(model, LargeSettings::default()).expect("settings");
    for _ in 0..100 {
        let work = stepper
            .step(DT, &load, &mut motion)
            .expect("a body at rest is stepped");
        assert_eq!((work.n_cutbacks, work.n_at_rounding), (0, 1));
    }
    for (now, then) in motion.position.iter().zip(&start) {
        assert!((now - then).abs() < 1e-12, "{:e}", now - then);
    }
}

/// For small strains the step is the trapezoidal rule: a bar's first axial vibration has the period `2 π/ω (1 + (ω dt)²/12)`.
#[test]
fn small_vibrations_are_those_of_the_trapezoidal_rule() {
    let law = Arc::clone(&laws(1e6, 0.0)[0]);
    let model = plate([1.0, 0.1], [40, 1], CellKind::Tri6, law);
    let mut motion = WorldMotion::at_rest(&model);
    // Fixed at x = 0, free at x = 1: u = sin(π x/2) cos(ω t), ω = π/2 √(E/ρ) = 49.67 rad/s.
    let rest = model.rest_positions().to_vec();
    for (x, rest) in motion
        .position
        .chunks_exact_mut(2)
        .zip(rest.chunks_exact(2))
    {
        x[0] += 1e-6 * (0.5 * std::f64::consts::PI * rest[0]).sin();
    }
    // The part of the first mode, which the lumped masses leave nearly alone.
    let amplitude = |x: &[f64]| {
        let nodes = x
            .chunks_exact(2)
            .zip(rest.chunks_exact(2))
            .zip(model.masses());
        let parts = nodes.map(|((x, rest), mass)| {
            let mode = (0.5 * std::f64::consts::PI * rest[0]).sin();
            (mass * mode * (x[0] - rest[0]), mass * mode * mode)
        });
        let (along, size) = parts.fold((0.0, 0.0), |(a, b), (c, d)| (a + c, b + d));
        along / size / 1e-6
    };
    let load = vec![0.0; model.n_dofs()];
    let settings = LargeSettings::conserving().with_tolerance(1e-8);
    let mut stepper = LargeStepper::new(model.clone(), settings).expect("settings");
    stepper.pin_where(|[x, _]| x == 0.0, Pin::both());
    let omega = 0.5 * std::f64::consts::PI * 1e3_f64.sqrt();
    let dt = 0.1 / omega;
    // tan(ω' dt/2) = ω dt/2 for the trapezoidal rule.
    let angle = 2.0 * 0.05_f64.atan();
    for step in 1..=200 {
        stepper.step(dt, &load, &mut motion).expect("small steps");
        let found = amplitude(&motion.position);
        let expected = (angle * f64::from(step)).cos();
        // Lumped masses at distances of 1/80 err by the square of that in the frequency; the rule's own error is 8e-4 of it.
        let phase = angle * f64::from(step);
        let allowed = phase / 6400.0 + 1e-4;
        assert!((found - expected).abs() < allowed, "step {step}: {found}");
    }
}

/// What loads and holds do is what energy rises by: a strip is swung round by its moved end under its weight.
#[test]
fn work_of_loads_and_holds_is_the_rise_of_energy() {
    let law = Arc::clone(&laws(1e6, 0.3)[3]);
    let model = plate([1.0, 0.1], [10, 1], CellKind::Tri6, law);
    let masses = model.masses().iter();
    let load: Vec<f64> = masses.flat_map(|mass| [0.0, -9.81 * mass]).collect();
    let mut motion = WorldMotion::at_rest(&model);
    let settings = LargeSettings::conserving().with_tolerance(1e-10);
    let mut stepper = LargeStepper::new(model.clone(), settings).expect("settings");
    let held = nodes_where(&model, |[x, _]| x == 0.0);
    stepper.pin_where(|[x, _]| x == 0.0, Pin::both());
    let (mut work, mut most, start) = (0.0, 0.0_f64, motion.energy(&model));
    for step in 0..60 {
        let speed = (0.1 * f64::from(step)).sin();
        held.iter()
            .for_each(|node| motion.velocity[2 * node] = speed);
        // Held nodes change their velocity by no force of the body: their kinetic energy is left out.
        let before = motion.clone();
        stepper
            .step(DT, &load, &mut motion)
            .expect("the strip swings");
        let way: Vec<f64> = motion
            .position
            .iter()
            .zip(&before.position)
            .map(|(x, y)| x - y)
            .collect();
        work += dot(&load, &way) + dot(stepper.reaction(), &way);
        let held_energy: f64 = held
            .iter()
            .map(|node| 0.5 * model.masses()[*node] * speed * speed)
            .sum();
        let rise = motion.energy(&model) - held_energy - start;
        most = most.max((work - rise).abs() / rise.abs().max(1.0));
    }
    println!("work {work}, off by {most:e}");
    assert!(work > 10.0 && most < 1e-8, "{most:e}");
}

/// Rayleigh's stiffness part is decay `2 η/dt`: the swing of a damped bar falls by `exp(-η ω²/2 t)`.
#[test]
fn stiffness_proportional_damping_has_its_ratio() {
    let law = Arc::clone(&laws(1e6, 0.0)[3]);
    let mut description = super::support::describe([1.0, 0.1], [10, 1], CellKind::Tri6, law);
    description.damping.stiffness = 2e-3;
    let model = FiniteStrainModel::assemble(description).expect("a good body");
    let mut motion = WorldMotion::at_rest(&model);
    let rest = model.rest_positions().to_vec();
    for (x, rest) in motion
        .position
        .chunks_exact_mut(2)
        .zip(rest.chunks_exact(2))
    {
        x[0] += 1e-6 * (0.5 * std::f64::consts::PI * rest[0]).sin();
    }
    let load = vec![0.0; model.n_dofs()];
    let start = motion.energy(&model);
    let settings = LargeSettings::conserving().with_tolerance(1e-8);
    let mut stepper = LargeStepper::new(model.clone(), settings).expect("settings");
    stepper.pin_where(|[x, _]| x == 0.0, Pin::both());
    let omega = 0.5 * std::f64::consts::PI * 1e3_f64.sqrt();
    // Two periods in steps of 1/200 of one.
    let dt = 2.0 * std::f64::consts::PI / omega / 200.0;
    for _ in 0..400 {
        stepper.step(dt, &load, &mut motion).expect("small steps");
    }
    let found = (motion.energy(&model) / start).ln();
    let expected = -2e-3 * omega * omega * 400.0 * dt;
    // ζ = .05: the ratio of energies swings by ζ about its mean, which is small beside two periods' 4 π ζ.
    assert!(
        (found / expected - 1.0).abs() < 0.05,
        "{found} for {expected}"
    );
}

/// Benchmark B30 (Simo, Vu-Quoc 1986): a beam of L = 10, EA = 2.8e7, EI = 1.4e4, ρA = 1.2 is driven to 6 rad/s in 15 s.
///
/// ```text
///   o=====================   ψ(t) = 2/5 (t²/2 + (15/2π)² (cos(2π t/15) - 1)), then 6 t - 45
///   ψ         L              largest lag of the tip -.575 at 6.77 s, steady extension 5.143e-4
/// ```
#[test]
fn a_beam_that_is_spun_up_lags_and_stretches_as_known() {
    use std::f64::consts::PI;
    let height = (12.0 * 1.4e4 / 2.8e7_f64).sqrt();
    let law = Arc::clone(&laws(2.8e7 / height, 0.0)[0]);
    let mut description = super::support::describe([10.0, height], [20, 1], CellKind::Tri6, law);
    description.density = 1.2 / height;
    let model = FiniteStrainModel::assemble(description).expect("a good body");
    let rest = model.rest_positions().to_vec();
    let held = nodes_where(&model, |[x, _]| x == 0.0);
    let tip = nodes_where(&model, |[x, y]| {
        x == 10.0 && (y - 0.5 * height).abs() < 1e-9
    })[0];
    let mut motion = WorldMotion::at_rest(&model);
    let load = vec![0.0; model.n_dofs()];
    let mut stepper = LargeStepper::new(model, LargeSettings::default()).expect("settings");
    stepper.pin_where(|[x, _]| x == 0.0, Pin::both());
    let dt = 0.02;
    let angle = |t: f64| {
        let swing = (15.0 / (2.0 * PI)).powi(2) * ((2.0 * PI * t / 15.0).cos() - 1.0);
        if t < 15.0 {
            0.4 * (0.5 * t * t + swing)
        } else {
            6.0 * t - 45.0
        }
    };
    let (mut lag, mut at, mut extension) = (0.0_f64, 0.0, 0.0);
    for step in 1..=1000 {
        let t = dt * f64::from(step);
        let (sin, cos) = angle(t).sin_cos();
        for &node in &held {
            let arm = rest[2 * node + 1] - 0.5 * height;
            for (axis, target) in [-sin * arm, 0.5 * height + cos * arm]
                .into_iter()
                .enumerate()
            {
                let dof = 2 * node + axis;
                motion.velocity[dof] = (target - motion.position[dof]) / dt;
            }
        }
        stepper
            .step(dt, &load, &mut motion)
            .expect("the beam is driven");
        let (x, y) = (
            motion.position[2 * tip],
            motion.position[2 * tip + 1] - 0.5 * height,
        );
        let across = -sin * x + cos * y;
        if across < lag {
            (lag, at) = (across, t);
        }
        if t > 18.0 {
            extension += (cos * x + sin * y - 10.0) / 100.0;
        }
    }
    println!("lag {lag:.4} at {at:.2} s, extension {extension:.4e}");
    assert!((lag + 0.575).abs() < 0.006, "{lag}");
    assert!((at - 6.77).abs() < 0.1, "{at}");
    assert!((extension / 5.143e-4 - 1.0).abs() < 0.01, "{extension:e}");
}

/// Strips of h = L/100 that swing down from a clamp keep what energy they have, their weight's included.
#[test]
fn a_slender_strip_keeps_its_energy_in_a_large_swing() {
    let law = Arc::clone(&laws(1e8, 0.3)[0]);
    let model = plate([1.0, 0.01], [40, 1], CellKind::Tri6, law);
    let masses = model.masses().iter();
    let load: Vec<f64> = masses.flat_map(|mass| [0.0, -9.81 * mass]).collect();
    let mut motion = WorldMotion::at_rest(&model);
    let settings = LargeSettings::conserving().with_tolerance(1e-9);
    let mut stepper = LargeStepper::new(model.clone(), settings).expect("settings");
    stepper.pin_where(|[x, _]| x == 0.0, Pin::both());
    let potential = |x: &[f64]| -dot(&load, x);
    let start = potential(&motion.position);
    let (mut lowest, mut off, mut n_iterations, mut n_cutbacks) = (0.0_f64, 0.0_f64, 0, 0);
    for step in 0..120 {
        let work = stepper
            .step(DT, &load, &mut motion)
            .unwrap_or_else(|error| panic!("step {step}: {error}"));
        n_iterations += work.n_iterations;
        n_cutbacks += work.n_cutbacks;
        let fallen = start - potential(&motion.position);
        lowest = lowest.max(fallen);
        off = off.max((motion.energy(&model) - fallen).abs());
    }
    println!(
        "energy off by {:.1e} of {lowest}, {} iterations a step, {n_cutbacks} cutbacks",
        off / lowest,
        n_iterations / 120
    );
    // Without a bound on the growth of the residual, or without factors of the definite part, dozens of steps are halved.
    assert_eq!(n_cutbacks, 0);
    assert!(lowest > 1.0 && off < 1e-8 * lowest, "{off:e} of {lowest}");
}

/// Rayleigh's mass part drags all motion: `M (v' - v)/dt = -α M (v + v')/2`, whatever the body does beside.
#[test]
fn mass_proportional_damping_brakes_a_flying_body() {
    let law = Arc::clone(&laws(1e6, 0.3)[0]);
    let mut description = super::support::describe([1.0, 0.5], [4, 2], CellKind::Tri6, law);
    description.damping.mass = 2.0;
    let model = FiniteStrainModel::assemble(description).expect("a good body");
    let mut motion = WorldMotion::at_rest(&model);
    motion
        .velocity
        .chunks_exact_mut(2)
        .for_each(|v| v.copy_from_slice(&[3.0, -1.0]));
    let load = vec![0.0; model.n_dofs()];
    let settings = LargeSettings::conserving().with_tolerance(1e-10);
    let mut stepper = LargeStepper::new(model, settings).expect("settings");
    for _ in 0..60 {
        stepper
            .step(DT, &load, &mut motion)
            .expect("the body flies");
    }
    let left = ((1.0 - DT) / (1.0 + DT)).powi(60);
    for v in motion.velocity.chunks_exact(2) {
        assert!((v[0] - 3.0 * left).abs() < 1e-9 && (v[1] + left).abs() < 1e-9);
    }
}

/// A node that is held in flight stays where it is to the last bit, and flies on when it is let go.
#[test]
fn nodes_are_held_and_let_go_between_steps() {
    let (model, mut motion) = spinning(1e6, 3, CellKind::Tri6);
    let load = vec![0.0; model.n_dofs()];
    let mut stepper = LargeStepper::new(model, LargeSettings::default()).expect("settings");
    let fly = |stepper: &mut LargeStepper, motion: &mut WorldMotion| {
        for _ in 0..10 {
            stepper.step(DT, &load, motion).expect("the plate flies");
        }
        [motion.position[0], motion.position[1]]
    };
    let caught = fly(&mut stepper, &mut motion);
    stepper.pin(0, Pin::both());
    motion.velocity[..2].fill(0.0);
    assert_eq!(fly(&mut stepper, &mut motion), caught);
    assert!(stepper.reaction()[0] != 0.0);
    stepper.pin(0, Pin { x: false, y: false });
    assert!(fly(&mut stepper, &mut motion) != caught);
    assert!(stepper.reaction()[0] == 0.0);
}
