//! B2, the bouncing bar: impact after impact for ten exact periods.
//!
//! Source: the exact solution of the wave equation under gravity (Doyen, Ern, Piperno 2011 use the same bar).
//!
//! ```text
//!    |#|  dropped from 5 m, g = 10 m/s²     height
//!    |#|                                     5 |\            /\
//!    |#|                                       | \   __     /  .
//!   =====                                    0 +--+==+--+==+----- t
//!                                              0  1 5/3 11/3 13/3  16/3
//! ```
//!
//! Data: see [`bars`](super::bars); 100 cells, 1332 steps a second, so that every event falls on the end of a step (the
//! scheme table takes 333).
//!
//! Exact: first contact 1 to 5/3 s with `p = 300 + 300 (t - 1)`; the bar leaves at a uniform +10 m/s with the strain
//! `2 g (x - L)/c²`; second contact 11/3 to 13/3 s with `p = 500 - 300 (t - 11/3)`; at 16/3 s all is as at the start.
//!
//! Excellent: after ten periods energy >= .98 of the initial, the height of one period to 1 %, no overlap.

use super::Outcome;
use super::bars::{CONTACT_TIME, Drop, Record, Scheme, drop_bar};
use super::figure::Figure;
use super::sheet::Sheet;

pub const PERIOD: f64 = 16.0 / 3.0;
pub const HEIGHT: f64 = 5.0;
const GRAVITY: f64 = 10.0;
const RATE: f64 = 1332.0;
/// The rate of the scheme table, c dt / h = 0.90 (1/s).
pub const COARSE: f64 = 333.0;
const FRONT: f64 = 0.05;
/// Begin of the two contacts of a period (s).
const TOUCH: [f64; 2] = [1.0, 11.0 / 3.0];

/// Ten periods, or fewer, at so many steps a second.
pub fn drop(n_periods: usize, rate: f64) -> Drop {
    Drop {
        n_cells: 100,
        dt: 1.0 / rate,
        gravity: GRAVITY,
        gap: HEIGHT,
        speed: 0.0,
        n_steps: (n_periods as f64 * PERIOD * rate).round() as usize,
    }
}

/// Exact pressure in the first period (Pa).
fn pressure(t: f64) -> f64 {
    let [first, second] = TOUCH;
    if (first..first + CONTACT_TIME).contains(&t) {
        300.0 + 300.0 * (t - first)
    } else if (second..second + CONTACT_TIME).contains(&t) {
        500.0 - 300.0 * (t - second)
    } else {
        0.0
    }
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    let n_periods = sheet.choose(10, 2);
    let mut drop_at = drop(n_periods, RATE);
    drop_at.n_steps = sheet.n_steps(drop_at.n_steps);
    let record = drop_bar(&Scheme::recommended(), &drop_at)?;
    for (name, begin) in ["first", "second"].into_iter().zip(TOUCH) {
        let span = [begin + FRONT, begin + CONTACT_TIME - FRONT];
        let [rms, _] = record.pressure_error(span, pressure);
        if begin == 1.0 {
            sheet.at_most(
                "rms error of the first pressure, of 300 Pa (-)",
                5e-3,
                rms / 300.0,
            );
        } else {
            // It meets the vibration that the fronts of the first one left in the mesh.
            sheet.tell(
                format!("1 + rms error of the {name} pressure, of 300 Pa (-)"),
                1.0,
                1.0 + rms / 300.0,
            );
        }
    }
    // The pressure falls from 500 Pa within a few cells' time, and grazes the floor a little longer.
    sheet.tell(
        "first release (s)",
        TOUCH[0] + CONTACT_TIME,
        record.release(2.5),
    );
    let height = record.at(&record.bottom, PERIOD);
    sheet.relative("height after one period, 16/3 s (m)", HEIGHT, height, 1e-2);
    let end = n_periods as f64 * PERIOD - 1e-3;
    sheet.at_least(
        format!("energy after {n_periods} periods, of the initial (-)"),
        0.98,
        record.at(&record.energy, end),
    );
    sheet.tell(
        format!("height after {n_periods} periods (m)"),
        HEIGHT,
        record.at(&record.bottom, end),
    );
    sheet.absolute("deepest overlap (m)", 0.0, record.penetration, 1e-9);
    figures(&record, sheet);
    Ok(())
}

fn figures(record: &Record, sheet: &mut Sheet) {
    let first: Vec<f64> = record
        .times
        .iter()
        .copied()
        .filter(|t| *t <= PERIOD)
        .collect();
    let n = first.len();
    let exact = first.iter().map(|&t| [t, pressure(t)]).collect();
    let axes = ["time (s)", "contact pressure (Pa)"];
    sheet.figure(
        Figure::new(
            "b2_pressure",
            "B2: pressure under the bouncing bar, first period",
            axes,
        )
        .within([0.0, 800.0])
        .exact("exact", exact)
        .line(
            "trapezoidal, redistributed mass",
            record.curve(&record.pressure)[..n].to_vec(),
        ),
    );
    let periods = (0..=10).map(|k| [k as f64 * PERIOD, HEIGHT]).collect();
    let axes = ["time (s)", "height of the lower end (m)"];
    sheet.figure(
        Figure::new("b2_height", "B2: the bouncing bar over ten periods", axes)
            .exact("top of the exact motion", periods)
            .line(
                "trapezoidal, redistributed mass",
                record.curve(&record.bottom),
            ),
    );
}
