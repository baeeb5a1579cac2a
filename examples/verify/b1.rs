//! B1, the impacting bar: one plane wave, and a wall that must not notice where it ends.
//!
//! Source: the exact solution of the wave equation, as in Carpenter, Taylor and Katona (1991).
//!
//! ```text
//!    |#|  v0 = 10 m/s, no gravity
//!    |#|                            p (Pa)
//!    |#|  gap 5 m                   300 |    +--------+
//!   =====                               |    |        |
//!                                     0 +----+--------+----- t
//!                                          0.5     1.1667 s
//! ```
//!
//! Data: see [`bars`](super::bars); 100 cells, 336 steps a second (c dt / h = 0.89), so that the gap closes and the wave
//! returns at the end of a step.
//!
//! Exact: `p = rho c v0 = 300 Pa` for `2 L / c`, then away at v0, unstrained.
//!
//! Excellent: plateau to 0.5 %, release within two steps, energy to 0.1 %. A gap that closes within a step is told beside
//! it: the nodes next to the floor are then stopped up to half a step late.

use super::Outcome;
use super::bars::{CONTACT_TIME, Drop, Record, Scheme, drop_bar};
use super::figure::Figure;
use super::sheet::Sheet;

pub const TOUCH: f64 = 0.5;
pub const SPEED: f64 = 10.0;
pub const PLATEAU: f64 = 300.0;
pub const RATE: f64 = 336.0;
/// Fronts are a few cells wide: they are left out over this time at both ends of the plateau (s).
pub const FRONT: f64 = 0.05;

/// The drop of this benchmark; the gap closes `phase` of a step after the end of one.
pub fn drop(phase: f64) -> Drop {
    Drop {
        n_cells: 100,
        dt: 1.0 / RATE,
        gravity: 0.0,
        gap: SPEED * (TOUCH + phase / RATE),
        speed: SPEED,
        n_steps: (1.5 * RATE) as usize,
    }
}

/// The plateau without its fronts (s).
pub const SPAN: [f64; 2] = [TOUCH + FRONT, TOUCH + CONTACT_TIME - FRONT];

pub fn run(sheet: &mut Sheet) -> Outcome {
    let scheme = Scheme::recommended();
    let mut drop_at = drop(0.0);
    drop_at.n_steps = sheet.n_steps(drop_at.n_steps);
    let record = drop_bar(&scheme, &drop_at)?;
    let [_, peak] = record.pressure_error(SPAN, |_| PLATEAU);
    sheet.relative(
        "mean pressure of the plateau (Pa)",
        PLATEAU,
        record.mean_pressure(SPAN),
        5e-3,
    );
    sheet.at_most(
        "largest error on the plateau, of 300 Pa (-)",
        5e-3,
        peak / PLATEAU,
    );
    let release = TOUCH + CONTACT_TIME;
    sheet.absolute("last contact (s)", release, record.release(2.0), 2.0 / RATE);
    let energy = record
        .energy
        .iter()
        .fold(0.0f64, |worst, e| worst.max((e - 1.0).abs()));
    sheet.absolute(
        "largest change of energy, of the initial (-)",
        0.0,
        energy,
        1e-3,
    );
    sheet.absolute("deepest overlap (m)", 0.0, record.penetration, 1e-9);
    sheet.tell(
        "velocity after the impact (m/s)",
        SPEED,
        record.at(&record.velocity, 1.45),
    );
    drop_at.gap = drop(0.5).gap;
    let late = drop_bar(&scheme, &drop_at)?;
    sheet.tell(
        "energy after a gap that closes half-way in a step",
        1.0,
        late.at(&late.energy, 1.45),
    );
    sheet.figure(figure(&record));
    Ok(())
}

fn figure(record: &Record) -> Figure {
    let [touch, release] = [TOUCH, TOUCH + CONTACT_TIME];
    let exact = vec![
        [0.0, 0.0],
        [touch, 0.0],
        [touch, PLATEAU],
        [release, PLATEAU],
        [release, 0.0],
        [1.5, 0.0],
    ];
    let axes = ["time (s)", "contact pressure (Pa)"];
    Figure::new("b1_pressure", "B1: pressure under the impacting bar", axes)
        .exact("exact", exact)
        .line("trapezoidal, moved mass", record.curve(&record.pressure))
}
