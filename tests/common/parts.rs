//! What scenes are made of.

use super::*;

/// A plane-stress material of Poisson's ratio 0.3: Young's modulus (Pa), density (kg/m²), stiffness damping (s).
pub fn elastic(young: f64, density: f64, rayleigh: f64) -> LinearElastic {
    LinearElastic::plane_stress(young, 0.3)
        .density(density)
        .rayleigh(rayleigh)
}

/// A block of 1 m and 1000 kg that sinks by some centimetres under its own weight, with this stiffness damping (s): at 2e-2
/// it comes to rest within a second.
pub fn soft_block(rayleigh: f64) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).material(elastic(1e6, 1000.0, rayleigh))
}

/// A dynamic body that cannot move. What is joined to it is claimed if something flexible lies on it.
pub fn locked_body() -> RigidBodyBuilder {
    RigidBodyBuilder::dynamic()
        .locked_axes(LockedAxes::TRANSLATION_LOCKED | LockedAxes::ROTATION_LOCKED)
}

/// Gives a body that cannot move a slab, its middle at `slab` from the body, and lays a small soft block on it.
pub fn lay_block_on(
    world: &mut PhysicsWorld,
    bodies: &mut FlexBodySet,
    anchor: RigidBodyHandle,
    slab: [f64; 2],
    rayleigh: f64,
) {
    let shape = ColliderBuilder::cuboid(1.0, 0.5).translation(vec2(slab[0], slab[1]));
    world.insert_collider(shape, Some(anchor));
    let [x, y] = place_of(&world.bodies[anchor]);
    let block = FlexBodyBuilder::rectangle([0.25, 0.25], [1, 1])
        .material(elastic(1e6, 100.0, rayleigh))
        .translation([x + slab[0] - 0.125, y + slab[1] + 0.5]);
    bodies
        .insert(block, world)
        .expect("the description is right");
}

/// A dynamic body of this mass (kg) and inertia (kg m²) at a place, without colliders, never asleep.
pub fn add_free_body(
    world: &mut PhysicsWorld,
    at: [f64; 2],
    mass: f64,
    inertia: f64,
) -> RigidBodyHandle {
    let mass = MassProperties::new(vec2(0.0, 0.0), real(mass), real(inertia));
    world.insert_body(
        RigidBodyBuilder::dynamic()
            .can_sleep(false)
            .translation(vec2(at[0], at[1]))
            .additional_mass_properties(mass),
    )
}

/// A hinge between these places of the first and the second body.
pub fn hinge(one: [f64; 2], other: [f64; 2]) -> RevoluteJointBuilder {
    RevoluteJointBuilder::new()
        .local_anchor1(vec2(one[0], one[1]))
        .local_anchor2(vec2(other[0], other[1]))
}
