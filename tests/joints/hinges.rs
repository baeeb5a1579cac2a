//! Hinged rigid bodies: period, energy, closure.

use crate::common::*;
use crate::support::*;

/// Period of a pendulum that swings by `amplitude`, from that of small swings, by the arithmetic-geometric mean.
fn period_at(amplitude: f64, small: f64) -> f64 {
    let (mut a, mut g) = (1.0f64, (0.5 * amplitude).cos());
    for _ in 0..8 {
        (a, g) = (0.5 * (a + g), (a * g).sqrt());
    }
    small / a
}

#[test]
fn a_compound_pendulum_has_its_exact_period_and_keeps_its_swing() {
    // A rod of 1 m hinged at its end, released at 60 degrees.
    //   T0 = 2π √(2L/3g); T by the arithmetic-geometric mean.
    let mut scene = Scene::new(DT);
    let anchor = claimed_anchor(&mut scene);
    let amplitude = std::f64::consts::FRAC_PI_3;
    let [sin, cos] = [amplitude.sin(), amplitude.cos()];
    let rod = free_body(&mut scene, [0.5 * sin, -0.5 * cos], 1.0, 1.0 / 12.0);
    scene.world.bodies[rod].set_rotation(Rotation::new(real(amplitude)), true);
    let hinge = RevoluteJointBuilder::new().local_anchor2(vec2(0.0, 0.5));
    join(&mut scene, anchor, rod, hinge);
    let exact = period_at(amplitude, std::f64::consts::TAU * (2.0 / (3.0 * G)).sqrt());
    let (mut crossings, mut last, mut time) = (Vec::new(), amplitude, 0.0);
    let mut largest = 0.0f64;
    while crossings.len() < 41 {
        scene.step();
        time += DT;
        let now = angle(&scene, rod);
        if now < 0.0 && last >= 0.0 {
            crossings.push(time - DT * now / (now - last));
        }
        if crossings.len() > 39 {
            largest = largest.max(now.abs());
        }
        last = now;
        assert!(time < 100.0, "it no longer swings");
    }
    let period = (crossings[40] - crossings[0]) / 40.0;
    println!(
        "period {period} exact {exact} error {:e} swing {largest} of {amplitude}",
        period / exact - 1.0
    );
    assert!((period / exact - 1.0).abs() < 1e-4);
    assert!((largest / amplitude - 1.0).abs() < 1e-3);
}
