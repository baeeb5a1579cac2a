use super::*;
use crate::constraint::contact::Remembered;
use crate::constraint::joint::Measure;
use crate::integrator::Beta2;
use crate::kkt::Island;
use crate::kkt::calm::tests::join;
use crate::math::{cos, sin};
use crate::system::{Point, RigidBlock, RigidLoad, RigidMotion, Step};

/// What is asked for: this share of every overlap stays.
const KEPT: f64 = 0.7;

/// A fixed block and `n` squares of 2 m and 3 kg, a row of them 2 m apart.
fn squares(n: usize) -> Vec<Block> {
    let load = RigidLoad {
        inverse_mass: [1.0 / 3.0, 1.0 / 3.0, 0.5],
        force: [0.0; 3],
        damping: [0.0; 3],
    };
    let rest = RigidMotion::default();
    let mut blocks = vec![Block::Rigid(RigidBlock::prescribed(rest, rest))];
    for k in 0..n {
        let start = RigidMotion {
            centre: Vec2::new(2.0 * k as f64, 0.0),
            ..rest
        };
        let step = Step::new(&Beta2::default(), 1e-2);
        blocks.push(Block::Rigid(RigidBlock::free(start, None, &load, &step)));
    }
    blocks
}

/// A contact at the arm of one block, with a `gap`, beyond which the block lies along `normal` from the other one.
fn contact(
    blocks: &[Block],
    [one, other]: [(usize, Vec2); 2],
    normal: Vec2,
    gap: f64,
) -> ActiveContact {
    let grips = [(one, 1.0), (other, -1.0)]
        .map(|((block, arm), weight)| (block, Point::Arm(arm), weight, arm));
    let row = Kinematics::with_levers(gap, normal, Vec2::zeros(), &grips);
    let mut contact = ActiveContact::new(0, row, Remembered::default(), 0.0, blocks);
    contact.asked = KEPT * gap.min(0.0);
    contact.leave(contact.asked);
    contact
}

fn share_out(blocks: &[Block], contacts: &mut [ActiveContact]) {
    let mut parting = Parting::default();
    let none = (&mut [][..], &[][..]);
    let shared = parting.share_out(blocks, contacts, none, (0.0, false), ActiveContact::gap);
    assert!(shared.is_ok());
}

const X: Vec2 = Vec2::new(1.0, 0.0);
const Y: Vec2 = Vec2::new(0.0, 1.0);

/// Corners that are a little in the ground, and squares in a row that are deeper in each other: what is asked for can be had.
#[test]
fn what_can_part_is_asked_for_all_of_it() {
    let blocks = squares(6);
    let mut contacts = Vec::new();
    for k in 1..=6 {
        for x in [-1.0, 1.0] {
            let places = [(k, Vec2::new(x, -1.0)), (0, Vec2::zeros())];
            contacts.push(contact(&blocks, places, Y, -1e-5));
        }
    }
    for k in 1..6 {
        for y in [-1.0, 1.0] {
            let places = [(k + 1, Vec2::new(-1.0, y)), (k, Vec2::new(1.0, y))];
            contacts.push(contact(&blocks, places, X, -0.02));
        }
    }
    share_out(&blocks, &mut contacts);
    for contact in &contacts {
        let missing = (contact.asked - contact.allowance) / (contact.asked / KEPT - contact.asked);
        assert!(missing.abs() < 0.05, "{missing} of the way is missing");
    }
}

/// Between two walls nothing parts, wherever the square is nearer to one of them; on the ground it rises all the same.
#[test]
fn what_stands_in_two_walls_is_left_there() {
    let blocks = squares(1);
    for deep in [0.01, 0.03, 0.06] {
        let at = |x, y| [(1, Vec2::new(x, y)), (0, Vec2::zeros())];
        let mut contacts = vec![
            contact(&blocks, at(-1.0, -1.0), X, -0.03),
            contact(&blocks, at(-1.0, 1.0), X, -0.03),
            contact(&blocks, at(1.0, -1.0), -X, -deep),
            contact(&blocks, at(1.0, 1.0), -X, -deep),
            contact(&blocks, at(-1.0, -1.0), Y, -0.02),
            contact(&blocks, at(1.0, -1.0), Y, -0.02),
        ];
        share_out(&blocks, &mut contacts);
        let [left, right, ground] = [0, 2, 4].map(|k| contacts[k].allowance);
        assert!(
            (left + right + 0.03 + deep).abs() < 1e-12,
            "{deep}: {left} and {right}"
        );
        let fine = FINENESS * deep;
        assert!(left >= -0.03 - fine && right >= -deep - fine);
        let raised = (ground + 0.02) / (0.02 * (1.0 - KEPT));
        assert!((0.25..1.0).contains(&raised), "{deep}: {raised}");
    }
}

/// Walls that lean apart by an angle: the square could slide out by what is missing over that angle, and goes no farther than half of it.
#[test]
fn nothing_is_led_far_along_a_wedge() {
    let blocks = squares(1);
    for lean in [1e-3, 1e-2, 0.1, 0.3] {
        let normals = [1.0, -1.0].map(|side| Vec2::new(side * cos(lean), sin(lean)));
        let mut contacts: Vec<_> = [-1.0, 1.0]
            .iter()
            .zip(normals)
            .map(|(&x, normal)| {
                let places = [(1, Vec2::new(x, 0.0)), (0, Vec2::zeros())];
                contact(&blocks, places, normal, -0.05)
            })
            .collect();
        share_out(&blocks, &mut contacts);
        for contact in &contacts {
            let parted = contact.allowance + 0.05;
            let (missing, tan) = (0.05 * (1.0 - KEPT), sin(lean) / cos(lean));
            let slid = missing * tan / (1.0 + tan.powi(2));
            let error = (contact.aside.abs() / slid - 1.0).abs();
            assert!(error < 0.01, "{lean}: slides by {}", contact.aside);
            let error = (parted / (slid * tan) - 1.0).abs();
            assert!(error < 0.01, "{lean}: parts by {parted}");
        }
    }
}

/// What is near is not run into by what parts from something else.
#[test]
fn what_is_near_keeps_its_room() {
    let blocks = squares(2);
    let mut contacts = vec![
        contact(&blocks, [(1, -X), (0, Vec2::zeros())], X, -0.05),
        contact(&blocks, [(2, -X), (1, X)], X, 0.001),
        contact(&blocks, [(2, X), (0, Vec2::zeros())], -X, 0.003),
    ];
    share_out(&blocks, &mut contacts);
    let parted = contacts[0].allowance + 0.05;
    assert!((parted - 0.004).abs() < 1e-4, "{parted}");
    assert_eq!(contacts[1].allowance, 0.0);
    assert_eq!(contacts[2].allowance, 0.0);
}

/// What misses a turn by `t` has points that miss their places by `t r`, `r` the radius of gyration: `√(I/m)` for any number of equal bodies.
#[test]
fn a_turn_counts_at_the_radius_of_gyration() {
    let gyration = (2.0_f64 / 3.0).sqrt();
    for others in [[1, 0], [1, 2]] {
        let mut island = Island {
            blocks: squares(2),
            ..Island::default()
        };
        join(&mut island, others);
        let tie = &mut island.joints.ties[0];
        (tie.is_hard, tie.gap) = (true, 0.3);
        let way = missing_way(&island.blocks, tie, &island.joints.grips);
        assert_eq!(way, 0.3);
        tie.row.measure = Measure::Turn(0.0);
        let way = missing_way(&island.blocks, tie, &island.joints.grips);
        assert!((way - 0.3 * gyration).abs() < 1e-12, "{way}");
    }
}

/// A row that comes half as near as it was asked to is late, one that comes less near is told to be out of reach.
#[test]
fn what_comes_less_than_half_as_near_is_out_of_reach() {
    let slop = 1e-6;
    for (missed, is_told) in [(0.0, false), (0.045, false), (0.055, true), (0.2, true)] {
        let mut island = Island {
            blocks: squares(1),
            ..Island::default()
        };
        join(&mut island, [1, 0]);
        let tie = &mut island.joints.ties[0];
        (tie.start, tie.asked, tie.target) = (0.4, [0.3, -0.1], 0.0);
        (tie.goal, tie.closing) = (0.3, -0.1);
        tie.leave(missed, slop);
        assert_eq!(tie.is_out_of_reach, is_told, "{missed}");
        assert!((tie.goal - 0.3 - missed).abs() < 1e-15);
    }
}
