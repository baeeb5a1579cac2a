//! Bodies that joints hold inside each other, with contact between them, as it is if nobody says otherwise.

use crate::common::*;
use foil2d::pipeline::Quality;

/// A row of links, each hinged or welded to the next at a place inside both, falls on a soft mat. Alone rapier holds the joints apart, as contact
/// pushes the links out of each other.
#[test]
fn links_that_are_joined_inside_each_other_stay_so() {
    for is_welded in [false, true] {
        for half in [0.101, 0.106, 0.12, 0.14] {
            for n in [2, 4, 6] {
                let mut scene = Scene::new(1.0 / 60.0);
                scene.fixed(
                    ColliderBuilder::cuboid(real(10.0), real(0.5)).translation(vec2(0.0, -0.5)),
                );
                let mat = FlexBodyBuilder::rectangle([2.0, 0.3], [16, 3]);
                let mat = mat.material(elastic(1e6, 1000.0, 1e-2));
                scene.flexible(mat.translation([-1.0, 0.0]));
                let links: Vec<_> = (0..n)
                    .map(|k| {
                        let place = vec2(-0.4 + 0.2 * f64::from(k), 0.6);
                        let link = RigidBodyBuilder::dynamic().translation(place);
                        let shape = ColliderBuilder::cuboid(real(half), real(0.04));
                        scene.rigid(link, shape.density(500.0)).0
                    })
                    .collect();
                let ends = [vec2(0.1, 0.0), vec2(-0.1, 0.0)];
                for pair in links.windows(2) {
                    let joint: GenericJoint = if is_welded {
                        let weld = FixedJointBuilder::new().local_anchor1(ends[0]);
                        weld.local_anchor2(ends[1]).build().into()
                    } else {
                        let hinge = RevoluteJointBuilder::new().local_anchor1(ends[0]);
                        hinge.local_anchor2(ends[1]).build().into()
                    };
                    scene.world.insert_impulse_joint(pair[0], pair[1], joint);
                }
                let name = format!("half a length of {half} m, {n} links, welded {is_welded}");
                let (mut before, mut n_claimed) = (f64::NAN, 0);
                for step in 0..150 {
                    scene.try_step().expect("the input is right");
                    let quality = scene.report().quality();
                    assert_ne!(quality, Quality::Unfinished, "{name}, step {step}");
                    let energy = energy_of(&scene);
                    if n_claimed > 0 {
                        assert!(
                            energy < before + 1.0,
                            "{name}, step {step}: {before} to {energy} J"
                        );
                    }
                    n_claimed += usize::from(scene.report().n_claimed() > 0);
                    before = energy;
                }
                assert!(n_claimed > 50, "{name}: {n_claimed}");
                for pair in links.windows(2) {
                    let [one, other] = [0, 1].map(|k| {
                        let body = &scene.world.bodies[pair[k]];
                        body.position().transform_point(ends[k])
                    });
                    let open = f64::from((one - other).length());
                    assert!(open < 1e-3, "{name}: {open} m open");
                }
            }
        }
    }
}

/// Boxes that overlap by 2 cm are welded to each other at the middle of one, which is outside the other, and are handed over 9 mm open. Contact that
/// keeps them apart would leave no way to close.
#[test]
fn bodies_that_are_welded_inside_each_other_come_together() {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.fixed(ColliderBuilder::cuboid(real(10.0), real(0.5)).translation(vec2(0.0, -0.5)));
    let [half, pitch, open] = [0.2, 0.38, 0.009];
    let boxes: Vec<_> = (0..4)
        .map(|k| {
            let place = vec2((f64::from(k) - 1.5) * (pitch + open), half);
            let body = RigidBodyBuilder::dynamic().translation(place);
            let shape = ColliderBuilder::cuboid(real(half), real(0.15));
            scene.rigid(body, shape.density(500.0)).0
        })
        .collect();
    for pair in boxes.windows(2) {
        let weld = FixedJointBuilder::new().local_anchor2(vec2(-pitch, 0.0));
        scene.world.insert_impulse_joint(pair[0], pair[1], weld);
    }
    let block = FlexBodyBuilder::rectangle([0.3, 0.2], [3, 2]).material(elastic(1e6, 1000.0, 1e-2));
    scene.flexible(block.translation([-0.15, 0.45]));
    for step in 0..120 {
        scene.try_step().expect("the input is right");
        let quality = scene.report().quality();
        assert_ne!(quality, Quality::Unfinished, "step {step}");
    }
    assert_eq!(scene.report().n_claimed(), 4);
    for pair in boxes.windows(2) {
        let [one, other] = [0, 1].map(|k| scene.world.bodies[pair[k]].translation());
        let apart = f64::from((other - one).length()) - pitch;
        assert!(apart.abs() < 1e-4, "{apart} m from where they are to be");
    }
}
