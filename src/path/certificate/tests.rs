use super::{Overlap, meet};
use crate::math::Vec2;
use crate::path::samples::{Random, distance};
use crate::path::{Certificate, MemberPair, MotionKind, Path, Surfaces};

fn square(centre: [f64; 2], half: f64) -> Vec<Vec2> {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    corners
        .iter()
        .map(|[x, y]| Vec2::new(centre[0] + x * half, centre[1] + y * half))
        .collect()
}

fn certify(surfaces: &Surfaces) -> Certificate {
    let pair = MemberPair {
        one: 0,
        other: 1,
        name: 0,
        closing: 0.1,
        margin: 0.1,
        least: f64::INFINITY,
        is_asleep: false,
    };
    let mut path = Path::new();
    let certificate = path.certificate(surfaces, &[pair]);
    assert_eq!(
        certificate.is_valid(),
        path.apart(surfaces, [0, 1], 0.0).is_some()
    );
    certificate
}

fn two(one: (&[Vec2], bool), other: (&[Vec2], bool)) -> Certificate {
    let mut surfaces = Surfaces::new();
    for (points, closed) in [one, other] {
        surfaces.add_chain(MotionKind::Flexible, closed, points, closed);
    }
    certify(&surfaces)
}

/// A loop from 2 to -2 with a clockwise hole of half side 1.
fn frame() -> (Vec<Vec2>, Vec<[u32; 2]>) {
    let mut points = square([0.0, 0.0], 2.0);
    points.extend(square([0.0, 0.0], 1.0).into_iter().rev());
    let edges = (0..8).map(|k| [k, k / 4 * 4 + (k + 1) % 4]).collect();
    (points, edges)
}

#[test]
fn overlapping_squares_cross_twice() {
    let found = two(
        (&square([0.0, 0.0], 1.0), true),
        (&square([1.5, 1.5], 1.0), true),
    );
    assert_eq!(
        (found.n_crossings, found.n_touching, found.n_contained),
        (2, 0, 0)
    );
    assert_eq!(found.first, Some((0, Overlap::Crossing)));
    assert_eq!(found.least_gap, -1.0);
}

#[test]
fn touching_is_told_from_crossing_and_from_a_gap_of_one_ulp() {
    let floor = [Vec2::new(-3.0, 0.0), Vec2::new(3.0, 0.0)];
    let touching = two((&square([0.0, 1.0], 1.0), true), (&floor, false));
    // The bottom lies on the floor, and both sides end there.
    assert_eq!((touching.n_crossings, touching.n_touching), (0, 3));
    assert_eq!(touching.first, Some((0, Overlap::Touching)));
    let mut above = square([0.0, 1.0], 1.0);
    above[..2]
        .iter_mut()
        .for_each(|corner| corner.y = f64::MIN_POSITIVE * 1e16);
    assert!(two((&above, true), (&floor, false)).is_valid());
    above[0].y = -f64::MIN_POSITIVE * 1e16;
    assert_eq!(two((&above, true), (&floor, false)).n_crossings, 2);
}

#[test]
fn a_vertex_on_the_other_edge_is_told_however_small_the_slope() {
    let edge = [Vec2::new(0.0, 0.0), Vec2::new(3.0, 1.0)];
    // .1 * 3 is not .3: the point is off the line by an ulp, and which side is known exactly.
    let beside = Vec2::new(0.1 * 3.0, 0.1);
    let away = beside + Vec2::new(-1.0, 3.0);
    assert_eq!(
        meet(edge, [Vec2::new(1.5, 0.5), away]),
        Some(Overlap::Touching)
    );
    assert_eq!(meet(edge, [beside, away]), Some(Overlap::Crossing));
    assert_eq!(
        meet(
            edge,
            [Vec2::new(beside.x.next_down().next_down(), 0.1), away]
        ),
        None
    );
}

#[test]
fn lines_through_each_other_need_not_share_a_point() {
    let points = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]].map(|[x, y]| Vec2::new(x, y));
    let [a, b, c, d] = points;
    assert_eq!(meet([a, b], [c, d]), None);
    assert_eq!(meet([a, c], [b, d]), Some(Overlap::Touching));
    assert_eq!(meet([a, b], [d, b]), Some(Overlap::Touching));
    // Balls, as edges of length zero.
    assert_eq!(meet([a, c], [b, b]), Some(Overlap::Touching));
    assert_eq!(meet([a, b], [c, c]), None);
    assert_eq!(meet([a, a], [a, a]), Some(Overlap::Touching));
    assert_eq!(meet([a, a], [b, b]), None);
}

#[test]
fn what_lies_inside_a_solid_is_contained() {
    let large = square([0.0, 0.0], 2.0);
    for inner in [
        (&square([0.0, 0.0], 1.0)[..], true),
        (&square([0.5, 0.0], 1.0)[..3], false),
        (&[Vec2::zeros()], false),
    ] {
        for certificate in [two((&large, true), inner), two(inner, (&large, true))] {
            assert_eq!(certificate.n_contained, 1);
            assert_eq!(certificate.first, Some((0, Overlap::Contained)));
        }
        // Inside an open chain or a loop that is not solid there is nothing to be in.
        assert!(two((&large, false), inner).is_valid());
    }
    // The ray from the middle of a diamond passes exactly through its corner; so it does from beside.
    let diamond = [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]].map(|[x, y]| Vec2::new(x, y));
    for (x, n) in [(0.0, 1), (-0.5, 1), (-1.5, 0), (1.5, 0)] {
        let ball = [Vec2::new(x, 0.0)];
        assert_eq!(two((&diamond, true), (&ball, false)).n_contained, n);
    }
    // Beside a corner, on the line of a side: the ray passes exactly through vertices.
    assert!(two((&large, true), (&[Vec2::new(-3.0, -2.0)], false)).is_valid());
    assert!(two((&large, true), (&[Vec2::new(-3.0, 2.0)], false)).is_valid());
}

#[test]
fn a_body_in_the_hole_of_another_is_not_contained() {
    let (points, edges) = frame();
    for (centre, half, contained) in [
        ([0.0, 0.0], 0.5, 0),
        ([1.5, 0.0], 0.2, 1),
        ([4.0, 0.0], 0.5, 0),
    ] {
        let mut surfaces = Surfaces::new();
        surfaces.add(MotionKind::Flexible, true, &points, edges.clone());
        surfaces.add_chain(MotionKind::Rigid, true, &square(centre, half), true);
        let certificate = certify(&surfaces);
        assert_eq!(
            (certificate.n_crossings, certificate.n_contained),
            (0, contained)
        );
    }
    // Both loops of the frame inside a larger square: two parts.
    let mut surfaces = Surfaces::new();
    surfaces.add(MotionKind::Flexible, true, &points, edges);
    surfaces.add_chain(MotionKind::Rigid, true, &square([0.0, 0.0], 3.0), true);
    assert_eq!(certify(&surfaces).n_contained, 2);
}

#[test]
fn a_member_against_itself_may_cross_but_not_touch_its_neighbours() {
    let pair = MemberPair {
        one: 0,
        other: 0,
        name: 0,
        closing: 0.01,
        margin: 0.01,
        least: f64::INFINITY,
        is_asleep: false,
    };
    let mut bow = square([0.0, 0.0], 1.0);
    let mut surfaces = Surfaces::new();
    surfaces.add_chain(MotionKind::Flexible, true, &bow, true);
    assert!(Path::new().certificate(&surfaces, &[pair]).is_valid());
    bow.swap(0, 1);
    surfaces.truncate(0);
    surfaces.add_chain(MotionKind::Flexible, true, &bow, true);
    assert_eq!(Path::new().certificate(&surfaces, &[pair]).n_crossings, 1);
    // A corner that folds: as far as its neighbour's end is from the other edge, and not at all where that lies on it.
    for height in [0.012, 0.0] {
        surfaces.truncate(0);
        let fold = [[0.6, height], [0.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
        let fold = fold.map(|[x, y]| Vec2::new(x, y));
        surfaces.add_chain(MotionKind::Flexible, true, &fold, true);
        let found = Path::new().certificate(&surfaces, &[pair]);
        // The last edge ends there too.
        assert_eq!(found.n_touching, if height > 0.0 { 0 } else { 2 });
        if height > 0.0 {
            assert!((found.least_gap - 0.2).abs() < 1e-12, "{found:?}");
        }
    }
}

#[test]
fn random_members_agree_with_all_against_all() {
    let mut random = Random::new(20);
    let mut counts = [0; 2];
    for _ in 0..2_000 {
        let mut surfaces = Surfaces::new();
        let centres = [random.point(1.0), random.point(1.0)];
        let size = random.unit();
        random.member(&mut surfaces, MotionKind::Rigid, centres[0], 1.0);
        random.member(&mut surfaces, MotionKind::Rigid, centres[1], size);
        let mut n_crossings = 0;
        for one in surfaces.members()[0].edges.clone() {
            for other in surfaces.members()[1].edges.clone() {
                let ([a, b], [c, d]) = (surfaces.ends(one), surfaces.ends(other));
                // Plain arithmetic will do: random edges do not nearly touch.
                let [u, v, w] = [b - a, d - c, c - a];
                let det = u.perp(&v);
                let (s, t) = (w.perp(&v) / det, w.perp(&u) / det);
                n_crossings += usize::from((0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t));
            }
        }
        let found = certify(&surfaces);
        assert_eq!(found.n_crossings, n_crossings);
        counts[0] += usize::from(n_crossings > 0);
        counts[1] += found.n_contained;
        let brute = distance(&surfaces, surfaces.points(), 0, 1);
        if n_crossings == 0 && brute < 0.2 {
            assert!((found.least_gap - (brute - 0.1) / 0.1).abs() < 1e-12);
        }
    }
    assert!(counts[0] > 100 && counts[1] > 20, "{counts:?}");
}
