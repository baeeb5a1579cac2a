//! Attachments that contradict each other: a compromise is found between them, and told of; the rest of the body moves as it should.

use crate::common::{Scene, elastic, is_solved, vec2};
use foil2d::pipeline::Quality;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

/// A strip that a weld holds by its end, and another one to a driven body, if it is welded twice.
struct Strip {
    scene: Scene,
    body: FlexBodyHandle,
    driven: RigidBodyHandle,
}

impl Strip {
    fn new(young: f64, is_welded_twice: bool) -> Self {
        let mut scene = Scene::new(1.0 / 60.0);
        let strip = FlexBodyBuilder::rectangle([1.0, 0.1], [10, 2])
            .material(elastic(young, 500.0, 1e-3))
            .translation([0.0, 2.0]);
        let body = scene.flexible(strip);
        let driven = RigidBodyBuilder::kinematic_position_based().translation(vec2(-1.0, 2.05));
        let driven = scene.rigid(driven, ColliderBuilder::ball(0.05)).0;
        let weld = || AttachmentBuilder::weld(body).where_(|[x, _]| x < 1e-9);
        let welds = [weld().to_world(), weld().to_rigid_body(driven)];
        for weld in welds.into_iter().take(1 + usize::from(is_welded_twice)) {
            let attached = scene.bodies.attach(weld, &scene.world.bodies);
            attached.expect("nodes and bodies exist");
        }
        Self {
            scene,
            body,
            driven,
        }
    }

    /// Height of the free end (m).
    fn tip(&self) -> f64 {
        let body = self.scene.body(self.body);
        body.position(body.n_nodes() - 1)[1]
    }
}

/// A driven body that the held nodes are welded to as well moves away by 5 mm: no place of theirs agrees with both. Once the jolt has died, the strip
/// swings on as one that is welded once.
#[test]
fn a_strip_that_is_welded_to_two_places_hangs_between_them_and_swings() {
    for young in [1e6, 1e8, 1.002e8] {
        let [mut once, mut twice] = [false, true].map(|twice| Strip::new(young, twice));
        let mut sag = [0.0; 2];
        for step in 0..360 {
            if step == 30 {
                let away = Pose::new(vec2(-1.005, 2.05), 0.0);
                let driven = &mut twice.scene.world.bodies[twice.driven];
                driven.set_next_kinematic_position(away);
            }
            once.scene.step();
            let report = twice.scene.try_step().expect("the step can be taken");
            let (quality, left) = (report.quality(), report.joint_violation());
            let name = format!("E {young:e}, step {step}: {quality:?}, {left:e} m");
            assert!(quality < Quality::Unfinished, "{name}");
            if step < 30 {
                assert!(is_solved(report) && left == 0.0, "{name}");
            }
            if step > 40 {
                // What the step began with is no reason to cut it.
                assert_eq!(report.n_parts(), 1, "{name}");
                assert_eq!(quality, Quality::Cut, "{name}");
                // Both distances sum up to what the places are apart: the larger one is half of it or more.
                assert!(left > 2.49e-3 && left < 5.01e-3, "{name}");
            }
            if step > 250 {
                sag[0] += (2.1 - once.tip()) / 109.0;
                sag[1] += (2.1 - twice.tip()) / 109.0;
            }
        }
        let start = twice.scene.body(twice.body).positions()[0];
        assert!((start + 2.5e-3).abs() < 2e-4, "E {young:e}: at {start} m");
        println!("E {young:e}: mean sag {sag:?} m");
        assert!(
            (sag[1] / sag[0] - 1.0).abs() < 0.1,
            "E {young:e}: {sag:?} m"
        );
    }
}
