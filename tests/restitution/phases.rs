//! A step ends where bodies touch, or have bounced: what they leave with does not depend on when in the step they met.

use super::SPEED;
use super::common::*;

/// Shares of a step that have passed when the bodies meet.
const PHASES: [f64; 7] = [0.02, 0.2, 0.4, 0.5, 0.6, 0.8, 0.98];

fn stiff(size: [f64; 2], cells: [usize; 2], e: f64) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle(size, cells)
        .material(LinearElastic::plane_strain(1e11, 0.3).density(1000.0))
        .friction(0.0)
        .restitution(e)
}

/// Leaving over approaching velocity of a block, large or small strain, that falls on the ground.
fn on_the_ground(is_large: bool, way: f64, e: f64, rate: f64) -> f64 {
    let mut scene = Scene::in_free_space(1.0 / rate);
    scene.fixed(
        ColliderBuilder::cuboid(5.0, 0.5)
            .translation(vec2(0.0, -0.5))
            .restitution(real(e)),
    );
    let block = stiff([0.5, 0.3], [5, 4], e)
        .translation([-0.25, way])
        .linvel([0.0, -SPEED]);
    let block = match is_large {
        true => block.large_strain(),
        false => block.small_strain(),
    };
    let block = scene.flexible(block);
    scene.steps(7);
    scene.body(block).linvel()[1] / SPEED
}

/// The same of a rigid ball that falls on a slab.
fn on_a_slab(way: f64, e: f64, rate: f64) -> f64 {
    let mut scene = Scene::in_free_space(1.0 / rate);
    scene.flexible(
        stiff([1.0, 0.2], [10, 4], e)
            .translation([-0.5, -0.2])
            .pin_where(|[_, y]| y == 0.0, Pin::both()),
    );
    let (ball, _) = scene.rigid(
        RigidBodyBuilder::dynamic()
            .translation(vec2(0.0, 0.1 + way))
            .linvel(vec2(0.0, -SPEED)),
        ColliderBuilder::ball(0.1)
            .density(1000.0)
            .friction(0.0)
            .restitution(real(e)),
    );
    scene.steps(7);
    f64::from(scene.world.bodies[ball].linvel().y) / SPEED
}

/// The same of a block that meets one at rest.
fn on_a_block(way: f64, e: f64, rate: f64) -> f64 {
    let mut scene = Scene::in_free_space(1.0 / rate);
    let falling = stiff([0.5, 0.3], [5, 4], e)
        .translation([-0.25, way])
        .linvel([0.0, -SPEED]);
    let falling = scene.flexible(falling);
    let resting = scene.flexible(stiff([0.5, 0.3], [5, 4], e).translation([-0.25, -0.3]));
    scene.steps(7);
    (scene.body(falling).linvel()[1] - scene.body(resting).linvel()[1]) / SPEED
}

#[test]
fn a_rebound_does_not_depend_on_when_in_the_step_bodies_meet() {
    for (rate, e) in [(60.0, 0.9), (60.0, 0.5), (480.0, 0.9)] {
        for phase in PHASES {
            let way = (2.0 + phase) * SPEED / rate;
            let found = [
                on_the_ground(true, way, e, rate),
                on_the_ground(false, way, e, rate),
                on_a_slab(way, e, rate),
                on_a_block(way, e, rate),
            ];
            for (found, what) in found.iter().zip(["large", "small", "ball", "blocks"]) {
                assert!(
                    (found - e).abs() < 2e-3,
                    "{what}, e {e}, {phase} of a step of 1/{rate} s: {found}"
                );
            }
        }
    }
}

/// A ball, and a plate of large or small strain, that slide along what they fall on: leaving velocity over approaching one, and slip that is left (m/s).
fn grazing(is_large: bool, phase: f64, e: f64, rate: f64) -> [[f64; 2]; 2] {
    let (fall, slip, friction) = (1.0, 10.0, 0.3);
    let way = (2.0 + phase) * fall / rate;
    let slab = |scene: &mut Scene| {
        let slab = stiff([8.0, 0.2], [80, 4], e).friction(friction);
        scene.flexible(
            slab.translation([-1.0, -0.2])
                .pin_where(|[_, y]| y == 0.0, Pin::both()),
        );
    };
    let mut scene = Scene::in_free_space(1.0 / rate);
    slab(&mut scene);
    let (ball, _) = scene.rigid(
        RigidBodyBuilder::dynamic()
            .translation(vec2(0.0, 0.2 + way))
            .linvel(vec2(slip, -fall)),
        ColliderBuilder::ball(real(0.2))
            .density(500.0)
            .friction(real(friction))
            .restitution(real(e)),
    );
    scene.steps(7);
    let of_ball = scene.world.bodies[ball].linvel();
    let mut scene = Scene::in_free_space(1.0 / rate);
    slab(&mut scene);
    let plate = stiff([0.5, 0.1], [5, 1], e)
        .friction(friction)
        .translation([0.0, way])
        .linvel([slip, -fall]);
    let plate = scene.flexible(match is_large {
        true => plate.large_strain(),
        false => plate.small_strain(),
    });
    scene.steps(7);
    let of_plate = scene.body(plate).linvel();
    [
        [f64::from(of_ball.x), f64::from(of_ball.y)].map(|v| v / fall),
        of_plate.map(|v| v / fall),
    ]
}

/// Where bodies meet early in a step its position stage gives more than the law asks for: impulses give some back with the friction that went along,
/// which gains nothing, as the position stage has taken more.
#[test]
fn what_slides_fast_rebounds_by_its_restitution_too() {
    for (rate, e) in [(60.0, 0.5), (240.0, 0.5), (60.0, 0.2)] {
        for phase in PHASES {
            for is_large in [true, false] {
                let [ball, plate] = grazing(is_large, phase, e, rate);
                // Friction acts in one direction all the while.
                let left = 10.0 - 0.3 * (1.0 + e);
                for (axis, wanted) in [left, e].into_iter().enumerate() {
                    assert!(
                        (ball[axis] - wanted).abs() < 5e-3,
                        "ball, e {e}, {phase} of a step of 1/{rate} s, axis {axis}: {}",
                        ball[axis]
                    );
                    // The front edge of a plate is struck first where friction turns it.
                    let within = [5e-2, 5e-3][axis];
                    assert!(
                        (plate[axis] - wanted).abs() < within,
                        "plate, e {e}, {phase} of a step of 1/{rate} s, axis {axis}: {}",
                        plate[axis]
                    );
                }
            }
        }
    }
}

/// What falls.
#[derive(Clone, Copy, Debug)]
enum Falling {
    Ball(RigidBodyHandle),
    Block(FlexBodyHandle),
}

impl Falling {
    /// Height (m) and velocity (m/s) of its centre of mass.
    fn motion(self, scene: &Scene) -> [f64; 2] {
        match self {
            Self::Ball(ball) => {
                let body = &scene.world.bodies[ball];
                [body.translation().y, body.linvel().y].map(f64::from)
            }
            Self::Block(block) => {
                let body = scene.body(block);
                [body.centre_of_mass()[1], body.linvel()[1]]
            }
        }
    }
}

/// Height over the one it fell from to which what falls on the ground, or on a slab, may rise after the step in which it meets that: by its energy then.
fn risen(falls: &str, height: f64, e: f64, rate: f64) -> f64 {
    let mut scene = Scene::in_free_space(1.0 / rate);
    scene.world.gravity = vec2(0.0, -G);
    // Around everything, so that the ball is taken too; it touches nothing.
    let ring = FlexBodyBuilder::annulus(8.0, 8.5, 0.8)
        .material(LinearElastic::plane_strain(1e8, 0.3).density(20.0))
        .pin_where(|_| true, Pin::both())
        .can_sleep(false);
    scene.flexible(ring);
    let falling = if falls == "ball" {
        scene.flexible(
            stiff([1.0, 0.2], [10, 4], e)
                .translation([-0.5, -0.2])
                .pin_where(|[_, y]| y == 0.0, Pin::both()),
        );
        let shape = ColliderBuilder::ball(0.1).density(1000.0).friction(0.0);
        let above = RigidBodyBuilder::dynamic().translation(vec2(0.0, 0.1 + height));
        Falling::Ball(scene.rigid(above, shape.restitution(real(e))).0)
    } else {
        let ground = ColliderBuilder::cuboid(5.0, 0.5).translation(vec2(0.0, -0.5));
        scene.fixed(ground.restitution(real(e)));
        let block = stiff([0.5, 0.3], [5, 4], e).translation([-0.25, height]);
        Falling::Block(scene.flexible(match falls {
            "large" => block.large_strain(),
            _ => block.small_strain(),
        }))
    };
    let [start, _] = falling.motion(&scene);
    loop {
        scene.step();
        let [now, speed] = falling.motion(&scene);
        if speed > 0.0 {
            return (now + 0.5 * speed * speed / G - start) / height + 1.0;
        }
        assert!(now > start - height - 0.1, "{falls} falls on");
    }
}

/// Under gravity the speed of an impact is the one at which bodies meet, not that of the beginning of its step.
#[test]
fn what_falls_rises_again_whenever_in_the_step_it_meets_the_ground() {
    for (rate, e) in [(60.0, 1.0), (60.0, 0.7), (240.0, 1.0)] {
        for falls in ["ball", "large", "small"] {
            for share in PHASES {
                let height = 0.8 + 0.05 * share;
                let found = risen(falls, height, e, rate);
                let off = found - e * e;
                assert!(
                    off.abs() < 2e-3,
                    "1/{rate} s, {falls} from {height} m, e {e}: rises by {found} of it"
                );
            }
        }
    }
}

/// The speed below which nothing rebounds goes with the world's unit of length: what comes at 0.1 m/s does in a world whose things are of centimetres.
#[test]
fn the_threshold_of_rebounds_goes_with_the_unit_of_length() {
    for (unit, rebounds) in [(1.0, false), (0.01, true)] {
        let mut scene = Scene::in_free_space(1.0 / 60.0);
        scene.world.integration_parameters.length_unit = real(unit);
        scene.fixed(
            ColliderBuilder::cuboid(5.0, 0.5)
                .translation(vec2(0.0, -0.5))
                .restitution(1.0),
        );
        let block = stiff([0.5, 0.3], [5, 4], 1.0)
            .translation([-0.25, 0.01])
            .linvel([0.0, -0.1]);
        let block = scene.flexible(block);
        scene.steps(12);
        let speed = scene.body(block).linvel()[1];
        assert_eq!(speed > 0.09, rebounds, "unit {unit}: {speed} m/s");
    }
}
