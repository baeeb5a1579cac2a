//! What stretched bodies do when they are plucked, let go, mirrored, turned, and saved.

use crate::support::*;
use foil2d::prelude::*;
use std::f64::consts::{PI, TAU};

/// A string: 1 m by 10 mm.
const THIN: f64 = 0.01;

fn string(stretch: f64) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([LENGTH, THIN], [60, 1])
        .material(hooke())
        .thickness(THICKNESS)
        .pre_stretch(PreStretch::along_x(stretch))
        .pin_where(is_end, Pin::both())
}

/// Frequency of the n-th mode of a string with some stiffness in bending, clamped at both ends (Hz): with `ε² = E I/T L²`,
///
/// ```text
/// f = n/2L √(T/ρA) (1 + 2 ε + (4 + n² π²/2) ε²)
/// ```
///
/// P. M. Morse, *Vibration and Sound*, 2nd ed., §16. Sections are those of the stretched strip, and its modulus that of further stretching.
fn note(n: f64, stretch: f64) -> f64 {
    let [lambda, mu] = constants();
    let [across, nominal] = neo_hookean([lambda, mu], stretch);
    let volume = THIN / across * THICKNESS / stretch;
    let tension = nominal * THIN / across * THICKNESS;
    let further = 1e-6;
    let stiffer = neo_hookean([lambda, mu], stretch + further)[1];
    // dσ/dε of what is stretched: λ dP/dλ over the stretched section.
    let modulus = stretch * (stiffer - nominal) / further / across;
    let bending = modulus * THICKNESS * THIN.powi(3) / 12.0;
    let epsilon = (bending / tension).sqrt() / LENGTH;
    let line = DENSITY * volume;
    let stiff = 1.0 + 2.0 * epsilon + (4.0 + 0.5 * (n * PI).powi(2)) * epsilon * epsilon;
    0.5 * n / LENGTH * (tension / line).sqrt() * stiff
}

/// The four lowest modes have the notes of Morse's stiff string. What is left are shear, the turning of sections and the next order in `ε`.
#[test]
fn a_string_has_the_notes_of_its_tension() {
    for stretch in [1.02, STRETCH, 1.3] {
        let body = string(stretch).build().expect("a string");
        let modes = body.natural_modes(7, 1e-8).expect("the string is stable");
        // At a stretch of 1.3 the lowest wave along the string is slower than its second note.
        let across = modes.modes.iter().filter(|mode| {
            let [along, across] = [0, 1].map(|axis| {
                let moved = mode.shape.iter().skip(axis).step_by(2);
                moved.fold(0.0f64, |most, u| most.max(u.abs()))
            });
            across > along
        });
        for (n, mode) in across.take(4).enumerate() {
            let expected = note((n + 1) as f64, stretch);
            let off = mode.frequency() / TAU / expected - 1.0;
            println!("note {} at {stretch}: {off:e}", n + 1);
            assert!(off.abs() < 0.01, "note {} at {stretch}: {off:e}", n + 1);
        }
    }
}

/// Plucked in its lowest mode, the middle goes to and fro at that frequency: measured by zero crossings over eight periods of 200 steps.
#[test]
fn a_plucked_string_swings_at_its_note() {
    let expected = note(1.0, STRETCH);
    let dt = 1.0 / (200.0 * expected);
    let body = string(STRETCH);
    let built = body.clone().build().expect("a string");
    let nodes = built.mesh().nodes().iter();
    let pluck = nodes.map(|[x, _]| [0.0, 0.02 * (PI * x / LENGTH).sin()]);
    let mut run = Run::new(body.velocities(pluck.collect()), dt);
    let mut crossings = Vec::new();
    let mut last = 0.0;
    for step in 1..=1600 {
        run.step();
        let [_, now] = run.strip().displacement(30);
        if last * now < 0.0 {
            crossings.push((step as f64 - now / (now - last)) * dt);
        }
        last = now;
    }
    let n_halves = (crossings.len() - 1) as f64;
    let period = 2.0 * (crossings[crossings.len() - 1] - crossings[0]) / n_halves;
    let off = 1.0 / (period * expected) - 1.0;
    println!("plucked: {off:e}");
    assert!(n_halves >= 14.0 && off.abs() < 0.01, "{n_halves}: {off:e}");
}

/// Let go in flight, a strip contracts, and swings about the length it has free of stress. It begins with the energy of its law, and keeps both momenta to
/// rounding and the energy to what a step is solved to.
#[test]
fn a_free_strip_contracts_and_keeps_energy_and_momentum() {
    let stretch = 1.2;
    let body = free_strip(hooke())
        .pre_stretch(PreStretch::along_x(stretch))
        .linvel([0.3, -0.2])
        .angvel(0.5);
    // Waves along the strip take L/c for a period of half a swing.
    let wave = (YOUNG / DENSITY).sqrt();
    let dt = LENGTH / wave / 50.0;
    let mut run = Run::new(body, dt);
    run.flex = FlexPipeline::new().with_integrator(Beta2::damped(1.0).expect("a member"));
    let [lambda, mu] = constants();
    let [across, _] = neo_hookean([lambda, mu], stretch);
    let ln = (stretch * across).ln();
    let density =
        0.5 * mu * (stretch * stretch + across * across - 2.0) - mu * ln + 0.5 * lambda * ln * ln;
    let stored = density * LENGTH * HEIGHT * THICKNESS / (stretch * across);
    let begin = run.strip().energy();
    assert!((begin.elastic / stored - 1.0).abs() < 1e-9);
    let momenta = |body: &FlexBody| {
        let [x, y] = body.momentum();
        [x, y, body.angular_momentum([0.0; 2])]
    };
    let before = momenta(run.strip());
    let whole = begin.kinetic + begin.elastic;
    let length = |body: &FlexBody| {
        let ([x, y], [u, v]) = (body.position(41), body.position(81));
        (u - x).hypot(v - y)
    };
    let mut shortest = f64::INFINITY;
    for _ in 0..200 {
        run.step();
        let now = run.strip().energy();
        assert!(((now.kinetic + now.elastic) / whole - 1.0).abs() < 1e-8);
        for (now, before) in momenta(run.strip()).into_iter().zip(before) {
            assert!((now - before).abs() < 1e-10 * run.strip().mass());
        }
        shortest = shortest.min(length(run.strip()));
    }
    // As much shorter than free of stress as it was longer, but for what the law is stiffer there.
    let free = LENGTH / stretch;
    assert!(shortest < 0.9 * free && shortest > 0.7 * free, "{shortest}");
}

/// A strip that is plucked and a mirrored, a turned and a shifted one do the same, to 1e-9 of its length in two hundred steps.
#[test]
fn mirrored_and_turned_strips_do_the_same() {
    let (angle, shift) = (0.7f64, [3.0, -1.0]);
    let make = |mirror: f64, angle: f64, shift: [f64; 2]| {
        let body = strip(hooke())
            .pre_stretch([STRETCH, 1.0])
            .rotation(angle)
            .translation(shift);
        let built = body.clone().build().expect("a strip");
        let (sin, cos) = angle.sin_cos();
        let nodes = built.mesh().nodes().iter();
        let pluck = nodes.map(|[x, _]| {
            let x = if mirror < 0.0 { LENGTH - x } else { *x };
            let [u, v] = [0.0, 0.5 * x * x * (LENGTH - x)];
            [cos * u - sin * v, sin * u + cos * v]
        });
        let mut run = Run::new(body.velocities(pluck.collect()), 1.0 / 480.0);
        for _ in 0..200 {
            run.step();
        }
        run
    };
    let plain = make(1.0, 0.0, [0.0; 2]);
    let mirrored = make(-1.0, 0.0, [0.0; 2]);
    let turned = make(1.0, angle, shift);
    let (sin, cos) = angle.sin_cos();
    for node in 0..plain.strip().n_nodes() {
        let [u, v] = plain.strip().displacement(node);
        let other = 41 * (node / 41) + 40 - node % 41;
        let [x, y] = mirrored.strip().displacement(other);
        assert!((x + u).abs().max((y - v).abs()) < 1e-9, "mirrored");
        let [x, y] = turned.strip().displacement(node);
        let [p, q] = [cos * u - sin * v, sin * u + cos * v];
        assert!((x - p).abs().max((y - q).abs()) < 1e-9, "turned");
    }
    let middle = plain.strip().displacement(20);
    assert!(middle[1].abs() > 1e-4, "they swing");
}

/// A run that was saved goes on bit for bit; the stress-free shape is saved with it.
#[cfg(feature = "serde-serialize")]
#[test]
fn a_saved_string_goes_on_bit_for_bit() {
    use foil2d::pipeline::Snapshot;
    let body = strip(hooke())
        .pre_stretch([STRETCH, 0.99])
        .rotation(0.3)
        .nodal_force(60, [0.0, -2.0]);
    let mut run = Run::new(body, 1.0 / 120.0);
    for _ in 0..20 {
        run.step();
    }
    let saved = Snapshot::take(&run.world, &run.flex_bodies, &run.flex).expect("laws are built in");
    let (world, flex_bodies, flex) = saved.restore().expect("a sound one");
    let mut other = Run {
        world,
        flex_bodies,
        flex,
        strip: run.strip,
    };
    for _ in 0..40 {
        run.step();
        other.step();
        assert_eq!(run.strip().state(), other.strip().state());
    }
    let node = run.strip().displacement(60);
    assert_eq!(node, other.strip().displacement(60));
    assert!(node[1] < -1e-4);
}
