//! Soft bodies that land, bounce, rest and sleep.

use crate::common::*;
use std::f64::consts::PI;

#[test]
fn soft_bodies_stay_above_polylines_and_height_fields() {
    stay_above(&[
        (Form::Square, 1e5, Made::Cuboid, Relief::Flat),
        (Form::Star, 3e6, Made::Polyline(0.2), Relief::Valley),
        (Form::Star, 3e6, Made::Heights(0.2), Relief::Valley),
    ]);
}

#[test]
fn soft_bodies_stay_above_flat_polylines() {
    stay_above(&[
        (Form::Square, 1e5, Made::Polyline(0.2), Relief::Flat),
        (Form::Star, 3e5, Made::Polyline(0.2), Relief::Flat),
    ]);
}

fn stay_above(cases: &[(Form, f64, Made, Relief)]) {
    let mut findings = Findings::default();
    for &(form, young, made, relief) in cases {
        let mut scene = Scene::new(1.0 / 60.0);
        scene.fixed(ground_of(made, relief, 5.0));
        scene.flexible(
            form.builder()
                .material(elastic(young, 500.0, 5e-3))
                .translation([0.1, 1.2])
                .rotation(0.1),
        );
        let mut onlooker = Onlooker::default();
        onlooker.watch(&mut scene, 240, |_| ());
        let name = format!("{form:?}, E {young:.0e}, {made:?}, {relief:?}");
        onlooker.check(&mut findings, &name);
        // The report sees what an onlooker sees, but for the rounding of rapier's places.
        let (depth, told) = (onlooker.overlap().depth, onlooker.told);
        findings.check(depth < told + 1e-5, || {
            format!("{name}: {depth:.2e} m deep, told {told:.2e} m")
        });
    }
    findings.report();
}

#[test]
fn a_soft_disc_dropped_on_a_polyline_bounces_and_comes_to_rest_in_equilibrium() {
    let mut findings = Findings::default();
    for young in [1e5, 1e6] {
        let mut scene = Scene::new(1.0 / 60.0);
        scene.fixed(ground_of(Made::Polyline(0.2), Relief::Flat, 5.0));
        // Of the twenty corners of its outline none looks down: on one it would stand until rounding tips it over.
        let disc = scene.flexible(
            Form::Disc
                .builder()
                .material(elastic(young, 500.0, 5e-3))
                .translation([0.1, 2.3])
                .rotation(PI / 20.0),
        );
        let mut up = 0.0f64;
        let mut onlooker = Onlooker::default();
        onlooker.watch(&mut scene, 600, |scene| {
            up = up.max(scene.body(disc).linvel()[1]);
        });
        let name = format!("E {young:.0e}");
        onlooker.check(&mut findings, &name);
        onlooker.check_energy(&mut findings, &name, scene.body(disc).mass() * G * 2.0);
        let body = scene.body(disc);
        let (height, share) = (
            body.centre_of_mass()[1],
            body.total_contact_force()[1] / (body.mass() * G),
        );
        println!("{name}: up at {up:.3} m/s, rests at {height:.4} m with {share:.5} of its weight");
        // It lands at 6.3 m/s; damping of a third of critical leaves a third of that.
        findings.check(up > 0.3, || format!("{name}: thrown back at {up:.3} m/s"));
        findings.check((share - 1.0).abs() < 1e-3, || {
            format!("{name}: the ground carries {share:.5} of its weight")
        });
        // Its own weight squashes it by less than rho g r² / E = 4.4 mm at 1e5 Pa, a few times that at the contact.
        findings.check((0.27..0.301).contains(&height), || {
            format!("{name}: the centre rests at {height:.4} m")
        });
        // It rocks about a facet of its outline, which damps little: a tenth of a thousandth of what it brought is left.
        let left = scene.body(disc).energy().kinetic / (scene.body(disc).mass() * G * 2.0);
        findings.check(left < 1e-4, || {
            format!("{name}: moves with {left:.1e} of its energy after 10 s")
        });
    }
    findings.report();
}

#[test]
fn a_soft_disc_at_rest_stays_and_falls_asleep() {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.fixed(ground_of(Made::Cuboid, Relief::Flat, 200.0).friction(0.5));
    let disc = scene.flexible(
        FlexBodyBuilder::disc(0.2, 0.1)
            .material(elastic(1e6, 500.0, 0.0))
            .translation([0.0, 0.5])
            .friction(0.5),
    );
    let mut onlooker = Onlooker::default();
    onlooker.watch(&mut scene, 300, |_| ());
    let [settled, _] = scene.body(disc).centre_of_mass();
    let mut later = Onlooker::default();
    // It lands balanced on a facet and tips off it when rounding lets it, which may take half a minute.
    later.watch(&mut scene, 2100, |_| ());
    let mut findings = Findings::default();
    onlooker.check(&mut findings, "falling");
    later.check(&mut findings, "resting");
    let brought = scene.body(disc).mass() * G * 0.3;
    onlooker.check_energy(&mut findings, "falling", brought);
    later.check_energy(&mut findings, "resting", brought);
    let [x, _] = scene.body(disc).centre_of_mass();
    println!("at {settled:.4} m after 5 s, at {x:.4} m after 40 s");
    // From one facet of its outline to the next it is 0.1 m.
    findings.check((x - settled).abs() < 0.05, || {
        format!("it rolled by {:.3} m in 35 s", x - settled)
    });
    findings.check(scene.report().n_asleep() == 1, || "awake after 40 s".into());
    findings.report();
}

/// How long twenty bodies dropped 0.3 m take until they sleep (s), if at all within 20 s.
fn time_to_sleep(builder: impl Fn() -> FlexBodyBuilder) -> Option<f64> {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    for i in 0..20 {
        scene.flexible(
            builder()
                .material(elastic(1e6, 500.0, 2e-3))
                .translation([f64::from(i) - 10.0, 0.5]),
        );
    }
    (1..=1200)
        .find(|_| {
            scene.try_step().expect("the step can be taken");
            scene.report().n_asleep() == 20
        })
        .map(|step| f64::from(step) / 60.0)
}

#[test]
fn soft_squares_fall_asleep() {
    let squares = time_to_sleep(|| FlexBodyBuilder::rectangle([0.4, 0.4], [5, 5]));
    assert!(squares.is_some(), "squares sleep within 20 s");
}

#[test]
fn soft_discs_fall_asleep_as_soft_squares_do() {
    let squares = time_to_sleep(|| FlexBodyBuilder::rectangle([0.4, 0.4], [5, 5]));
    let discs = time_to_sleep(|| FlexBodyBuilder::disc(0.2, 0.1));
    println!("squares {squares:?} s, discs {discs:?} s");
    // A disc rocks about the facet it rests on, which takes longer than a square's bouncing.
    let squares = squares.expect("squares sleep within 20 s");
    let discs = discs.expect("discs sleep within 20 s");
    assert!(
        discs < 3.0 * squares + 2.0,
        "discs {discs} s, squares {squares} s"
    );
}
