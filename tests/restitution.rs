//! Newton's restitution where an impact is shorter than the step: rigid contacts in a claimed island, stiff bodies.

mod common;

use common::*;
use CoefficientCombineRule::{Average, Max, Min, Multiply};

/// A rigid ball falls on a rigid box that rests on a flexible slab, so that the pair is solved in one island.
fn on_a_box(e: [f64; 2], rules: [CoefficientCombineRule; 2], speed: f64, dt: f64, heavy: f64) -> (f64, bool) {
    let mut scene = Scene::in_free_space(dt);
    scene.flexible(
        FlexBodyBuilder::rectangle([2.0, 0.5], [16, 4])
            .material(LinearElastic::plane_stress(1e9, 0.3).density(1000.0).rayleigh(1e-4))
            .pin_where(|[_, y]| y == 0.0, Pin::both()),
    );
    let (_, _) = scene.rigid(
        RigidBodyBuilder::dynamic().translation(vec2(1.013, 0.7)).gravity_scale(0.0),
        ColliderBuilder::cuboid(0.3, 0.2).density(real(heavy)).restitution(real(e[0])).restitution_combine_rule(rules[0]).friction(0.0),
    );
    let (ball, _) = scene.rigid(
        RigidBodyBuilder::dynamic().translation(vec2(1.013, 1.3)).linvel(vec2(0.0, -speed)),
        ColliderBuilder::ball(0.1).density(100.0).restitution(real(e[1])).restitution_combine_rule(rules[1]).friction(0.0),
    );
    let mut claimed = false;
    for _ in 0..(0.5 / dt) as usize {
        scene.step();
        claimed |= scene.report().n_claimed() == 2;
    }
    (f64::from(scene.world.bodies[ball].linvel().y) / speed, claimed)
}

#[test]
fn probe() {
    for dt in [1.0/60.0, 1.0 / 240.0] {
    for e in [0.0, 0.5, 1.0] {
        // Relative velocity after = e * before: the box takes the rest.
        println!("rigid on box e {e} dt {dt:.4}: {:?}", on_a_box([e, e], [Average, Average], 2.0, dt, 1e9));
    }
    println!("rules avg(0,1) {:?}", on_a_box([0.0, 1.0], [Average, Average], 2.0, dt, 1e9));
    println!("rules max(0,.8) {:?}", on_a_box([0.0, 0.8], [Average, Max], 2.0, dt, 1e9));
    println!("rules min(.3,.8) {:?}", on_a_box([0.3, 0.8], [Average, Min], 2.0, dt, 1e9));
    println!("rules mul(.5,.8) {:?}", on_a_box([0.5, 0.8], [Multiply, Average], 2.0, dt, 1e9));
    for e in [0.0, 0.5, 1.0] {
        for (young, kept) in [(2e11, false), (2e11, true)] {
        // a stiff flexible block on rigid ground
        let mut scene = Scene::in_free_space(dt);
        scene.fixed(ColliderBuilder::cuboid(5.0, 0.5).translation(vec2(0.0, -0.5)).restitution(real(e)));
        let b = scene.flexible(FlexBodyBuilder::rectangle([1.0, 1.0], [8, 8]).translation([0.0, 0.3]).restitution(e).friction(0.0).contact_inertia(if kept { ContactInertia::Kept } else { ContactInertia::Redistributed })
            .material(LinearElastic::plane_stress(young, 0.3).density(1000.0)).linvel([0.0, -2.0]));
        let k0 = scene.body(b).energy().kinetic;
        scene.steps((0.4/dt) as usize);
        println!("flex on ground e {e} dt {dt:.4} kept {kept}: {} energy {:.4}", scene.body(b).linvel()[1] / 2.0, (scene.body(b).energy().kinetic + scene.body(b).energy().elastic) / k0);
        }
        let mut scene = Scene::in_free_space(dt);
        scene.flexible(FlexBodyBuilder::rectangle([2.0, 0.5], [16, 4]).restitution(e).friction(0.0)
            .material(LinearElastic::plane_stress(2e11, 0.3).density(7800.0)).pin_where(|[_, y]| y == 0.0, Pin::both()));
        let (ball, _) = scene.rigid(RigidBodyBuilder::dynamic().translation(vec2(1.04, 0.9)).linvel(vec2(0.0, -2.0)), ColliderBuilder::ball(0.1).density(100.0).restitution(real(e)));
        scene.steps((0.4/dt) as usize);
        println!("ball on slab e {e} dt {dt:.4}: {:?}", scene.world.bodies[ball].linvel().y / 2.0);
        // central: stiff flexible on rigid free box
        let mut scene = Scene::in_free_space(dt);
        let b = scene.flexible(FlexBodyBuilder::rectangle([1.0, 1.0], [8, 8]).restitution(e).friction(0.0)
            .material(LinearElastic::plane_stress(2e11, 0.3).density(1000.0)).linvel([1.0, 0.0]));
        let (rb, _) = scene.rigid(RigidBodyBuilder::dynamic().translation(vec2(2.0, 0.5)).linvel(vec2(-1.0, 0.0)), ColliderBuilder::cuboid(0.5, 0.37).density(500.0).restitution(real(e)));
        scene.steps((0.8/dt) as usize);
        let (v1, v2) = (scene.body(b).linvel()[0], f64::from(scene.world.bodies[rb].linvel().x));
        println!("flex box pair e {e}: e measured {} spin {:.1e} angvel {:.1e}", (v2 - v1) / 2.0, scene.body(b).state().frame.spin, scene.world.bodies[rb].angvel());
    }
    }
}
