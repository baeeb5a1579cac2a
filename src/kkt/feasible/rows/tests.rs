use super::*;
use crate::constraint::contact::{ContactLaw, Owner};
use crate::kkt::feasible::Way;
use crate::path::samples::Random;
use crate::system::{RigidBlock, RigidMotion};

const CLOSING: f64 = 0.02;
const ROUND: f64 = 0.01;

/// The near pairs of a spike whose tip stands for a sharp corner, over the two slopes of a valley; `None` if they are not apart.
fn over_valley(tip: Vec2, corner: Vec2, slopes: [f64; 2]) -> Option<FeasiblePath> {
    let start = RigidMotion {
        centre: tip - corner,
        ..RigidMotion::default()
    };
    let ground = RigidMotion::default();
    let above = RigidMotion {
        centre: start.centre + Vec2::new(0.0, 1.0),
        ..start
    };
    let blocks = vec![
        Block::Rigid(RigidBlock::prescribed(start, above)),
        Block::Rigid(RigidBlock::prescribed(ground, ground)),
    ];
    let none = Vec2::zeros();
    let spike = [(0, none, corner), (1, Vec2::new(0.0, 1.0), none)];
    let ends = [-1.0, 0.0, 1.0].map(|x: f64| Vec2::new(x, x.abs() * slopes[usize::from(x > 0.0)]));
    let valley = [0, 1, 2].map(|name| (name, ends[name as usize], none));
    let mut path = FeasiblePath::default();
    let one = path.rigid_member(0, &blocks, 0, [ROUND; 2], &spike, &[[0, 1]]);
    let other = path.rigid_member(1, &blocks, 0, [0.0; 2], &valley, &[[0, 1], [1, 2]]);
    let is_added = path.add_way(Way {
        members: [one, other],
        owners: [Owner::Collider(0), Owner::Collider(1)],
        law: ContactLaw::default(),
        places: (0, 0),
        closing: CLOSING,
        margin: CLOSING,
        reach: 0.1,
    });
    path.rest(&blocks);
    path.list_near();
    is_added.then_some(path)
}

/// What a tip may touch beside the bottom of a valley are both slopes, wherever the core that stands for it has its feet.
#[test]
fn a_sharp_corner_touches_both_slopes_of_a_valley() {
    let mut random = Random::new(21);
    let mut n_beyond = 0;
    for _ in 0..8_000 {
        let slopes = [0, 1].map(|_| 0.05 + 1.5 * random.unit());
        let tip = Vec2::new(random.within(0.05), 0.15 * random.unit());
        let corner = Vec2::new(random.within(0.03), -0.03 * random.unit());
        let lines = [(-1.0, slopes[0]), (1.0, slopes[1])].map(|(side, slope): (f64, f64)| {
            let normal = Vec2::new(-side * slope, 1.0).normalize();
            let along = Vec2::new(side, slope).normalize();
            (normal, along)
        });
        let is_over =
            |(normal, along): (Vec2, Vec2)| normal.dot(&tip) > 0.0 && along.dot(&tip) > 0.0;
        let core_is_above = lines
            .iter()
            .all(|(normal, _)| normal.dot(&(tip - corner)) > 0.0);
        if !core_is_above || !lines.into_iter().all(is_over) {
            continue;
        }
        let Some(path) = over_valley(tip, corner, slopes) else {
            continue;
        };
        for (edge, (normal, along)) in lines.into_iter().enumerate() {
            let gap = normal.dot(&tip) - (CLOSING - ROUND);
            if gap > 0.09 {
                continue;
            }
            let target = Target::Edge(1 + edge);
            let mut rows = path.near().iter();
            let row = rows.find(|near| near.point == 0 && near.target == target);
            let Some(near) = row else {
                panic!("no row over slope {edge} of {slopes:?} at {tip}, corner {corner}");
            };
            assert!((path.kinematics(near).gap - gap).abs() < 1e-12);
            n_beyond += usize::from(along.dot(&(tip - corner)) < 0.0);
        }
    }
    assert!(n_beyond > 100, "{n_beyond} of a core beyond the bottom");
}
