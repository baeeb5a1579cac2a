//! Soft bodies that land, bounce, rest and sleep.

use crate::common::*;

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
        let disc = scene.flexible(
            Form::Disc
                .builder()
                .material(elastic(young, 500.0, 5e-3))
                .translation([0.1, 2.3]),
        );
        let (mut up, mut carried) = (0.0f64, 0.0);
        let mut step = 0;
        let mut onlooker = Onlooker::default();
        onlooker.watch(&mut scene, 600, |scene| {
            let body = scene.body(disc);
            up = up.max(body.linvel()[1]);
            step += 1;
            if step > 300 {
                carried += body.total_contact_force()[1] / 300.0;
            }
        });
        let name = format!("E {young:.0e}");
        onlooker.check(&mut findings, &name);
        onlooker.check_energy(&mut findings, &name, scene.body(disc).mass() * G * 2.0);
        let body = scene.body(disc);
        let (height, share) = (body.centre_of_mass()[1], carried / (body.mass() * G));
        // It has landed on a corner, tips over, by rounding, and rocks on a facet: for minutes by its damping, if it is soft.
        let kinetic = body.energy().kinetic;
        println!(
            "{name}: up at {up:.3} m/s, rests at {height:.4} m with {share:.6} of its weight and {kinetic:.1e} J"
        );
        // It lands at 6.3 m/s; damping of a third of critical leaves a third of that.
        findings.check(up > 0.3, || format!("{name}: thrown back at {up:.3} m/s"));
        findings.check((share - 1.0).abs() < 1e-3, || {
            format!("{name}: the ground carries {share:.5} of its weight")
        });
        // Its own weight squashes it by less than rho g r² / E = 4.4 mm at 1e5 Pa, a few times that at the contact.
        findings.check((0.27..0.301).contains(&height), || {
            format!("{name}: the centre rests at {height:.4} m")
        });
        // A thousandth of what it brought; a corner stands 3.6 J higher than the middle of a facet.
        findings.check(kinetic < 1e-3 * body.mass() * G * 2.0, || {
            format!("{name}: {kinetic:.1e} J after 10 s")
        });
    }
    findings.report();
}

/// A disc of 0.4 m without damping, dropped 0.3 m on its corner in the middle, 5 s later and 30 s later. It tips over from its corner, by rounding,
/// and rocks on the facet beside it, in the end at 2.9 Hz: only the integrator damps that, by 0.13 a second.
#[test]
#[ignore = "open: it rolls by 1.7 m in 25 s and gains 0.4 J"]
fn a_soft_disc_at_rest_stays_and_gains_nothing() {
    let mut findings = Findings::default();
    let (mut scene, disc) = dropped_disc(0.0);
    let brought = scene.body(disc).mass() * G * 0.3;
    let total = |scene: &Scene| total_energy(scene.body(disc));
    let mut onlooker = Onlooker::default();
    onlooker.watch(&mut scene, 300, |_| ());
    let [settled, _] = scene.body(disc).centre_of_mass();
    let before = total(&scene);
    let (mut least, mut gained) = (before, 0.0f64);
    let mut later = Onlooker::default();
    later.watch(&mut scene, 1500, |scene| {
        gained = gained.max(total(scene) - least);
        least = least.min(total(scene));
    });
    onlooker.check(&mut findings, "falling");
    later.check(&mut findings, "resting");
    onlooker.check_energy(&mut findings, "falling", brought);
    later.check_energy(&mut findings, "resting", brought);
    let [x, _] = scene.body(disc).centre_of_mass();
    let kinetic = scene.body(disc).energy().kinetic;
    println!(
        "at {settled:.4} m after 5 s, at {x:.4} m after 30 s with {kinetic:.1e} J, {:.1e} J gained of {:.2} J lost",
        gained,
        before - total(&scene)
    );
    // From one facet of its outline to the next it is 0.05 m.
    findings.check((x - settled).abs() < 0.05, || {
        format!("it rolled by {:.3} m in 25 s", x - settled)
    });
    // A twentieth of what it needs to get over the next corner.
    findings.check(gained < 0.05, || format!("it gained {gained:.2e} J"));
    // On its corner it stands a joule higher than on the facet.
    findings.check(kinetic < 0.05 && before - total(&scene) > 0.5, || {
        format!("it still moves with {kinetic:.2e} J after 30 s")
    });
    findings.report();
}

/// It pivots about the node that it stands on: no force does work there.
#[test]
fn a_soft_disc_that_tips_over_its_corner_gains_nothing_on_the_way() {
    let (mut scene, disc) = dropped_disc(0.0);
    scene.steps(300);
    let before = total_energy(scene.body(disc));
    let mut n_steps = 0;
    while scene.body(disc).energy().kinetic < 0.3 && n_steps < 300 {
        scene.step();
        n_steps += 1;
    }
    let gained = total_energy(scene.body(disc)) - before;
    let kinetic = scene.body(disc).energy().kinetic;
    println!("{gained:.1e} J gained with {kinetic:.2} J after {n_steps} steps");
    // Half a percent with moments at the time of the weights.
    assert!(
        gained.abs() < 1e-3 * kinetic,
        "{gained:.2e} J gained with {kinetic:.2} J"
    );
}

/// Kinetic, elastic and potential energy (J).
fn total_energy(body: &FlexBody) -> f64 {
    let energy = body.energy();
    energy.kinetic + energy.elastic + body.mass() * G * body.centre_of_mass()[1]
}

#[test]
fn a_damped_soft_disc_at_rest_falls_asleep() {
    let (mut scene, disc) = dropped_disc(5e-3);
    scene.steps(600);
    let [x, _] = scene.body(disc).centre_of_mass();
    assert!(x.abs() < 0.05, "it rolled by {x:.3} m");
    assert_eq!(scene.report().n_asleep(), 1, "awake after 10 s");
}

fn dropped_disc(rayleigh: f64) -> (Scene, FlexBodyHandle) {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.fixed(ground_of(Made::Cuboid, Relief::Flat, 200.0).friction(0.5));
    let disc = scene.flexible(
        FlexBodyBuilder::disc(0.2, 0.1)
            .material(elastic(1e6, 500.0, rayleigh))
            .translation([0.0, 0.5])
            .friction(0.5),
    );
    (scene, disc)
}

/// How long twenty bodies dropped 0.3 m take until they sleep (s), if at all within 20 s.
fn time_to_sleep(builder: impl Fn() -> FlexBodyBuilder) -> Option<f64> {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    for i in 0..20 {
        scene.flexible(
            builder()
                .material(elastic(1e6, 500.0, 5e-3))
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

/// With less damping, of 2e-3 s, discs have tipped over from their corners before these are still, and rock on a facet at 2.9 Hz, by 0.018 of critical
/// damping: for some 40 s, until they move by less than a hundred-millionth of their size.
#[test]
fn soft_discs_fall_asleep_as_soft_squares_do() {
    let squares = time_to_sleep(|| FlexBodyBuilder::rectangle([0.4, 0.4], [5, 5]));
    let discs = time_to_sleep(|| FlexBodyBuilder::disc(0.2, 0.1));
    println!("squares {squares:?} s, discs {discs:?} s");
    let squares = squares.expect("squares sleep within 20 s");
    let discs = discs.expect("discs sleep within 20 s");
    assert!(
        discs < 3.0 * squares + 2.0,
        "discs {discs} s, squares {squares} s"
    );
}
