//! Rows where edges join and where they end.

use super::{around, of_ball, rows};
use crate::math::{Vec2, perp, rotation};
use crate::path::samples::{Random, power_of_ten};
use crate::path::{MotionKind, NearPair, Surfaces, Target};

/// A spike in a valley has rows at its tip, one with each slope; the bottom of the valley is in the way of nothing, and is a corner from below.
#[test]
fn the_bottom_of_a_notch_is_no_corner() {
    let valley = [[-1.0, 0.5], [0.0, 0.0], [1.0, 0.2]].map(|[x, y]| Vec2::new(x, y));
    for (kind, up) in [
        (MotionKind::Still, true),
        (MotionKind::Still, false),
        (MotionKind::Flexible, true),
    ] {
        let mut surfaces = Surfaces::new();
        let spike = [[0.004, 0.012], [0.5, 0.4], [-0.02, 1.0]].map(|[x, y]| {
            let y = if up { y } else { 0.1 - y };
            Vec2::new(x, y)
        });
        surfaces.add_chain(MotionKind::Rigid, false, &spike, true);
        surfaces.add_chain(kind, false, &valley, false);
        let rows = rows(&surfaces, 1.0);
        let of_bottom = rows.iter().filter(|row| row.point == 4).count();
        let of_tip = rows.iter().filter(|row| row.point == 0).count();
        let is_left_out = kind == MotionKind::Still && up;
        assert_eq!(of_bottom == 0, is_left_out, "{kind:?}, from above {up}");
        assert!(!up || of_tip == 2, "{of_tip} at the tip");
    }
}

#[test]
fn sliding_over_a_straight_joint_has_one_row_all_the_way() {
    let mut random = Random::new(12);
    for _ in 0..2_000 {
        let size = power_of_ten(random.within(3.0));
        let along = rotation(random.within(3.2)) * Vec2::new(1.0, 0.0);
        let origin = random.point(size);
        let lengths = [0.1 + random.unit(), 0.1 + random.unit()];
        let chain = [
            origin - along * lengths[0],
            origin,
            origin + along * lengths[1],
        ];
        let height = power_of_ten(-6.0 * random.unit()) * size.max(0.1);
        let exact = origin + perp(along) * height;
        let near_joint = |ball: Vec2| {
            let (rows, brute) = of_ball(ball, &chain, false);
            assert_eq!(rows.len(), 1, "{ball} over {chain:?}");
            // The foot may be misplaced by 1e-14 of the coordinates.
            assert!((rows[0].distance - brute).abs() < 1e-14 * (size + 1.0));
            assert!(rows[0].normal.dot(&perp(along)) > 1.0 - 1e-9);
        };
        for x in around(exact.x, 2) {
            around(exact.y, 2).for_each(|y| near_joint(Vec2::new(x, y)));
        }
        for step in [1e-16, 1e-15, 1e-14, 1e-13, 1e-12, 1e-9, 1e-3] {
            let step = f64::min(step * size, 0.05);
            near_joint(exact + along * step);
            near_joint(exact - along * step);
        }
    }
}

#[test]
fn a_convex_joint_hands_over_to_its_vertex_and_back_without_a_gap() {
    // A roof of 2 x 45°: the cone of the ridge is a quarter of the plane.
    let roof = [
        Vec2::new(-1.0, -1.0),
        Vec2::new(0.0, 0.0),
        Vec2::new(1.0, -1.0),
    ];
    let mut last = None;
    for k in -4_000..=4_000 {
        let angle = f64::from(k) * 2.5e-4;
        let ball = rotation(angle) * Vec2::new(0.0, 0.25);
        let (rows, brute) = of_ball(ball, &roof, false);
        assert_eq!(rows.len(), 1, "at angle {angle}");
        assert!((rows[0].distance - brute).abs() < 1e-15);
        // One step moves the ball by 6.25e-5.
        assert!((rows[0].distance - last.unwrap_or(rows[0].distance)).abs() < 6.3e-5);
        last = Some(rows[0].distance);
        let in_cone = angle.abs() <= std::f64::consts::FRAC_PI_4;
        assert_eq!(
            rows[0].target == Target::Vertex(2),
            in_cone,
            "at angle {angle}"
        );
    }
    // Exactly on the border of the cone, and one ulp beside.
    for x in around(0.25, 3) {
        assert_eq!(of_ball(Vec2::new(x, 0.25), &roof, false).0.len(), 1);
    }
}

#[test]
fn beside_an_end_but_under_an_edge_only_the_edge_counts() {
    // The end of the ground lies under the block's bottom: the block's corner sees that end beyond the ground, but is itself
    // not what the end is closest to.
    let block = [[-0.9, 0.1], [0.1, 0.1], [0.1, 1.1], [-0.9, 1.1]].map(|[x, y]| Vec2::new(x, y));
    let mut surfaces = Surfaces::new();
    surfaces.add_chain(MotionKind::Rigid, true, &block, true);
    let ground = [Vec2::new(-2.0, 0.0), Vec2::zeros()];
    surfaces.add_chain(MotionKind::Still, false, &ground, false);
    let found: Vec<_> = rows(&surfaces, 0.3)
        .iter()
        .map(|row| (row.point, row.target))
        .collect();
    assert_eq!(found, [(0, Target::Edge(4)), (5, Target::Edge(0))]);
}

#[test]
fn in_a_reflex_joint_there_are_both_feet_and_never_the_vertex() {
    for slope in [1.0, 0.1, 1e-3, 1e-6] {
        let valley = [
            Vec2::new(-1.0, slope),
            Vec2::new(0.0, 0.0),
            Vec2::new(1.0, slope),
        ];
        for k in -100..=100 {
            let x = f64::from(k) * 0.02 * 0.3 * slope;
            let (rows, brute) = of_ball(Vec2::new(x, 0.3), &valley, false);
            let both = x.abs() < 0.3 * slope;
            assert_eq!(
                rows.len(),
                if both { 2 } else { 1 },
                "x = {x}, slope {slope}"
            );
            let least = rows
                .iter()
                .map(|row| row.distance)
                .fold(f64::INFINITY, f64::min);
            assert!((least - brute).abs() < 1e-15);
            assert!(rows.iter().all(|row| matches!(row.target, Target::Edge(_))));
        }
    }
}

#[test]
fn the_end_of_an_open_chain_is_a_vertex_from_all_round() {
    let chain = [Vec2::new(0.0, 0.0), Vec2::new(1.0, 0.0)];
    for x in around(1.0, 40).chain([1.1, 2.0]) {
        let (rows, brute) = of_ball(Vec2::new(x, 0.2), &chain, false);
        assert_eq!(rows.len(), 1);
        assert!((rows[0].distance - brute).abs() < 1e-15);
    }
    assert_eq!(
        of_ball(Vec2::new(1.2, 0.0), &chain, false).0[0].target,
        Target::Vertex(2)
    );
}

#[test]
fn balls_and_capsules_end_to_end_have_one_row() {
    let mut surfaces = Surfaces::new();
    surfaces.add_chain(MotionKind::Rigid, false, &[Vec2::zeros()], false);
    surfaces.add_chain(MotionKind::Rigid, false, &[Vec2::new(0.3, 0.4)], false);
    let found = rows(&surfaces, 1.0);
    assert_eq!(found.len(), 1);
    assert_eq!((found[0].point, found[0].target), (0, Target::Vertex(1)));
    assert!((found[0].normal - Vec2::new(-0.6, -0.8)).norm() < 1e-15);
    assert_eq!(found[0].distance, 0.5);
    // Ends face each other on one line.
    surfaces.truncate(0);
    surfaces.add_chain(
        MotionKind::Rigid,
        false,
        &[Vec2::zeros(), Vec2::new(1.0, 0.0)],
        false,
    );
    surfaces.add_chain(
        MotionKind::Rigid,
        false,
        &[Vec2::new(1.1, 0.0), Vec2::new(2.0, 0.0)],
        false,
    );
    assert_eq!(rows(&surfaces, 1.0).len(), 1);
}

#[test]
fn corners_exactly_over_the_joints_of_a_floor_have_one_row_each() {
    // A square of 1 on a floor with joints every .25: three joints lie under its bottom, two exactly under its corners.
    let mut random = Random::new(13);
    for _ in 0..500 {
        let turn = rotation(random.within(3.2));
        let origin = random.point(100.0);
        let shift = [0.0, 1e-16, -1e-15, 1e-14, 3e-14, -1e-13, 1e-12, 1e-7][random.index(8)];
        let at = |x: f64, y: f64| origin + turn * Vec2::new(x, y);
        let floor: Vec<Vec2> = (-4..=8).map(|k| at(0.25 * f64::from(k), 0.0)).collect();
        let corners =
            [[0.0, 0.01], [1.0, 0.01], [1.0, 1.01], [0.0, 1.01]].map(|[x, y]| at(x + shift, y));
        let mut surfaces = Surfaces::new();
        surfaces.add_chain(MotionKind::Flexible, true, &corners, true);
        surfaces.add_chain(MotionKind::Still, false, &floor, false);
        let rows = rows(&surfaces, 0.02);
        let is_at = |row: &NearPair, corner: usize| {
            // The corner itself, or the joint .01 below it.
            (surfaces.points()[row.point] - surfaces.points()[corner]).norm() < 0.01 + 1e-8
        };
        for corner in [0, 1] {
            let n = rows.iter().filter(|row| is_at(row, corner)).count();
            // One within rounding. Beyond it, a corner over the floor and a joint under the bottom have a row each.
            assert!(
                n == 1 || n == 2 && shift.abs() > 2e-15,
                "{n} rows at shift {shift}"
            );
            assert!(rows.iter().filter(|row| row.point == corner).count() <= 1);
        }
        // In all the three joints in the middle besides.
        assert!(
            (5..=6).contains(&rows.len()),
            "{} at shift {shift}",
            rows.len()
        );
        assert!(rows.iter().all(|row| (row.distance - 0.01).abs() < 1e-13));
    }
}
