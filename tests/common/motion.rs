//! Where bodies are and how they move: as numbers, and as bits.

use super::*;

/// Place of a body (m).
pub fn place_of(body: &RigidBody) -> [f64; 2] {
    let at = body.translation();
    [f64::from(at.x), f64::from(at.y)]
}

/// Velocity of a body's centre of mass (m/s).
pub fn velocity_of(body: &RigidBody) -> [f64; 2] {
    let v = body.linvel();
    [f64::from(v.x), f64::from(v.y)]
}

/// Turn of a body, in (-π, π] (rad).
pub fn turn_of(body: &RigidBody) -> f64 {
    let turn = body.rotation();
    f64::from(turn.im).atan2(f64::from(turn.re))
}

/// Place, turn as cosine and sine, velocity and spin of a body, as rapier holds them.
pub fn motion_of(body: &RigidBody) -> [f64; 7] {
    let (at, turn, v) = (body.translation(), body.rotation(), body.linvel());
    [at.x, at.y, turn.re, turn.im, v.x, v.y, body.angvel()].map(f64::from)
}

/// All bits of the motion of all bodies, in the order of their sets.
pub fn motion_bits(world: &PhysicsWorld, bodies: &FlexBodySet) -> Vec<u64> {
    let flexible = bodies
        .iter()
        .flat_map(|(_, body)| body.positions().iter().chain(body.velocities()));
    let flexible: Vec<u64> = flexible.map(|x| x.to_bits()).collect();
    let rigid = world.rigid_bodies().flat_map(|(_, body)| motion_of(body));
    flexible
        .into_iter()
        .chain(rigid.map(f64::to_bits))
        .collect()
}

/// A flexible body with a number in its committed state that is none, if there is one.
pub fn sick_flexible(bodies: &FlexBodySet) -> Option<FlexBodyHandle> {
    let is_sick = |body: &FlexBody| {
        let state = body.state();
        let all = [
            &state.position,
            &state.velocity,
            &state.displacement,
            &state.rate,
            &state.acceleration,
        ];
        !(all.into_iter().flatten().all(|x| x.is_finite()) && state.torque.is_finite())
    };
    bodies
        .iter()
        .find(|(_, body)| is_sick(body))
        .map(|(handle, _)| handle)
}

/// A rigid body with a number in its motion that is none, if there is one.
pub fn sick_rigid(world: &PhysicsWorld) -> Option<RigidBodyHandle> {
    world
        .rigid_bodies()
        .find(|(_, body)| motion_of(body).iter().any(|x| !x.is_finite()))
        .map(|(handle, _)| handle)
}

/// FNV-1a over the bits of numbers, the same on every machine.
pub struct Hash(pub u64);

impl Default for Hash {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Hash {
    pub fn take(&mut self, value: f64) {
        for byte in value.to_bits().to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}
