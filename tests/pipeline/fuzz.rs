//! Random operations between steps.

use crate::support::*;
use foil2d::body::FlexBodyError;
use std::error::Error;

/// Marsaglia's xorshift: enough to choose among operations.
struct Chance(u64);

impl Chance {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn at(&mut self) -> [f64; 2] {
        [self.within(-3.0, 3.0), self.within(0.0, 4.0)]
    }
}

const N_OPERATIONS: usize = 2000;

/// An overlap of the size of a body, undone within the shortest step, gives 1.5 m × 240 / s; beyond ten times that
/// something feeds on itself (m/s).
const FASTEST: f64 = 4e3;

/// The floor and two walls.
const N_STATIC: usize = 3;

fn flexible(chance: &mut Chance) -> FlexBodyBuilder {
    let material = LinearElastic::plane_stress(chance.within(1e6, 1e8), 0.3)
        .density(1000.0)
        .rayleigh(2e-3);
    let builder = match chance.below(4) {
        0 => FlexBodyBuilder::rectangle([0.6, 0.4], [3, 3]),
        1 => FlexBodyBuilder::disc(0.3, 0.2),
        2 => FlexBodyBuilder::rectangle([1.5, 0.15], [8, 1]),
        _ => {
            FlexBodyBuilder::rectangle([1.5, 0.2], [6, 2]).pin_where(|[x, _]| x == 0.0, Pin::both())
        }
    };
    builder
        .material(material)
        .translation(chance.at())
        .rotation(chance.within(-3.0, 3.0))
        .linvel([chance.within(-3.0, 3.0), 0.0])
        .friction(chance.within(0.0, 1.0))
}

fn shape(chance: &mut Chance) -> SharedShape {
    let size = chance.within(0.1, 0.3) as Real;
    let corner = |x: Real, y: Real| Vector::new(x * size, y * size);
    match chance.below(6) {
        0 => SharedShape::ball(size),
        1 => SharedShape::cuboid(size, size),
        2 => SharedShape::capsule_x(size, 0.5 * size),
        3 => SharedShape::triangle(corner(-1.0, -1.0), corner(1.0, -1.0), corner(0.0, 1.0)),
        4 => SharedShape::round_cuboid(size, size, 0.1 * size),
        _ => SharedShape::compound(vec![
            (Pose::translation(-size, 0.0), SharedShape::ball(size)),
            (
                Pose::translation(size, 0.0),
                SharedShape::cuboid(size, size),
            ),
        ]),
    }
}

struct Play {
    scene: Scene,
    flexible: Vec<FlexBodyHandle>,
    rigid: Vec<RigidBodyHandle>,
}

impl Play {
    fn new() -> Self {
        let mut scene = Scene::with_floor();
        for x in [-4.0, 4.0] {
            let wall = ColliderBuilder::cuboid(0.5, 5.0).translation(vector(x, 4.0));
            scene.world.insert_collider(wall, None);
        }
        Self {
            scene,
            flexible: Vec::new(),
            rigid: Vec::new(),
        }
    }

    fn operate(&mut self, chance: &mut Chance) -> Result<&'static str, Box<dyn Error>> {
        let operation = chance.below(18);
        let name = match operation {
            0 | 1 => self.insert_flexible(chance)?,
            2 | 3 => self.insert_rigid(chance),
            4 => self.remove_flexible(chance)?,
            5 => self.remove_rigid(chance),
            6..=12 => self.change_rigid(operation, chance),
            13..=15 => self.change_flexible(operation, chance)?,
            16 => {
                let lengths = [0.0, 1.0 / 240.0, 1.0 / 60.0, 1.0 / 60.0, 1.0 / 30.0];
                self.scene.set_dt(lengths[chance.below(5)]);
                "step length"
            }
            _ => {
                self.scene.world.gravity = vector(chance.within(-5.0, 5.0), -9.81);
                "gravity"
            }
        };
        Ok(name)
    }

    fn insert_flexible(&mut self, chance: &mut Chance) -> Result<&'static str, BuildError> {
        if self.flexible.len() < 5 {
            let handle = self.scene.insert(flexible(chance))?;
            self.flexible.push(handle);
        }
        Ok("insert flexible")
    }

    fn insert_rigid(&mut self, chance: &mut Chance) -> &'static str {
        if self.rigid.len() < 10 {
            let [x, y] = chance.at();
            let body = RigidBodyBuilder::dynamic().translation(vector(x, y));
            let collider = ColliderBuilder::new(shape(chance))
                .density(chance.within(100.0, 2000.0) as Real)
                .restitution(chance.within(0.0, 0.8) as Real);
            self.rigid.push(self.scene.world.insert(body, collider).0);
        }
        "insert rigid"
    }

    fn remove_flexible(&mut self, chance: &mut Chance) -> Result<&'static str, FlexBodyError> {
        if !self.flexible.is_empty() {
            let handle = self.flexible.swap_remove(chance.below(self.flexible.len()));
            let scene = &mut self.scene;
            scene.flex_bodies.remove(handle, &mut scene.world)?;
        }
        Ok("remove flexible")
    }

    fn remove_rigid(&mut self, chance: &mut Chance) -> &'static str {
        if !self.rigid.is_empty() {
            let handle = self.rigid.swap_remove(chance.below(self.rigid.len()));
            self.scene.world.remove_body(handle);
        }
        "remove rigid"
    }

    fn change_rigid(&mut self, operation: usize, chance: &mut Chance) -> &'static str {
        if self.rigid.is_empty() {
            return "nothing rigid";
        }
        let handle = self.rigid[chance.below(self.rigid.len())];
        let world = &mut self.scene.world;
        let [x, y] = chance.at();
        let body = &mut world.bodies[handle];
        match operation {
            6 | 7 => {
                body.set_translation(vector(x, y), true);
                "teleport"
            }
            8 => {
                body.set_linvel(vector(10.0 * x, 20.0 * (y - 2.0)), true);
                "velocity"
            }
            9 => {
                let is_enabled = body.is_enabled();
                body.set_enabled(!is_enabled);
                "enable"
            }
            10 => {
                let types = [
                    RigidBodyType::Dynamic,
                    RigidBodyType::Dynamic,
                    RigidBodyType::Fixed,
                    RigidBodyType::KinematicVelocityBased,
                    RigidBodyType::KinematicPositionBased,
                ];
                body.set_body_type(types[chance.below(5)], true);
                "type"
            }
            11 => {
                let collider = body.colliders()[0];
                world.colliders[collider].set_shape(shape(chance));
                "shape"
            }
            _ => {
                if body.is_sleeping() {
                    body.wake_up(true);
                } else {
                    body.sleep();
                }
                "sleep"
            }
        }
    }

    fn change_flexible(
        &mut self,
        operation: usize,
        chance: &mut Chance,
    ) -> Result<&'static str, FlexBodyError> {
        if self.flexible.is_empty() {
            return Ok("nothing flexible");
        }
        let handle = self.flexible[chance.below(self.flexible.len())];
        let body = &mut self.scene.flex_bodies[handle];
        let node = chance.below(body.n_nodes());
        let [x, y] = chance.at();
        match operation {
            13 => {
                body.set_nodal_force(node, [100.0 * x, 100.0 * (y - 2.0)])?;
                Ok("nodal force")
            }
            14 => {
                let n = 2 * body.n_nodes();
                let velocities: Vec<f64> = (0..n)
                    .map(|dof| if dof % 2 == 0 { x } else { y - 2.0 })
                    .collect();
                body.set_velocities(&velocities)?;
                Ok("velocities")
            }
            _ => {
                let surface = body.collider_handle();
                let collider = &mut self.scene.world.colliders[surface];
                let is_enabled = collider.is_enabled();
                collider.set_enabled(!is_enabled);
                Ok("enable surface")
            }
        }
    }

    /// Rapier holds a carrier for every flexible body and a surface on it, and nothing else of ours.
    #[track_caller]
    fn assert_counted(&self, context: &str) {
        let scene = &self.scene;
        let (n_flexible, n_rigid) = (self.flexible.len(), self.rigid.len());
        assert_eq!(scene.flex_bodies.len(), n_flexible, "{context}");
        assert_eq!(scene.world.bodies.len(), n_flexible + n_rigid, "{context}");
        let n_colliders = n_flexible + n_rigid + N_STATIC;
        assert_eq!(scene.world.colliders.len(), n_colliders, "{context}");
    }

    #[track_caller]
    fn assert_finite(&self, context: &str) {
        for (handle, body) in self.scene.flex_bodies.iter() {
            let state = body.state();
            let all = [
                &state.position,
                &state.velocity,
                &state.displacement,
                &state.rate,
                &state.acceleration,
            ];
            let is_finite = all.into_iter().flatten().all(|x| x.is_finite());
            assert!(is_finite, "{context}: {handle:?}");
            let speeds = body.velocities().iter().map(|v| v.abs());
            let fastest = speeds.fold(0.0, f64::max);
            assert!(
                fastest < FASTEST,
                "{context}: {handle:?} moves at {fastest:e} m/s"
            );
        }
        for (handle, body) in self.scene.world.rigid_bodies() {
            let is_finite = body.translation().is_finite()
                && body.linvel().is_finite()
                && body.angvel().is_finite();
            assert!(is_finite, "{context}: {handle:?}");
        }
    }
}

/// Plays one seed through; returns it with how many steps were refused.
fn play(seed: u64) -> Result<(Play, usize), Box<dyn Error>> {
    let mut chance = Chance(seed);
    let mut play = Play::new();
    let (mut n_refused, mut n_held) = (0, 0);
    for index in 0..N_OPERATIONS {
        let operation = play.operate(&mut chance)?;
        let context = format!("seed {seed}, operation {index} ({operation})");
        let before = play.scene.bits();
        let held = play.scene.step().map(StepReport::n_held);
        match held {
            Ok(held) => n_held += held,
            Err(_) => {
                n_refused += 1;
                assert_eq!(before, play.scene.bits(), "{context} was refused");
            }
        }
        play.assert_finite(&context);
        play.assert_counted(&context);
    }
    // Holding is for what is jammed: one step in fifty would be a habit.
    assert!(n_held < N_OPERATIONS / 50, "{n_held} islands were held");
    Ok((play, n_refused))
}

#[test]
fn two_thousand_random_operations_between_steps_never_panic_stay_finite_and_leak_nothing() -> Outcome
{
    // Bodies are put into each other and into the floor: every step can be taken all the same.
    let (mut play, n_refused) = play(0x2545_f491_4f6c_dd1d)?;
    assert_eq!(n_refused, 0, "of {N_OPERATIONS} steps");
    for handle in std::mem::take(&mut play.flexible) {
        let scene = &mut play.scene;
        scene.flex_bodies.remove(handle, &mut scene.world)?;
    }
    for handle in std::mem::take(&mut play.rigid) {
        play.scene.world.remove_body(handle);
    }
    play.assert_counted("after the last removal");
    // What comes next finds a world without traces of what was there.
    play.scene.world.gravity = vector(0.0, -GRAVITY);
    play.scene.set_dt(1.0 / 60.0);
    let block = play.scene.insert(square().translation([-0.5, 0.001]))?;
    play.scene.steps(120)?;
    let body = &play.scene.flex_bodies[block];
    let ratio = body.total_contact_force()[1] / (GRAVITY * body.mass());
    assert!((ratio - 1.0).abs() < 1e-3, "{ratio} of the weight");
    Ok(())
}
