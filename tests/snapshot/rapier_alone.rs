//! Rapier alone resumes bit for bit: what a snapshot of ours relies on.

use crate::common::*;
use foil2d::rapier::math::Real;

fn world() -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    let floor = ColliderBuilder::cuboid(20.0, 0.5).translation(Vector::new(0.0, -0.5));
    world.insert_collider(floor, None);
    let mut last = None;
    for index in 0..12_u8 {
        let (column, row) = (f64::from(index % 3), f64::from(index / 3));
        let body = RigidBodyBuilder::dynamic()
            .translation(vec2(0.3 * column, 0.5 + 0.9 * row))
            .rotation(0.1 * Real::from(index))
            .ccd_enabled(index == 5);
        let (body, _) = world.insert(body, ColliderBuilder::cuboid(0.2, 0.15).restitution(0.3));
        if let Some(last) = last.filter(|_| index % 4 == 1) {
            let joint = RevoluteJointBuilder::new()
                .local_anchor1(Vector::new(0.3, 0.0))
                .local_anchor2(Vector::new(-0.3, 0.0));
            world.impulse_joints.insert(last, body, joint, true);
        }
        if let Some(last) = last.filter(|_| index % 4 == 3) {
            let joint = RevoluteJointBuilder::new()
                .local_anchor1(Vector::new(0.3, 0.0))
                .local_anchor2(Vector::new(-0.3, 0.0));
            world.multibody_joints.insert(last, body, joint, true);
        }
        last = Some(body);
    }
    world
}

fn poses(world: &PhysicsWorld) -> Vec<u64> {
    motion_bits(world, &FlexBodySet::new())
}

#[test]
fn rapier_alone_resumes_bit_for_bit_from_its_world() {
    for pause in [1, 7, 40, 120, 300] {
        let mut straight = world();
        let mut saved = world();
        for _ in 0..pause {
            straight.step();
            saved.step();
        }
        let bytes = postcard::to_stdvec(&saved).expect("a world is written");
        let mut resumed: PhysicsWorld = postcard::from_bytes(&bytes).expect("and read");
        for step in 0..300 {
            straight.step();
            resumed.step();
            assert_eq!(
                poses(&straight),
                poses(&resumed),
                "pause {pause}, step {step}"
            );
        }
        let [one, other] =
            [&straight, &resumed].map(|world| postcard::to_stdvec(world).expect("is written"));
        assert!(one == other, "pause {pause}: the bytes differ");
    }
}
