//! The same nodes welded to a wall and to a rigid body: three rows more than there are motions, and forces that only stiff cells tell from those.

use crate::common::{Dice, G, Scene, is_solved, real, vec2};
use foil2d::pipeline::Held;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

/// What hangs on the end of a strip that is welded to a wall there is held by the wall, whatever the strip is made of. The force that carries a moment lies
/// in the stretch of an edge between two nodes; taken for one of the rows too many, it was given up in every pass, and the strip stood still, unfinished.
#[test]
fn a_heavy_body_on_nodes_that_are_welded_to_a_wall_hangs_still() {
    for seed in 0..12 {
        let mut dice = Dice(seed);
        let young = dice.pick(&[1e5, 1e7, 1e9]);
        let (mass, arm) = (dice.pick(&[5.0, 500.0]), dice.between(0.5, 4.0));
        let mut scene = Scene::new(dice.pick(&[1.0 / 240.0, 1.0 / 60.0, 1.0 / 30.0]));
        let strip = FlexBodyBuilder::rectangle([2.0, 0.25], [8, 2])
            .material(LinearElastic::plane_stress(young, 0.3).density(500.0))
            .translation([0.0, 2.0]);
        let strip = scene.flexible(strip);
        let body = RigidBodyBuilder::dynamic().translation(vec2(-arm, 2.125));
        let shape = ColliderBuilder::cuboid(real(0.1), real(0.1)).mass(real(mass));
        let hung = scene.rigid(body, shape).0;
        let at_end = |[x, _]: [f64; 2]| x < 1e-9;
        let to_body = AttachmentBuilder::weld(strip).where_(at_end);
        let welds = [
            to_body.to_rigid_body(hung),
            AttachmentBuilder::weld(strip).where_(at_end).to_world(),
        ];
        let [to_body, _] = welds.map(|weld| {
            let attached = scene.bodies.attach(weld, &scene.world.bodies);
            Held::Attachment(attached.expect("nodes and bodies exist"))
        });
        let n_steps = (2.0 / scene.dt()) as usize;
        for step in 0..n_steps {
            let report = scene.try_step().expect("the step can be taken");
            let is_solved = is_solved(report);
            assert!(is_solved, "seed {seed}, E {young:e}, step {step}");
        }
        let place = scene.world.bodies[hung].translation();
        let fallen = f64::hypot(f64::from(place.x) + arm, f64::from(place.y) - 2.125);
        assert!(fallen < 1e-4, "seed {seed}, E {young:e}: {fallen:e} m");
        let mut joints = scene.report().joints().iter();
        let pull = joints.find(|joint| joint.joint == to_body);
        let pull = pull.map_or(0.0, |joint| joint.force[1]);
        println!("seed {seed}, E {young:e}, {mass} kg: {fallen:e} m, {pull:e} N");
        assert!(
            (pull / (-mass * G) - 1.0).abs() < 1e-3,
            "seed {seed}: {pull:e} N"
        );
    }
}
