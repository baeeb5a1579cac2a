//! Beams that something heavy falls on, as thick as they are whatever the number of cells through them.

use crate::common::*;

/// What became of a ball that fell on a beam.
struct Throw {
    onlooker: Onlooker,
    /// Lowest and highest after that, from where it first touches (m).
    reached: [f64; 2],
    /// Most elastic energy (J).
    elastic: f64,
    /// Largest von Mises stress (Pa).
    stress: f64,
}

fn throw(
    scene: &mut Scene,
    beam: FlexBodyHandle,
    ball: RigidBodyHandle,
    touch: f64,
    time: f64,
) -> Throw {
    let mut seen = Throw {
        onlooker: Onlooker::default(),
        reached: [0.0, f64::MIN],
        elastic: 0.0,
        stress: 0.0,
    };
    let n_steps = (time / scene.dt()).round() as usize;
    let Throw {
        onlooker,
        reached,
        elastic,
        stress,
    } = &mut seen;
    onlooker.watch(scene, n_steps, |scene| {
        let (body, ball) = (scene.body(beam), &scene.world.bodies[ball]);
        let height = place_of(ball)[1] - touch;
        reached[0] = reached[0].min(height);
        if reached[0] < 0.0 && velocity_of(ball)[1] > 0.0 {
            reached[1] = reached[1].max(height);
        }
        *elastic = elastic.max(body.energy().elastic);
        let most = body.von_mises().expect("the element tells its stress");
        *stress = most.into_iter().fold(*stress, f64::max);
    });
    seen
}

/// A ball of 70 kg that falls 1 m on the end of a board of 4 m.
fn springboard(rate: f64, n_through: usize, rayleigh: f64) -> Throw {
    let mut scene = Scene::new(1.0 / rate);
    let board = scene.flexible(
        FlexBodyBuilder::rectangle([4.0, 0.05], [40, n_through])
            .material(elastic(1.15e10, 1000.0, rayleigh))
            .thickness(0.5)
            .pin_where(|[x, _]| x < 1e-9, Pin::both())
            .friction(0.8),
    );
    let (ball, _) = scene.rigid(
        RigidBodyBuilder::dynamic()
            .translation(vec2(3.8, 1.3))
            .lock_rotations(),
        ColliderBuilder::ball(0.25).mass(70.0).friction(0.8),
    );
    throw(&mut scene, board, ball, 0.3, 3.0)
}

#[test]
fn a_springboard_throws_back_whatever_its_cells_its_damping_and_the_step() {
    let mut findings = Findings::default();
    for rayleigh in [2e-3, 5e-3] {
        let reference = springboard(480.0, 1, rayleigh);
        let [_, expected] = reference.reached;
        println!("beta {rayleigh:.0e}: {expected:.3} m at 1/480 s, one cell thick");
        for (rate, n_through) in [(60.0, 1), (60.0, 2), (120.0, 2), (240.0, 2), (60.0, 3)] {
            let seen = springboard(rate, n_through, rayleigh);
            let name = format!("beta {rayleigh:.0e}, 1/{rate} s, {n_through} cells");
            let [lowest, highest] = seen.reached;
            println!(
                "{name}: lowest {lowest:.3} m, back to {highest:.3} m, elastic {:.4e} J",
                seen.elastic
            );
            seen.onlooker.check(&mut findings, &name);
            // The weight does work on the whole way down.
            let brought = 70.0 * G * (1.0 - lowest);
            seen.onlooker.check_energy(&mut findings, &name, brought);
            findings.check(seen.elastic < 1.02 * brought, || {
                format!(
                    "{name}: {:.3e} J stored, {brought:.3e} J brought",
                    seen.elastic
                )
            });
            // Steps of a sixtieth resolve the first mode (a period of 1 s) and damp what is faster.
            findings.check((highest - expected).abs() < 0.25 * expected, || {
                format!("{name}: thrown back to {highest:.3} m, not {expected:.3} m")
            });
        }
    }
    findings.report();
}

/// A ball of 100 kg that falls 0.5 m on the middle of a steel beam of 4 m on two pins.
fn steel_beam(rate: f64, n_through: usize, rayleigh: f64) -> Throw {
    let mut scene = Scene::new(1.0 / rate);
    let beam = scene.flexible(
        FlexBodyBuilder::rectangle([4.0, 0.2], [40, n_through])
            .material(elastic(2.1e11, 7800.0, rayleigh))
            .thickness(0.1)
            .friction(0.4)
            .pin_where(
                |[x, y]| (x - 2.0).abs() > 2.0 - 1e-9 && y < 1e-9,
                Pin::both(),
            ),
    );
    let (ball, _) = scene.rigid(
        RigidBodyBuilder::dynamic().translation(vec2(2.0, 0.8)),
        ColliderBuilder::ball(0.1).mass(100.0),
    );
    throw(&mut scene, beam, ball, 0.3, 1.0)
}

#[test]
fn a_ball_rebounds_from_a_steel_beam_whatever_the_cells_through_its_thickness() {
    rebound(&[1e-3]);
}

#[test]
fn a_ball_rebounds_from_a_steel_beam_of_little_damping() {
    rebound(&[0.0, 1e-4]);
}

fn rebound(dampings: &[f64]) {
    let mut findings = Findings::default();
    for &rayleigh in dampings {
        let expected = steel_beam(60.0, 1, rayleigh);
        for n_through in [1, 2, 4] {
            let seen = steel_beam(60.0, n_through, rayleigh);
            let name = format!("beta {rayleigh:.0e}, {n_through} cells");
            let [lowest, highest] = seen.reached;
            println!(
                "{name}: {:.2} mm down, back to {:.2} mm, elastic {:.3e} J, stress {:.2e} Pa",
                -1e3 * lowest,
                1e3 * highest,
                seen.elastic,
                seen.stress
            );
            seen.onlooker.check(&mut findings, &name);
            let brought = 100.0 * G * (0.5 - lowest);
            seen.onlooker.check_energy(&mut findings, &name, brought);
            findings.check(seen.elastic < 1.02 * brought, || {
                format!(
                    "{name}: {:.3e} J stored, {brought:.3e} J brought",
                    seen.elastic
                )
            });
            // Bending does not depend on the cells through the thickness; of what is local, a rebound shows little and the stress
            // under the ball some.
            let same = expected.reached[1];
            findings.check((highest - same).abs() < 0.2 * same, || {
                format!(
                    "{name}: back to {:.2} mm, one cell thick {:.2} mm",
                    1e3 * highest,
                    1e3 * same
                )
            });
            findings.check(seen.stress < 2.0 * expected.stress, || {
                format!(
                    "{name}: {:.2e} Pa, one cell thick {:.2e} Pa",
                    seen.stress, expected.stress
                )
            });
        }
    }
    findings.report();
}

#[test]
fn a_ball_in_a_cup_on_a_bent_arm_brings_no_energy() {
    let mut findings = Findings::default();
    for rate in [60.0, 120.0] {
        let mut scene = Scene::new(1.0 / rate);
        let [width, length] = [0.08, 2.0];
        let arm = scene.flexible(
            FlexBodyBuilder::rectangle([width, length], [2, 30])
                .material(elastic(1e9, 700.0, 5e-4))
                .thickness(0.08)
                .translation([0.0, 0.02])
                .pin_where(|[_, y]| y < 1e-9, Pin::both()),
        );
        let cup = RigidBodyBuilder::dynamic().translation(vec2(0.5 * width, 2.02));
        let bottom = ColliderBuilder::cuboid(0.15, 0.02)
            .translation(vec2(0.0, 0.03))
            .mass(0.1);
        let wall = ColliderBuilder::cuboid(0.02, 0.06)
            .translation(vec2(-0.14, 0.1))
            .mass(0.05);
        let (cup, _) = scene.rigid(cup, bottom);
        scene.world.insert_collider(wall, Some(cup));
        let tip = move |[_, y]: [f64; 2]| y > length - 1e-9;
        let weld = AttachmentBuilder::weld(arm).where_(tip).to_rigid_body(cup);
        let rope = AttachmentBuilder::pin(arm).where_(tip).to_world();
        let bodies = &scene.world.bodies;
        scene.bodies.attach(weld, bodies).expect("the cup is there");
        let rope = scene.bodies.attach(rope, bodies).expect("the arm is there");
        scene.rigid(
            RigidBodyBuilder::dynamic().translation(vec2(0.02, 2.15)),
            ColliderBuilder::ball(0.08).mass(1.0).friction(0.6),
        );
        let name = format!("1/{rate} s");
        let n = rate as usize;
        let mut pulling = Onlooker::default();
        for step in 1..=n {
            let part = step as f64 / rate;
            let rope = scene.bodies.attachment_mut(rope).expect("it is there");
            rope.set_target([-0.4 * part, 0.0], 0.0)
                .expect("the numbers are finite");
            pulling.step(&mut scene);
        }
        pulling.check(&mut findings, &format!("{name}, pulled"));
        // Held still, nothing does work any more.
        let settled = scene.body(arm).energy().elastic;
        let mut still = Onlooker::default();
        still.watch(&mut scene, 3 * n, |_| ());
        println!(
            "{name}: {settled:.2} J stored, {:.3e} J gained",
            still.rise()
        );
        still.check(&mut findings, &name);
        // What the bent arm stores is all that there is to gain from.
        still.check_energy(&mut findings, &name, settled);
    }
    findings.report();
}
