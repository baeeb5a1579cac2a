//! Hooks that leave numbers which are none: what is refused, whose contact is named, and that nothing has happened.

use crate::support::*;
use foil2d::pipeline::StepError;

const MODIFY: ActiveHooks = ActiveHooks::MODIFY_SOLVER_CONTACTS;

/// What a hook leaves of a contact.
type Spoil = fn(&mut ModifiableManifold<'_>);

/// Spoils the contacts of one pair, in whichever order it comes, and notes that it was asked.
struct Spoils([ColliderHandle; 2], Spoil);

impl PhysicsHooks for Spoils {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let Self([one, other], spoil) = *self;
        let found = pair(context.collider1, context.collider2);
        if let (true, Some(rigid)) = (found == pair(one, other), context.rigid_mut()) {
            spoil(rigid);
        }
    }
}

/// Sets the distance of every contact.
fn set_distance(rigid: &mut ModifiableManifold<'_>, distance: Real) {
    for contact in rigid.solver_contacts.iter_mut() {
        contact.dist = distance;
    }
}

/// A block that slides on the ground, and a claimed box on a claimed box on it.
struct Tower {
    scene: Scene,
    ground: ColliderHandle,
    block: ColliderHandle,
    boxes: [ColliderHandle; 2],
    told: Recorder,
}

impl Tower {
    fn new() -> Self {
        let mut scene = Scene::new(DT);
        let ground = scene.ground(0.5);
        let block = scene.flexible(block().active_hooks(MODIFY).linvel([1.0, 0.0]));
        let boxes = [1.2, 1.6].map(|y| {
            let body = RigidBodyBuilder::dynamic().translation(vec2(0.5, y));
            let shape = ColliderBuilder::cuboid(0.2, 0.2).density(100.0);
            scene
                .rigid(body, shape.active_hooks(MODIFY).active_events(ALL))
                .1
        });
        let block = scene.body(block).collider_handle();
        Self {
            scene,
            ground,
            block,
            boxes,
            told: Recorder::default(),
        }
    }

    fn step(&mut self, hooks: &dyn PhysicsHooks) -> Result<(), StepError> {
        let Scene {
            world,
            bodies,
            flex,
        } = &mut self.scene;
        flex.step_with_events(world, bodies, hooks, &self.told)
            .map(|_| ())
    }

    /// The bits of all motions.
    fn bits(&self) -> Vec<u64> {
        motion_bits(&self.scene.world, &self.scene.bodies)
    }

    /// How many pairs rapier lists as touching.
    fn n_touching(&self) -> usize {
        let touching = self.scene.world.contact_pairs();
        touching
            .filter(|pair| pair.has_any_active_contact())
            .count()
    }
}

const REFUSED: [(&str, Spoil); 13] = [
    ("a friction NaN", |rigid| *rigid.friction = Real::NAN),
    ("a friction inf", |rigid| *rigid.friction = Real::INFINITY),
    ("a friction -inf", |rigid| {
        *rigid.friction = Real::NEG_INFINITY
    }),
    ("a restitution NaN", |rigid| *rigid.restitution = Real::NAN),
    ("a restitution inf", |rigid| {
        *rigid.restitution = Real::INFINITY
    }),
    ("a restitution -inf", |rigid| {
        *rigid.restitution = Real::NEG_INFINITY
    }),
    ("a normal NaN in x", |rigid| rigid.normal.x = Real::NAN),
    ("a normal NaN in y", |rigid| rigid.normal.y = Real::NAN),
    ("a normal inf", |rigid| rigid.normal.x = Real::INFINITY),
    ("a normal of no length", |rigid| {
        *rigid.normal = Vector::ZERO
    }),
    ("a distance NaN", |rigid| set_distance(rigid, Real::NAN)),
    ("a distance inf", |rigid| {
        set_distance(rigid, Real::INFINITY)
    }),
    ("a distance -inf", |rigid| {
        set_distance(rigid, Real::NEG_INFINITY)
    }),
];

#[test]
fn what_a_hook_leaves_that_is_no_number_is_refused_by_the_name_of_the_pair_and_nothing_has_happened()
 {
    for (name, spoil) in REFUSED {
        // Flexible on fixed, rigid on flexible, and two claimed boxes.
        for which in 0..3 {
            let mut tower = Tower::new();
            for _ in 0..10 {
                tower.step(&()).expect("a sound step");
            }
            let Tower {
                ground,
                block,
                boxes: [lower, upper],
                ..
            } = tower;
            let spoiled = [[block, ground], [lower, block], [upper, lower]][which];
            let before = tower.bits();
            tower.told.take();
            for _ in 0..2 {
                let error = tower.step(&Spoils(spoiled, spoil)).expect_err(name);
                let StepError::Hook(one, other) = error else {
                    panic!("{name}: {error}");
                };
                assert_eq!(pair(one, other), pair(spoiled[0], spoiled[1]), "{name}");
                let said = error.to_string();
                let names = [format!("{one:?}"), format!("{other:?}")];
                assert!(
                    said.contains("modify_solver_contacts")
                        && names.iter().all(|name| said.contains(name)),
                    "{name}: {said}"
                );
                assert_eq!(before, tower.bits(), "{name}: it moves");
                assert_eq!(tower.told.take(), [""; 0], "{name}: it is told");
            }
        }
    }
}

#[test]
fn a_world_goes_on_after_a_misbehaving_hook_bit_for_bit_as_if_it_had_never_been() {
    for (name, spoil) in REFUSED {
        let (mut refused, mut never) = (Tower::new(), Tower::new());
        for step in 0..60 {
            // Before it has moved, while it lands, and at rest.
            if [0, 3, 40].contains(&step) {
                let pair = [refused.block, refused.ground];
                refused.step(&Spoils(pair, spoil)).expect_err(name);
            }
            for tower in [&mut refused, &mut never] {
                tower.step(&()).expect("the world goes on");
            }
            assert_eq!(refused.bits(), never.bits(), "{name}: step {step}");
            // Between the two, rapier lists no contact of pairs that have hooks.
            assert_eq!(refused.n_touching(), never.n_touching(), "{name}: {step}");
            let (heard, expected) = (refused.told.take(), never.told.take());
            assert_eq!(heard, expected, "{name}: step {step}");
        }
    }
}

#[test]
fn a_hook_that_clears_what_it_has_spoiled_is_obeyed() {
    let mut tower = Tower::new();
    let spoil: Spoil = |rigid| {
        *rigid.friction = Real::NAN;
        *rigid.normal = Vector::ZERO;
        rigid.solver_contacts.clear();
    };
    let hooks = Spoils([tower.block, tower.ground], spoil);
    for _ in 0..30 {
        tower.step(&hooks).expect("no contact, no number");
    }
    // Nothing holds it: free fall from rest.
    let (_, body) = tower.scene.bodies.iter().next().expect("a block");
    let fallen = body.linvel()[1] / (30.0 * DT * G);
    // The boxes fall with it and press nothing; what rapier's precision leaves.
    assert!((fallen + 1.0).abs() < 1e-4, "{fallen}");
}

#[test]
fn negative_coefficients_left_by_a_hook_act_as_none() {
    let end = |spoil: Spoil| {
        let mut tower = Tower::new();
        let hooks = Spoils([tower.block, tower.ground], spoil);
        for _ in 0..30 {
            tower.step(&hooks).expect("a sound step");
        }
        tower.bits()
    };
    let negative = end(|rigid| (*rigid.friction, *rigid.restitution) = (-1.0, -0.5));
    let none = end(|rigid| (*rigid.friction, *rigid.restitution) = (0.0, 0.0));
    assert_eq!(negative, none);
}
