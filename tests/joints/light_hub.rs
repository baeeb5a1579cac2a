//! Springs and motors at light bodies that carry heavy ones.

use crate::common::*;

/// What holds the hub.
#[derive(Clone, Copy, Debug)]
enum Held {
    /// A rail with a motor that holds a place.
    Along,
    /// A hinge with a motor that holds an angle.
    About,
    /// Springs on both sides, off the middle.
    Between,
}

/// A hub with a block of 10 kg welded around it, on springs of a stiffness (N/m or N m/rad); largest energies (J) of the seconds of a run, of motion and
/// in springs.
fn swing(held: Held, hub: f64, stiffness: f64, rate: f64) -> Vec<f64> {
    let mut scene = Scene::in_free_space(1.0 / rate);
    let alone = InteractionGroups::none();
    let shape = ColliderBuilder::cuboid(0.05, 0.05)
        .mass(real(hub))
        .collision_groups(alone);
    let (hub, _) = scene.rigid(RigidBodyBuilder::dynamic(), shape);
    let (velocity, spin) = match held {
        Held::About => ([0.0; 2], 3.0),
        Held::Along | Held::Between => ([1.0, 0.0], 0.0),
    };
    let block = FlexBodyBuilder::rectangle([0.3, 0.3], [3, 3])
        .material(LinearElastic::plane_stress(1e8, 0.3).density(10.0 / 0.09))
        .translation([-0.15, -0.15])
        .collision_groups(alone)
        .linvel(velocity)
        .angvel(spin);
    let block = scene.flexible(block);
    let inner = AttachmentBuilder::weld(block).where_(|[x, y]| x.abs().max(y.abs()) < 0.11);
    let weld = scene
        .bodies
        .attach(inner.to_rigid_body(hub), &scene.world.bodies);
    weld.expect("the nodes inside");
    let body = &mut scene.world.bodies[hub];
    body.set_linvel(vec2(velocity[0], velocity[1]), true);
    body.set_angvel(real(spin), true);
    let ends = [-1.0, 1.0].map(|side| [vec2(side, 0.05), vec2(0.1 * side, 0.05)]);
    let fixed = |scene: &mut Scene, at: Vector| {
        let base = RigidBodyBuilder::fixed().translation(at);
        scene.world.insert_body(base)
    };
    let k = real(stiffness);
    let joints: Vec<(Vector, GenericJoint)> = match held {
        Held::Along => {
            let rail = PrismaticJointBuilder::new(vec2(1.0, 0.0));
            let rail = rail.motor_model(MotorModel::ForceBased);
            vec![(vec2(0.0, 0.0), rail.motor_position(0.0, k, 0.0).into())]
        }
        Held::About => {
            let hinge = RevoluteJointBuilder::new().motor_model(MotorModel::ForceBased);
            vec![(vec2(0.0, 0.0), hinge.motor_position(0.0, k, 0.0).into())]
        }
        Held::Between => {
            let spring = |[at, own]: [Vector; 2]| {
                let joint = SpringJointBuilder::new(0.9, k, 0.0).local_anchor2(own);
                (at, joint.into())
            };
            ends.map(spring).to_vec()
        }
    };
    for (at, joint) in joints {
        let base = fixed(&mut scene, at);
        scene.world.impulse_joints.insert(base, hub, joint, true);
    }
    let stored = |scene: &Scene| {
        let body = &scene.world.bodies[hub];
        let stretches = match held {
            Held::Along => vec![body.translation().x],
            Held::About => vec![body.rotation().angle()],
            Held::Between => ends
                .map(|[at, own]| (*body.position() * own - at).length() - 0.9)
                .to_vec(),
        };
        let squares = stretches
            .into_iter()
            .map(|stretch| f64::from(stretch).powi(2));
        0.5 * stiffness * squares.sum::<f64>()
    };
    let seconds = (0..5).map(|_| {
        let mut most = 0.0f64;
        for _ in 0..rate as usize {
            scene.step();
            let own = scene.body(block).energy();
            most = most.max(own.kinetic + own.elastic + stored(&scene));
        }
        most
    });
    seconds.collect()
}

#[test]
fn a_light_hub_swings_with_what_is_welded_to_it() {
    for rate in [60.0, 240.0] {
        for (held, stiffness, kept) in [
            (Held::Along, 1e3, 0.99),
            (Held::Along, 1e4, 0.97),
            (Held::About, 1e2, 0.98),
            (Held::About, 5e2, 0.93),
            (Held::Between, 1e3, 0.8),
        ] {
            for hub in [1.0, 0.05, 0.01] {
                let energies = swing(held, hub, stiffness, rate);
                let [first, last] = [energies[0], energies[4]];
                let name = format!("{held:?} {stiffness}, {hub} kg at {rate} Hz");
                assert!(last > kept * first, "{name}: {energies:?} J");
                assert!(last < 1.01 * first, "{name}: {energies:?} J");
            }
        }
    }
}
