//! The main job on a coarse mesh: a truck and falling crates on a flexible bridge come to rest, and the piers carry them.
//!
//! ```text
//!            ___
//!   o-------|   |      []
//!   '-(_)---(_)-'     [__]     ◇        P = truck, crates
//!  ======================================
//!  |__|                              |__|   Σ R = Σ W,  δ by beam theory
//! ```

#[path = "../examples/bridge.rs"]
#[allow(dead_code, reason = "the example's own output is not needed here")]
mod bridge;

use foil2d::prelude::*;

/// Positions within 13 m are read back from rapier in its own precision: 1 ulp is 9.5e-7 m in `f32`.
const POSITION_TOLERANCE: f64 = if cfg!(feature = "f64") { 1e-9 } else { 1e-5 };

#[test]
#[cfg_attr(
    feature = "f64",
    ignore = "open: overlaps of 4.7e-8 m where the tolerance is that of double precision"
)]
fn the_piers_carry_the_weight_of_all_that_came_to_rest_on_the_bridge()
-> Result<(), Box<dyn std::error::Error>> {
    let setup = bridge::scene::Setup {
        divisions: [44, 2],
        dt: 1.0 / 120.0,
        integrator: Beta2::damped(0.9)?,
    };
    let run = bridge::run(&setup, 1440, |_| {})?;
    let found = &run.headline;
    assert!(found.finite);
    // What is left of the vibration has a mean of zero; its amplitude is below 1e-3 of the weight by then.
    assert!((found.weight_ratio - 1.0).abs() < 1e-3, "{found:?}");
    assert!(found.max_penetration_m < POSITION_TOLERANCE, "{found:?}");
    assert!(found.end_speed_m_per_s < 1e-3, "{found:?}");
    // The beam is 33 times longer than deep: what beam theory leaves out at the bearings is a few tenths of a percent.
    let deflection = found.midspan_deflection_m / found.midspan_deflection_beam_m;
    assert!((deflection - 1.0).abs() < 0.01, "{found:?}");
    let stress = found.midspan_stress_pa / found.midspan_stress_beam_pa;
    assert!((stress - 1.0).abs() < 0.01, "{found:?}");
    Ok(())
}

#[test]
fn the_film_strip_and_the_history_show_every_picture_and_every_step()
-> Result<(), Box<dyn std::error::Error>> {
    let run = bridge::run(&bridge::full()?, 48, |_| {})?;
    let svg = bridge::picture::film(&run).to_svg();
    assert_eq!(svg.matches("t = ").count(), 8, "one label per picture");
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
    assert_eq!(bridge::csv(&run.records).lines().count(), 1 + 48);
    Ok(())
}
