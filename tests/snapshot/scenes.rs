//! Scenes with something of everything, and what a handler hears of them.

pub use crate::common::*;
use foil2d::rapier::math::Real;

/// Counts in the user data of every contact how often it was shown, and lets friction depend on it.
pub struct Ageing;

impl PhysicsHooks for Ageing {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        if let ModifiableContacts::Rigid(manifold) = &mut context.contacts {
            *manifold.user_data = manifold.user_data.wrapping_add(1) % 1000;
            *manifold.friction = 0.2 + 0.3 * (*manifold.user_data as Real) / 1000.0;
        }
    }
}

/// A world with its flexible bodies, and the steps it has made.
pub struct Run {
    pub world: PhysicsWorld,
    pub flex_bodies: FlexBodySet,
    pub flex: FlexPipeline,
    pub n_steps: usize,
    /// What the world's side of an attachment follows.
    pub held: Option<AttachmentHandle>,
}

impl Run {
    pub fn new() -> Self {
        let mut world = PhysicsWorld::new();
        let floor = ColliderBuilder::cuboid(30.0, 0.5).translation(vec2(0.0, -0.5));
        world.insert_collider(floor, None);
        Self {
            world,
            flex_bodies: FlexBodySet::new(),
            flex: FlexPipeline::new(),
            n_steps: 0,
            held: None,
        }
    }

    pub fn flexible(&mut self, builder: FlexBodyBuilder) -> FlexBodyHandle {
        let events = ActiveEvents::COLLISION_EVENTS | ActiveEvents::CONTACT_FORCE_EVENTS;
        let builder = builder.active_events(events);
        self.flex_bodies
            .insert(builder, &mut self.world)
            .expect("the body is sound")
    }

    pub fn rigid(&mut self, [x, y]: [f64; 2], shape: ColliderBuilder) -> RigidBodyHandle {
        let body = RigidBodyBuilder::dynamic().translation(vec2(x, y));
        let shape = shape.density(400.0).friction(0.4);
        self.world.insert(body, shape).0
    }

    pub fn step(&mut self, log: &Recorder) {
        if let Some(held) = self.held {
            let time = self.n_steps as f64 / 60.0;
            // To and fro in three seconds, by arithmetic that is the same everywhere.
            let phase = (time / 3.0).fract();
            let sway = 0.8 * ((phase - 0.5).abs() - 0.25);
            let attachment = self.flex_bodies.attachment_mut(held).expect("it is held");
            attachment
                .set_target([sway, 0.0], 0.1 * sway)
                .expect("held by the world");
        }
        self.n_steps += 1;
        self.flex
            .step_with_events(&mut self.world, &mut self.flex_bodies, &Ageing, log)
            .expect("the scene steps");
    }
}

pub fn rubber() -> LinearElastic {
    elastic(2e7, 1000.0, 2e-3)
}

/// Contact with friction, joints, attachments of every kind, hooks, things that rapier solves alone, and a pile that sleeps.
pub fn everything() -> Run {
    let mut run = Run::new();
    let beam = FlexBodyBuilder::rectangle([4.0, 0.3], [24, 3])
        .pin_where(|[x, y]| y == 0.0 && (x == 0.0 || x == 4.0), Pin::both())
        .translation([-2.0, 2.0]);
    run.flexible(beam.material(rubber()).friction(0.4));
    let slider = FlexBodyBuilder::rectangle([1.0, 1.0], [8, 8])
        .translation([5.0, 0.002])
        .linvel([2.0, 0.0]);
    let hooks = ActiveHooks::MODIFY_SOLVER_CONTACTS;
    run.flexible(slider.material(rubber()).friction(0.3).active_hooks(hooks));
    let disc = FlexBodyBuilder::disc(0.5, 0.2)
        .translation([-6.0, 1.2])
        .angvel(4.0);
    run.flexible(disc.material(rubber()).restitution(0.4).user_data(7));
    let swing = FlexBodyBuilder::rectangle([0.2, 1.5], [2, 12]).translation([9.0, 2.0]);
    let swing = run.flexible(swing.material(rubber()));
    let top = AttachmentBuilder::weld(swing)
        .where_(|[_, y]| y > 1.49)
        .to_world();
    run.held = Some(
        run.flex_bodies
            .attach(top, &run.world.bodies)
            .expect("it is sound"),
    );
    let weight = run.rigid([9.1, 1.7], ColliderBuilder::ball(0.2));
    let bottom = AttachmentBuilder::pin(swing)
        .where_(|[_, y]| y < 0.01)
        .to_rigid_body(weight);
    run.flex_bodies
        .attach(bottom, &run.world.bodies)
        .expect("it is sound");
    let crate_on_beam = run.rigid([0.5, 2.502], ColliderBuilder::cuboid(0.2, 0.2));
    run.rigid([0.55, 2.904], ColliderBuilder::cuboid(0.15, 0.2));
    let partner = run.rigid([1.2, 2.6], ColliderBuilder::cuboid(0.2, 0.2));
    let hinge = RevoluteJointBuilder::new()
        .local_anchor1(vec2(0.35, 0.1))
        .local_anchor2(vec2(-0.35, 0.0))
        .motor_velocity(0.5, 0.1);
    run.world
        .impulse_joints
        .insert(crate_on_beam, partner, hinge, true);
    // Rapier's own, far away: a pile, a hinged pair and a bullet.
    for level in 0..4 {
        run.rigid(
            [
                -15.0 + 0.05 * f64::from(level),
                0.3 + 0.6 * f64::from(level),
            ],
            ColliderBuilder::cuboid(0.3, 0.25),
        );
    }
    let (one, other) = (
        run.rigid([15.0, 2.0], ColliderBuilder::ball(0.2)),
        run.rigid([15.6, 2.0], ColliderBuilder::ball(0.2)),
    );
    let chain = RevoluteJointBuilder::new()
        .local_anchor1(vec2(0.3, 0.0))
        .local_anchor2(vec2(-0.3, 0.0));
    run.world.multibody_joints.insert(one, other, chain, true);
    let bullet = RigidBodyBuilder::dynamic()
        .translation(vec2(-25.0, 3.0))
        .linvel(vec2(40.0, 0.0))
        .ccd_enabled(true);
    run.world.insert(bullet, ColliderBuilder::ball(0.1));
    // What comes to rest sleeps beside all that.
    let stiff = elastic(1e8, 1000.0, 5e-3);
    let sleeper = FlexBodyBuilder::rectangle([0.5, 0.25], [4, 2]).translation([-10.0, 0.001]);
    run.flexible(sleeper.material(stiff));
    run.rigid([-9.75, 0.46], ColliderBuilder::cuboid(0.2, 0.2));
    run
}
