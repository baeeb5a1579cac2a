//! A spin is no approach: what is round leaves with the same velocity however fast it turns.

use super::SPEED;
use super::common::*;

const PHASES: [f64; 5] = [0.05, 0.3, 0.5, 0.7, 0.95];

fn slab(scene: &mut Scene, e: f64, friction: f64) {
    let slab = FlexBodyBuilder::rectangle([2.0, 0.2], [20, 2])
        .material(LinearElastic::plane_stress(2e11, 0.3).density(1000.0));
    scene.flexible(
        slab.friction(friction)
            .restitution(e)
            .pin_where(|[_, y]| y == 0.0, Pin::both())
            .translation([-1.0, -0.2]),
    );
}

/// Leaving over approaching velocity of a rigid ball that spins (rad/s).
fn of_a_ball(e: f64, friction: f64, spin: f64, (rate, phase): (f64, f64)) -> f64 {
    let mut scene = Scene::in_free_space(1.0 / rate);
    slab(&mut scene, e, friction);
    let (ball, _) = scene.rigid(
        RigidBodyBuilder::dynamic()
            .translation(vec2(0.0, 0.2 + SPEED / rate * (3.0 + phase)))
            .linvel(vec2(0.0, -SPEED))
            .angvel(real(spin)),
        ColliderBuilder::ball(real(0.2))
            .density(500.0)
            .friction(real(friction))
            .restitution(real(e)),
    );
    scene.steps(8);
    f64::from(scene.world.bodies[ball].linvel().y) / SPEED
}

#[test]
fn a_ball_that_spins_rebounds_by_its_restitution() {
    for (rate, spin) in [(60.0, 10.0), (60.0, 40.0), (240.0, 40.0)] {
        for (e, friction) in [(0.5, 0.3), (0.5, 0.0), (0.9, 0.3)] {
            for phase in PHASES {
                let found = of_a_ball(e, friction, spin, (rate, phase));
                assert!(
                    (found - e).abs() < 2e-3,
                    "e {e}, friction {friction}, {spin} rad/s, {phase} of a step of 1/{rate} s: {found}"
                );
            }
        }
    }
}

/// A ring of either strain: its corners come to the slab, and go from it, at `ω` times half a side at most.
#[test]
fn a_stiff_ring_that_spins_rebounds_by_its_restitution() {
    let (e, spin, inner, radius, edge) = (0.5, 30.0, 0.14, 0.2, 0.008);
    let side = edge * radius / (0.5 * (inner + radius));
    let grazing = 0.5 * spin * side;
    for (phase, is_large) in PHASES
        .iter()
        .flat_map(|phase| [(phase, false), (phase, true)])
    {
        let mut scene = Scene::in_free_space(1.0 / 60.0);
        slab(&mut scene, e, 0.0);
        let ring = FlexBodyBuilder::annulus(inner, radius, edge)
            .material(LinearElastic::plane_stress(2e11, 0.3).density(500.0))
            .friction(0.0)
            .restitution(e)
            .translation([0.0, radius + SPEED / 60.0 * (3.0 + phase)])
            .linvel([0.0, -SPEED])
            .angvel(spin);
        let ring = scene.flexible(match is_large {
            true => ring.large_strain(),
            false => ring.small_strain(),
        });
        scene.steps(8);
        let found = scene.body(ring).linvel()[1];
        let error = (found - e * SPEED).abs();
        assert!(
            error < (1.0 + e) * grazing,
            "{phase} of a step, large {is_large}: {found} m/s, off by {error}"
        );
    }
}

/// Rollers at one height hand a block on that is carried by them, and do not throw it.
#[test]
fn a_block_on_rollers_stays_on_them() {
    let (spin, radius) = (40.0, 0.1);
    for rate in [60.0, 240.0] {
        let mut scene = Scene::in_free_space(1.0 / rate);
        scene.world.gravity = vec2(0.0, -9.81);
        for k in 0..24 {
            scene.rigid(
                RigidBodyBuilder::kinematic_velocity_based()
                    .translation(vec2(0.3 * f64::from(k) - 0.6, -radius))
                    .angvel(real(-spin)),
                ColliderBuilder::ball(real(radius))
                    .friction(0.5)
                    .restitution(0.5),
            );
        }
        let block = FlexBodyBuilder::rectangle([1.0, 0.2], [20, 2])
            .material(LinearElastic::plane_stress(2e11, 0.3).density(1000.0))
            .friction(0.5)
            .restitution(0.5)
            .translation([-0.5, 1e-4])
            .linvel([spin * radius, 0.0]);
        let block = scene.flexible(block);
        let start = scene.body(block).centre_of_mass()[1];
        for step in 0..(0.8 * rate) as usize {
            scene.step();
            let risen = scene.body(block).centre_of_mass()[1] - start;
            assert!(risen < 1e-4, "dt 1/{rate} s, step {step}: {risen} m");
        }
    }
}
