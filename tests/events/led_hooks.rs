//! What is shown to hooks is led as everything else is: on terrain, on platforms that are open from below, on belts.

use crate::support::*;
use foil2d::pipeline::Quality;

const MODIFY: ActiveHooks = ActiveHooks::MODIFY_SOLVER_CONTACTS;

/// Hills that one wave makes, as a polyline or as a height field.
#[derive(Clone, Copy)]
struct Hills {
    height: f64,
    phase: f64,
    is_field: bool,
}

impl Hills {
    const HALF: f64 = 3.0;
    const N: usize = 20;

    fn points(self) -> Vec<[f64; 2]> {
        let place = |k| Self::HALF * (2.0 * k as f64 / Self::N as f64 - 1.0);
        let rise = |x: f64| self.height * (2.0 * x + self.phase).sin();
        (0..=Self::N).map(|k| [place(k), rise(place(k))]).collect()
    }

    fn collider(self) -> ColliderBuilder {
        let points = self.points();
        if self.is_field {
            let heights = points.iter().map(|[_, y]| real(*y)).collect();
            return ColliderBuilder::heightfield(heights, vec2(2.0 * Self::HALF, 1.0));
        }
        ColliderBuilder::polyline(points.iter().map(|[x, y]| vec2(*x, *y)).collect(), None)
    }

    /// How deep the nodes of a body are below the segments at the most (m).
    fn depth(self, body: &FlexBody) -> f64 {
        let points = self.points();
        let under = |[x, y]: [f64; 2]| {
            let mut segments = points.windows(2);
            let over = segments.find(|ends| x >= ends[0][0] && x <= ends[1][0]);
            over.map_or(0.0, |ends| {
                let part = (x - ends[0][0]) / (ends[1][0] - ends[0][0]);
                ends[0][1] + part * (ends[1][1] - ends[0][1]) - y
            })
        };
        let places = body.positions().chunks_exact(2);
        let depths = places.map(|at| under([at[0], at[1]]));
        depths.fold(0.0, f64::max)
    }
}

/// A soft body that is thrown on hills, with hooks that change nothing or none, and how deep it gets (m).
fn thrown(seed: u64, is_hooked: bool) -> (Vec<f64>, f64) {
    let mut dice = Dice(seed);
    let hills = Hills {
        height: dice.between(0.1, 0.4),
        phase: dice.between(0.0, 6.0),
        is_field: seed.is_multiple_of(2),
    };
    let young = dice.pick(&[1e5, 1e6, 1e8]);
    let body = match seed % 3 {
        0 => FlexBodyBuilder::rectangle([0.5, 0.5], [4, 4]),
        1 => FlexBodyBuilder::disc(0.25, 0.12),
        _ => FlexBodyBuilder::annulus(0.18, 0.28, 0.1),
    };
    let mut scene = Scene::new(DT);
    scene.fixed(hills.collider());
    let body = body
        .material(elastic(young, 1000.0, 1e-3))
        .translation([dice.between(-1.0, 1.0), 1.0])
        .rotation(dice.between(0.0, 6.2))
        .linvel([dice.between(-1.0, 1.0), dice.between(-8.0, 0.0)])
        .angvel(dice.between(-6.0, 6.0));
    let body = scene.flexible(match is_hooked {
        true => body.active_hooks(MODIFY),
        false => body,
    });
    let listener = Listener::default();
    let mut deepest = 0.0f64;
    for _ in 0..90 {
        scene.hear(&listener);
        deepest = deepest.max(hills.depth(scene.body(body)));
    }
    (scene.body(body).positions().to_vec(), deepest)
}

/// Bodies that signed gaps alone held came to rest up to a fifth of a metre in such hills.
#[test]
fn hooks_that_change_nothing_change_nothing() {
    let mut findings = Findings::default();
    for seed in 1..=12 {
        let (alone, _) = thrown(seed, false);
        let (hooked, deepest) = thrown(seed, true);
        findings.check(deepest < 1e-5, || format!("{seed}: {deepest} m deep"));
        let away = alone.iter().zip(&hooked);
        let most = away.fold(0.0f64, |most, (one, other)| most.max((one - other).abs()));
        findings.check(most < 1e-9, || format!("{seed}: {most} m elsewhere"));
    }
    findings.report();
}

/// Rapier's platform that is open from below.
struct OneWay(ColliderHandle);

impl PhysicsHooks for OneWay {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let up = if context.collider1 == self.0 {
            1.0
        } else {
            -1.0
        };
        context.update_as_oneway_platform(vec2(0.0, up), 0.6);
    }
}

/// Over the joint of two segments, whose end is met from aside, as well as anywhere else; and what comes from below goes through.
#[test]
fn a_platform_of_segments_that_is_open_from_below_carries_what_falls_on_it() {
    let mut findings = Findings::default();
    for k in 0..28 {
        let at = -0.35 + 0.7 / 27.0 * f64::from(k);
        for (young, drop, turn) in [(1e6, 0.05, 0.0), (1e5, 0.5, 0.0), (1e7, 0.3, 0.3)] {
            let mut scene = Scene::new(DT);
            let line = [-2.0, 0.0, 2.0].map(|x| vec2(x, 0.0)).to_vec();
            let platform = ColliderBuilder::polyline(line, None).active_hooks(MODIFY);
            let platform = scene.fixed(platform);
            let square = FlexBodyBuilder::rectangle([0.5, 0.5], [4, 4])
                .material(elastic(young, 1000.0, 1e-3))
                .rotation(turn);
            let above = scene.flexible(square.clone().translation([at - 0.25, drop]));
            let below = scene.flexible(square.translation([at + 1.1, -0.8]).linvel([0.0, 6.5]));
            let listener = Listener::default();
            let (mut lowest, mut worst, mut highest) = (0.0f64, Quality::Solved, f64::NEG_INFINITY);
            for _ in 0..90 {
                scene.hear_with(&OneWay(platform), &listener);
                let low = |body: FlexBodyHandle, scene: &Scene| {
                    let places = scene.body(body).positions().chunks_exact(2);
                    places.map(|place| place[1]).fold(f64::INFINITY, f64::min)
                };
                lowest = lowest.min(low(above, &scene));
                highest = highest.max(low(below, &scene));
                worst = worst.max(scene.report().quality());
            }
            let what = || format!("{at} {young}: {lowest} m, {highest} m, {worst:?}");
            findings.check(lowest > -1e-4 && highest > 0.0, what);
            findings.check(worst == Quality::Solved, what);
        }
    }
    findings.report();
}

/// Runs along the surface at 1 m/s, to the right of what lies on it.
struct Belt(ColliderHandle);

impl PhysicsHooks for Belt {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let is_first = context.collider1 == self.0;
        if let Some(rigid) = context.rigid_mut() {
            let along = if is_first { 1.0 } else { -1.0 };
            for contact in rigid.solver_contacts.iter_mut() {
                contact.tangent_velocity = vec2(along, 0.0);
            }
        }
    }
}

/// `v = μ g t` until it goes with the belt, over the joints of a polyline and of what rapier has for boxes alike.
#[test]
fn a_belt_of_segments_carries_with_coulombs_friction() {
    let line: Vec<_> = (0..=20)
        .map(|k| vec2(0.4 * f64::from(k) - 4.0, 0.0))
        .collect();
    let shapes = [
        ColliderBuilder::polyline(line, None),
        ColliderBuilder::cuboid(4.0, 0.5).translation(vec2(0.0, -0.5)),
    ];
    for shape in shapes {
        let mut scene = Scene::new(DT);
        let belt = scene.fixed(shape.friction(0.2).active_hooks(MODIFY));
        let disc = FlexBodyBuilder::rectangle([0.4, 0.2], [8, 4])
            .material(elastic(1e7, 1000.0, 1e-3))
            .friction(0.2)
            .translation([-3.0, 0.0]);
        let block = scene.flexible(disc);
        let listener = Listener::default();
        for step in 1..=90 {
            scene.hear_with(&Belt(belt), &listener);
            let expected = (0.2 * G * f64::from(step) * DT).min(1.0);
            let [speed, _] = scene.body(block).linvel();
            assert!(
                (speed - expected).abs() < 0.04,
                "step {step}: {speed} m/s, not {expected}"
            );
        }
        let [speed, _] = scene.body(block).linvel();
        assert!((speed - 1.0).abs() < 1e-3, "{speed} m/s");
    }
}

/// A belt to the left of the middle, ice to the right of it.
struct HalfBelt(ColliderHandle);

impl PhysicsHooks for HalfBelt {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let is_first = context.collider1 == self.0;
        if let Some(rigid) = context.rigid_mut() {
            let along = if is_first { 1.0 } else { -1.0 };
            for contact in rigid.solver_contacts.iter_mut() {
                contact.tangent_velocity = vec2(along, 0.0);
                if contact.anchor1.x > 0.0 {
                    *rigid.friction = 0.0;
                }
            }
        }
    }
}

/// Half of the weight rubs: `v = μ g t / 2`. Whatever is said of a pair holds where it was said.
#[test]
fn what_hooks_say_holds_where_they_say_it() {
    let mut scene = Scene::new(DT);
    let line = [-4.0, -1.3, 0.7, 4.0].map(|x| vec2(x, 0.0)).to_vec();
    let belt = ColliderBuilder::polyline(line, None).friction(0.2);
    let belt = scene.fixed(belt.active_hooks(MODIFY));
    let plank = FlexBodyBuilder::rectangle([4.0, 0.1], [40, 2])
        .material(elastic(1e8, 1000.0, 1e-3))
        .friction(0.2)
        .translation([-2.0, 0.0]);
    let plank = scene.flexible(plank);
    let listener = Listener::default();
    for step in 1..=18 {
        scene.hear_with(&HalfBelt(belt), &listener);
        let expected = 0.1 * G * f64::from(step) * DT;
        let [speed, _] = scene.body(plank).linvel();
        assert!(
            (speed - expected).abs() < 0.1 * expected + 0.01,
            "step {step}: {speed} m/s, not {expected}"
        );
    }
}
