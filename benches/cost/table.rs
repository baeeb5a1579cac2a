//! What is printed of a scene.

use crate::measure::Timing;
use crate::scene::{DT, Scene};

/// Prints the times of one scene; the first two sides are this crate's.
pub fn print(scene: &Scene, timings: &[Timing]) {
    let last = if scene.is_clamped() {
        format!("tip after {:.2} s, mm", scene.n_warm_up as f64 * DT)
    } else {
        String::new()
    };
    println!("\n{}", scene.name());
    println!(
        "  {:<22} {:>11} {:>11} {:>11} {:>11} {:>11}  {last}",
        "median of a step, us", "whole", "rapier's", "stage", "/ first", "/ Quad4"
    );
    for timing in timings {
        let deflection = if scene.is_clamped() {
            format!("{:.2}", 1e3 * timing.deflection)
        } else {
            String::new()
        };
        println!(
            "  {:<22} {:>11} {:>11} {:>11} {:>11} {:>11}  {deflection}",
            timing.label,
            digits(timing.whole()),
            digits(timing.rapier()),
            digits(timing.own()),
            digits(timing.ratio_to(&timings[0])),
            digits(timing.ratio_to(&timings[1])),
        );
    }
}

/// How the numbers are to be read.
pub fn print_reading() {
    println!("{READING}");
}

const READING: &str = "
Reading
  - foil2d Tri3 and rapier's soft bodies share every triangle; Quad4 (the default) and Tri6 have the same nodes. dt = 1/60 s.
  - \"rapier's\" is what rapier's own steps take within foil2d's step (one with dt = 0 where it was needed, then the full one);
    \"stage\" is the rest. Ratios are of whole steps.
  - rapier's soft bodies run with 4 substeps and default settings; \"converged Fem\" lifts the cap of 20
    conjugate-gradient iterations to 2000, \"Fem to 1e-8\" lowers the tolerance from 1e-5 as well: same tip, more work.
    Their cantilever has no collision surface, foil2d's has.
  - The cantilever is undamped. The block is damped (Rayleigh 2 ms here, rapier's default there); in contact
    it was dropped from 1 m, and the steps that count are those from 2 s on in which it touches the floor.
  - Where it does not say \"large strain\": foil2d's body keeps one factor in one co-rotating frame, rapier's soft bodies are
    corotational cell by cell and also stand large strain, which this body does not.
  - Bodies of large strain find their equilibrium to 1e-8 in every step. The swing goes down by .9 of the length: a side whose tip goes
    beyond the length solves something else.
  - rapier's soft bodies rest without sinking, stick and slip about right, tear, collide with themselves, recover from
    tangles, sleep and serialize. A step is not all there is to a soft body.
  - A step that is wrong is not fast: beam theory lets the cantilever's tip swing down to 2 x 15.1 mm = 30.2 mm after
    half a period of 1.97 s. Compare the last column, and converged Fem where the default Fem is too soft.";

/// Three digits, or a dash for nothing.
fn digits(value: Option<f64>) -> String {
    match value {
        None => "-".to_owned(),
        Some(value) if value < 10.0 => format!("{value:.2}"),
        Some(value) if value < 100.0 => format!("{value:.1}"),
        Some(value) => format!("{value:.0}"),
    }
}
