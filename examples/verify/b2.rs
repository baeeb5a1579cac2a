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
//! Data: see [`bars`](super::bars); 100 cells, central difference with the mass of the contact nodes moved inwards, 306 steps a
//! second: .98 of the critical one, and every event falls on the end of a step. There the errors of lumped elements and of
//! central difference in the speed of a wave, `-(kh)²/24` and `+(ω dt)²/24`, all but cancel, and the fronts stay sharp. The
//! trapezoidal rule errs in the same direction as the elements: told beside it, with 1332 steps a second.
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
const RATE: f64 = 306.0;
/// The rate of the trapezoidal rule (1/s).
const FINE: f64 = 1332.0;
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
    let record = drop_bar(&Scheme::explicit(), &drop_at)?;
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
    let mut slow = drop(n_periods, FINE);
    slow.n_steps = sheet.n_steps(slow.n_steps);
    let implicit = drop_bar(&Scheme::recommended(), &slow)?;
    sheet.tell(
        "height after one period, trapezoidal (m)",
        HEIGHT,
        implicit.at(&implicit.bottom, PERIOD),
    );
    sheet.tell(
        format!("energy after {n_periods} periods, trapezoidal"),
        1.0,
        implicit.at(&implicit.energy, end),
    );
    figures(&[record, implicit], sheet);
    Ok(())
}

fn figures(records: &[Record; 2], sheet: &mut Sheet) {
    let names = ["central difference, moved mass", "trapezoidal, moved mass"];
    let first = |times: &[f64]| times.iter().take_while(|t| **t <= PERIOD).count();
    let times = &records[1].times;
    let exact = times[..first(times)].iter().map(|&t| [t, pressure(t)]);
    let title = "B2: pressure under the bouncing bar, first period";
    let axes = ["time (s)", "contact pressure (Pa)"];
    let mut pressures = Figure::new("b2_pressure", title, axes).within([0.0, 800.0]);
    let periods = (0..=10).map(|k| [k as f64 * PERIOD, HEIGHT]).collect();
    let title = "B2: the bouncing bar over ten periods";
    let axes = ["time (s)", "height of the lower end (m)"];
    let mut heights =
        Figure::new("b2_height", title, axes).exact("top of the exact motion", periods);
    // The implicit one first, so that it does not hide the other.
    for (record, name) in records.iter().zip(names).rev() {
        let curve = record.curve(&record.pressure)[..first(&record.times)].to_vec();
        pressures = pressures.line(name, curve);
        heights = heights.line(name, record.curve(&record.bottom));
    }
    sheet.figure(pressures.exact("exact", exact.collect()));
    sheet.figure(heights);
}
