use super::*;
use crate::constraint::joint::{
    JointGrip, JointKey, JointLaw, JointOwner, JointRow, Measure, RememberedJoint,
};
use crate::kkt::Island;
use crate::kkt::joints::Finish;
use crate::kkt::together;
use crate::kkt::together::tests::{flexible, island_of, random_motion, rigid};
use crate::linalg::complementarity::{RowKind, Status};
use crate::math::{Vec2, cross};
use crate::path::samples::Random;
use crate::system::{Block, Point, RigidBlock};

/// A joint between two blocks, wherever that is.
pub(in crate::kkt) fn join(island: &mut Island, blocks: [usize; 2]) {
    let first = island.joints.grips.len();
    for (block, weight) in blocks.into_iter().zip([1.0, -1.0]) {
        let point = match &island.blocks[block] {
            Block::Flex(_) => Point::Node(0),
            Block::Rigid(_) => Point::Arm(Vec2::zeros()),
        };
        island
            .joints
            .grips
            .push(JointGrip::new(block, point, weight));
    }
    let row = JointRow {
        key: JointKey {
            owner: JointOwner::Impulse(first as u32, 0),
            row: 0,
        },
        measure: Measure::Along(Vec2::x()),
        sign: 1.0,
        grips: (first, first + 2),
        law: JointLaw::Rigid {
            goal: 0.0,
            rate: 0.0,
        },
        remembered: None::<RememberedJoint>,
    };
    island.joints.ties.push(ActiveJoint {
        row,
        is_hard: false,
        has_mass: true,
        share: 1.0,
        finish: Finish::Hold { rate: 0.0 },
        start: 0.0,
        goal: 0.0,
        give: 0.0,
        yielding: 0.0,
        kind: RowKind::Bilateral,
        gap: 0.0,
        direction: Vec2::x(),
        applied: Vec2::x(),
        end: Vec2::x(),
        multiplier: 0.0,
        status: Status::Stick,
        closing: 0.0,
        closer: 0.0,
        answer: 0.0,
        asked: [0.0; 2],
        kick: 0.0,
        impulse: 0.0,
        settled: 0.0,
        began: 0.0,
        driven: 0.0,
        is_movable: true,
        target: 0.0,
        seen: 0.0,
        n_same: 0,
        is_left: false,
        is_out_of_reach: false,
    });
}

fn calmed(island: &mut Island, excess: f64) -> f64 {
    let leaders = together::groups_of(island, |block| !block.is_prescribed());
    let joints = (&island.joints.ties[..], &island.joints.grips[..]);
    remove_relative_motion(&mut island.blocks, joints, &leaders, excess)
}

/// Linear momentum, angular momentum about the origin and kinetic energy, by the velocities that there are.
fn sums(block: &Block) -> [f64; 4] {
    match block {
        Block::Rigid(body) => {
            let (motion, [mass, _, polar]) = (body.current(), body.mass());
            let linear = mass * motion.velocity;
            let angular = polar * motion.spin + cross(motion.centre, linear);
            [linear.x, linear.y, angular, body.kinetic_energy(motion)]
        }
        Block::Flex(body) => {
            let momentum = body.momentum();
            let (linear, angular) = (momentum.linear, momentum.angular);
            [linear.x, linear.y, angular, body.kinetic_energy()]
        }
    }
}

fn total(blocks: &[Block]) -> [f64; 4] {
    let all: Vec<[f64; 4]> = blocks.iter().map(sums).collect();
    std::array::from_fn(|i| all.iter().map(|one| one[i]).sum())
}

fn place(island: &mut Island) {
    for block in &mut island.blocks {
        if let Block::Flex(body) = block {
            body.place_velocities();
        }
    }
}

/// Velocity of some point of a block (m/s).
fn velocity_of(block: &Block) -> (Vec2, Vec2) {
    match block {
        Block::Rigid(body) => (body.current().centre, body.current().velocity),
        Block::Flex(body) => (body.position(3), body.velocity(3)),
    }
}

#[test]
fn what_is_taken_is_what_was_asked_and_momentum_stays() {
    let mut random = Random::new(11);
    for case in 0..60 {
        let members = [0, 1, 2].map(|slot| {
            let centre = random.point(1.0) + Vec2::new(0.0, 10.0 * f64::from(slot == 2));
            match (case >> slot) % 2 == 0 {
                true => rigid(&mut random, centre),
                false => flexible(&mut random, centre, false),
            }
        });
        let (mut island, _) = island_of(members.into());
        place(&mut island);
        join(&mut island, [0, 1]);
        let (joined, alone) = (total(&island.blocks[..2]), sums(&island.blocks[2]));
        let asked = 1e-2 * joined[3];
        let taken = calmed(&mut island, asked);
        let after = total(&island.blocks[..2]);
        assert!((taken / asked - 1.0).abs() < 1e-9, "{taken} J of {asked}");
        let fallen = joined[3] - after[3];
        assert!((fallen / asked - 1.0).abs() < 1e-9, "{fallen} J of {asked}");
        for i in 0..3 {
            let off = after[i] - joined[i];
            assert!(off.abs() < 1e-11 * (1.0 + joined[3]), "sum {i} by {off:e}");
        }
        assert_eq!(sums(&island.blocks[2]), alone, "what is not joined");
        // More than there is: what is left is the common motion.
        let all = calmed(&mut island, 1e3 * joined[3]);
        assert!(all > 0.0 && all < joined[3]);
        let rest = calmed(&mut island, joined[3]);
        assert!(rest.abs() < 1e-11 * joined[3], "{rest} J are left");
    }
}

#[test]
fn what_is_joined_to_a_driven_body_is_calmed_about_its_motion() {
    let mut random = Random::new(12);
    let mut n_calmed = 0;
    for case in 0..40 {
        let led = random_motion(&mut random, Vec2::zeros());
        let anchor = Block::Rigid(RigidBlock::prescribed(led, led));
        let centre = random.point(1.0);
        let body = match case % 2 == 0 {
            true => rigid(&mut random, centre),
            false => flexible(&mut random, centre, false),
        };
        let (mut island, _) = island_of(vec![(anchor, [0.0; 4]), body]);
        place(&mut island);
        join(&mut island, [0, 1]);
        let shared = |at: Vec2| led.velocity + led.spin * crate::math::perp(at - led.centre);
        let (at, before) = velocity_of(&island.blocks[1]);
        let energy = sums(&island.blocks[1])[3];
        let taken = calmed(&mut island, 1e-3 * energy);
        // Nearer to a driven motion may be faster: then nothing is taken.
        if taken == 0.0 {
            assert_eq!(velocity_of(&island.blocks[1]).1, before);
            continue;
        }
        n_calmed += 1;
        let (_, after) = velocity_of(&island.blocks[1]);
        let [before, after] = [before, after].map(|velocity| velocity - shared(at));
        let scale = after.dot(&before) / before.norm_squared();
        assert!(scale < 1.0 && scale > 0.0, "{scale}");
        assert!((after - scale * before).norm() < 1e-12 * before.norm());
        let fallen = energy - sums(&island.blocks[1])[3];
        assert!((fallen / taken - 1.0).abs() < 1e-8, "{fallen} J of {taken}");
        assert!(taken <= 1e-3 * energy * (1.0 + 1e-9), "{taken} J");
    }
    assert!(n_calmed > 10, "{n_calmed}");
}
