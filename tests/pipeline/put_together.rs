//! Bodies that the user puts into others: rigid ones into flexible ones that have been there before, and flexible ones into each other.

use crate::common::{G, Scene, from_outline, place_of, real, vec2};
use foil2d::pipeline::{InsertionNote, Participant, Quality};
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

/// A beam of 4 m by 0.2 m at `[0, y]`, held at both ends.
fn beam(y: f64) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([4.0, 0.2], [20, 2])
        .material(LinearElastic::plane_stress(1e7, 0.3).density(1000.0))
        .translation([0.0, y])
        .pin_where(|[x, _]| x.min(4.0 - x) < 1e-9, Pin::both())
}

/// A box of half a side `half` at `at`, which may sleep.
fn put(
    scene: &mut Scene,
    half: f64,
    at: [f64; 2],
    groups: InteractionGroups,
) -> (RigidBodyHandle, ColliderHandle) {
    let body = RigidBodyBuilder::dynamic().translation(vec2(at[0], at[1]));
    let shape = ColliderBuilder::cuboid(real(half), real(half));
    scene.world.insert(body, shape.solver_groups(groups))
}

fn notes_overlap(scene: &Scene, body: FlexBodyHandle, with: ColliderHandle) -> bool {
    let with = Participant::Rigid(with);
    let notes = scene.report().insertion_notes();
    notes.contains(&InsertionNote::Overlap { body, with })
}

/// A box inserted over a beam that has been there for a while, or moved into it, is told once, and its overlap as long as there is one, whatever
/// the contact stage makes of it.
#[test]
fn a_body_put_into_an_older_one_is_told_until_it_is_out() {
    for is_moved in [false, true] {
        let mut scene = Scene::new(1.0 / 60.0);
        let beam = scene.flexible(beam(0.5));
        scene.steps(20);
        let inside = [2.0, 0.62];
        let start = if is_moved { [2.0, 8.0] } else { inside };
        let (body, collider) = put(&mut scene, 0.3, start, InteractionGroups::all());
        if is_moved {
            scene.step();
            assert!(!notes_overlap(&scene, beam, collider));
            scene.world.bodies[body].set_translation(vec2(inside[0], inside[1]), true);
        }
        for step in 0..60 {
            scene.try_step().expect("a step");
            assert_eq!(
                notes_overlap(&scene, beam, collider),
                step == 0,
                "step {step}"
            );
            // The beam's axis is in the box: at least half of its thickness is.
            let place = scene.world.bodies[body].position();
            let nodes = scene.body(beam).positions().chunks_exact(2);
            let depths = nodes.map(|node| {
                let local = place.inverse_transform_point(vec2(node[0], node[1]));
                0.3 - f64::from(local.x.abs().max(local.y.abs()))
            });
            let deepest = depths.fold(0.0, f64::max);
            let told = scene.report().gap_violation();
            assert!(
                deepest < 0.01 || told > 0.3 * deepest,
                "step {step}: {deepest} m, told {told}"
            );
        }
    }
}

/// What cannot be parted, a box across a beam whose nodes are all held, most of it below, and in the ground, stays told and awake, and costs one try
/// but for those steps in which it is tried in parts again, ever more seldom.
#[test]
fn what_is_stuck_for_good_is_told_in_every_step_and_costs_one_try() {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.4);
    let held = beam(0.5).pin_where(|_| true, Pin::both());
    scene.flexible(held.small_strain());
    scene.steps(20);
    let (body, _) = put(&mut scene, 1.04, [2.14, 0.25], InteractionGroups::all());
    let mut in_parts = Vec::new();
    for step in 0..240 {
        let report = scene.try_step().expect("a step");
        let (quality, overlap, n_parts) =
            (report.quality(), report.gap_violation(), report.n_parts());
        // The first steps part what can be parted.
        if step >= 10 {
            assert_eq!(quality, Quality::Unfinished, "step {step}");
            assert!(overlap > 0.01, "step {step}: {overlap} m");
        }
        if n_parts > 1 {
            in_parts.push(step);
        }
        assert!(!scene.world.bodies[body].is_sleeping(), "step {step}");
    }
    for span in [30..60, 60..120, 120..240] {
        let n_tried = in_parts.iter().filter(|step| span.contains(*step)).count();
        assert!((1..=3).contains(&n_tried), "{span:?}: {in_parts:?}");
    }
}

/// A ball, or a capsule, whose centre is inside a block comes out by the nearest way, as a box does: it fell through it.
#[test]
fn what_is_round_comes_out_of_what_its_centre_is_in() {
    for is_small in [false, true] {
        for (shape, aside) in [
            (ColliderBuilder::ball(0.25), 0.03),
            (ColliderBuilder::ball(0.25), 0.0),
            (ColliderBuilder::capsule_x(0.05, 0.25), 0.03),
        ] {
            for y in [0.61, 0.59, 0.45] {
                let mut scene = Scene::new(1.0 / 60.0);
                scene.ground(0.5);
                let block = FlexBodyBuilder::rectangle([1.0, 0.6], [10, 6]).material(
                    LinearElastic::plane_strain(1e6, 0.3)
                        .density(1000.0)
                        .rayleigh(5e-3),
                );
                let block = scene.flexible(if is_small {
                    block.small_strain()
                } else {
                    block
                });
                scene.steps(60);
                let body = RigidBodyBuilder::dynamic().translation(vec2(0.5 + aside, y));
                let (body, _) = scene.world.insert(body, shape.clone().density(1000.0));
                for _ in 0..90 {
                    scene.step();
                    let height = f64::from(scene.world.bodies[body].translation().y);
                    assert!(
                        height < 1.2,
                        "{y}, {aside}, small {is_small}: thrown to {height} m"
                    );
                }
                // Up or down, it is beside the block, not in it.
                let place = place_of(&scene.world.bodies[body]);
                let away = from_outline(scene.body(block), place);
                assert!(away > 0.24, "{y}, {aside}, small {is_small}: {away} m");
                assert!(scene.report().gap_violation() < 1e-6);
            }
        }
    }
}

/// Solver groups that let nothing push leave nothing to be told.
#[test]
fn what_no_solver_group_lets_push_is_no_trespasser() {
    let mut scene = Scene::new(1.0 / 60.0);
    let beam = scene.flexible(beam(0.5));
    let (body, collider) = put(&mut scene, 0.3, [2.0, 1.5], InteractionGroups::none());
    for _ in 0..60 {
        scene.step();
        assert_eq!(scene.report().quality(), Quality::Solved);
        assert!(!notes_overlap(&scene, beam, collider));
    }
    let y = scene.world.bodies[body].translation().y;
    assert!(y < -2.0, "it falls through the beam: {y} m");
}

/// What the user lets pass afterwards is told no more.
#[test]
fn what_is_let_pass_is_told_no_more() {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.flexible(beam(0.5));
    scene.steps(5);
    let (_, collider) = put(&mut scene, 0.3, [2.0, 0.62], InteractionGroups::all());
    scene.step();
    assert!(scene.report().gap_violation() > 0.1);
    scene.world.colliders[collider].set_solver_groups(InteractionGroups::none());
    scene.step();
    assert_eq!(scene.report().gap_violation(), 0.0);
}

/// A half-space has a middle at its surface, which may be in a body that lies on it, and no size.
#[test]
fn a_body_laid_flush_on_a_half_space_is_not_in_it() {
    for at in [[0.0, 0.0], [-0.5, 0.0], [-0.5, 1e-4]] {
        let mut scene = Scene::new(1.0 / 60.0);
        let up = foil2d::rapier::math::Vector::new(0.0, 1.0);
        scene.fixed(ColliderBuilder::new(SharedShape::halfspace(up)));
        let block = FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4])
            .material(LinearElastic::plane_stress(1e7, 0.3).density(1000.0))
            .translation(at);
        scene.flexible(block);
        for _ in 0..3 {
            scene.step();
            assert!(scene.report().insertion_notes().is_empty());
            assert!(scene.report().gap_violation() < 1e-6);
        }
    }
}

/// Bodies that are put into each other fly and fall as one body would, while they part and when they have.
#[test]
fn what_is_put_into_each_other_in_flight_flies_on() {
    for (young, overlap, turned, is_large) in [
        (1e5, 0.5, 0.5, true),
        (1e6, 0.9, 0.5, true),
        (1e5, 0.9, 0.0, false),
    ] {
        let mut scene = Scene::new(1.0 / 60.0);
        let [one, other] = [0.0, 5.0].map(|x| {
            let body = FlexBodyBuilder::rectangle([1.0, 0.6], [6, 4])
                .material(LinearElastic::plane_stress(young, 0.3).density(1000.0))
                .translation([x, 100.0])
                .linvel([3.0, 0.0]);
            scene.flexible(match is_large {
                true => body,
                false => body.small_strain(),
            })
        });
        scene.steps(10);
        let [x, y] = scene.body(one).centre_of_mass();
        let place = [x + 1.0 - overlap, y];
        let Scene { world, bodies, .. } = &mut scene;
        let is_put = bodies.set_position(other, place, turned, world);
        assert_eq!(is_put, Ok(()));
        let mean = |scene: &Scene, of: fn(&FlexBody) -> [f64; 2]| {
            let [a, b] = [one, other].map(|body| of(scene.body(body)));
            [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
        };
        let (from, before) = (
            mean(&scene, FlexBody::centre_of_mass),
            mean(&scene, FlexBody::linvel),
        );
        let dt = f64::from(scene.world.integration_parameters.dt);
        for step in 1..=60 {
            scene.try_step().expect("a step");
            if step == 1 {
                assert!(
                    scene.report().gap_violation() > 0.1,
                    "they are in each other"
                );
            }
            let time = f64::from(step) * dt;
            let velocity = mean(&scene, FlexBody::linvel);
            let off = velocity[1] - before[1] + G * time;
            assert!(
                off.abs() < 1e-6 && (velocity[0] - 3.0).abs() < 1e-6,
                "{off}"
            );
            let centre = mean(&scene, FlexBody::centre_of_mass);
            let fallen = before[1] * time - 0.5 * G * time * time;
            let off = [
                centre[0] - from[0] - 3.0 * time,
                centre[1] - from[1] - fallen,
            ];
            // Steps take the mean of accelerations, within a part of the last one.
            assert!(off[0].abs() < 1e-5 && off[1].abs() < 1e-2, "{off:?}");
        }
        assert!(scene.report().gap_violation() < 1e-6, "they have parted");
    }
}

/// Blocks that are laid on each other in line, too near by a little or by a third: the corners of both are in line with the sides of the other, where
/// edges do not cross.
#[test]
fn blocks_that_overlap_in_line_are_told() {
    for (overlap, is_told) in [(-1e-3, false), (0.0, false), (1e-5, false)]
        .into_iter()
        .chain([0.005, 0.015, 0.03, 0.05, 0.1].map(|overlap| (overlap, true)))
    {
        let mut scene = Scene::new(1.0 / 60.0);
        scene.ground(0.5);
        for y in [0.01, 0.31 - overlap] {
            let block = FlexBodyBuilder::rectangle([0.3, 0.3], [4, 4])
                .material(LinearElastic::plane_stress(1e6, 0.3).density(1000.0))
                .translation([-0.15, y]);
            scene.flexible(block);
        }
        scene.try_step().expect("a step");
        let n_told = scene.report().insertion_notes().len();
        assert_eq!(n_told, usize::from(is_told), "{overlap} m");
    }
}

/// A fixed capsule put onto a ring, or through its wall, and the ring come apart. Nodes in it that face away from its nearest side were held by
/// nothing: the ring fell asleep around it.
#[test]
fn a_rounded_shape_put_through_a_wall_is_led_out_of_it() {
    for aside in [-0.34, -0.22, -0.13, 0.04, 0.19, 0.31] {
        for height in [0.02, 0.18, 0.29] {
            let mut scene = Scene::new(1.0 / 60.0);
            scene.ground(0.5);
            let material = LinearElastic::plane_strain(1e6, 0.3).density(1000.0);
            let ring = scene.flexible(
                FlexBodyBuilder::annulus(0.25, 0.4, 0.1)
                    .material(material.rayleigh(5e-3))
                    .translation([0.0, 0.9]),
            );
            scene.steps(60);
            let [x, y] = scene.body(ring).centre_of_mass();
            let middle = [x + aside, y + height];
            let capsule = ColliderBuilder::capsule_x(real(0.2), real(0.1));
            let place = vec2(middle[0], middle[1]);
            scene
                .world
                .insert_collider(capsule.translation(place), None);
            for _ in 0..240 {
                scene.try_step().expect("a step");
            }
            assert_eq!(scene.report().quality(), Quality::Solved);
            let body = scene.body(ring);
            for share in [-1.0, -0.5, 0.0, 0.5, 1.0] {
                let place = [middle[0] + 0.2 * share, middle[1]];
                let away = from_outline(body, place);
                assert!(away > 0.099, "{aside}, {height}: {away} m from {share}");
            }
        }
    }
}
