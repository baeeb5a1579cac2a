//! Single motions: who is stopped, where, and who is not.

use super::Scene;
use crate::math::{Vec2, rotation};
use crate::path::samples::{Random, distance};
use crate::path::{MemberPair, Motion, MotionKind, Path, Surfaces};

fn square(centre: Vec2, half: f64) -> Vec<Vec2> {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    corners
        .iter()
        .map(|&[x, y]| centre + Vec2::new(x, y) * half)
        .collect()
}

fn joints(n: i32, length: f64) -> Vec<Vec2> {
    (-n..=n)
        .map(|k| Vec2::new(f64::from(k) * length, 0.0))
        .collect()
}

#[test]
fn sliding_over_joints_is_free_at_any_height_over_the_guard() {
    use MotionKind::{Flexible, Rigid, Still};
    for height in [1e-9, 1e-3, 0.1, 0.4, 0.8, 1.0] {
        for kind in [Rigid, Flexible] {
            let guard = 0.002;
            let bottom = guard + height * 0.01;
            let mut scene = Scene::new(
                (kind, &square(Vec2::new(0.03, bottom + 0.5), 0.5), true),
                (Still, &joints(100, 0.1), false),
            );
            let shift = Vec2::new(5.0, 0.0);
            if kind == Rigid {
                scene
                    .motion
                    .move_rigid(&scene.surfaces, 0, Vec2::new(0.03, 0.5), shift, 0.0);
            } else {
                scene
                    .motion
                    .ends_mut(&scene.surfaces, 0)
                    .iter_mut()
                    .for_each(|end| *end += shift);
            }
            assert_eq!(scene.toi().t, 1.0, "at {height} margins over the guard");
            // Asked the other way round as well.
            scene.pair = MemberPair {
                one: 1,
                other: 0,
                ..scene.pair
            };
            assert_eq!(scene.toi().t, 1.0);
        }
    }
}

#[test]
fn members_that_move_together_are_free_however_close() {
    let mut random = Random::new(31);
    for _ in 0..500 {
        let mut scene = Scene::random(&mut random);
        scene.motion.rest(&scene.surfaces);
        let shift = random.point(1e3);
        for member in 0..2 {
            match scene.surfaces.members()[member].kind {
                MotionKind::Rigid => {
                    scene
                        .motion
                        .move_rigid(&scene.surfaces, member, Vec2::zeros(), shift, 0.0)
                }
                MotionKind::Flexible => {
                    scene
                        .motion
                        .ends_mut(&scene.surfaces, member)
                        .iter_mut()
                        .for_each(|end| *end += shift);
                }
                MotionKind::Still => {}
            }
        }
        if scene.surfaces.members()[1].kind == MotionKind::Still {
            continue;
        }
        // Without room over the floor the rounding of the shift counts as an approach.
        let distance = distance(&scene.surfaces, scene.surfaces.points(), 0, 1);
        if distance - scene.pair.floor(distance) > 1e-11 {
            assert_eq!(scene.toi().t, 1.0);
        }
    }
}

#[test]
fn a_ball_that_turns_with_a_long_edge_as_one_body_is_free_at_once() {
    // 4 m from the centre of a plank of 10 m that turns half round: the direction between them turns with it.
    let plank = [Vec2::new(-5.0, 0.0), Vec2::new(5.0, 0.0)];
    let mut scene = Scene::new(
        (MotionKind::Rigid, &[Vec2::new(4.0, 0.003)], false),
        (MotionKind::Rigid, &plank, false),
    );
    for member in [0, 1] {
        let shift = Vec2::new(1.0, -2.0);
        scene
            .motion
            .move_rigid(&scene.surfaces, member, Vec2::zeros(), shift, 3.0);
    }
    let toi = scene.toi();
    assert_eq!((toi.t, toi.n_advances), (1.0, 0));
}

#[test]
fn a_wheel_that_rolls_on_is_hardly_cut() {
    // 32 corners, half a radian along the ground from a distance of closing: the ground is never nearer than the start by
    // more than what the corners' arcs take, r (1 - cos(π/32)) = .0024.
    let wheel: Vec<Vec2> = (0..32)
        .map(|k| {
            Vec2::new(0.0, 0.511)
                + rotation(std::f64::consts::TAU * (f64::from(k) + 0.5) / 32.0)
                    * Vec2::new(0.5, 0.0)
        })
        .collect();
    let mut scene = Scene::new(
        (MotionKind::Rigid, &wheel, true),
        (MotionKind::Still, &joints(100, 0.1), false),
    );
    scene.motion.move_rigid(
        &scene.surfaces,
        0,
        Vec2::new(0.0, 0.511),
        Vec2::new(0.25, 0.0),
        -0.5,
    );
    let toi = scene.toi();
    assert_eq!(toi.t, 1.0);
    assert!(toi.n_advances < 200, "{toi:?}");
}

#[test]
fn a_corner_that_dips_and_returns_is_seen() {
    // The chord of a half turn keeps its distance while the arc goes through the ground. A test of the end alone, or of the
    // end with a bulge of r θ²/8 added, lets shallow arcs through that start at their floor.
    for turn in [0.02, 0.1, 0.5, 3.1] {
        let spoke = |angle: f64| rotation(angle) * Vec2::new(0.0, -1.0);
        let arm = [Vec2::zeros(), spoke(-0.5 * turn)];
        for height in [1e-6, 1e-3, 0.1] {
            let low = arm[1].y - 0.002 - height * 0.01;
            let ground = [Vec2::new(-5.0, low), Vec2::new(5.0, low)];
            let mut scene = Scene::new(
                (MotionKind::Rigid, &arm, false),
                (MotionKind::Still, &ground, false),
            );
            scene
                .motion
                .move_rigid(&scene.surfaces, 0, Vec2::zeros(), Vec2::zeros(), turn);
            let (_, early, toi) = scene.check(2_000);
            let dip = 1.0 - crate::math::cos(0.5 * turn);
            let room = 0.9 * height * 0.01;
            assert_eq!(
                toi.t < 1.0,
                dip > room,
                "turn {turn}, height {height}: {toi:?}"
            );
            assert!(!early);
        }
    }
}

#[test]
fn a_jam_keeps_its_guard_through_any_number_of_pushes() {
    // A block pushed into the floor by a metre, again and again; then turned into it.
    for turn in [0.0, 0.4] {
        let mut scene = Scene::new(
            (MotionKind::Rigid, &square(Vec2::new(0.0, 0.6), 0.5), true),
            (MotionKind::Still, &joints(10, 0.1), false),
        );
        let mut points = scene.surfaces.points().to_vec();
        let mut centre = Vec2::new(0.0, 0.6);
        for push in 0..60 {
            scene.motion.rest(&scene.surfaces);
            let shift = Vec2::new(0.0, -1.0);
            scene
                .motion
                .move_rigid(&scene.surfaces, 0, centre, shift, turn);
            let toi = scene.toi();
            scene.surfaces.advance(&scene.motion, toi.t);
            centre += shift * toi.t;
            points.copy_from_slice(scene.surfaces.points());
            let distance = distance(&scene.surfaces, &points, 0, 1);
            // The guard is .002; at the guard, millionths of it per push.
            assert!(
                distance >= 0.002 * (1.0 - 1e-4),
                "{distance} after {push} pushes"
            );
        }
    }
}

#[test]
fn who_starts_at_the_guard_may_leave_and_slide_but_not_approach() {
    for (shift, free) in [
        ([0.0, 1.0], true),
        ([0.03, 0.0], true),
        ([1.0, 1e-3], true),
        ([0.0, -1e-3], false),
    ] {
        // Inside one edge all the way, or above the guard when the next one comes.
        let mut scene = Scene::new(
            (MotionKind::Rigid, &[Vec2::new(0.05, 0.001)], false),
            (MotionKind::Still, &joints(100, 0.1), false),
        );
        let shift = Vec2::new(shift[0], shift[1]);
        scene
            .motion
            .move_rigid(&scene.surfaces, 0, Vec2::new(0.05, 0.001), shift, 0.0);
        let toi = scene.toi();
        if free {
            assert!(toi.t == 1.0 || shift.x == 1.0, "{shift} {toi:?}");
        } else {
            assert!(toi.t < 1e-5, "{toi:?}");
        }
    }
}

#[test]
fn a_member_that_passes_through_between_two_instants_is_stopped_before() {
    let mut scene = Scene::new(
        (MotionKind::Rigid, &square(Vec2::new(0.0, 50.0), 0.5), true),
        (MotionKind::Still, &joints(3, 1.0), false),
    );
    scene.motion.move_rigid(
        &scene.surfaces,
        0,
        Vec2::new(0.0, 50.0),
        Vec2::new(0.0, -100.0),
        9.0,
    );
    let (_, early, toi) = scene.check(20_000);
    assert!(toi.t > 0.48 && toi.t < 0.5 && !early, "{toi:?}");
}

#[test]
fn every_pair_that_is_stopped_tells_its_own_time() {
    let mut surfaces = Surfaces::new();
    surfaces.add_chain(MotionKind::Still, false, &joints(10, 1.0), false);
    let balls = [1.0, 2.0, 4.0]
        .map(|y| surfaces.add_chain(MotionKind::Flexible, false, &[Vec2::new(y, y)], false));
    let mut motion = Motion::new();
    motion.rest(&surfaces);
    for ball in balls {
        motion.ends_mut(&surfaces, ball)[0].y -= 3.0;
    }
    let pairs = balls.map(|ball| MemberPair {
        one: 0,
        other: ball,
        name: 0,
        closing: 0.01,
        margin: 0.01,
        least: f64::INFINITY,
        is_asleep: false,
    });
    let mut hits = Vec::new();
    let toi = Path::new().time_of_impact(&surfaces, &motion, &pairs, &mut hits);
    // Floors lie .002 + .003 over the ground.
    let times: Vec<(usize, f64)> = hits.iter().map(|hit| (hit.pair, hit.t)).collect();
    assert_eq!(times.len(), 2);
    assert!((times[0].1 - 0.995 / 3.0).abs() < 1e-12 && (times[1].1 - 1.995 / 3.0).abs() < 1e-12);
    assert_eq!((toi.t, toi.first), (hits[0].t, Some(hits[0])));
}
