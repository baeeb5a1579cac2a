use super::{NearPair, Target};
use crate::math::{Vec2, perp, rotation};
use crate::path::samples::{Random, distance, power_of_ten};
use crate::path::{MemberPair, MotionKind, Path, Surfaces};

const PAIR: MemberPair = MemberPair {
    one: 0,
    other: 1,
    name: 7,
    closing: 0.01,
    margin: 0.01,
    least: f64::INFINITY,
    is_asleep: false,
};

fn rows(surfaces: &Surfaces, reach: f64) -> Vec<NearPair> {
    let mut rows = Vec::new();
    Path::new().near(surfaces, &[PAIR], reach, &mut rows);
    rows
}

/// The rows of a ball (member 0) near a chain.
fn of_ball(ball: Vec2, chain: &[Vec2], closed: bool) -> (Vec<NearPair>, f64) {
    let mut surfaces = Surfaces::new();
    surfaces.add_chain(MotionKind::Rigid, false, &[ball], false);
    surfaces.add_chain(MotionKind::Still, closed, chain, closed);
    let distance = distance(&surfaces, surfaces.points(), 0, 1);
    (rows(&surfaces, 1e4), distance)
}

/// A number and its neighbours up to some ulp away.
fn around(value: f64, ulps: i32) -> impl Iterator<Item = f64> {
    (-ulps..=ulps).map(move |k| {
        let step = if k < 0 { f64::next_down } else { f64::next_up };
        (0..k.abs()).fold(value, |value, _| step(value))
    })
}

#[test]
fn the_closest_pair_of_two_members_always_has_a_row() {
    let mut random = Random::new(10);
    let mut n = 0;
    while n < 3_000 {
        let mut surfaces = Surfaces::new();
        let centres = [random.point(1.5), random.point(1.5)];
        for centre in centres {
            random.member(&mut surfaces, MotionKind::Rigid, centre, 1.0);
        }
        if Path::new().apart(&surfaces, [0, 1], 0.0).is_none() {
            continue;
        }
        n += 1;
        let brute = distance(&surfaces, surfaces.points(), 0, 1);
        let rows = rows(&surfaces, brute * 1.01);
        let least = rows
            .iter()
            .map(|row| row.distance)
            .fold(f64::INFINITY, f64::min);
        assert!((least - brute).abs() < 1e-13, "{least} {brute}");
    }
}

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
fn rows_are_as_defined_and_no_key_comes_twice() {
    let mut random = Random::new(11);
    for _ in 0..300 {
        let mut surfaces = Surfaces::new();
        for n in [5 + random.index(60), 5 + random.index(60)] {
            let chain = random.chain(n, 0.2);
            surfaces.add_chain(MotionKind::Flexible, false, &chain, random.unit() < 0.5);
        }
        let rows = rows(&surfaces, 0.1);
        let mut keys: Vec<u64> = rows.iter().map(|row| row.key).collect();
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(keys.len(), rows.len());
        let mut n_inner = 0;
        for [of, against] in [[0, 1], [1, 0]] {
            for point in surfaces.members()[of].points.clone() {
                for edge in surfaces.members()[against].edges.clone() {
                    let (p, [a, b]) = (surfaces.points()[point], surfaces.ends(edge));
                    let xi = (p - a).dot(&(b - a)) / (b - a).norm_squared();
                    let off = (p - a - (b - a) * xi).norm();
                    n_inner += usize::from(xi > 0.0 && xi < 1.0 && off <= 0.11);
                }
            }
        }
        let inner = rows
            .iter()
            .filter(|row| matches!(row.target, Target::Edge(_)));
        assert_eq!(inner.count(), n_inner);
        for row in &rows {
            let target = match row.target {
                Target::Edge(edge) => {
                    let [a, b] = surfaces.ends(edge);
                    a + (b - a) * row.xi
                }
                Target::Vertex(vertex) => surfaces.points()[vertex],
            };
            // Coordinates and lengths of a few units.
            assert!(
                (target + row.normal * row.distance - surfaces.points()[row.point]).norm() < 1e-14
            );
            assert!(row.distance <= 0.11);
        }
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

#[test]
fn keys_do_not_depend_on_other_members_or_pairs() {
    let chain = [Vec2::new(0.0, 0.0), Vec2::new(1.0, 0.0)];
    let ball = [Vec2::new(0.5, 0.01)];
    let mut surfaces = Surfaces::new();
    surfaces.add_chain(MotionKind::Rigid, false, &ball, false);
    surfaces.add_chain(MotionKind::Still, false, &chain, false);
    let alone = rows(&surfaces, 0.1);
    surfaces.truncate(0);
    surfaces.add_chain(MotionKind::Rigid, false, &chain, false);
    surfaces.add_chain(MotionKind::Rigid, false, &ball, false);
    surfaces.add_chain(MotionKind::Still, false, &chain, false);
    let mut among = Vec::new();
    let far = MemberPair {
        one: 0,
        other: 1,
        name: 8,
        ..PAIR
    };
    Path::new().near(
        &surfaces,
        &[
            far,
            MemberPair {
                one: 1,
                other: 2,
                ..PAIR
            },
        ],
        0.1,
        &mut among,
    );
    assert_eq!(among.len(), 2);
    assert_eq!(alone[0].key, among[1].key);
    assert_ne!(among[0].key, among[1].key);
}

/// Moves a number by up to two ulp, or not.
fn jittered(value: Vec2, random: &mut Random) -> Vec2 {
    let mut one = |value: f64| {
        let k = random.index(5);
        around(value, 2).nth(k).unwrap_or(value)
    };
    Vec2::new(one(value.x), one(value.y))
}

#[test]
fn on_a_lattice_with_or_without_jitter_the_closest_pair_has_a_row_and_a_ball_no_two_at_one_place() {
    // Feet fall on joints, vertices lie over vertices and edges on one line all the time.
    let mut random = Random::new(14);
    for round in 0..20_000 {
        let mut surfaces = Surfaces::new();
        let scale = [1.0, 0.1, 1e3 / 3.0][random.index(3)];
        let chain = |n: usize, from: [usize; 2], random: &mut Random| {
            // Steps to the right and up or down: monotonous, so that it does not cross itself.
            let mut x = from[0];
            let points = (0..n).map(|_| {
                x += 1 + random.index(2);
                Vec2::new(x as f64, (from[1] + random.index(3)) as f64) * scale
            });
            let points: Vec<Vec2> = points.collect();
            points
                .into_iter()
                .map(|p| {
                    if round % 2 == 0 {
                        p
                    } else {
                        jittered(p, random)
                    }
                })
                .collect::<Vec<_>>()
        };
        let sizes = [1 + random.index(4), 2 + random.index(4)];
        let (from, height) = (random.index(5), random.index(4));
        let one = chain(sizes[0], [from, height], &mut random);
        let other = chain(sizes[1], [0, 0], &mut random);
        surfaces.add_chain(MotionKind::Flexible, false, &one, false);
        surfaces.add_chain(MotionKind::Flexible, false, &other, false);
        if Path::new().apart(&surfaces, [0, 1], 0.0).is_none() {
            continue;
        }
        let brute = distance(&surfaces, surfaces.points(), 0, 1);
        if brute < 1e-9 * scale {
            continue;
        }
        let rows = rows(&surfaces, 20.0 * scale);
        let least = rows
            .iter()
            .map(|row| row.distance)
            .fold(f64::INFINITY, f64::min);
        assert!(
            (least - brute).abs() < 1e-13 * scale,
            "{least} {brute} between {one:?} and {other:?}"
        );
        if one.len() == 1 {
            for (k, row) in rows.iter().enumerate() {
                let foot = |row: &NearPair| one[0] - row.normal * row.distance;
                let same = rows[..k]
                    .iter()
                    .any(|before| (foot(before) - foot(row)).norm() < 1e-9 * scale);
                assert!(!same, "{rows:?} between {one:?} and {other:?}");
            }
        }
    }
}
