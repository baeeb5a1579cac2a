use super::*;
use crate::kkt::Island;
use crate::kkt::calm::tests::join;
use crate::kkt::together::tests::{random_motion, rigid};
use crate::path::samples::Random;

const DT: f64 = 1e-2;

/// Two bodies and rows between them, which press at the beginning and at the end of the step as their levers and directions then are.
struct Joined {
    island: Island,
    ends: Vec<JointGrip>,
}

impl Joined {
    fn new(random: &mut Random, laws: &[JointLaw]) -> Self {
        let mut island = Island::default();
        for x in [0.0, 1.0] {
            island.blocks.push(rigid(random, Vec2::new(x, 0.0)).0);
        }
        for law in laws {
            join(&mut island, [0, 1]);
            if let Some(tie) = island.joints.ties.last_mut() {
                (tie.is_hard, tie.row.law) = (true, *law);
                [tie.direction, tie.end] = [0, 1].map(|_| random.point(1.0).normalize());
                [tie.kick, tie.impulse] = [0, 1].map(|_| random.within(2.0));
            }
        }
        let mut ends = island.joints.grips.clone();
        for grip in island.joints.grips.iter_mut().chain(&mut ends) {
            grip.lever = random.point(0.5);
        }
        Self { island, ends }
    }

    /// Lets the impulses of a row act on both bodies.
    fn press(&mut self, row: usize) {
        let tie = &self.island.joints.ties[row];
        for at in tie.row.grips.0..tie.row.grips.1 {
            let sides = [
                (&self.island.joints.grips[at], tie.direction, tie.kick),
                (&self.ends[at], tie.end, tie.impulse),
            ];
            for (grip, along, impulse) in sides {
                let force = impulse * grip.weight * along;
                let Block::Rigid(body) = &mut self.island.blocks[grip.block] else {
                    panic!("both are rigid");
                };
                let couple = grip.lever.x * force.y - grip.lever.y * force.x;
                body.add_impulse([force.x, force.y, couple]);
            }
        }
    }

    fn work(&self) -> JointWork {
        let grips = WorkGrips {
            start: &self.island.joints.grips,
            end: &self.ends,
        };
        joint_work(
            &self.island.blocks,
            &self.island.joints.ties,
            grips,
            [DT; 2],
        )
    }

    fn gained(&self) -> f64 {
        end_energy(&self.island.blocks)[0] - start_energy(&self.island.blocks)[0]
    }
}

const HINGE: JointLaw = JointLaw::Rigid {
    goal: 0.0,
    rate: 0.0,
};

/// Nothing but the joint acts: its work is what the bodies have gained.
#[test]
fn the_work_of_joints_is_the_energy_that_bodies_gain() {
    let mut random = Random::new(11);
    for _ in 0..20 {
        let mut joined = Joined::new(&mut random, &[HINGE, HINGE]);
        joined.press(0);
        joined.press(1);
        let (work, gained) = (joined.work(), joined.gained());
        let scale = start_energy(&joined.island.blocks)[0] + gained.abs();
        assert!((work.all - gained).abs() < 1e-12 * scale);
        assert_eq!(work.idle, work.all);
    }
}

/// Rows that are led, motors and what is driven may do work; a limit may take some.
#[test]
fn only_rows_that_do_no_work_are_idle() {
    let led = JointLaw::Rigid {
        goal: 0.0,
        rate: 0.1,
    };
    let motor = JointLaw::Drive {
        rate: 1.0,
        most: 5.0,
    };
    let (mut random, mut signs) = (Random::new(12), [0, 0]);
    for _ in 0..20 {
        for law in [led, motor] {
            let mut joined = Joined::new(&mut random, &[law]);
            joined.press(0);
            let work = joined.work();
            assert!(work.all != 0.0 && work.idle == 0.0);
        }
        let mut joined = Joined::new(&mut random, &[JointLaw::Limit { bound: 0.0 }]);
        joined.press(0);
        let gained = joined.gained();
        signs[usize::from(gained > 0.0)] += 1;
        let error = joined.work().idle - gained.max(0.0);
        assert!(error.abs() < 1e-12 * (1.0 + gained.abs()), "{error}");
        let mut joined = Joined::new(&mut random, &[HINGE]);
        let [from, to] = [0, 1].map(|_| random_motion(&mut random, Vec2::zeros()));
        joined.island.blocks[1] = Block::Rigid(RigidBlock::prescribed(from, to));
        assert_eq!(joined.work().idle, 0.0);
    }
    assert!(signs.iter().all(|count| *count > 3), "{signs:?}");
}
