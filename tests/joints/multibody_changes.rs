//! Multibodies on something soft, to which much is done between steps: nothing panics, and all numbers stay numbers.
//!
//! Not what rapier 0.36 alone does not stand: joints of multibodies that are removed one by one or twice, or named by their root; links that are far apart when they are
//! joined; loops that contradict their links.

use crate::common::*;

/// Numbers that look random.
struct Chance(u64);

impl Chance {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (self.0 >> 33) as usize % n
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.below(1_000_000) as f64 / 1e6
    }
}

fn hinge(chance: &mut Chance) -> GenericJoint {
    let ends = [vec2(0.16, 0.0), vec2(-0.16, 0.0)];
    match chance.below(4) {
        0 => RevoluteJointBuilder::new()
            .limits([-0.5, 0.8])
            .local_anchor1(ends[0])
            .local_anchor2(ends[1])
            .build()
            .into(),
        1 => PrismaticJointBuilder::new(vec2(1.0, 0.0))
            .local_anchor1(ends[0])
            .local_anchor2(ends[1])
            .limits([-0.05, 0.2])
            .build()
            .into(),
        2 => FixedJointBuilder::new()
            .local_anchor1(ends[0])
            .local_anchor2(ends[1])
            .build()
            .into(),
        _ => RevoluteJointBuilder::new()
            .local_anchor1(ends[0])
            .local_anchor2(ends[1])
            .motor_position(real(chance.within(-1.0, 1.0)), 50.0, 5.0)
            .build()
            .into(),
    }
}

fn link(scene: &mut Scene, x: f64, y: f64) -> RigidBodyHandle {
    let body = RigidBodyBuilder::dynamic().translation(vec2(x, y));
    let shape = ColliderBuilder::cuboid(0.15, 0.05).density(200.0);
    scene.world.insert(body, shape).0
}

/// Something that a user may do; what it was.
fn change(
    scene: &mut Scene,
    links: &mut Vec<RigidBodyHandle>,
    chance: &mut Chance,
    parted: &mut bool,
) -> &'static str {
    let one = links[chance.below(links.len())];
    let world = &mut scene.world;
    let handle = MultibodyJointHandle(one.0);
    match chance.below(12) {
        0 if !*parted => {
            *parted = true;
            let joints = &mut world.multibody_joints;
            joints.remove_multibody_articulations(one, true);
            "part"
        }
        2 => {
            world.bodies[one].wake_up(true);
            "wake"
        }
        3 => {
            let (x, y) = (chance.within(-0.8, 0.8), chance.within(0.5, 1.0));
            links.push(link(scene, x, y));
            "insert"
        }
        4 => {
            let (x, y) = (chance.within(-0.8, 0.8), chance.within(0.5, 1.0));
            world.bodies[one].set_translation(vec2(x, y), true);
            "move"
        }
        5 => {
            if let Some((multibody, _)) = world.multibody_joints.get_mut(handle) {
                let mut rates = multibody.generalized_velocity_mut();
                rates
                    .iter_mut()
                    .for_each(|rate| *rate = real(chance.within(-1.0, 1.0)));
            }
            "throw"
        }
        6 => {
            if let Some((multibody, id)) = world.multibody_joints.get_mut(handle) {
                multibody.damping_mut().fill(real(chance.within(0.0, 1.0)));
                multibody.armature_mut().fill(real(chance.within(0.0, 0.1)));
                multibody
                    .frictions_mut()
                    .fill(real(chance.within(0.0, 1.0)));
                if let Some(link) = multibody.link_mut(id).filter(|link| !link.is_root()) {
                    link.joint
                        .set_spring(2, real(chance.within(0.0, 100.0)), 0.1);
                }
            }
            "brake"
        }
        7 => {
            if let Some((multibody, id)) = world.multibody_joints.get_mut(handle)
                && let Some(link) = multibody.link_mut(id).filter(|link| !link.is_root())
            {
                link.joint.data.set_motor_velocity(
                    JointAxis::AngX,
                    real(chance.within(-3.0, 3.0)),
                    real(chance.within(0.0, 10.0)),
                );
            }
            "drive"
        }
        8 => {
            world.bodies[one].add_force(vec2(chance.within(-5.0, 5.0), 0.0), true);
            "push"
        }
        9 => {
            let groups = [-1, 0, 1][chance.below(3)];
            world.bodies[one].set_dominance_group(groups);
            "dominate"
        }
        10 => {
            if let Some((multibody, _)) = world.multibody_joints.get_mut(handle) {
                let is_enabled = multibody.self_contacts_enabled();
                multibody.set_self_contacts_enabled(!is_enabled);
            }
            "touch"
        }
        _ => {
            world.bodies[one].sleep();
            "sleep"
        }
    }
}

/// One random course of changes; the tests below take them apart so that they run beside each other.
fn judge(seed: u64) {
    let mut chance = Chance(seed);
    let mut scene = Scene::new([1.0 / 60.0, 1.0 / 240.0][chance.below(2)]);
    scene.ground(0.5);
    for x in [-0.9, 0.1] {
        let soft = LinearElastic::plane_stress(3e5, 0.3).density(300.0);
        let bed = FlexBodyBuilder::rectangle([0.8, 0.2], [8, 2])
            .material(soft.rayleigh(1e-3))
            .translation([x, 0.001]);
        let bed = if chance.below(2) == 0 {
            bed
        } else {
            bed.small_strain()
        };
        scene.flexible(bed);
    }
    let mut links: Vec<RigidBodyHandle> = Vec::new();
    for place in 0..5 {
        links.push(link(&mut scene, -0.64 + 0.32 * f64::from(place), 0.4));
    }
    for pair in 0..4 {
        let joint = hinge(&mut chance);
        let joints = &mut scene.world.multibody_joints;
        joints.insert(links[pair], links[pair + 1], joint, true);
    }
    let (mut history, mut parted) = (Vec::new(), false);
    for step in 0..400 {
        if step % 10 == 9 {
            history.push(change(&mut scene, &mut links, &mut chance, &mut parted));
        }
        let taken = scene.try_step().map(|_| ());
        assert!(taken.is_ok(), "seed {seed}, {history:?}: {taken:?}");
        for (_, body) in scene.bodies.iter() {
            let are_numbers = body.positions().iter().all(|x| x.is_finite());
            assert!(are_numbers, "seed {seed}, step {step}, {history:?}");
        }
        for link in &links {
            let body = &scene.world.bodies[*link];
            let is_sound = body.translation().is_finite() && body.linvel().is_finite();
            assert!(is_sound, "seed {seed}, step {step}, {history:?}");
        }
    }
}

#[test]
fn whatever_is_done_to_multibodies_between_steps_they_stay_sound() {
    for seed in 1..=2 {
        judge(seed);
    }
}

#[test]
fn whatever_else_is_done_to_multibodies_between_steps_they_stay_sound() {
    for seed in 3..=4 {
        judge(seed);
    }
}

#[test]
fn whatever_is_yet_done_to_multibodies_between_steps_they_stay_sound() {
    for seed in 5..=6 {
        judge(seed);
    }
}
