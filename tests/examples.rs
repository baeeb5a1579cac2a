//! The examples hold their headline numbers, and run shortened.

#![allow(
    clippy::duplicate_mod,
    reason = "every example brings its own copy of the shared arguments"
)]

#[path = "../examples/box_on_beam.rs"]
mod box_on_beam;
#[path = "../examples/cantilever.rs"]
mod cantilever;
#[path = "../examples/catapult.rs"]
mod catapult;
#[path = "../examples/custom_element.rs"]
mod custom_element;
#[path = "../examples/falling_block.rs"]
mod falling_block;
#[path = "../examples/grab.rs"]
mod grab;
#[path = "../examples/gripper.rs"]
mod gripper;
#[path = "../examples/rope.rs"]
mod rope;
#[path = "../examples/sensor_gate.rs"]
mod sensor_gate;
#[path = "../examples/springboard.rs"]
mod springboard;
#[path = "../examples/trampoline.rs"]
mod trampoline;
#[path = "../examples/truck.rs"]
mod truck;
#[path = "../examples/two_blocks.rs"]
mod two_blocks;

use std::error::Error;

type Outcome = Result<(), Box<dyn Error>>;

fn assert_within(what: &str, value: f64, expected: f64, tolerance: f64) {
    assert!(
        (value - expected).abs() <= tolerance,
        "{what} is {value:e}, not {expected:e} within {tolerance:e}"
    );
}

/// Converged plane elasticity: 15.1218 mm and 0.507408 Hz. One per cent is what 63 nodes can give; T3 locks.
#[test]
fn a_cantilever_bends_and_vibrates_as_plane_elasticity_says() -> Outcome {
    let outcome = cantilever::run(&cantilever::cli::Options::default())?;
    for errors in [outcome.errors, outcome.elements.qm6, outcome.elements.tri6] {
        assert_within("tip error", errors.tip_error, 0.0, 0.01);
        assert_within("frequency error", errors.frequency_error, 0.0, 0.01);
    }
    // An independent program's T3 on this mesh gives 0.62 of the tip.
    assert_within(
        "T3's tip error",
        outcome.elements.tri3.tip_error,
        -0.38,
        0.01,
    );
    Ok(())
}

/// In small strain a beam of any stiffness is the same beam in its own units of time, so its errors are the same up to
/// round-off: displacements of 76 nm on positions of 1 m are known to 1e-9, and the step to rapier's precision.
#[test]
fn a_cantilever_has_the_same_relative_errors_at_any_stiffness() -> Outcome {
    let outcome = cantilever::run(&cantilever::cli::Options::default())?;
    for at in &outcome.stiffness {
        let what = format!("E = {:e}", at.young);
        assert_within(&what, at.errors.tip_error, outcome.errors.tip_error, 1e-7);
        let frequency_error = outcome.errors.frequency_error;
        assert_within(&what, at.errors.frequency_error, frequency_error, 1e-7);
    }
    Ok(())
}

/// The trapezoidal rule conserves the energy of linear vibration exactly; 10,000 steps leave round-off.
#[test]
fn a_vibrating_cantilever_keeps_its_energy_for_ten_thousand_steps() -> Outcome {
    let outcome = cantilever::run(&cantilever::cli::Options::default())?;
    assert!(outcome.energy_drift <= 1e-9, "{:e}", outcome.energy_drift);
    Ok(())
}

/// One wave up and down: contact for 2 L / c, and away at the speed of approach. What rebound lacks is vibration the mesh
/// keeps; it falls with the step.
#[test]
fn a_falling_block_rebounds_by_its_elasticity() -> Outcome {
    let outcomes = falling_block::run(&falling_block::cli::Options::default())?;
    let bars = [(0.95, 0.03), (0.975, 0.015), (0.985, 0.01)];
    for (outcome, (rebound, contact_time)) in outcomes.iter().zip(bars) {
        let (dt, block) = (outcome.dt, &outcome.block);
        assert!(block.penetration_m <= 1e-9, "{dt}: {}", block.penetration_m);
        assert!(block.energy_error <= 1e-3, "{dt}: {}", block.energy_error);
        assert!(block.rebound >= rebound, "{dt}: {}", block.rebound);
        assert_within("contact time", block.contact_time_error, 0.0, contact_time);
    }
    Ok(())
}

/// At rest the contact force is the weight whatever the ratio of the masses, and the beam sags as its own stiffness matrix
/// says. The box's velocity is read in rapier's precision.
#[test]
fn a_box_a_thousand_times_heavier_rests_on_a_beam() -> Outcome {
    let jitter = if cfg!(feature = "f64") { 1e-9 } else { 1e-4 };
    for outcome in box_on_beam::run(&box_on_beam::cli::Options::default())? {
        let ratio = outcome.ratio;
        assert_within("force / weight", outcome.force_over_weight, 1.0, 1e-4);
        assert_within("sag error", outcome.sag_error, 0.0, 0.02);
        assert!(
            outcome.jitter_m_per_s <= jitter,
            "ratio {ratio}: the box still moves at {:e} m/s",
            outcome.jitter_m_per_s
        );
    }
    Ok(())
}

/// Equilibrium of each block and Coulomb's law. Blocks are not rigid: at E = 1 MPa friction falls 5.9e-3 short of mu m g,
/// at 10 MPa, here, 6.9e-4. The tolerances leave room for that remainder and no more than three times as much.
#[test]
fn a_flexible_block_on_another_sticks_below_the_friction_limit_and_slides_above() -> Outcome {
    let stack = two_blocks::run(&two_blocks::cli::Options::default())?.stack;
    assert_within(
        "on the upper block",
        stack.upper_force_over_weight,
        1.0,
        1e-4,
    );
    assert_within("on the floor", stack.lower_force_over_weight, 1.0, 1e-4);
    assert_within("friction / pull", stack.stick_force_over_pull, 1.0, 1e-4);
    assert!(stack.stick_speed_m_per_s <= 1e-6, "{stack:?}");
    assert_within("friction / limit", stack.slip_force_over_limit, 1.0, 2e-3);
    assert_within("acceleration", stack.slip_acceleration_ratio, 1.0, 4e-3);
    Ok(())
}

/// B3 with 20 cells a bar: the front of a wave is a few cells wide, so part of the motion stays as vibration. The force
/// and the times of contact are those of the wave equation to within a cell's travel time, 2.5 us.
#[test]
fn two_equal_bars_exchange_their_velocities() -> Outcome {
    let collision = two_blocks::run(&two_blocks::cli::Options::default())?.collision;
    let [left, right] = collision.velocity_ratios;
    assert_within("the left bar's velocity", left, -1.0, 0.04);
    assert_within("the right bar's velocity", right, 1.0, 0.04);
    assert_within("first contact", collision.touch_s, 49.46e-6, 2.5e-6);
    assert_within("last contact", collision.part_s, 148.39e-6, 2.5e-6);
    assert_within("plateau", collision.plateau_n, 133.45e3, 0.02 * 133.45e3);
    assert!(collision.momentum_error <= 1e-11, "{collision:?}");
    assert!(collision.energy_error <= 4e-3, "{collision:?}");
    Ok(())
}

/// Locking of the fully integrated quadrilateral, predicted by hand to first order in the beam's slenderness.
#[test]
fn a_users_own_element_conforms_and_locks_as_its_theory_says() -> Outcome {
    let outcome = custom_element::run(&custom_element::cli::Options::default())?;
    let predicted = outcome.predicted_stiffening;
    assert_within("stiffening", outcome.stiffening, predicted, 5e-3);
    assert_within("default element", outcome.default_tip_error, 0.0, 0.01);
    Ok(())
}

/// Equilibrium of a block that hangs on a spring, and on the floor afterwards.
#[test]
fn a_mouse_spring_holds_a_block_by_its_weight() -> Outcome {
    let outcome = grab::run(&grab::cli::Options::default())?;
    // It still swings a little after eight seconds.
    assert_within("spring / weight", outcome.force_over_weight, 1.0, 1e-2);
    assert_within("stretch", outcome.stretch_ratio, 1.0, 1e-2);
    assert_within("floor / weight", outcome.floor_over_weight, 1.0, 1e-2);
    assert_within("height", outcome.rest_height_m, 0.25, 0.01);
    Ok(())
}

/// Motors at their bounds grip with it, friction carries the weight, and the part rises with the hand but for the fingers' shear.
#[test]
fn two_fingers_grip_with_their_motors_force_and_lift_by_friction() -> Outcome {
    let outcome = gripper::run(&gripper::cli::Options::default())?;
    for grip in outcome.grip_ratios {
        assert_within("grip / motor", grip, 1.0, 1e-2);
    }
    assert_within("friction / weight", outcome.lift_over_weight, 1.0, 1e-2);
    assert!(outcome.used_friction < 1.0, "{outcome:?}");
    assert_within("rise", outcome.rise_ratio, 1.0, 0.02);
    Ok(())
}

/// Statics of the springs, and a drive across at the speed of the rims.
#[test]
fn a_truck_on_springs_crosses_a_flexible_deck() -> Outcome {
    let outcome = truck::run(&truck::cli::Options::default())?;
    for pressed in outcome.compression_ratios {
        assert_within("compression", pressed, 1.0, 1e-2);
    }
    assert_within("speed", outcome.speed_ratio, 1.0, 0.02);
    assert!(outcome.reached_m > 8.0, "{outcome:?}");
    assert!(
        outcome.deepest_sag_m > 1e-3 && outcome.deepest_sag_m < 0.1,
        "{outcome:?}"
    );
    Ok(())
}

/// Free fall is exact under the trapezoidal rule for rigid motion; a gate's times are known to a step of 1/240 s in one second.
#[test]
fn light_gates_measure_gravity_and_push_nothing() -> Outcome {
    let outcome = sensor_gate::run(&sensor_gate::cli::Options::default())?;
    assert_eq!((outcome.reached_s.len(), outcome.left_s.len()), (12, 12));
    assert_within("g", outcome.g_error, 0.0, 5e-3);
    assert_eq!(outcome.sheet_events, [2, 2], "block and ball");
    assert_eq!(outcome.n_forces, 0);
    // Positions of 15 m in steps that rapier holds to 1e-7 of a second.
    assert!(outcome.deviation_m < 1e-5, "{:e} m", outcome.deviation_m);
    Ok(())
}

/// `--steps 3` is for smoke tests: it must not trip over motion that has not happened yet.
#[test]
fn every_example_runs_shortened() -> Outcome {
    let steps = Some(3);
    cantilever::run(&cantilever::cli::Options {
        json: true,
        steps,
        ..Default::default()
    })?;
    falling_block::run(&falling_block::cli::Options {
        json: true,
        steps,
        ..Default::default()
    })?;
    box_on_beam::run(&box_on_beam::cli::Options {
        json: true,
        steps,
        ..Default::default()
    })?;
    two_blocks::run(&two_blocks::cli::Options {
        json: true,
        steps,
        ..Default::default()
    })?;
    custom_element::run(&custom_element::cli::Options {
        json: true,
        steps,
        ..Default::default()
    })?;
    grab::run(&grab::cli::Options {
        json: true,
        steps,
        ..Default::default()
    })?;
    gripper::run(&gripper::cli::Options {
        json: true,
        steps,
        ..Default::default()
    })?;
    truck::run(&truck::cli::Options {
        json: true,
        steps,
        ..Default::default()
    })?;
    sensor_gate::run(&sensor_gate::cli::Options {
        json: true,
        steps,
        ..Default::default()
    })?;
    Ok(())
}

/// The ball goes around the peg by more than half a turn and back; nothing brings energy but gravity.
#[test]
fn a_rope_swings_winds_around_a_peg_and_unwinds() -> Outcome {
    let outcome = rope::run(&rope::support::cli::Options::default(), None)?;
    assert_eq!(outcome.unsolved, 0);
    assert!(outcome.energy_gained < 0.01, "{outcome:?}");
    assert!((1.0..1.05).contains(&outcome.longest), "{outcome:?}");
    assert!(outcome.wound > 4.0, "{outcome:?}");
    assert!(outcome.max_penetration_m < 1e-5, "{outcome:?}");
    // The ball in its circle of a metre carries several times its weight.
    assert!(outcome.peg_force_n > 2.0 * 20.0, "{outcome:?}");
    Ok(())
}

/// The tension that the strip is built under is its law's from the first step on, but for what its weight adds in one; the ball goes as deep as energy lets it, to some hundredths, and the slack strip lets it deeper.
#[test]
fn a_trampoline_is_as_taut_and_as_deep_as_its_energy_says() -> Outcome {
    let outcome = trampoline::run(&trampoline::support::cli::Options::default(), None)?;
    let [tension, expected] = outcome.taut.tension_n;
    assert_within("tension", tension / expected, 1.0, 1e-4);
    for bounce in [outcome.taut, outcome.slack] {
        let [depth, expected] = bounce.depth_m;
        assert_within("depth", depth / expected, 1.0, 0.05);
        assert!(bounce.rebound > 0.7 && bounce.rebound < 1.0, "{bounce:?}");
        assert!(bounce.energy_gained < 1e-3, "{bounce:?}");
        assert_eq!(bounce.unsolved, 0);
        assert!(bounce.max_penetration_m < 1e-6, "{bounce:?}");
    }
    assert!(outcome.slack.depth_m[0] > 1.1 * outcome.taut.depth_m[0]);
    Ok(())
}

/// Standing still the board is the elastica, to its shear and the chords of its cells; in a jump what moves sideways and in the board itself is not stored.
#[test]
fn a_springboard_bends_as_the_elastica_and_throws_the_jumper_up() -> Outcome {
    let outcome = springboard::run(&springboard::support::cli::Options::default(), None)?;
    assert_within("force / weight", outcome.force_over_weight, 1.0, 1e-4);
    let [sag, expected] = outcome.sag_m;
    assert_within("sag", sag / expected, 1.0, 5e-3);
    let [depth, expected] = outcome.depth_m;
    assert_within("depth", depth / expected, 0.98, 0.02);
    assert_within("tip", outcome.tip_over_length, 0.3, 0.01);
    assert!(
        outcome.rebound > 0.85 && outcome.rebound < 1.0,
        "{outcome:?}"
    );
    assert!(outcome.energy_gained < 1e-3, "{outcome:?}");
    assert_eq!(outcome.unsolved, 0);
    assert!(outcome.max_penetration_m < 1e-6, "{outcome:?}");
    Ok(())
}

/// The ball flies on its parabola, and gets no more than is stored.
#[test]
fn a_catapult_throws_by_what_it_stores() -> Outcome {
    let outcome = catapult::run(&catapult::support::cli::Options::default(), None)?;
    let [range, expected] = outcome.range_m;
    assert_within("range", range / expected, 1.0, 5e-3);
    assert!(range < outcome.ideal_range_m, "{outcome:?}");
    assert!(
        outcome.efficiency > 0.4 && outcome.efficiency < 1.0,
        "{outcome:?}"
    );
    assert!(outcome.energy_gained < 1e-3, "{outcome:?}");
    assert_eq!(outcome.unsolved, 0);
    assert!(outcome.max_penetration_m < 1e-6, "{outcome:?}");
    Ok(())
}
