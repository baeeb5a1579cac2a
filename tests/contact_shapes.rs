//! Every shape of rapier as ground under a flexible block, and as a body on a flexible slab.

mod common;

use common::*;
use foil2d::pipeline::Participant;

/// All shapes with a level top at height zero that a block of one metre can rest on, by name.
fn grounds() -> Vec<(&'static str, ColliderBuilder)> {
    let flat = |x: f64, y: f64| vec2(x, y);
    vec![
        ("cuboid", ColliderBuilder::cuboid(3.0, 0.5).translation(flat(0.0, -0.5))),
        ("round cuboid", ColliderBuilder::round_cuboid(3.0, 0.4, 0.1).translation(flat(0.0, -0.5))),
        ("capsule", ColliderBuilder::capsule_x(3.0, 0.3).translation(flat(0.0, -0.3))),
        ("triangle", ColliderBuilder::triangle(flat(-3.0, 0.0), flat(0.0, -2.0), flat(3.0, 0.0))),
        ("round triangle", ColliderBuilder::round_triangle(flat(-3.0, -0.1), flat(0.0, -2.0), flat(3.0, -0.1), 0.1)),
        ("segment", ColliderBuilder::segment(flat(-3.0, 0.0), flat(3.0, 0.0))),
        ("convex polygon", ColliderBuilder::convex_hull(&[flat(-3.0, 0.0), flat(3.0, 0.0), flat(2.0, -1.0), flat(-2.0, -1.0)]).expect("a hull")),
        ("round convex polygon", ColliderBuilder::round_convex_hull(&[flat(-3.0, -0.1), flat(3.0, -0.1), flat(2.0, -1.0), flat(-2.0, -1.0)], 0.1).expect("a hull")),
        ("half-space", ColliderBuilder::new(SharedShape::halfspace(vec2(0.0, 1.0)))),
        ("polyline", ColliderBuilder::polyline((-3..=3).map(|k| flat(f64::from(k) + 0.03, 0.0)).collect(), None)),
        ("triangle mesh", ColliderBuilder::trimesh(vec![flat(-3.0, 0.0), flat(0.1, 0.0), flat(3.0, 0.0), flat(0.1, -1.0)], vec![[0, 3, 1], [1, 3, 2]]).expect("a mesh")),
        ("height field", ColliderBuilder::heightfield(vec![0.0, 0.0, 0.0, 0.0], vec2(6.0, 1.0))),
        ("compound", ColliderBuilder::compound(vec![
            (Pose::from_translation(vec2(-1.4, -0.5)), SharedShape::cuboid(1.5, 0.5)),
            (Pose::from_translation(vec2(1.6, -0.3)), SharedShape::round_cuboid(1.4, 0.2, 0.1)),
        ])),
    ]
}

fn soft_block() -> FlexBodyBuilder {
    // The damping ratio of the squeezing mode, ω = π/2 · sqrt(E / ρ), is 0.6.
    FlexBodyBuilder::rectangle([1.0, 1.0], [8, 8]).material(
        LinearElastic::plane_stress(1e6, 0.3).density(1000.0).rayleigh(2.4e-2),
    )
}

#[test]
fn a_flexible_block_rests_on_every_shape() {
    for dt in [1.0/60.0, 1.0/240.0] {
    for (name, ground) in grounds() {
        let mut scene = Scene::new(dt);
        let ground = scene.fixed(ground);
        let block = scene.flexible(soft_block().translation([-0.45, 0.05]));
        let mut gap = 0.0f64;
        for _ in 0..(4.0 / dt) as usize {
            gap = gap.max(scene.step().gap_violation());
        }
        let weight = scene.body(block).mass() * G;
        let [fx, fy] = scene.force_on_flexible(block);
        let normal_error = scene.report().contacts().iter().map(|c| { let s = if c.contactor == Participant::Rigid(ground) { -1.0 } else { 1.0 }; (s * c.normal[1] - 1.0).abs() }).fold(0.0, f64::max);
        println!("{dt:.4} {name}: force {:.1e} {:.1e} gap {gap:.1e} normal {normal_error:.1e} contacts {} newton {} y {:.5}", fx / weight, fy / weight - 1.0, scene.report().contacts().len(), scene.report().n_newton(), scene.body(block).centre_of_mass()[1]);
    }}
}

#[test]
fn a_flexible_block_rests_on_two_balls() {
    let mut scene = Scene::new(1.0/60.0);
    for x in [0.0, 1.0] { scene.fixed(ColliderBuilder::ball(0.3).translation(vec2(x, -0.3))); }
    let block = scene.flexible(FlexBodyBuilder::rectangle([1.5, 0.5], [15, 5]).translation([-0.25, 0.05]).material(
        LinearElastic::plane_stress(1e7, 0.3).density(1000.0).rayleigh(1e-2)));
    let mut gap = 0.0f64;
    for _ in 0..300 { gap = gap.max(scene.step().gap_violation()); }
    let weight = scene.body(block).mass() * G;
    println!("two balls {:?} gap {gap:.1e} {:?}", scene.force_on_flexible(block), weight);
    for c in scene.report().contacts() { println!("   {:?} {:?} {:.3}", c.position, c.normal, c.normal_force); }
}

/// Bodies that rest on a slab by themselves.
fn bodies() -> Vec<(&'static str, ColliderBuilder, f64)> {
    let p = vec2;
    vec![
        ("ball", ColliderBuilder::ball(0.2), 0.2),
        ("cuboid", ColliderBuilder::cuboid(0.27, 0.2), 0.2),
        ("round cuboid", ColliderBuilder::round_cuboid(0.22, 0.15, 0.05), 0.2),
        ("capsule", ColliderBuilder::capsule_x(0.27, 0.1), 0.1),
        ("triangle", ColliderBuilder::triangle(p(-0.33, 0.0), p(0.33, 0.0), p(0.0, 0.4)), 0.0),
        ("round triangle", ColliderBuilder::round_triangle(p(-0.33, 0.0), p(0.33, 0.0), p(0.0, 0.4), 0.05), 0.05),
        ("convex polygon", ColliderBuilder::convex_hull(&[p(-0.22, 0.0), p(0.22, 0.0), p(0.4, 0.3), p(-0.4, 0.3)]).expect("a hull"), 0.0),
        ("round convex polygon", ColliderBuilder::round_convex_hull(&[p(-0.22, 0.0), p(0.22, 0.0), p(0.4, 0.3), p(-0.4, 0.3)], 0.05).expect("a hull"), 0.05),
        ("compound", ColliderBuilder::compound(vec![
            (Pose::from_translation(p(-0.3, 0.1)), SharedShape::cuboid(0.12, 0.1)),
            (Pose::from_translation(p(0.3, 0.1)), SharedShape::ball(0.1)),
            (Pose::from_translation(p(0.0, 0.25)), SharedShape::cuboid(0.4, 0.05)),
        ]), 0.0),
    ]
}

#[test]
fn every_shape_rests_on_a_flexible_slab() {
    for (young, dt) in [(1e7, 1.0 / 60.0), (1e7, 1.0 / 240.0), (2e11, 1.0/60.0)] {
    for (name, collider, foot) in bodies() {
        let mut scene = Scene::new(dt);
        let slab = scene.flexible(
            FlexBodyBuilder::rectangle([3.0, 0.5], [30, 5])
                .material(LinearElastic::plane_stress(young, 0.3).density(1000.0).rayleigh(1e-2 * (1e7f64 / young).sqrt()))
                .pin_where(|[_, y]| y == 0.0, Pin::both()),
        );
        let (body, handle) = scene.rigid(
            RigidBodyBuilder::dynamic().translation(vec2(1.437, 0.5 + foot + 0.02)).angular_damping(if name == "ball" { 5.0 } else { 0.0 }),
            collider.density(1000.0),
        );
        let mut gap = 0.0f64;
        for _ in 0..(4.0/dt) as usize { gap = gap.max(scene.step().gap_violation()); }
        let weight = scene.mass(body) * G;
        let [fx, fy] = scene.force_on_collider(handle);
        println!("{young:.0e} {dt:.4} {name}: force {:.1e} {:.1e} gap {gap:.1e} contacts {} newton {} at {:?} angle {:.1e} {}", fx / weight, fy / weight - 1.0, scene.report().contacts().len(), scene.report().n_newton(), scene.world.bodies[body].translation(), scene.world.bodies[body].rotation().angle(), -scene.force_on_flexible(slab)[1] / weight);
    }}
}

#[test]
fn a_moving_platform_carries_a_flexible_block() {
    for young in [1e6, 1e9] {
    let dt = 1.0 / 60.0;
    let mut scene = Scene::new(dt);
    let (platform, _) = scene.world.insert(
        RigidBodyBuilder::kinematic_velocity_based().linvel(vec2(0.8, 0.0)).translation(vec2(0.0, -0.25)),
        ColliderBuilder::cuboid(2.0, 0.25).friction(0.6),
    );
    let block = scene.flexible(FlexBodyBuilder::rectangle([1.0, 1.0], [8, 8]).friction(0.6).translation([-0.5, 0.0]).material(
        LinearElastic::plane_stress(young, 0.3).density(1000.0).rayleigh(2.4e-2 * (1e6f64 / young).sqrt())));
    for k in 0..240 {
        scene.step();
        if k % 60 == 59 { println!("{young:e} {k}: v {:?} f {:?}", scene.body(block).linvel(), scene.force_on_flexible(block)); }
    }
    scene.world.bodies[platform].set_linvel(vec2(0.8, 0.5), true);
    for k in 0..120 {
        scene.step();
        if k % 60 == 59 { println!("{young:e} up {k}: v {:?} f {:?} y {} gap {:.1e}", scene.body(block).linvel(), scene.force_on_flexible(block), scene.body(block).centre_of_mass()[1] - f64::from(scene.world.bodies[platform].translation().y) , scene.report().gap_violation()); }
    }
    }
}
