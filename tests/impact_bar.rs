//! Benchmark B1, the impacting bar: L = 10 m, E = 900 Pa, rho = 1 kg/m³, nu = 0, section guided, no gravity.
//!
//! ```text
//!   |#|  c = sqrt(E / rho) = 30 m/s
//!   |#|  v0 = 0.1 m/s              contact from t = 0.5 s for 2 L / c = 2/3 s,
//!   |#|  gap 0.05 m                then away at v0 and unstrained
//!  =====
//! ```
//!
//! 100 cells, one thick; the two nodes that meet the floor give up their inertia.

#[path = "../examples/falling_block.rs"]
mod falling_block;

use falling_block::{Impact, bar, impact};
use std::error::Error;

/// Step (s), least rebound (-), largest relative error of the contact time (-).
const BARS: [(f64, f64, f64); 3] = [
    (1.0 / 60.0, 0.95, 0.03),
    (1.0 / 240.0, 0.975, 0.015),
    (1.0 / 1000.0, 0.985, 0.01),
];

/// The bar, with a gap that closes `phase` of a step after the end of one.
fn drop_bar(dt: f64, phase: f64) -> Result<Impact, Box<dyn Error>> {
    impact(bar(), dt, phase, &falling_block::cli::Options::default())
}

fn assert_rebounds(dt: f64, phase: f64) -> Result<Impact, Box<dyn Error>> {
    let (_, rebound, contact_time) = BARS
        .into_iter()
        .find(|(step, ..)| *step == dt)
        .ok_or("a step of the benchmark")?;
    let found = drop_bar(dt, phase)?;
    assert!(
        found.penetration_m <= 1e-9
            && found.rebound >= rebound
            && found.contact_time_error.abs() <= contact_time,
        "dt = {dt} s, phase {phase}: {found:?}"
    );
    Ok(found)
}

#[test]
fn the_bar_rebounds_without_overlap_and_with_its_energy() -> Result<(), Box<dyn Error>> {
    for (dt, ..) in BARS {
        let found = assert_rebounds(dt, 0.0)?;
        assert!(found.energy_error <= 1e-3, "dt = {dt} s: {found:?}");
    }
    Ok(())
}

/// The benchmark's gap closes at the end of a step, which a user's will not. Nothing may be gained, up to the round-off of
/// a thousand steps.
#[test]
fn the_bar_rebounds_from_a_gap_that_closes_within_a_step() -> Result<(), Box<dyn Error>> {
    for (dt, ..) in BARS {
        for phase in [0.1, 0.5, 0.9] {
            let found = assert_rebounds(dt, phase)?;
            assert!(found.energy_gain <= 1e-9, "dt = {dt} s: {found:?}");
        }
    }
    Ok(())
}

/// A gap that closes half-way through a step stops the part of the bar next to the floor half a step early or late: the
/// energy that costs vanishes with the step, faster than the step itself.
#[test]
fn closing_within_a_step_costs_energy_that_vanishes_with_the_step() -> Result<(), Box<dyn Error>> {
    let losses = BARS.map(|(dt, ..)| drop_bar(dt, 0.5).map(|found| (dt, found.energy_loss)));
    let losses: Vec<(f64, f64)> = losses.into_iter().collect::<Result<_, _>>()?;
    for pair in losses.windows(2) {
        let [(long, more), (short, less)] = [pair[0], pair[1]];
        assert!(more / less > long / short, "losses {losses:?}");
    }
    Ok(())
}

/// Force times time is the change of momentum. The treatment of impacts may change the velocity of the last step in
/// contact by what the contact had stored, here below a thousandth.
#[test]
fn the_contact_force_accounts_for_the_change_of_momentum() -> Result<(), Box<dyn Error>> {
    for (dt, ..) in BARS {
        let found = drop_bar(dt, 0.0)?;
        assert!(found.impulse_error.abs() <= 1e-3, "dt = {dt} s: {found:?}");
    }
    Ok(())
}
