//! Links of multibody joints: rapier moves them, the flexible stage meets them with the motion they have.

use crate::common::*;

/// Two hinged bars of 2 kg that rest in free space.
fn bars(scene: &mut Scene) -> [RigidBodyHandle; 2] {
    let bars = [0.0, 1.0].map(|x| {
        let body = RigidBodyBuilder::dynamic()
            .translation(vec2(x, 0.0))
            .can_sleep(false);
        let shape = ColliderBuilder::cuboid(real(0.45), real(0.1)).density(real(2.0 / 0.18));
        scene.world.insert(body, shape).0
    });
    let hinge = RevoluteJointBuilder::new()
        .local_anchor1(vec2(0.5, 0.0))
        .local_anchor2(vec2(-0.5, 0.0));
    let joints = &mut scene.world.multibody_joints;
    joints.insert(bars[0], bars[1], hinge, true);
    bars
}

#[test]
fn a_multibody_goes_its_way_and_a_flexible_body_gets_what_a_wall_would_give() {
    // The coupling is one-sided, and this is its bound: the multibody keeps its momentum to the last bit, so that the whole gains what the
    // flexible body does, which is that of an impact on something of infinite mass: at most twice its momentum relative to the link.
    let (mut alone, mut scene) = (
        Scene::in_free_space(1.0 / 120.0),
        Scene::in_free_space(1.0 / 120.0),
    );
    let (theirs, ours) = (bars(&mut alone), bars(&mut scene));
    let block = scene.flexible(
        FlexBodyBuilder::rectangle([0.3, 0.3], [3, 3])
            .material(
                LinearElastic::plane_stress(1e6, 0.3)
                    .density(100.0)
                    .rayleigh(1e-4),
            )
            .translation([1.5, -0.15])
            .linvel([-1.0, 0.0]),
    );
    let mass = scene.body(block).mass();
    let mut touches = false;
    for step in 0..120 {
        alone.world.step();
        touches |= !scene.step().contacts().is_empty();
        for (&one, &other) in ours.iter().zip(&theirs) {
            let (one, other) = (&scene.world.bodies[one], &alone.world.bodies[other]);
            assert_eq!(one.position(), other.position(), "step {step}");
        }
    }
    assert!(touches, "they meet");
    // It came at 1 m/s and leaves with the restitution of the deformation.
    let gained = mass * (scene.body(block).linvel()[0] + 1.0);
    let most = 2.0 * mass;
    assert!(
        gained > 0.5 * most && gained <= most * 1.001,
        "{gained} of {most}"
    );
}
