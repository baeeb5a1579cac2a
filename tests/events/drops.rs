//! Ten thousand touches of random drops, and ten thousand random operations: events never miss, double or go stale.

use crate::support::*;
use foil2d::pipeline::Participant;

/// A pad that holds what falls on it, and what falls: each in a lane of its own.
const LANES: usize = 50;

const WORLDS: usize = 200;

fn pad(dice: &mut Dice) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([1.0, 0.2], [2, 1])
        .material(elastic(dice.pick(&[1e6, 1e8]), 1000.0, 5e-3))
        .pin_where(|[_, y]| y == 0.0, Pin::both())
}

/// Adds a lane; returns its pair of colliders.
fn add_lane(scene: &mut Scene, lane: usize, dice: &mut Dice) -> [ColliderHandle; 2] {
    let x = 3.0 * lane as f64;
    let (height, speed) = (dice.between(0.0, 0.1), dice.between(-2.0, 0.0));
    let is_pad_flexible = dice.roll() < 0.6;
    let lower = if is_pad_flexible {
        let pad = scene.flexible(pad(dice).translation([x, 0.0]));
        scene.body(pad).collider_handle()
    } else {
        let pad = ColliderBuilder::cuboid(0.5, 0.1);
        scene.fixed(pad.translation(vec2(x + 0.5, 0.1)))
    };
    let above = 0.2 + height;
    let upper = if is_pad_flexible && dice.roll() < 0.5 {
        let at = RigidBodyBuilder::dynamic()
            .translation(vec2(x + 0.5, above + 0.15))
            .linvel(vec2(0.0, speed))
            .angvel(real(dice.between(-1.0, 1.0)));
        let ball = ColliderBuilder::ball(0.15);
        let square = ColliderBuilder::cuboid(0.15, 0.15);
        let shape = if dice.roll() < 0.5 { ball } else { square };
        scene.rigid(at, shape.density(500.0).active_events(ALL)).1
    } else {
        let cube = FlexBodyBuilder::rectangle([0.3, 0.3], [1, 1])
            .material(elastic(dice.pick(&[1e5, 1e7]), 500.0, 5e-3))
            .translation([x + 0.35, above])
            .linvel([0.0, speed])
            .active_events(ALL);
        let cube = scene.flexible(cube);
        scene.body(cube).collider_handle()
    };
    [lower, upper]
}

/// Whether a pair touches, seen without events: rapier lists a contact, or the report does.
fn touches(scene: &Scene, [one, other]: [ColliderHandle; 2]) -> bool {
    let known = scene.world.narrow_phase.contact_pair(one, other);
    let collider = |participant| match participant {
        Participant::Rigid(handle) => handle,
        Participant::Flex(handle) => scene.body(handle).collider_handle(),
    };
    known.is_some_and(ContactPair::has_any_active_contact)
        || scene.report().contacts().iter().any(|contact| {
            pair(collider(contact.contactor), collider(contact.target)) == pair(one, other)
        })
}

#[test]
fn ten_thousand_random_drops_start_and_stop_once_per_touch() {
    let mut dice = Dice(4);
    let (mut n_starts, mut n_stops) = (0, 0);
    let mut n_bounced = 0;
    for world in 0..WORLDS {
        let mut scene = Scene::new(DT);
        let lanes: Vec<_> = (0..LANES)
            .map(|lane| add_lane(&mut scene, lane, &mut dice))
            .collect();
        let (listener, mut touching) = (Listener::default(), Touching::default());
        let mut changes = [0; LANES];
        let mut was = [false; LANES];
        for step in 0..16 {
            let heard = scene.hear(&listener);
            touching.take(&heard.collisions, &format!("world {world}, step {step}"));
            for event in &heard.forces {
                let name = pair(event.collider1, event.collider2);
                assert!(
                    touching.is_touching(name),
                    "world {world}, step {step}: {event:?}"
                );
            }
            for (lane, &pair_of_lane) in lanes.iter().enumerate() {
                let [one, other] = pair_of_lane;
                let is_touching = touches(&scene, pair_of_lane);
                let told = touching.is_touching(pair(one, other));
                assert_eq!(is_touching, told, "world {world}, step {step}, lane {lane}");
                changes[lane] += usize::from(is_touching != was[lane]);
                was[lane] = is_touching;
            }
        }
        n_bounced += changes.iter().filter(|&&changes| changes > 1).count();
        // Half of all are taken away in touch, the others' worlds end with them.
        for [_, upper] in &lanes {
            let parent = scene.world.colliders[*upper].parent().expect("it falls");
            match scene.bodies.of_collider(*upper) {
                Some(body) => drop(scene.bodies.remove(body, &mut scene.world)),
                None => drop(scene.world.remove_body(parent)),
            }
        }
        let heard = scene.hear(&listener);
        touching.take(&heard.collisions, &format!("world {world}, end"));
        for &[one, other] in &lanes {
            assert!(
                !touching.is_touching(pair(one, other)),
                "world {world}: a stale touch"
            );
        }
        n_starts += touching.n_starts;
        n_stops += touching.n_stops;
    }
    println!("{n_starts} starts, {n_stops} stops, {n_bounced} lanes bounced");
    assert_eq!(n_starts, n_stops);
    assert!(n_starts >= 10_000, "{n_starts}");
}

/// A world in which anything may happen.
struct Play {
    scene: Scene,
    flexible: Vec<FlexBodyHandle>,
    rigid: Vec<RigidBodyHandle>,
}

const N_STATIC: usize = 3;

impl Play {
    fn new() -> Self {
        let mut scene = Scene::new(DT);
        scene.ground(0.5);
        for x in [-4.0, 4.0] {
            scene.fixed(ColliderBuilder::cuboid(0.5, 5.0).translation(vec2(x, 4.0)));
        }
        Self {
            scene,
            flexible: Vec::new(),
            rigid: Vec::new(),
        }
    }

    fn insert(&mut self, dice: &mut Dice) {
        let at = [dice.between(-3.0, 3.0), dice.between(0.0, 5.0)];
        if dice.roll() < 0.4 && self.flexible.len() < 4 {
            let block = FlexBodyBuilder::rectangle([0.8, 0.4], [2, 1])
                .material(elastic(dice.pick(&[1e6, 1e8]), 1000.0, 5e-3))
                .translation(at)
                .rotation(dice.between(-3.0, 3.0))
                .active_events(ALL);
            let block = self.scene.flexible(block);
            self.flexible.push(block);
        } else if self.rigid.len() < 8 {
            let ball = ColliderBuilder::ball(0.3);
            let square = ColliderBuilder::cuboid(0.3, 0.2);
            let shape = if dice.roll() < 0.5 { ball } else { square };
            let body = RigidBodyBuilder::dynamic().translation(vec2(at[0], at[1]));
            let shape = shape.density(500.0).active_events(ALL);
            self.rigid.push(self.scene.world.insert(body, shape).0);
        }
    }

    fn remove(&mut self, dice: &mut Dice) {
        let pick = |n: usize, dice: &mut Dice| (dice.roll() * n as f64) as usize;
        if dice.roll() < 0.4 && !self.flexible.is_empty() {
            let handle = self.flexible.swap_remove(pick(self.flexible.len(), dice));
            self.scene
                .bodies
                .remove(handle, &mut self.scene.world)
                .expect("it is there");
        } else if !self.rigid.is_empty() {
            let handle = self.rigid.swap_remove(pick(self.rigid.len(), dice));
            self.scene.world.remove_body(handle);
        }
    }

    fn change(&mut self, dice: &mut Dice) {
        let world = &mut self.scene.world;
        if dice.roll() < 0.25 && !self.flexible.is_empty() {
            let handle = dice.pick(&self.flexible);
            let groups = [
                InteractionGroups::all(),
                InteractionGroups::all(),
                InteractionGroups::none(),
            ];
            let body = &mut self.scene.bodies[handle];
            match (dice.roll() * 3.0) as usize {
                0 => body.set_sensor(dice.roll() < 0.3),
                1 => body.set_collision_groups(dice.pick(&groups)),
                _ => body.set_solver_groups(dice.pick(&groups)),
            }
        } else if !self.rigid.is_empty() {
            let handle = dice.pick(&self.rigid);
            let to = vec2(dice.between(-3.0, 3.0), dice.between(0.0, 5.0));
            let speed = vec2(dice.between(-20.0, 20.0), dice.between(-20.0, 20.0));
            let types = [
                RigidBodyType::Dynamic,
                RigidBodyType::Dynamic,
                RigidBodyType::Fixed,
                RigidBodyType::KinematicVelocityBased,
            ];
            let body = &mut world.bodies[handle];
            let collider = body.colliders()[0];
            match (dice.roll() * 7.0) as usize {
                0 | 1 => body.set_translation(to, true),
                2 => body.set_linvel(speed, true),
                3 => body.set_enabled(!body.is_enabled()),
                4 => body.set_body_type(dice.pick(&types), true),
                5 => world.colliders[collider].set_sensor(dice.roll() < 0.3),
                _ => world.colliders[collider].set_enabled(dice.roll() < 0.7),
            }
        }
    }

    fn assert_whole(&self, context: &str) {
        let n_bodies = self.flexible.len() + self.rigid.len();
        assert_eq!(self.scene.world.bodies.len(), n_bodies, "{context}");
        assert_eq!(
            self.scene.world.colliders.len(),
            n_bodies + N_STATIC,
            "{context}"
        );
        assert_eq!(self.scene.bodies.len(), self.flexible.len(), "{context}");
        assert_eq!(sick_flexible(&self.scene.bodies), None, "{context}");
        assert_eq!(sick_rigid(&self.scene.world), None, "{context}");
    }
}

#[test]
fn ten_thousand_random_operations_leave_no_stale_event_no_handle_and_finite_numbers() {
    let (mut n_operations, mut n_events) = (0, 0);
    for seed in 0..10 {
        let (mut dice, mut play) = (Dice(seed), Play::new());
        let (listener, mut touching) = (Listener::default(), Touching::default());
        for operation in 0..1000 {
            let context = format!("seed {seed}, operation {operation}");
            match dice.roll() {
                x if x < 0.25 => play.insert(&mut dice),
                x if x < 0.4 => play.remove(&mut dice),
                _ => play.change(&mut dice),
            }
            n_operations += 1;
            let heard = play.scene.hear(&listener);
            n_events += heard.collisions.len() + heard.forces.len();
            touching.take(&heard.collisions, &context);
            for event in &heard.forces {
                let name = pair(event.collider1, event.collider2);
                assert!(touching.is_touching(name), "{context}: {event:?}");
                assert!(event.total_force_magnitude.is_finite(), "{context}");
            }
            play.assert_whole(&context);
        }
        while !play.flexible.is_empty() || !play.rigid.is_empty() {
            play.remove(&mut dice);
        }
        for _ in 0..2 {
            let heard = play.scene.hear(&listener);
            touching.take(&heard.collisions, "the end");
        }
        assert_eq!(touching.n_starts, touching.n_stops, "seed {seed}");
        play.assert_whole("the end");
    }
    assert_eq!(n_operations, 10_000);
    assert!(n_events > 10_000, "{n_events}");
}
