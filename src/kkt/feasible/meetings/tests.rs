use super::*;
use crate::constraint::contact::Owner;
use crate::system::{Block, RigidBlock, RigidMotion};

const CLOSING: f64 = 0.01;
/// Coordinates of the tip on either side of the ridge (m).
const ASIDE: f64 = 0.05;
const HEIGHT: f64 = 0.012;

/// A wedge stands with its tip on a roof.
///
/// ```text
///       \   /
///        \ /
///     _ - V - _     slope to either side
///   /_         _\
/// ```
struct Ridge {
    path: FeasiblePath,
    blocks: Vec<Block>,
}

impl Ridge {
    fn new(slope: f64, is_wedge_first: bool) -> Self {
        let start = RigidMotion {
            centre: Vec2::new(-ASIDE, HEIGHT),
            ..RigidMotion::default()
        };
        let roof = RigidMotion::default();
        let blocks = vec![
            Block::Rigid(RigidBlock::prescribed(start, roof)),
            Block::Rigid(RigidBlock::prescribed(roof, roof)),
        ];
        let mut path = FeasiblePath::default();
        let tip = [[0.0, 0.0], [0.5, 1.0], [-0.5, 1.0]].map(Vec2::from);
        let house = [
            [0.0, 0.0],
            [-1.0, -slope],
            [-1.0, -3.0],
            [1.0, -3.0],
            [1.0, -slope],
        ]
        .map(Vec2::from);
        let shapes: [&[Vec2]; 2] = [&tip, &house];
        let members = [0, 1].map(|block: usize| {
            let corners = shapes[block].iter().zip(0..);
            let points = corners.map(|(corner, name)| (name, *corner, Vec2::zeros()));
            let points: Vec<_> = points.collect();
            let n = points.len() as u32;
            let edges: Vec<_> = (0..n).map(|a| [a, (a + 1) % n]).collect();
            path.rigid_member(block, &blocks, 0, [0.0; 2], &points, &edges)
        });
        let [wedge, roof] = members;
        let is_apart = path.add_way(Way {
            members: if is_wedge_first {
                members
            } else {
                [roof, wedge]
            },
            owners: [Owner::Collider(0), Owner::Collider(1)],
            law: ContactLaw::default(),
            places: (0, 0),
            closing: CLOSING,
            margin: CLOSING,
            reach: 0.1,
        });
        assert!(is_apart);
        path.rest(&blocks);
        path.list_near();
        Self { path, blocks }
    }

    /// The tip over its side of the roof.
    fn tip(&self) -> NearPair {
        let is_tip = |near: &&NearPair| near.point == 0 && matches!(near.target, Target::Edge(_));
        let Some(tip) = self.path.near().iter().find(is_tip) else {
            panic!("the tip is over neither side");
        };
        *tip
    }

    /// Lets the tip slide over the ridge, under a force with this friction along its face; returns the pair it leaves.
    fn slide(&mut self, friction: f64, pass: usize) -> NearPair {
        let from = self.tip();
        let left = self.path.kinematics(&from);
        let across = -self.path.surfaces.points()[0].x;
        if let Block::Rigid(wedge) = &mut self.blocks[0] {
            wedge.stop_at(Vec2::new(across, HEIGHT), 0.0);
        }
        assert!(self.path.advance(&self.blocks));
        self.path.list_near();
        let to = self.tip();
        assert_ne!(from.target, to.target);
        let rows = [&left, &self.path.kinematics(&to)];
        let force = [3.0, 3.0 * friction];
        self.path.note_slide(&from, Some(&to), rows, force, pass);
        from
    }
}

/// Directions of a force along the normal of a side with this friction, for both sides of the roof.
fn on_sides(slope: f64, friction: f64) -> [Vec2; 2] {
    [-1.0, 1.0].map(|side| {
        let normal = Vec2::new(side * slope, 1.0).normalize();
        (normal + friction * perp(normal)).normalize()
    })
}

#[test]
fn a_tip_that_slides_to_and_fro_over_a_ridge_is_held_within_the_cone_between_both_sides() {
    for (slope, friction) in [(0.3, 0.0), (0.3, 0.2), (0.05, -0.4), (1.0, 0.0)] {
        for is_wedge_first in [true, false] {
            let mut ridge = Ridge::new(slope, is_wedge_first);
            ridge.slide(friction, 1);
            ridge.slide(friction, 1);
            assert!(
                ridge.path.held(0).is_none(),
                "once in a pass is no to and fro"
            );
            assert!(!ridge.path.is_at_meeting(&ridge.tip()));
            let left = ridge.slide(friction, 2);
            assert_eq!(ridge.path.n_meetings(), 1);
            assert!(ridge.path.is_at_meeting(&ridge.tip()) && ridge.path.is_at_meeting(&left));
            let Some((_, row, away, law, key)) = ridge.path.held(0) else {
                panic!("not held on a slope of {slope}");
            };
            // What sticks to the ridge under a force on the edges of the cone presses as over either side.
            let sign = if is_wedge_first { 1.0 } else { -1.0 };
            let mut limits = [-1.0, 1.0]
                .map(|side| sign * (row.normal + side * law.friction * row.tangent()).normalize());
            limits.sort_by(|a, b| a.x.total_cmp(&b.x));
            let mut sides = on_sides(slope, friction);
            sides.sort_by(|a, b| a.x.total_cmp(&b.x));
            for (limit, side) in limits.iter().zip(sides) {
                assert!((limit - side).norm() < 1e-12, "{limit} instead of {side}");
            }
            // It is led to where it closes above the ridge, not beside it.
            let tip = ridge.path.surfaces.points()[0];
            let closed = tip - sign * away;
            assert!(
                (closed - Vec2::new(0.0, CLOSING)).norm() < 1e-12,
                "{closed}"
            );
            assert_ne!(key.part & MEETING, 0);
        }
    }
}

#[test]
fn a_ridge_that_need_not_hold_lets_go_and_holds_no_more_than_twice() {
    let mut ridge = Ridge::new(0.3, true);
    let mut n_held = 0;
    for pass in 1..20 {
        ridge.slide(0.0, pass);
        if let Some((near, ..)) = ridge.path.held(0) {
            n_held += 1;
            ridge.path.let_go(&near);
            assert!(ridge.path.held(0).is_none());
        }
    }
    assert_eq!(n_held, 2);
}

#[test]
fn a_vertex_of_a_straight_edge_holds_nothing() {
    let mut ridge = Ridge::new(1e-9, true);
    for pass in 1..5 {
        ridge.slide(0.0, pass);
        assert!(ridge.path.held(0).is_none());
    }
}

#[test]
fn a_tip_that_leaves_for_good_is_held_by_the_side_it_would_have_come_to() {
    let mut ridge = Ridge::new(0.3, true);
    for pass in 1..3 {
        let from = ridge.tip();
        let row = ridge.path.kinematics(&from);
        let Block::Rigid(wedge) = &mut ridge.blocks[0] else {
            return;
        };
        wedge.stop_at(Vec2::new(ASIDE, HEIGHT), 0.0);
        ridge.path.advance(&ridge.blocks);
        ridge
            .path
            .note_slide(&from, None, [&row; 2], [1.0, 0.0], pass);
        let Block::Rigid(wedge) = &mut ridge.blocks[0] else {
            return;
        };
        wedge.stop_at(Vec2::new(-ASIDE, HEIGHT), 0.0);
        ridge.path.advance(&ridge.blocks);
        ridge.path.list_near();
    }
    let Some((_, row, _, law, _)) = ridge.path.held(0) else {
        panic!("not held");
    };
    assert!((row.normal - Vec2::new(0.0, 1.0)).norm() < 1e-12);
    assert!((law.friction - 0.3).abs() < 1e-12);
}

/// A wedge that has turned hangs over beside the ridge: with its tip at its place above the ridge it would be in the roof. The row of the
/// meeting tells how far; what is left when the tip has gone so far along it is the share by which that leans from the side.
#[test]
fn a_tip_that_is_held_above_a_ridge_lets_no_side_that_leans_into_the_roof() {
    for (turn, is_wedge_first) in [(-1.3, true), (1.3, true), (-1.3, false), (1.3, false)] {
        let mut ridge = Ridge::new(0.3, is_wedge_first);
        ridge.slide(0.0, 1);
        ridge.slide(0.0, 2);
        let mut at = Vec2::new(0.0, CLOSING);
        let mut gaps = [0.0; 2];
        for gap in &mut gaps {
            // It turns above the roof, by no more than a part of it at a time, and comes down.
            for height in [0.5, 0.0] {
                let Block::Rigid(wedge) = &mut ridge.blocks[0] else {
                    return;
                };
                wedge.stop_at(at + Vec2::new(0.0, height), turn);
                assert!((0..9).any(|_| ridge.path.advance(&ridge.blocks)));
            }
            ridge.path.list_near();
            let Some((_, row, ..)) = ridge.path.held(0) else {
                panic!("not held");
            };
            *gap = row.gap;
            let sign = if is_wedge_first { 1.0 } else { -1.0 };
            at -= sign * row.gap * row.normal;
        }
        let lean = 1.3 + f64::atan(0.5) - std::f64::consts::FRAC_PI_2;
        let overlap = CLOSING * (1.0 - f64::cos(lean));
        let left = overlap * (1.0 - f64::cos(lean));
        assert!((gaps[0] + overlap).abs() < 1e-12, "{turn}: {gaps:?}");
        assert!((gaps[1] + left).abs() < 1e-12, "{turn}: {gaps:?}");
    }
}
