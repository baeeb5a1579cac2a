//! Soft tyres that roll, and a car that drives.

use crate::common::*;

/// Where a car with these tyres is after 5 s (m), and what was seen.
fn drive(young: Option<f64>) -> (f64, Onlooker) {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.fixed(ground_of(Made::Polyline(0.1), Relief::Flat, 40.0).friction(1.0));
    let chassis = car(&mut scene, young);
    let mut onlooker = Onlooker::default();
    onlooker.watch(&mut scene, 300, |_| ());
    (place_of(&scene.world.bodies[chassis])[0], onlooker)
}

#[test]
fn a_car_with_soft_tyres_drives_on_a_polyline() {
    let (rigid, _) = drive(None);
    let (soft, onlooker) = drive(Some(1e6));
    println!("rigid wheels {rigid:.2} m, soft tyres {soft:.2} m");
    let mut findings = Findings::default();
    onlooker.check(&mut findings, "car");
    // Tyres weigh six times as much as the hubs whose inertia rapier's motors reckon with, and roll on a squeezed radius.
    findings.check((0.5 * rigid..1.05 * rigid).contains(&soft), || {
        format!("{soft:.2} m with soft tyres, {rigid:.2} m with rigid wheels")
    });
    findings.report();
}

/// A tyre on its hub, turned by this torque (N m).
fn roll(
    made: Made,
    young: f64,
    torque: f64,
    speed: f64,
    time: f64,
) -> (Scene, FlexBodyHandle, Onlooker) {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.fixed(ground_of(made, Relief::Flat, 60.0).friction(1.0));
    let spin = -speed / WHEEL[0];
    let tyre = scene.flexible(tyre([0.0, 0.451], young).linvel([speed, 0.0]).angvel(spin));
    let (hub, _) = scene.rigid(
        RigidBodyBuilder::dynamic()
            .translation(vec2(0.0, 0.451))
            .linvel(vec2(speed, 0.0))
            .angvel(real(spin)),
        hub_ball(0.2),
    );
    mount(&mut scene, tyre, hub);
    scene.world.bodies[hub].add_torque(real(torque), true);
    let mut onlooker = Onlooker::default();
    onlooker.watch(&mut scene, (60.0 * time) as usize, |_| ());
    (scene, tyre, onlooker)
}

#[test]
fn a_soft_tyre_that_is_turned_rolls() {
    let mut findings = Findings::default();
    for made in [Made::Cuboid, Made::Polyline(0.5), Made::Polyline(0.1)] {
        let (torque, time) = (40.0, 2.0);
        let (scene, tyre, onlooker) = roll(made, 1e6, -torque, 0.0, time);
        let name = format!("{made:?}");
        onlooker.check(&mut findings, &name);
        let body = scene.body(tyre);
        // Rolls without slipping: torque / radius over mass and inertia / radius², of ring and ball.
        let inertia =
            0.5 * body.mass() * (0.45f64.powi(2) + 0.22f64.powi(2)) + 0.5 * 5.0 * 0.2f64.powi(2);
        let inert = body.mass() + 5.0 + inertia / WHEEL[0].powi(2);
        let expected = 0.5 * torque / WHEEL[0] / inert * time * time;
        let [x, _] = body.centre_of_mass();
        println!("{name}: {x:.3} m, a rigid wheel {expected:.3} m");
        // Damped tyres take up to a third of a drive of a quarter of the weight.
        findings.check((0.65 * expected..1.05 * expected).contains(&x), || {
            format!("{name}: {x:.3} m, a rigid wheel {expected:.3} m")
        });
    }
    findings.report();
}

#[test]
fn a_soft_tyre_that_rolls_gains_no_speed_and_does_not_stop_at_once() {
    let mut findings = Findings::default();
    for made in [Made::Cuboid, Made::Polyline(0.5), Made::Polyline(0.1)] {
        let (scene, tyre, onlooker) = roll(made, 1e6, 0.0, 2.0, 1.0);
        let name = format!("{made:?}");
        onlooker.check(&mut findings, &name);
        onlooker.check_energy(&mut findings, &name, onlooker.energy[0]);
        let [x, _] = scene.body(tyre).centre_of_mass();
        println!(
            "{name}: {x:.3} m in 1 s from 2 m/s, gained {:.3e} of {:.3e} J",
            onlooker.rise(),
            onlooker.energy[0]
        );
        findings.check((1.0..2.02).contains(&x), || {
            format!("{name}: {x:.3} m in 1 s from 2 m/s")
        });
    }
    findings.report();
}
