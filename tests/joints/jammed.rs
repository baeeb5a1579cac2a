//! Boxes that are hinged to their neighbour where they also touch: they tip until a corner meets the neighbour's face, and jam there by friction.

use crate::common::*;
use foil2d::pipeline::Quality;

/// Two soft blocks with three boxes on them, each farther right than the one below; the uppermost is hinged in the middle of one below.
#[derive(Debug)]
struct Tower {
    lean: f64,
    masses: [f64; 3],
    young: f64,
    half: f64,
    rate: f64,
    hinged_to: usize,
}

impl Tower {
    fn random(dice: &mut Dice) -> Self {
        let mut power = |low: f64, high: f64| 10f64.powf(dice.between(low, high));
        let masses = [power(0.7, 2.2), power(1.0, 3.0), power(2.0, 3.6)];
        let young = power(4.5, 6.3);
        Self {
            lean: dice.between(0.04, 0.16),
            masses,
            young,
            half: dice.between(0.12, 0.22),
            rate: dice.pick(&[30.0, 60.0, 120.0]),
            hinged_to: dice.pick(&[0, 1, 1]),
        }
    }

    /// Lets it fall for so long (s); returns the most energy that a step of claimed boxes has gained, over what there was when it began to fall, and
    /// how many steps were not finished.
    fn fall(&self, time: f64) -> (f64, usize) {
        let &Self { lean, half, .. } = self;
        let mut scene = Scene::new(1.0 / self.rate);
        scene.ground(0.6);
        for k in [0.0, 1.0] {
            let material = LinearElastic::plane_stress(self.young, 0.3)
                .density(900.0)
                .rayleigh(1e-2);
            let block = FlexBodyBuilder::rectangle([2.0 * half, 2.0 * half], [3, 3]);
            let place = [lean * k - half, (2.0 * half + 0.01) * k];
            scene.flexible(block.material(material).friction(0.6).translation(place));
        }
        let base = 2.0 * (2.0 * half + 0.01);
        let centre = |k: usize| {
            let k = k as f64;
            [lean * (k + 2.0), base + (2.0 * half + 0.005) * k + half]
        };
        let boxes = [0, 1, 2].map(|k| {
            let [x, y] = centre(k);
            let body = RigidBodyBuilder::dynamic()
                .can_sleep(false)
                .translation(vec2(x, y));
            let shape = ColliderBuilder::cuboid(real(half), real(half))
                .friction(0.6)
                .mass(real(self.masses[k]));
            scene.rigid(body, shape).0
        });
        let at = centre(1);
        let anchor = |k: usize| {
            let [x, y] = centre(k);
            vec2(at[0] - x, at[1] - y)
        };
        let hinge = RevoluteJointBuilder::new()
            .local_anchor1(anchor(self.hinged_to))
            .local_anchor2(anchor(2));
        scene
            .world
            .insert_impulse_joint(boxes[self.hinged_to], boxes[2], hinge.build());
        let (mut most, mut n_unfinished) = (0.0f64, 0);
        let start = energy_of(&scene);
        let (mut before, mut was_claimed) = (start, false);
        for _ in 0..(time / scene.dt()) as usize {
            let report = scene.try_step().expect("a step");
            n_unfinished += usize::from(report.quality() == Quality::Unfinished);
            let is_claimed = report.n_claimed() == boxes.len();
            let now = energy_of(&scene);
            if was_claimed && is_claimed {
                most = most.max((now - before) / start);
            }
            (before, was_claimed) = (now, is_claimed);
        }
        (most, n_unfinished)
    }
}

/// What a corner that jams answers to the hinge is of any size, and moves nothing. A tower that falls otherwise than the next one is asked for no more than
/// a few hundredths in a step, which is what contacts of long steps add; forces that do not cancel have added up to five times what there was.
#[test]
fn corners_that_jam_give_no_energy() {
    let (mut findings, mut dice) = (Findings::default(), Dice(61));
    let (n, mut n_risen, mut n_unfinished) = (60, 0, 0);
    for _ in 0..n {
        let tower = Tower::random(&mut dice);
        let (most, unfinished) = tower.fall(2.0);
        n_risen += usize::from(most > 0.02);
        n_unfinished += unfinished;
        findings.check(most < 0.1, || format!("{tower:?}: {most} of the energy"));
    }
    findings.check(n_risen <= n / 20, || format!("{n_risen} of {n} towers"));
    findings.check(n_unfinished <= n / 10, || {
        format!("{n_unfinished} unfinished steps")
    });
    println!("{n_risen} of {n} above 0.02, {n_unfinished} unfinished");
    findings.report();
}
