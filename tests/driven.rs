//! Bodies that are driven: by pins that are moved, and by welds to kinematic bodies.

mod common;

use common::{Scene, real, vec2};
use foil2d::integrator::Beta2;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;

const DT: f64 = 1.0 / 60.0;

/// How a body is driven.
#[derive(Clone, Copy, Debug, PartialEq)]
enum By {
    Pins,
    Weld,
}

/// A block of 3 m by 0.5 m that is held along its lower edge, and what drives it.
struct Driven {
    scene: Scene,
    block: FlexBodyHandle,
    base: Option<RigidBodyHandle>,
    lower: Vec<usize>,
    moved: [f64; 2],
}

impl Driven {
    fn new(scene: Scene, young: f64, is_large: bool, by: By) -> Self {
        let mut scene = scene;
        let block = FlexBodyBuilder::rectangle([3.0, 0.5], [24, 4])
            .material(LinearElastic::plane_stress(young, 0.3).density(1000.0))
            .friction(0.8);
        let block = match is_large {
            true => block.large_strain(),
            false => block.small_strain(),
        };
        let is_low = |[_, y]: [f64; 2]| y < 1e-9;
        let block = scene.flexible(match by {
            By::Pins => block.pin_where(is_low, Pin::both()),
            By::Weld => block,
        });
        let nodes = 0..scene.body(block).n_nodes();
        let lower: Vec<usize> = nodes
            .filter(|&node| is_low(scene.body(block).position(node)))
            .collect();
        let base = (by == By::Weld).then(|| {
            let base = RigidBodyBuilder::kinematic_velocity_based().translation(vec2(1.5, -0.2));
            let base = scene.world.insert_body(base);
            let weld = AttachmentBuilder::weld(block).nodes(lower.clone());
            let weld = weld.to_rigid_body(base);
            scene
                .bodies
                .attach(weld, &scene.world.bodies)
                .expect("a weld of the lower edge");
            base
        });
        Self {
            scene,
            block,
            base,
            lower,
            moved: [0.0; 2],
        }
    }

    /// A step in which the lower edge moves at this velocity (m/s).
    fn step(&mut self, velocity: [f64; 2]) {
        let Self { scene, base, .. } = self;
        if let Some(base) = *base {
            scene.world.bodies[base].set_linvel(vec2(velocity[0], velocity[1]), true);
        } else {
            let dt = scene.dt();
            for (moved, velocity) in self.moved.iter_mut().zip(velocity) {
                *moved += dt * velocity;
            }
            for &node in &self.lower {
                scene.bodies[self.block]
                    .set_pin_displacement(node, self.moved)
                    .expect("a pinned node");
            }
        }
        scene.step();
    }

    fn velocity(&self) -> [f64; 2] {
        self.scene.body(self.block).linvel()
    }
}

fn all_kinds() -> impl Iterator<Item = (bool, By)> {
    [true, false]
        .into_iter()
        .flat_map(|is_large| [By::Pins, By::Weld].map(|by| (is_large, by)))
}

/// What is stiffer than the step resolves goes with what drives it from the first step on, when it starts, turns aside and stops, and does not swing about
/// its velocity.
#[test]
fn a_stiff_body_goes_with_what_drives_it_at_once() {
    for (is_large, by) in all_kinds() {
        let mut driven = Driven::new(Scene::in_free_space(DT), 1e11, is_large, by);
        let phases = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [-1.0, 0.5], [0.0, 0.0]];
        for velocity in phases {
            for step in 0..10 {
                driven.step(velocity);
                let found = driven.velocity();
                let off = (found[0] - velocity[0]).hypot(found[1] - velocity[1]);
                assert!(
                    off < 0.02,
                    "large {is_large}, {by:?}, {velocity:?}, step {step}: {found:?} m/s"
                );
            }
        }
    }
}

/// A stiff block that is drawn by its lower edge, a pin to the mean of its nodes or to the middle one, is thrown as a rigid one: its centre begins with
/// `I / (I + m d²)` of the pin's velocity.
#[test]
fn a_stiff_body_that_is_drawn_by_a_pin_swings_as_a_rigid_one() {
    for is_large in [true, false] {
        for (young, is_mean) in [(1e9, true), (1e11, true), (1e9, false), (1e11, false)] {
            let mut scene = Scene::in_free_space(DT);
            let block = FlexBodyBuilder::rectangle([1.0, 0.5], [8, 4])
                .material(LinearElastic::plane_stress(young, 0.3).density(1000.0));
            let block = scene.flexible(match is_large {
                true => block.large_strain(),
                false => block.small_strain(),
            });
            let pin = AttachmentBuilder::pin(block);
            let pin = match is_mean {
                true => pin.where_(|[_, y]| y < 1e-9),
                false => pin.node(4),
            };
            let pin = scene
                .bodies
                .attach(pin.to_world(), &scene.world.bodies)
                .expect("a pin");
            let inertia = (1.0 + 0.25) / 12.0;
            let expected = 2.0 * inertia / (inertia + 0.0625);
            for step in 0..12 {
                if step >= 4 {
                    let moved = 2.0 * DT * f64::from(step - 3);
                    let pin = scene.bodies.attachment_mut(pin).expect("the pin");
                    pin.set_target([moved, 0.0], 0.0).expect("a number");
                }
                scene.step();
                // It turns by a tenth of a radian.
                let found = scene.body(block).linvel()[0];
                let expected = if step < 4 { 0.0 } else { expected };
                let name = format!("large {is_large}, E {young:e}, mean {is_mean}, step {step}");
                assert!((found - expected).abs() < 0.15, "{name}: {found} m/s");
            }
        }
    }
}

/// A box on a platform that speeds up to 1 m/s, sideways or upwards, has its velocity in every step.
#[test]
fn a_box_rides_a_driven_platform() {
    for ((is_large, by), young) in all_kinds().flat_map(|kind| [(kind, 1e8), (kind, 1e11)]) {
        for axis in 0..2 {
            let mut driven = Driven::new(Scene::new(DT), young, is_large, by);
            let body = RigidBodyBuilder::dynamic().translation(vec2(1.5, 0.6));
            let shape = ColliderBuilder::cuboid(real(0.2), real(0.1)).density(real(100.0));
            let (rider, _) = driven.scene.rigid(body, shape.friction(real(0.8)));
            for _ in 0..20 {
                driven.step([0.0; 2]);
            }
            for step in 0..90 {
                let mut velocity = [0.0; 2];
                velocity[axis] = (f64::from(step + 1) * 2.0 * DT).min(1.0);
                driven.step(velocity);
                let found = driven.scene.world.bodies[rider].linvel();
                let found = f64::from([found.x, found.y][axis]);
                assert!(
                    (found - velocity[axis]).abs() < 0.05,
                    "large {is_large}, {by:?}, E {young:e}, axis {axis}, step {step}: {found} m/s of {}",
                    velocity[axis]
                );
            }
        }
    }
}

/// A stiff bar whose middle is turned at 3 rad/s has the kinetic energy of a rigid one.
#[test]
fn a_stiff_rotor_turns_as_a_rigid_one() {
    let mut scene = Scene::in_free_space(DT);
    let bar = FlexBodyBuilder::rectangle([3.0, 0.5], [24, 4])
        .material(LinearElastic::plane_stress(1e12, 0.3).density(1000.0))
        .translation([-1.5, -0.25])
        .pin_where(|[x, _]| (x - 1.5).abs() < 0.2, Pin::both());
    let bar = scene.flexible(bar);
    let body = scene.body(bar);
    let places: Vec<(usize, [f64; 2])> = (0..body.n_nodes())
        .map(|node| (node, body.position(node)))
        .filter(|(_, [x, _])| x.abs() < 0.2)
        .collect();
    let spin = 3.0;
    let expected = 0.5 * 1500.0 * (9.0 + 0.25) / 12.0 * spin * spin;
    for step in 1..=60 {
        let (sin, cos) = (spin * DT * f64::from(step)).sin_cos();
        for &(node, [x, y]) in &places {
            let turned = [cos * x - sin * y - x, sin * x + cos * y - y];
            scene.bodies[bar]
                .set_pin_displacement(node, turned)
                .expect("a pinned node");
        }
        scene.step();
        let kinetic = scene.body(bar).energy().kinetic;
        assert!(
            (kinetic / expected - 1.0).abs() < 0.05,
            "step {step}: {kinetic} J of {expected}"
        );
    }
}

/// A bar whose end is driven at a constant velocity `v` from rest: a wave of stress `ρ c v` runs into it, and the driver works against it.
#[test]
fn a_driven_bar_resists_with_the_stress_of_its_wave() {
    // 1 m in 100 cells of 1 cm, 0.1 m wide; c = 1000 m/s crosses a cell in a step.
    let (young, density, speed) = (1e9, 1e3, 1.0);
    for is_large in [false, true] {
        let mut scene = Scene::in_free_space(1e-5);
        scene.flex = FlexPipeline::new().with_integrator(Beta2::trapezoidal());
        let bar = FlexBodyBuilder::rectangle([1.0, 0.1], [100, 1])
            .material(LinearElastic::plane_stress(young, 0.0).density(density))
            .pin_where(|[x, _]| x < 1e-9, Pin::both());
        let bar = scene.flexible(match is_large {
            true => bar.large_strain(),
            false => bar.small_strain(),
        });
        let body = scene.body(bar);
        let held: Vec<usize> = (0..body.n_nodes())
            .filter(|&node| body.position(node)[0] < 1e-9)
            .collect();
        let n = 80;
        let mut impulse = 0.0;
        for step in 1..=n {
            for &node in &held {
                scene.bodies[bar]
                    .set_pin_displacement(node, [1e-5 * speed * f64::from(step), 0.0])
                    .expect("a pinned node");
            }
            scene.step();
            impulse += 1e-5 * scene.body(bar).total_reaction()[0];
        }
        let time = 1e-5 * f64::from(n);
        let force = 0.1 * density * 1e3 * speed;
        // What momentum the driver has given, and what energy: half of it is stored.
        let body = scene.body(bar);
        let momentum = body.momentum()[0] / (force * time);
        let told = impulse / (force * time);
        let [kinetic, elastic] = [body.energy().kinetic, body.energy().elastic]
            .map(|energy| energy / (0.5 * force * speed * time));
        assert!(
            (momentum - 1.0).abs() < 0.02,
            "large {is_large}: {momentum}"
        );
        assert!((told - 1.0).abs() < 0.03, "large {is_large}: {told}");
        assert!((kinetic - 1.0).abs() < 0.02, "large {is_large}: {kinetic}");
        assert!((elastic - 1.0).abs() < 0.02, "large {is_large}: {elastic}");
    }
}

/// Pins that speed up give a body its momentum and its angular momentum: what they are told to give in each step sums up to both, whatever the step resolves of
/// the body.
#[test]
fn pins_that_speed_up_give_what_moves_the_body() {
    for (young, rate) in [(1e6, 60.0), (1e8, 60.0), (1e11, 60.0), (1e8, 240.0)] {
        for is_large in [true, false] {
            for acceleration in [[2.0, 0.0], [-1.0, 3.0]] {
                let scene = Scene::in_free_space(1.0 / rate);
                let mut driven = Driven::new(scene, young, is_large, By::Pins);
                let (dt, mass) = (driven.scene.dt(), 1500.0);
                let name = format!("E {young:e}, large {is_large}, {acceleration:?}, 1/{rate} s");
                let steps = (2.0 * rate) as usize;
                let (mut given, mut turned) = ([0.0; 2], 0.0);
                let (mut before, mut spun) = ([0.0; 2], 0.0);
                for step in 0..steps {
                    if step == steps / 2 {
                        before = driven.velocity();
                        spun = driven.scene.report().angular_momentum();
                    }
                    let time = dt * step as f64;
                    // It starts smoothly.
                    let ramp = (time / 0.5).min(1.0);
                    driven.step(acceleration.map(|a| a * ramp * ramp * time));
                    if step >= steps / 2 {
                        let body = driven.scene.body(driven.block);
                        let force = body.total_reaction();
                        given = [0, 1].map(|axis| given[axis] + dt * force[axis]);
                        turned += dt * body.reaction_moment([0.0; 2]);
                    }
                }
                let after = driven.velocity();
                let size = mass * 2.0;
                for axis in 0..2 {
                    let off = given[axis] - mass * (after[axis] - before[axis]);
                    assert!(off.abs() < 5e-3 * size, "{name}: {off} of {size} N s");
                }
                let off = turned - (driven.scene.report().angular_momentum() - spun);
                assert!(off.abs() < 1e-2 * size, "{name}: {off} of {size} N m s");
            }
        }
    }
}

/// The same of a bar that is drawn by one pin, with its mass at that.
#[test]
fn a_pin_that_draws_a_bar_gives_what_moves_it() {
    for is_large in [true, false] {
        let mut scene = Scene::in_free_space(DT);
        let bar = FlexBodyBuilder::rectangle([1.0, 0.1], [20, 2])
            .material(LinearElastic::plane_stress(1e8, 0.3).density(1000.0))
            .pin_where(|[x, y]| x == 0.0 && (y - 0.05).abs() < 1e-9, Pin::both());
        let bar = scene.flexible(match is_large {
            true => bar.large_strain(),
            false => bar.small_strain(),
        });
        let (mut given, mut moved, dt) = (0.0, 0.0, scene.dt());
        for step in 1..=60 {
            moved -= 2.0 * dt * dt * f64::from(step);
            let body = &mut scene.bodies[bar];
            body.set_pin_displacement(21, [moved, 0.0])
                .expect("the pin");
            scene.step();
            given += dt * scene.body(bar).total_reaction()[0];
        }
        let grown = 100.0 * scene.body(bar).linvel()[0];
        assert!(
            (given - grown).abs() < 2e-2 * grown.abs(),
            "large {is_large}: {given} N s for {grown}"
        );
    }
}

/// Rapier goes by substeps, each rounded where numbers are coarse: what rides goes as far.
#[test]
fn what_rides_far_from_the_origin_goes_with_its_platform() {
    for x in [0.0, 1000.0, 5000.0] {
        for is_small in [false, true] {
            let mut scene = Scene::new(DT);
            let platform = RigidBodyBuilder::kinematic_velocity_based()
                .linvel(vec2(3.0, 0.0))
                .angvel(0.0);
            let platform = scene.rigid(
                platform.translation(vec2(x, 0.0)),
                ColliderBuilder::cuboid(5.0, 0.5)
                    .translation(vec2(0.0, -0.5))
                    .friction(1.0),
            );
            let rider = FlexBodyBuilder::rectangle([0.8, 0.4], [8, 4])
                .material(LinearElastic::plane_stress(5e5, 0.3).density(1000.0))
                .translation([x - 0.4, 1e-3])
                .linvel([3.0, 0.0])
                .friction(1.0);
            let rider = scene.flexible(match is_small {
                true => rider.small_strain(),
                false => rider,
            });
            let ahead = |scene: &Scene| {
                let platform = scene.world.bodies[platform.0].translation().x;
                scene.body(rider).centre_of_mass()[0] - f64::from(platform)
            };
            scene.steps(60);
            let before = ahead(&scene);
            scene.steps(600);
            let slipped = ahead(&scene) - before;
            assert!(slipped.abs() < 3e-3, "{slipped} m at {x} m, {is_small}");
        }
    }
}
