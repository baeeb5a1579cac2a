//! A world that is stepped by rapier alone, or with all its dynamic bodies claimed.

use crate::common::*;
use foil2d::coupling::RapierSets;

/// A step of 1/60 s.
pub const DT: f64 = 1.0 / 60.0;

/// Behaviours that the flexible stage does not share, and why: none.
pub const DIFFERENCES: &[(&str, &str)] = &[];

/// Whether a behaviour holds, and what was measured.
pub struct Verdict {
    pub holds: bool,
    pub measured: String,
}

pub fn verdict(holds: bool, measured: impl Into<String>) -> Verdict {
    Verdict {
        holds,
        measured: measured.into(),
    }
}

/// Whether `value` is `expected` to within `tolerance`.
pub fn is_near(value: f64, expected: f64, tolerance: f64) -> Verdict {
    verdict(
        (value - expected).abs() <= tolerance,
        format!("{value}, expected {expected} ± {tolerance}"),
    )
}

/// All of these.
pub fn all<const N: usize>(verdicts: [Verdict; N]) -> Verdict {
    let measured: Vec<String> = verdicts
        .iter()
        .map(|one| format!("{}{}", if one.holds { "" } else { "NOT " }, one.measured))
        .collect();
    verdict(verdicts.iter().all(|one| one.holds), measured.join("; "))
}

/// A world, stepped one way or the other.
pub struct Stage {
    pub world: PhysicsWorld,
    pub heard: Recorder,
    flex_bodies: FlexBodySet,
    flex: FlexPipeline,
    anchor: Option<RigidBodyHandle>,
    /// Most bodies that were claimed in a step, the anchor left out.
    pub n_claimed: usize,
}

impl Stage {
    /// With rapier alone.
    pub fn alone() -> Self {
        Self {
            world: empty_world(DT),
            heard: Recorder::default(),
            flex_bodies: FlexBodySet::new(),
            flex: FlexPipeline::new(),
            anchor: None,
            n_claimed: 0,
        }
    }

    /// With a flexible block on a body that cannot move.
    pub fn claimed() -> Self {
        let mut stage = Self::alone();
        let anchor = locked_body().translation(vec2(1000.0, 0.0));
        let anchor = stage.world.insert_body(anchor);
        let (world, bodies) = (&mut stage.world, &mut stage.flex_bodies);
        lay_block_on(world, bodies, anchor, [0.0, 0.0], 1e-2);
        stage.anchor = Some(anchor);
        stage
    }

    /// A body with one collider; claimed if it can be.
    pub fn add(&mut self, body: RigidBodyBuilder, shape: ColliderBuilder) -> RigidBodyHandle {
        let (body, _) = self.world.insert(body, shape);
        self.tie(body);
        body
    }

    /// [`Stage::add`] of a dynamic body at a place.
    pub fn dynamic(&mut self, x: f64, y: f64, shape: ColliderBuilder) -> RigidBodyHandle {
        self.add(RigidBodyBuilder::dynamic().translation(vec2(x, y)), shape)
    }

    /// Has a body claimed, by a joint that locks nothing.
    pub fn tie(&mut self, body: RigidBodyHandle) {
        if let Some(anchor) = self.anchor {
            let free = GenericJointBuilder::new(JointAxesMask::empty());
            self.world.impulse_joints.insert(anchor, body, free, true);
        }
    }

    pub fn fixed(&mut self, shape: ColliderBuilder) -> ColliderHandle {
        self.world.insert_collider(shape, None)
    }

    /// A floor at `y = 0`.
    pub fn floor(&mut self, friction: f64) -> ColliderHandle {
        self.fixed(floor(friction))
    }

    pub fn no_gravity(&mut self) {
        self.world.gravity = vec2(0.0, 0.0);
    }

    pub fn join(
        &mut self,
        one: RigidBodyHandle,
        other: RigidBodyHandle,
        joint: impl Into<GenericJoint>,
    ) -> ImpulseJointHandle {
        self.world.impulse_joints.insert(one, other, joint, true)
    }

    pub fn step_with(&mut self, hooks: &dyn PhysicsHooks) {
        if self.anchor.is_none() {
            RapierSets::of_world(&mut self.world, hooks, &self.heard).step();
            return;
        }
        let report = self
            .flex
            .step_with_events(&mut self.world, &mut self.flex_bodies, hooks, &self.heard)
            .expect("the step can be taken");
        self.n_claimed = self.n_claimed.max(report.n_claimed().saturating_sub(1));
    }

    pub fn steps_with(&mut self, n: usize, hooks: &dyn PhysicsHooks) {
        for _ in 0..n {
            self.step_with(hooks);
        }
    }

    pub fn step(&mut self) {
        self.step_with(&());
    }

    pub fn steps(&mut self, n: usize) {
        self.steps_with(n, &());
    }

    pub fn at(&self, body: RigidBodyHandle) -> [f64; 2] {
        place_of(&self.world.bodies[body])
    }

    pub fn velocity(&self, body: RigidBodyHandle) -> [f64; 2] {
        velocity_of(&self.world.bodies[body])
    }

    pub fn spin(&self, body: RigidBodyHandle) -> f64 {
        f64::from(self.world.bodies[body].angvel())
    }

    pub fn angle(&self, body: RigidBodyHandle) -> f64 {
        turn_of(&self.world.bodies[body])
    }

    pub fn sleeps(&self, body: RigidBodyHandle) -> bool {
        self.world.bodies[body].is_sleeping()
    }
}

pub type Behaviour = fn(&mut Stage) -> Verdict;

/// Runs a behaviour both ways and compares the verdicts.
pub fn compare(name: &str, behaviour: Behaviour, is_claimable: bool) {
    let theirs = behaviour(&mut Stage::alone());
    let mut stage = Stage::claimed();
    let ours = behaviour(&mut stage);
    println!(
        "{name}\n  rapier alone: {}\n  claimed: {}",
        theirs.measured, ours.measured
    );
    assert!(theirs.holds, "with rapier alone: {}", theirs.measured);
    if is_claimable {
        assert!(stage.n_claimed > 0, "nothing was claimed");
    }
    match DIFFERENCES.iter().find(|(listed, _)| *listed == name) {
        None => assert!(ours.holds, "claimed: {}", ours.measured),
        Some((_, why)) => {
            println!("  differs: {why}");
            assert!(!ours.holds, "differs no more: {}", ours.measured);
        }
    }
}

/// Makes a test of every behaviour; those after `unclaimed` have no dynamic body that could be claimed.
macro_rules! behaviours {
    ($($name:ident)* $(; unclaimed $($other:ident)*)?) => {
        mod both_ways {
            $(#[test] fn $name() { $crate::support::compare(stringify!($name), super::$name, true); })*
            $($(#[test] fn $other() { $crate::support::compare(stringify!($other), super::$other, false); })*)?
        }
    };
}

/// A box of this half size.
pub fn square(half: f64) -> ColliderBuilder {
    ColliderBuilder::cuboid(real(half), real(half))
}
