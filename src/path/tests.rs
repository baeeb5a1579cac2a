//! The parts together: crowds that are pushed at random, pass after pass.

use super::samples::Random;
use super::{Hit, MemberPair, Motion, MotionKind, NearPair, Path, Surfaces};
use crate::math::Vec2;

/// Nine members of all kinds on a grid of 3 × 3 in a still frame, every one against every other.
fn crowd(random: &mut Random) -> (Surfaces, Vec<MemberPair>) {
    let mut surfaces = Surfaces::new();
    let frame = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]].map(|[x, y]| Vec2::new(x, y));
    surfaces.add_chain(MotionKind::Still, false, &frame, true);
    for k in 0..9 {
        let kind = if k % 2 == 0 {
            MotionKind::Rigid
        } else {
            MotionKind::Flexible
        };
        let centre = Vec2::new(f64::from(k % 3) - 1.0, f64::from(k / 3) - 1.0) * 1.2;
        random.member(&mut surfaces, kind, centre, 0.55);
    }
    let mut pairs = Vec::new();
    for one in 0..10 {
        for other in one + 1..10 {
            let name = pairs.len() as u64;
            pairs.push(MemberPair {
                one,
                other,
                name,
                closing: 0.01,
                margin: 0.01,
                least: f64::INFINITY,
                is_asleep: false,
            });
        }
    }
    (surfaces, pairs)
}

/// Pushes all towards the middle, with stray and turns.
fn push(surfaces: &Surfaces, random: &mut Random, motion: &mut Motion) {
    motion.rest(surfaces);
    for (index, member) in surfaces.members().iter().enumerate() {
        let points = &surfaces.points()[member.points.clone()];
        let centre = points.iter().sum::<Vec2>() / points.len() as f64;
        let shift = random.point(0.5) - centre * 0.5;
        match member.kind {
            MotionKind::Still => {}
            MotionKind::Rigid => {
                motion.move_rigid(surfaces, index, centre, shift, random.within(1.0))
            }
            MotionKind::Flexible => {
                for end in motion.ends_mut(surfaces, index) {
                    *end += shift + random.point(0.02);
                }
            }
        }
    }
}

#[test]
fn a_crowd_pushed_at_random_stays_apart_by_its_guard() {
    let mut random = Random::new(40);
    let (mut path, mut motion) = (Path::new(), Motion::new());
    let (mut hits, mut rows): (Vec<Hit>, Vec<NearPair>) = (Vec::new(), Vec::new());
    for _ in 0..20 {
        let (mut surfaces, pairs) = crowd(&mut random);
        if path.certificate(&surfaces, &pairs).least_gap < 0.0 {
            continue;
        }
        let mut closest = f64::INFINITY;
        for _ in 0..100 {
            push(&surfaces, &mut random, &mut motion);
            let toi = path.time_of_impact(&surfaces, &motion, &pairs, &mut hits);
            surfaces.advance(&motion, toi.t);
            let certificate = path.certificate(&surfaces, &pairs);
            assert!(certificate.is_valid(), "{certificate:?} after {toi:?}");
            // The guard is .8 margins below closing; at it, millionths of the distance per push.
            assert!(certificate.least_gap > -0.8 - 1e-4, "{certificate:?}");
            closest = closest.min(certificate.least_gap);
            // The certificate measures edges, the rows points: the same distance.
            path.near(&surfaces, &pairs, 0.01, &mut rows);
            let least = rows
                .iter()
                .map(|row| row.distance)
                .fold(f64::INFINITY, f64::min);
            if certificate.least_gap < 1.0 {
                assert!((certificate.least_gap - (least - 0.01) / 0.01).abs() < 1e-10);
            }
        }
        // They were jammed.
        assert!(closest < -0.79, "{closest}");
    }
}

#[test]
fn a_pair_has_room_if_it_may_be_led_as_near_as_others() {
    let pair = |least| MemberPair {
        one: 0,
        other: 1,
        name: 0,
        closing: 0.01,
        margin: 0.01,
        least,
        is_asleep: false,
    };
    let usual = pair(f64::INFINITY).guard();
    for (least, has_room) in [
        (f64::INFINITY, true),
        (0.01, true),
        (0.0021, true),
        (0.0019, false),
        (1e-12, false),
    ] {
        let pair = pair(least);
        assert_eq!(pair.has_room(), has_room, "{least}");
        // Never farther than others are kept, and never at the very distance it began with: what turns there needs room.
        let expected = usual.min(0.9 * least);
        assert!((pair.guard() - expected).abs() <= 1e-15, "{least}");
    }
}
