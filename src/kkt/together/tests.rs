use super::*;
use crate::body::{FlexBodyBuilder, Pin};
use crate::constraint::contact::{
    Candidate, ContactKey, ContactLaw, Kinematics, Owner, Pair, Remembered,
};
use crate::fe::material::LinearElastic;
use crate::integrator::Beta2;
use crate::kkt::ActiveContact;
use crate::kkt::calm::tests::join;
use crate::kkt::joints::Finish;
use crate::kkt::together;
use crate::math::{cross, perp};
use crate::path::samples::Random;
use crate::system::samples::{body_of, predicted};
use crate::system::{Point, RigidBlock, RigidLoad, Step};

const DT: f64 = 1e-2;

pub(in crate::kkt) fn random_motion(random: &mut Random, centre: Vec2) -> RigidMotion {
    RigidMotion {
        centre,
        angle: random.within(3.0),
        velocity: random.point(4.0),
        spin: random.within(6.0),
    }
}

pub(in crate::kkt) fn rigid(random: &mut Random, centre: Vec2) -> (Block, Sums) {
    let [mass, polar] = [0, 1].map(|_| 0.2 + random.unit());
    let load = RigidLoad {
        inverse_mass: [mass, mass, polar],
        force: [0.0; 3],
        damping: [0.0; 3],
    };
    let motion = random_motion(random, centre);
    let step = Step::new(&Beta2::default(), DT);
    let body = RigidBlock::free(motion, None, &load, &step);
    let start = of_rigid(&body, &motion);
    (Block::Rigid(body), start)
}

/// A rectangle that moves as a rigid body; one that is pinned stays.
pub(in crate::kkt) fn flexible(
    random: &mut Random,
    centre: Vec2,
    is_pinned: bool,
) -> (Block, Sums) {
    let [width, height] = [0.3 + random.unit(), 0.3 + random.unit()];
    let material = LinearElastic::plane_stress(1e5, 0.3).density(1.0);
    let mut builder = FlexBodyBuilder::rectangle([width, height], [3, 2])
        .small_strain()
        .material(material)
        .rotation(random.within(3.0))
        .translation([centre.x, centre.y]);
    builder = if is_pinned {
        builder.pin_where(|[x, _]| x < 1e-9, Pin::both())
    } else {
        builder
            .linvel(random.point(4.0).into())
            .angvel(random.within(6.0))
    };
    let body = body_of(builder);
    let block = predicted(&body, DT);
    let [x, y] = body.momentum();
    let start = [x, y, body.angular_momentum([0.0; 2]), body.energy().kinetic];
    (Block::Flex(Box::new(block)), start)
}

/// A contact that presses between two blocks, wherever that is.
fn press(island: &mut Island, blocks: [usize; 2]) {
    let grips = blocks.map(|block| match &island.blocks[block] {
        Block::Flex(_) => (block, Point::Node(0), 1.0, Vec2::zeros()),
        Block::Rigid(_) => (block, Point::Arm(Vec2::zeros()), -1.0, Vec2::zeros()),
    });
    let row = Kinematics::with_levers(0.0, Vec2::new(0.0, 1.0), Vec2::zeros(), &grips);
    let mut contact = ActiveContact::new(0, row, Remembered::default(), 0.0, &island.blocks);
    contact.multiplier[0] = 1.0;
    island.contacts.push(contact);
}

/// Linear momentum, angular momentum about the origin, kinetic energy.
pub(in crate::kkt) type Sums = [f64; 4];

fn of_rigid(body: &RigidBlock, motion: &RigidMotion) -> Sums {
    let [mass, _, polar] = body.mass();
    let linear = mass * motion.velocity;
    let angular = polar * motion.spin + cross(motion.centre, linear);
    [linear.x, linear.y, angular, body.kinetic_energy(motion)]
}

fn at_end(block: &mut Block) -> Sums {
    match block {
        Block::Rigid(body) => of_rigid(body, body.current()),
        Block::Flex(body) => {
            body.place_velocities();
            let momentum = body.momentum();
            let (linear, angular) = (momentum.linear, momentum.angular);
            [linear.x, linear.y, angular, body.kinetic_energy()]
        }
    }
}

fn total(all: &[Sums]) -> Sums {
    std::array::from_fn(|i| all.iter().map(|one| one[i]).sum())
}

/// An island of blocks with what they have at the beginning.
pub(in crate::kkt) fn island_of(blocks: Vec<(Block, Sums)>) -> (Island, Vec<Sums>) {
    let mut island = Island::default();
    let (members, start) = blocks.into_iter().unzip();
    island.blocks = members;
    (island, start)
}

fn ended(island: &mut Island) -> Vec<Sums> {
    assert!(together::end_together(
        island,
        (DT, 1.0),
        &mut IslandSummary::default()
    ));
    island.blocks.iter_mut().map(at_end).collect()
}

/// Velocity that a block has at a point, as the rigid body that it moves as (m/s).
fn velocity_at(block: &Block, point: Vec2) -> Vec2 {
    match block {
        Block::Rigid(body) => body.velocity(point - body.current().centre),
        Block::Flex(body) => {
            let last = body.positions().len() / 2 - 1;
            let apart = body.position(last) - body.position(0);
            let spin = cross(apart, body.velocity(last) - body.velocity(0)) / apart.norm_squared();
            let at = |point: Vec2| body.velocity(0) + spin * perp(point - body.position(0));
            for node in 0..=last {
                let off = body.velocity(node) - at(body.position(node));
                assert!(off.norm() < 1e-12, "node {node} moves by itself: {off}");
            }
            at(point)
        }
    }
}

#[test]
fn bodies_that_touch_move_on_as_one_with_the_momentum_they_have_and_no_more_energy() {
    let mut random = Random::new(3);
    for case in 0..60 {
        let [one, other, far] = [0, 1, 2].map(|slot| {
            let centre = random.point(1.0) + Vec2::new(0.0, 10.0 * f64::from(slot == 2));
            if (case >> slot) % 2 == 0 {
                rigid(&mut random, centre)
            } else {
                flexible(&mut random, centre, false)
            }
        });
        let (mut island, start) = island_of(vec![one, other, far]);
        press(&mut island, [0, 1]);
        let end = ended(&mut island);
        // The third is alone: it goes on.
        for group in [0..2, 2..3] {
            let (before, after) = (total(&start[group.clone()]), total(&end[group.clone()]));
            for i in 0..3 {
                let off = after[i] - before[i];
                assert!(off.abs() < 1e-11 * (1.0 + before[3]), "sum {i} by {off:e}");
            }
            assert!(
                after[3] <= before[3] * (1.0 + 1e-12),
                "energy grows in {group:?}"
            );
        }
        assert!(
            total(&end[..2])[3] < 0.99 * total(&start[..2])[3],
            "they stay as they were"
        );
        // One rigid body: no point of one moves against the other.
        let point = random.point(2.0);
        let slip = velocity_at(&island.blocks[0], point) - velocity_at(&island.blocks[1], point);
        assert!(slip.norm() < 1e-12, "{slip}");
    }
}

#[test]
fn bodies_that_touch_what_is_held_move_as_that_does() {
    let mut random = Random::new(4);
    // On terrain or a body that is led, and on a flexible body that is pinned.
    let led = random_motion(&mut random, Vec2::zeros());
    for case in 0..40 {
        let anchor = match case % 3 {
            0 => (
                Block::Rigid(RigidBlock::prescribed(
                    RigidMotion::default(),
                    RigidMotion::default(),
                )),
                [0.0; 4],
            ),
            1 => (Block::Rigid(RigidBlock::prescribed(led, led)), [0.0; 4]),
            _ => flexible(&mut random, Vec2::zeros(), true),
        };
        let motion = if case % 3 == 1 {
            led
        } else {
            RigidMotion::default()
        };
        let centres = [random.point(1.0), random.point(1.0)];
        let members = [
            rigid(&mut random, centres[0]),
            anchor,
            flexible(&mut random, centres[1], false),
        ];
        let (mut island, _) = island_of(members.into());
        // The last touches what is held through the first.
        press(&mut island, [0, 1]);
        press(&mut island, [0, 2]);
        ended(&mut island);
        for slot in [0, 2] {
            let point = random.point(2.0);
            let velocity = motion.velocity + motion.spin * perp(point - motion.centre);
            let off = velocity_at(&island.blocks[slot], point) - velocity;
            assert!(off.norm() < 1e-12, "block {slot} of case {case}: {off}");
        }
    }
}

/// What lies on the ground beside a body that is crushed between the ground and a paddle has nothing to do with the paddle.
#[test]
fn the_ground_joins_nobody_and_holds_more_than_what_is_led() {
    let mut random = Random::new(6);
    let led = random_motion(&mut random, Vec2::zeros());
    let prescribed = |motion| {
        (
            Block::Rigid(RigidBlock::prescribed(motion, motion)),
            [0.0; 4],
        )
    };
    for order in [[2, 3], [3, 2]] {
        let mut members = vec![
            rigid(&mut random, Vec2::new(0.3, 0.2)),
            flexible(&mut random, Vec2::new(2.5, 0.2), false),
        ];
        for slot in order {
            members.push(prescribed(match slot {
                2 => led,
                _ => RigidMotion::default(),
            }));
        }
        let [paddle, ground] = [0, 1].map(|which| order[which]);
        let (mut island, _) = island_of(members);
        press(&mut island, [0, paddle]);
        press(&mut island, [0, ground]);
        press(&mut island, [1, ground]);
        ended(&mut island);
        for slot in [0, 1] {
            let velocity = velocity_at(&island.blocks[slot], random.point(2.0));
            assert!(velocity.norm() < 1e-12, "block {slot}: {velocity}");
        }
    }
}

/// What holds makes two bodies one; a spring between them leaves each what it has.
#[test]
fn springs_join_nobody() {
    let finishes = [
        (Finish::Hold { rate: 0.0 }, true),
        (Finish::Limit, true),
        (Finish::Spring, false),
        (Finish::Nothing, false),
    ];
    for (finish, is_joined) in finishes {
        let mut random = Random::new(7);
        let members = vec![
            rigid(&mut random, Vec2::new(0.0, 0.3)),
            flexible(&mut random, Vec2::new(3.0, -0.2), false),
        ];
        let (mut island, start) = island_of(members);
        join(&mut island, [0, 1]);
        island.joints.ties[0].finish = finish;
        let end = ended(&mut island);
        for (before, after) in start.iter().zip(&end) {
            let off = (0..3).map(|k| (after[k] - before[k]).abs());
            let is_kept = off.fold(0.0, f64::max) < 1e-11 * (1.0 + before[3]);
            assert_eq!(is_kept, !is_joined, "{finish:?}: {before:?}, {after:?}");
        }
    }
}

#[test]
fn places_are_those_of_the_beginning_where_others_are_near_and_contacts_are_forgotten() {
    for is_near in [true, false] {
        let mut random = Random::new(5);
        let members = [
            rigid(&mut random, Vec2::new(0.3, 0.4)),
            flexible(&mut random, Vec2::new(-0.3, 0.1), false),
            rigid(&mut random, Vec2::new(0.0, 10.0)),
        ];
        let (mut island, start) = island_of(members.into());
        press(&mut island, [0, 1]);
        if is_near {
            island.candidates.push(Candidate {
                key: ContactKey {
                    contactor: Owner::Flex(0),
                    point: 0,
                    target: Owner::Collider(0),
                    part: 0,
                },
                pair: Pair::Near { blocks: [1, 2] },
                law: ContactLaw::default(),
            });
        }
        let end = ended(&mut island);
        assert!(island.contacts.is_empty());
        let mut moved: f64 = 0.0;
        for block in &island.blocks {
            match block {
                Block::Rigid(body) => {
                    let way = body.current().centre - body.start().centre;
                    let turn = body.current().angle - body.start().angle;
                    moved = moved.max(way.norm()).max(turn.abs());
                }
                Block::Flex(body) => {
                    let pairs = body.positions().iter().zip(body.start_positions());
                    moved = pairs.fold(moved, |moved, (end, start)| moved.max((end - start).abs()));
                }
            }
        }
        assert_eq!(moved < 1e-12, is_near, "{moved} m");
        // Wherever they go, as one body, they keep what they have.
        let (found, expected) = (total(&end), total(&start));
        for k in 0..3 {
            assert!(
                (found[k] - expected[k]).abs() < 1e-9,
                "{found:?} {expected:?}"
            );
        }
    }
}
