use super::{NearPair, Target};
use crate::math::Vec2;
use crate::path::samples::{Random, distance};
use crate::path::{MemberPair, MotionKind, Path, Surfaces};

mod joints;

pub(super) const PAIR: MemberPair = MemberPair {
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
