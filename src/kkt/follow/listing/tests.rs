use super::*;
use crate::constraint::contact::Owner;
use crate::kkt::feasible::{FeasiblePath, Way};
use crate::kkt::follow::listing;
use crate::kkt::working_set;
use crate::math::Vec2;
use crate::path::Target;
use crate::system::{Block, RigidBlock, RigidMotion};

const CLOSING: f64 = 0.01;

/// How a pass lists what is near.
const PASS: Listing<'_> = Listing {
    memory: None,
    pass: 1,
    keeps_rows: false,
    is_again: false,
    slop: 0.0,
    rest: 0.0,
    kept: 0.0,
};

/// A wedge with its tip over the left side of a roof, both prescribed.
fn wedge_on_roof(is_wedge_first: bool) -> Island {
    let start = RigidMotion {
        centre: Vec2::new(-0.05, 0.012),
        ..RigidMotion::default()
    };
    let rest = RigidMotion::default();
    let mut path = FeasiblePath::default();
    let blocks = vec![
        Block::Rigid(RigidBlock::prescribed(start, rest)),
        Block::Rigid(RigidBlock::prescribed(rest, rest)),
    ];
    let wedge = [[0.0, 0.0], [0.5, 1.0], [-0.5, 1.0]].map(Vec2::from);
    let roof = [[0.0, 0.0], [-1.0, -0.3], [0.0, -3.0], [1.0, -0.3]].map(Vec2::from);
    let shapes: [&[Vec2]; 2] = [&wedge, &roof];
    let [wedge, roof] = [0, 1].map(|block: usize| {
        let corners = shapes[block].iter().zip(0..);
        let points: Vec<_> = corners
            .map(|(corner, name)| (name, *corner, Vec2::zeros()))
            .collect();
        let n = points.len() as u32;
        let edges: Vec<_> = (0..n).map(|a| [a, (a + 1) % n]).collect();
        path.rigid_member(block, &blocks, 0, [0.0; 2], &points, &edges)
    });
    assert!(path.add_way(Way {
        members: if is_wedge_first {
            [wedge, roof]
        } else {
            [roof, wedge]
        },
        owners: [Owner::Collider(0), Owner::Collider(1)],
        law: ContactLaw {
            friction: 0.5,
            ..ContactLaw::default()
        },
        places: (0, 0),
        closing: CLOSING,
        margin: CLOSING,
        reach: 0.1,
    }));
    path.rest(&blocks);
    let mut island = Island::default();
    (island.path, island.blocks) = (path, blocks);
    island
}

/// Leads the wedge to a place above the roof, turned by an angle.
fn lead(island: &mut Island, x: f64, angle: f64) {
    if let Block::Rigid(wedge) = &mut island.blocks[0] {
        wedge.stop_at(Vec2::new(x, 0.012), angle);
    }
    assert!(island.path.advance(&island.blocks));
}

/// The contact that carries a force.
fn pressing(island: &Island) -> ActiveContact {
    let mut found = island
        .contacts
        .iter()
        .filter(|one| one.multiplier != [0.0; 2]);
    match (found.next(), found.next()) {
        (Some(one), None) => *one,
        _ => panic!("one contact is to carry the force"),
    }
}

#[test]
fn a_tip_that_turns_over_a_ridge_has_slid_no_other_way_on_the_other_side() {
    for is_wedge_first in [true, false] {
        let mut island = wedge_on_roof(is_wedge_first);
        listing::list_near(&mut island, &PASS);
        let Some(tip) = island.contacts.iter_mut().find(|contact| {
            contact.base.is_some_and(|base| {
                base.near.point == 0 && matches!(base.near.target, Target::Edge(_))
            })
        }) else {
            panic!("the tip is over neither side");
        };
        tip.multiplier = [3.0, 0.4];
        tip.status = [Status::Stick; 2];
        // Over the ridge and back again, turning about the tip: the surfaces touch a closing distance below it.
        for (x, angle) in [(0.02, 0.2), (-0.03, 0.3), (0.01, 0.4)] {
            lead(&mut island, x, angle);
            let before = pressing(&island);
            working_set::measure(&mut island, false);
            let left = before.kinematics;
            let slid = left
                .tangent()
                .dot(&island.path.moved(&left, &island.blocks))
                + before.slip_before;
            listing::list_near(&mut island, &PASS);
            let now = pressing(&island);
            let target = |contact: &ActiveContact| contact.base.map(|base| base.near.target);
            assert_ne!(target(&before), target(&now), "the tip stays on its side");
            let own = now
                .kinematics
                .tangent()
                .dot(&island.path.moved(&now.kinematics, &island.blocks));
            assert!(
                (own - slid).abs() > 0.1 * CLOSING * angle,
                "rows that agree show nothing: {own} and {slid}"
            );
            working_set::measure(&mut island, false);
            let now = pressing(&island).slip;
            assert!((now - slid).abs() < 1e-12, "{now} m after {slid} m");
        }
    }
}
