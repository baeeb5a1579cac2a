//! Bodies that touch where a joint holds them: contact and joint may hold the same motion, and press against each other with forces that move nothing.

use crate::common::*;

/// Spins a scene freely for three seconds from its second step on, whose rounding the joints have taken out; energy never grows by a hundredth.
fn assert_no_growth(mut scene: Scene, name: &str) {
    scene.step();
    let start = energy_of(&scene);
    let n = (3.0 / scene.dt()) as usize;
    for step in 0..n {
        scene.step();
        let now = energy_of(&scene) / start;
        assert!(now < 1.01, "{name}, step {step}: {now} of the energy");
    }
}

fn bar(young: f64, density: f64, is_large: bool) -> FlexBodyBuilder {
    let bar = FlexBodyBuilder::rectangle([0.8, 0.2], [8, 2]).material(
        LinearElastic::plane_stress(young, 0.3)
            .density(density)
            .rayleigh(1e-3),
    );
    match is_large {
        true => bar.large_strain(),
        false => bar.small_strain(),
    }
}

/// A bar welded to a box that is hinged, in the middle of a face, to another one which it touches there. Their corners block the hinge: all turns as one.
#[test]
fn boxes_that_are_hinged_where_they_touch_keep_their_energy() {
    for (young, rate) in [(2e6, 60.0), (2e6, 120.0), (1e9, 60.0), (1e9, 120.0)] {
        let (spin, offset) = (1.0, 0.3);
        let mut scene = Scene::in_free_space(1.0 / rate);
        let bar = scene.flexible(
            bar(young, 50.0, false)
                .translation([0.0, -0.1])
                .linvel([0.0, -0.8 * spin])
                .angvel(spin),
        );
        let boxes = [(700.0, 0.0, 0.0), (400.0, 0.8, offset)].map(|(density, away, faster)| {
            let body = RigidBodyBuilder::dynamic()
                .translation(vec2(1.2 + away, 0.0))
                .linvel(vec2(0.0, spin * away + faster))
                .angvel(real(spin));
            let shape = ColliderBuilder::cuboid(real(0.4), real(0.1));
            scene.rigid(body, shape.density(real(density))).0
        });
        let weld = AttachmentBuilder::weld(bar).where_(|[x, _]| x > 0.799);
        scene
            .bodies
            .attach(weld.to_rigid_body(boxes[0]), &scene.world.bodies)
            .expect("a weld of the right end");
        let hinge = RevoluteJointBuilder::new()
            .local_anchor1(vec2(0.4, 0.0))
            .local_anchor2(vec2(-0.4, 0.0));
        scene
            .world
            .insert_impulse_joint(boxes[0], boxes[1], hinge.build());
        assert_no_growth(scene, &format!("E {young:e}, {rate} Hz"));
    }
}

/// A bar whose end is pinned to a box that it touches there, and one welded to another bar: the joints hold what the contacts would.
#[test]
fn bars_that_are_held_where_they_touch_keep_their_energy() {
    for is_large in [true, false] {
        for is_rigid in [true, false] {
            let mut scene = Scene::in_free_space(1.0 / 120.0);
            let spin = if is_rigid { 2.0 } else { 1.0 };
            let young = if is_rigid { 7e8 } else { 1e6 };
            let spinning = |x: f64, body: FlexBodyBuilder| {
                body.translation([x, -0.1])
                    .linvel([0.0, spin * (x + 0.4 - 0.8)])
                    .angvel(spin)
            };
            let first = scene.flexible(spinning(0.0, bar(young, 200.0, is_large)));
            let held =
                |kind: AttachmentBuilder| kind.where_(|[x, _]| x > 0.799).contacts_enabled(true);
            let held = if is_rigid {
                let body = RigidBodyBuilder::dynamic()
                    .translation(vec2(1.2, 0.0))
                    .linvel(vec2(0.0, 0.4 * spin))
                    .angvel(real(spin));
                let shape = ColliderBuilder::cuboid(real(0.4), real(0.1)).density(real(9000.0));
                let (body, _) = scene.rigid(body, shape);
                held(AttachmentBuilder::pin(first))
                    .to_rigid_body(body)
                    .at_point([-0.4, 0.0])
            } else {
                let second = scene.flexible(spinning(0.8, bar(young, 200.0, is_large)));
                held(AttachmentBuilder::weld(first)).to_flexible(second)
            };
            scene
                .bodies
                .attach(held, &scene.world.bodies)
                .expect("an attachment of the right end");
            assert_no_growth(scene, &format!("large {is_large}, to a box {is_rigid}"));
        }
    }
}

/// A ball hinged to a box exactly where the two touch, on contacts as rapier has them: the hinge lets it nod, the contact does not, and the two push against
/// each other with forces of any size. Some hundredths of the energy may come of that; it had been up to 26,000 times what there was.
#[test]
fn a_ball_that_is_hinged_where_it_touches_is_not_thrown() {
    for rate in [60.0, 120.0, 240.0, 1000.0] {
        let spin = -1.0;
        let mut scene = Scene::in_free_space(1.0 / rate);
        let turning = |y: f64, spin: f64, faster: f64| {
            RigidBodyBuilder::dynamic()
                .translation(vec2(0.0, y))
                .linvel(vec2(-spin * y, 0.0))
                .angvel(real(faster * spin))
        };
        let (chest, _) = scene.rigid(
            turning(0.0, spin, 1.0),
            ColliderBuilder::cuboid(0.15, 0.25).mass(20.0),
        );
        let (head, _) = scene.rigid(
            turning(0.37, spin, 1.3),
            ColliderBuilder::ball(0.12).mass(4.0),
        );
        let neck = hinge([0.0, 0.25], [0.0, -0.12]);
        scene.world.insert_impulse_joint(chest, head, neck.build());
        let limb = FlexBodyBuilder::rectangle([0.1, 0.5], [2, 10])
            .material(
                LinearElastic::plane_stress(2e6, 0.35)
                    .density(1000.0)
                    .rayleigh(2e-3),
            )
            .translation([-0.25, -0.25])
            .linvel([0.0, -0.2 * spin])
            .angvel(spin);
        let limb = scene.flexible(limb);
        let weld = AttachmentBuilder::weld(limb).where_(|[x, _]| x > 0.0999);
        scene
            .bodies
            .attach(weld.to_rigid_body(chest), &scene.world.bodies)
            .expect("a weld along the chest");
        let start = energy_of(&scene);
        for step in 0..(3.0 * rate) as usize {
            scene.try_step().expect("a step");
            let now = energy_of(&scene) / start;
            assert!(now < 1.1, "1/{rate} s, step {step}: {now} of the energy");
        }
    }
}

/// A bar hung on a hinge with a soft one at its end, which it touches where it holds it: what swings has the energy that it began with.
#[test]
fn bars_that_are_hung_and_touch_where_they_are_held_gain_nothing() {
    for (is_weld, rate) in [(true, 60.0), (true, 240.0), (false, 60.0), (false, 240.0)] {
        let mut scene = Scene::in_free_space(1.0 / rate).with_gravity(0.0, -9.81);
        let anchor = scene.world.insert_body(RigidBodyBuilder::fixed());
        let (upper, _) = scene.rigid(
            RigidBodyBuilder::dynamic().translation(vec2(0.5, 0.0)),
            ColliderBuilder::cuboid(0.5, 0.05).mass(20.0),
        );
        let hung = hinge([0.0, 0.0], [-0.5, 0.0]);
        scene
            .world
            .insert_impulse_joint(anchor, upper, hung.build());
        let lower = FlexBodyBuilder::rectangle([1.0, 0.1], [10, 2])
            .material(LinearElastic::plane_stress(3e8, 0.3).density(500.0))
            .translation([1.0, -0.05]);
        let lower = scene.flexible(lower);
        let held = match is_weld {
            true => AttachmentBuilder::weld(lower).where_(|[x, _]| x < 1e-9),
            false => {
                AttachmentBuilder::pin(lower).where_(|[x, y]| x < 1e-9 && (y - 0.05).abs() < 1e-9)
            }
        };
        let held = held.contacts_enabled(true).to_rigid_body(upper);
        scene
            .bodies
            .attach(held, &scene.world.bodies)
            .expect("the end is there");
        let fallen = 9.81 * (20.0 * 0.5 + 50.0 * 1.5);
        let start = energy_of(&scene);
        for step in 0..(4.0 * rate) as usize {
            scene.try_step().expect("a step");
            let gained = (energy_of(&scene) - start) / fallen;
            assert!(
                gained < 0.01,
                "weld {is_weld}, 1/{rate} s, step {step}: {gained} of the fall"
            );
        }
    }
}
