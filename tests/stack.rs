//! Stacks: heavy on light on flexible, and forces that a statically indeterminate box spreads evenly.

mod common;

use common::*;

/// Beam of 4 m × 0.2 m whose lower corners are pinned, damped in its bending.
fn beam(young: f64, cells: [usize; 2]) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle([4.0, 0.2], cells)
        .material(
            LinearElastic::plane_stress(young, 0.3)
                .density(1000.0)
                .rayleigh(0.02),
        )
        .pin_where(|[x, y]| y == 0.0 && (x == 0.0 || x == 4.0), Pin::both())
}

fn boxed(scene: &mut Scene, at: [f64; 2], half: [f64; 2], mass: f64) -> (RigidBodyHandle, ColliderHandle) {
    scene.rigid(
        RigidBodyBuilder::dynamic().translation(vec2(at[0], at[1])),
        ColliderBuilder::cuboid(real(half[0]), real(half[1]))
            .density(0.0)
            .mass(real(mass))
            .friction(0.5),
    )
}

#[test]
fn three_boxes_with_the_heaviest_on_top_stand_on_a_beam_for_a_minute() {
    let mut scene = Scene::new(1.0 / 60.0);
    let beam = scene.flexible(beam(1e10, [40, 4]));
    let masses = [10.0, 10.0, 10_000.0];
    let boxes: Vec<_> = (0..3)
        .map(|k| boxed(&mut scene, [2.0, 0.4 + 0.4 * k as f64], [0.2, 0.2], masses[k]))
        .collect();
    let mut worst = [0.0f64; 3];
    for step in 0..3600 {
        scene.step();
        if step < 3000 { continue; }
        let support = scene.force_on_flexible(beam)[1];
        let total: f64 = masses.iter().sum::<f64>() * G;
        worst[0] = worst[0].max((-support / total - 1.0).abs());
        // The middle interfaces: what a box gets from below is what it carries.
        for k in 1..3 {
            let above: f64 = masses[k..].iter().sum::<f64>() * G;
            let force: f64 = scene.report().contacts().iter().filter_map(|c| {
                let own = foil2d::pipeline::Participant::Rigid(boxes[k].1);
                let below = foil2d::pipeline::Participant::Rigid(boxes[k - 1].1);
                let sign = if (c.contactor, c.target) == (own, below) { 1.0 } else if (c.contactor, c.target) == (below, own) { -1.0 } else { return None };
                Some(sign * (c.normal_force * c.normal[1] + c.tangential_force * c.normal[0]))
            }).sum();
            worst[k] = worst[k].max((force / above - 1.0).abs());
        }
    }
    for (k, (body, _)) in boxes.iter().enumerate() {
        let body = &scene.world.bodies[*body];
        println!("box {k}: at {:?} angle {:.2e} v {:?}", body.translation(), body.rotation().angle(), body.linvel());
    }
    println!("worst {worst:?} reaction {:?} gap {:.1e} lim {:.1e}", scene.body(beam).total_reaction(), scene.report().gap_violation(), scene.report().energy_limited());
}

#[test]
fn a_body_a_million_times_heavier_on_a_light_one_presses_with_the_total_weight() {
    for (young, dt) in [(1e9, 1.0 / 60.0), (1e11, 1.0 / 60.0), (1e11, 1.0 / 500.0)] {
    let mut scene = Scene::new(dt);
    scene.ground(0.5);
    let block = scene.flexible(
        FlexBodyBuilder::rectangle([1.0, 1.0], [8, 8]).material(
            LinearElastic::plane_stress(young, 0.3).density(1000.0).rayleigh(5e-3),
        ),
    );
    let (light, _) = boxed(&mut scene, [0.5, 1.1], [0.3, 0.1], 1.0);
    let (heavy, _) = boxed(&mut scene, [0.5, 1.5], [0.3, 0.3], 1e6);
    let total = G * (1e6 + 1.0 + 1000.0);
    let mut worst = 0.0f64;
    for step in 0..(20.0 / dt) as usize {
        scene.step();
        if step >= (18.0/dt) as usize {
            worst = worst.max((scene.report().contacts().iter().filter(|c| c.position[1].abs() < 0.1).map(|c| c.normal_force).sum::<f64>() / total - 1.0).abs());
        }
    }
    println!("E {young:.0e} dt {dt}: {worst:.2e} light {:?} heavy {:?} {} {}", scene.world.bodies[light].translation(), scene.world.bodies[heavy].translation(), scene.report().n_newton(), scene.report().contacts().len());
    }
}

#[test]
fn a_box_on_four_points_presses_evenly() {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    let block = scene.flexible(
        FlexBodyBuilder::rectangle([2.0, 0.5], [16, 4]).material(
            LinearElastic::plane_stress(1e8, 0.3).density(1000.0).rayleigh(5e-3),
        ),
    );
    let body = scene.world.insert_body(RigidBodyBuilder::dynamic().translation(vec2(1.0, 0.7)).can_sleep(false));
    for x in [-0.5, 0.5] {
        scene.world.insert_collider(ColliderBuilder::cuboid(0.125, 0.2).translation(vec2(x, 0.0)).density(1000.0), Some(body));
    }
    scene.steps(1200);
    for c in scene.report().contacts() {
        println!("{:?} {:?} f {:.4} {:.4} {:?}", c.position, c.normal, c.normal_force, c.tangential_force, c.sticks);
    }
    println!("on block {:?} of {} + {}", scene.force_on_flexible(block), scene.mass(body) * G, scene.body(block).mass()*G);
}
#[test]
fn trace() {
    for (masses, mu, span) in [(vec![10.0], 0.5, 0.4), (vec![10.0, 10.0], 0.5, 0.4), (vec![10.0, 1000.0], 0.5, 0.4), (vec![10.0, 1000.0], 0.0, 0.4)] {
        let mut scene = Scene::new(1.0 / 60.0);
        let beam = scene.flexible(beam(1e10, [40, 4]));
        let boxes: Vec<_> = masses.iter().enumerate()
            .map(|(k, m)| boxed(&mut scene, [2.03, span + 0.4 * k as f64], [0.2, 0.2], *m))
            .collect();
        println!("{masses:?} {mu}");
        for k in 0..600 {
            scene.step();
            let r = scene.report();
            if k < 6 || k % 60 == 0 {
                print!("{k}: F {:.5} newton {} res {:.1e} gap {:.1e} lim {:.1e} contacts {} ", -scene.force_on_flexible(beam)[1] / (masses.iter().sum::<f64>() * G), r.n_newton(), r.solver_residual(), r.gap_violation(), r.energy_limited(), r.contacts().len());
                for (b, _) in &boxes { let b = &scene.world.bodies[*b]; print!("[{:.5} {:.5} a {:.1e} v {:.1e} {:.1e} w {:.1e}] ", b.translation().x, b.translation().y, b.rotation().angle(), b.linvel().x, b.linvel().y, b.angvel()); }
                if k < 6 { for c in r.contacts() { print!("{:?} {:.1}/{:.1} ", c.position, c.normal_force, c.tangential_force); } }
                println!();
            }
        }
    }
}
