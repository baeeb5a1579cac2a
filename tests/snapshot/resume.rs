//! Saved and restored, a run is the run it was.

use super::support::*;
use foil2d::fe::material::hyperelastic::{HyperelasticSolid, J2Plasticity, StableNeoHookean};
use foil2d::fe::mesh::CellKind;
use foil2d::kkt::ConstraintFunction;
use foil2d::pipeline::Snapshot;

#[test]
fn three_hundred_steps_saved_and_three_hundred_more_are_six_hundred() {
    let log = Recorder::default();
    let mut straight = everything();
    (0..300).for_each(|_| straight.step(&log));
    let heard = log.take();
    assert!(heard.len() > 20, "the scene has events: {}", heard.len());
    assert!(straight.flex.report().n_asleep() > 0, "something sleeps");
    assert!(
        straight.flex.report().joints().len() > 2,
        "joints and attachments hold"
    );
    assert!(straight.flex.report().contacts().len() > 8, "things touch");
    let mut resumed = straight.resumed();
    assert_same(&straight, &resumed, "after nothing");
    compare(&mut straight, &mut resumed, 300);
}

#[test]
fn a_copy_in_memory_goes_on_like_one_of_bytes() {
    let log = Recorder::default();
    let mut straight = everything();
    (0..100).for_each(|_| straight.step(&log));
    let (world, flex_bodies, flex) = straight.snapshot().restore().expect("a sound one");
    let mut copy = Run {
        world,
        flex_bodies,
        flex,
        n_steps: straight.n_steps,
        held: straight.held,
    };
    compare(&mut straight, &mut copy, 100);
}

/// Saves and restores after every step: no cache may ever decide a bit.
fn step_by_step(mut straight: Run, n_steps: usize) {
    let mut resumed = straight.resumed();
    let mut n_contacts = 0;
    for step in 0..n_steps {
        let (one, other) = (Recorder::default(), Recorder::default());
        straight.step(&one);
        resumed.step(&other);
        assert_eq!(one.take(), other.take(), "events of step {step}");
        assert_same(&straight, &resumed, &format!("after step {step}"));
        resumed = resumed.resumed();
        n_contacts = n_contacts.max(straight.flex.report().contacts().len());
    }
    assert!(n_contacts > 1, "things touch: {n_contacts} contacts");
}

#[test]
fn a_run_restored_after_every_step_never_differs() {
    step_by_step(everything(), 360);
}

#[test]
fn a_run_by_the_trapezoidal_rule_restored_after_every_step_never_differs() {
    let mut run = everything();
    run.flex = FlexPipeline::new().with_integrator(Beta2::trapezoidal());
    step_by_step(run, 150);
}

#[test]
fn a_run_by_constraint_functions_restored_after_every_step_never_differs() {
    let mut run = everything();
    let functions = ConstraintFunction::new(1e-4, 1e-3).expect("sound epsilons");
    run.flex =
        FlexPipeline::new().with_contact_method(ContactMethod::ConstraintFunction(functions));
    step_by_step(run, 100);
}

#[test]
fn a_run_on_links_of_a_multibody_restored_after_every_step_never_differs() {
    let mut run = Run::new();
    let base = run
        .world
        .insert_body(RigidBodyBuilder::fixed().translation(vec2(0.0, 1.0)));
    let link = run.rigid([0.5, 1.0], ColliderBuilder::cuboid(0.5, 0.05));
    let hinge = RevoluteJointBuilder::new()
        .local_anchor2(vec2(-0.5, 0.0))
        .contacts_enabled(false);
    run.world.multibody_joints.insert(base, link, hinge, true);
    let soft = LinearElastic::plane_stress(1e6, 0.3)
        .density(300.0)
        .rayleigh(1e-3);
    let block = FlexBodyBuilder::rectangle([0.3, 0.3], [3, 3]).translation([0.1, 1.051]);
    run.flexible(block.material(soft));
    run.rigid([0.3, 1.46], ColliderBuilder::cuboid(0.1, 0.1));
    step_by_step(run, 120);
}

/// An explicit block remembers internal forces, late forces and half kicks of the step before.
#[test]
fn an_explicit_run_restored_after_every_step_never_differs() {
    let mut run = Run::new();
    run.world.integration_parameters.dt = 1e-4;
    let soft = LinearElastic::plane_stress(1e5, 0.3).density(1000.0);
    let damped = soft.rayleigh(1e-5).rayleigh_mass(0.5);
    let kept = FlexBodyBuilder::rectangle([0.5, 0.5], [5, 5])
        .small_strain()
        .translation([0.0, 0.002])
        .linvel([0.3, -1.0]);
    run.flexible(kept.material(damped).contact_inertia(ContactInertia::Kept));
    let moved = FlexBodyBuilder::rectangle([0.5, 0.5], [5, 5])
        .small_strain()
        .rotation(0.2)
        .translation([1.5, 0.002])
        .linvel([0.3, -1.0]);
    run.flexible(moved.material(damped));
    run.rigid([0.25, 0.65], ColliderBuilder::ball(0.14));
    run.flex = FlexPipeline::new().with_integrator(Beta2::central_difference());
    step_by_step(run, 400);
}

#[test]
fn a_world_saved_asleep_wakes_as_it_would_have() {
    let log = Recorder::default();
    let mut straight = Run::new();
    let stiff = elastic(1e8, 1000.0, 5e-3);
    let block = FlexBodyBuilder::rectangle([0.5, 0.25], [4, 2]).translation([-10.0, 0.001]);
    let block = straight.flexible(block.material(stiff).friction(0.5));
    straight.rigid([-9.75, 0.46], ColliderBuilder::cuboid(0.2, 0.2));
    let is_asleep = |run: &Run| {
        let carrier = run.flex_bodies[block].rigid_body_handle();
        run.world.bodies[carrier].is_sleeping()
    };
    let woken = (0..900).find(|_| {
        straight.step(&log);
        is_asleep(&straight)
    });
    assert!(woken.is_some(), "the block falls asleep");
    (0..5).for_each(|_| straight.step(&log));
    let mut resumed = straight.resumed();
    compare(&mut straight, &mut resumed, 5);
    assert!(is_asleep(&resumed), "it still sleeps");
    for run in [&mut straight, &mut resumed] {
        run.rigid([-9.7, 1.5], ColliderBuilder::ball(0.1));
    }
    compare(&mut straight, &mut resumed, 200);
}

/// Bodies come and go: vacant slots, and handles that were given before.
#[test]
fn handles_are_valid_after_a_restore_and_new_ones_are_those_of_the_straight_run() {
    let log = Recorder::default();
    let mut straight = everything();
    (0..10).for_each(|_| straight.step(&log));
    let handles: Vec<_> = straight
        .flex_bodies
        .iter()
        .map(|(handle, _)| handle)
        .collect();
    straight
        .flex_bodies
        .remove(handles[2], &mut straight.world)
        .expect("it is there");
    straight.step(&log);
    let mut resumed = straight.resumed();
    assert!(
        resumed.flex_bodies.get(handles[2]).is_none(),
        "its handle is stale"
    );
    let one = resumed.flex_bodies[handles[1]].positions();
    assert_eq!(one, straight.flex_bodies[handles[1]].positions());
    for run in [&mut straight, &mut resumed] {
        let added = FlexBodyBuilder::rectangle([0.4, 0.4], [4, 4]).translation([-6.0, 1.0]);
        let handle = run.flexible(added.material(rubber()));
        assert_eq!(handle.into_raw_parts(), (2, 1));
    }
    compare(&mut straight, &mut resumed, 60);
}

#[test]
fn changes_that_wait_for_the_next_step_are_saved_too() {
    let log = Recorder::default();
    let mut straight = everything();
    (0..120).for_each(|_| straight.step(&log));
    let added = FlexBodyBuilder::rectangle([0.4, 0.4], [4, 4]).translation([-6.0, 3.0]);
    let added = straight.flexible(added.material(rubber()).angvel(3.0));
    straight.rigid([5.5, 2.0], ColliderBuilder::ball(0.2));
    let (slider, body) = straight.flex_bodies.iter_mut().nth(1).expect("it is there");
    body.set_nodal_force(0, [0.0, 50.0]).expect("it has a node");
    body.apply_impulse_at_node(1, [0.0, 2.0])
        .expect("it has two");
    body.set_velocities(&vec![0.5; 2 * body.n_nodes()])
        .expect("two a node");
    let spring = AttachmentBuilder::spring_damper(added, 1e3, 10.0)
        .node(0)
        .to_flexible(slider);
    straight
        .flex_bodies
        .attach(spring, &straight.world.bodies)
        .expect("it is sound");
    let moved = straight
        .world
        .bodies
        .iter_mut()
        .find(|(_, body)| body.is_dynamic() && !body.is_sleeping() && body.mass() > 0.0);
    let (_, moved) = moved.expect("something moves");
    moved.set_linvel(vec2(0.3, 1.0), true);
    let mut resumed = straight.resumed();
    compare(&mut straight, &mut resumed, 200);
}

/// A sensor is left in the detection step of a step that is then refused: that it was left waits for a step that is taken.
#[test]
fn what_waits_to_be_told_of_a_sensor_is_saved_too() {
    let log = Recorder::default();
    let mut straight = Run::new();
    let block = FlexBodyBuilder::rectangle([1.0, 1.0], [4, 4]).translation([0.0, 0.001]);
    straight.flexible(block.material(rubber()));
    let top = straight.rigid([0.5, 1.202], ColliderBuilder::cuboid(0.2, 0.2));
    let gate = ColliderBuilder::cuboid(0.5, 0.5)
        .translation(vec2(8.0, 0.5))
        .sensor(true)
        .active_events(ActiveEvents::COLLISION_EVENTS);
    let gate = straight.world.insert_collider(gate, None);
    let ball = straight.rigid([8.0, 0.3], ColliderBuilder::ball(0.2));
    (0..10).for_each(|_| straight.step(&log));
    let met = log.collisions();
    log.take();
    let is_gate = |event: &CollisionEvent| [event.collider1(), event.collider2()].contains(&gate);
    assert_eq!(
        met.iter().filter(|event| is_gate(event)).count(),
        1,
        "{met:?}"
    );
    straight.world.bodies[ball].set_translation(vec2(20.0, 0.3), true);
    straight.world.bodies[top].add_force(vec2(f64::NAN, 0.0), true);
    straight
        .flex
        .step_with_events(
            &mut straight.world,
            &mut straight.flex_bodies,
            &Ageing,
            &log,
        )
        .expect_err("a force that is no number");
    assert!(log.take().is_empty(), "nothing has happened yet");
    let mut resumed = straight.resumed();
    for run in [&mut straight, &mut resumed] {
        run.world.bodies[top].reset_forces(true);
        run.step(&log);
        let told = log.collisions();
        log.take();
        let is_gate =
            |event: &CollisionEvent| [event.collider1(), event.collider2()].contains(&gate);
        let left = told
            .iter()
            .filter(|event| event.stopped() && is_gate(event));
        assert_eq!(left.count(), 1, "{told:?}");
    }
    compare(&mut straight, &mut resumed, 60);
}

/// Their factors are of the state that each step begins with, and of nothing before.
#[test]
fn bodies_of_large_strain_restored_after_every_step_never_differ() {
    let mut run = everything();
    let law = StableNeoHookean::plane_strain(1e5, 0.3);
    let rope = FlexBodyBuilder::rectangle_of([1.0, 0.1], [8, 1], CellKind::Tri6)
        .material(HyperelasticSolid::new(law).with_density(1000.0))
        .translation([0.0, 6.0])
        .angvel(3.0);
    run.flex_bodies
        .insert(rope, &mut run.world)
        .expect("the description is right");
    step_by_step(run, 120);
}

/// Surfaces have their mass in the air, and none at the ground.
#[test]
fn bodies_of_small_strain_that_bounce_restored_after_every_step_never_differ() {
    let mut run = everything();
    let bar = FlexBodyBuilder::rectangle([1.0, 0.3], [10, 3])
        .small_strain()
        .material(rubber())
        .restitution(1.0)
        .translation([-0.5, 8.0])
        .linvel([0.0, -20.0])
        .angvel(2.0);
    let bar = run
        .flex_bodies
        .insert(bar, &mut run.world)
        .expect("the description is right");
    let has_mass = |run: &Run| !run.flex_bodies[bar].model().has_massless_nodes();
    assert!(has_mass(&run));
    let mut touched = run.resumed();
    let log = Recorder::default();
    let n_steps = (0..200)
        .take_while(|_| {
            touched.step(&log);
            has_mass(&touched)
        })
        .count();
    assert!((2..100).contains(&n_steps), "{n_steps} steps in the air");
    step_by_step(run, n_steps + 60);
}

/// A bar that its spin pulls in two, but for its hardening: what has flowed, and what is flowing.
#[test]
fn a_body_that_flows_restored_after_every_step_never_differs() {
    for kind in [CellKind::Tri6, CellKind::Quad4] {
        let mut run = everything();
        let law = J2Plasticity::plane_strain(1e5, 0.3, 100.0).with_hardening(2e4);
        let bar = FlexBodyBuilder::rectangle_of([1.0, 0.1], [8, 1], kind)
            .material(HyperelasticSolid::new(law).with_density(1000.0))
            .translation([0.0, 6.0])
            .angvel(5.0);
        let bar = run
            .flex_bodies
            .insert(bar, &mut run.world)
            .expect("the description is right");
        let log = Recorder::default();
        (0..4).for_each(|_| run.step(&log));
        let flowed = run.flex_bodies[bar].max_plastic_strain();
        assert!(flowed > 0.0, "{flowed}");
        assert!(run.flex.report().energy().flowed > 0.0);
        step_by_step(run, 60);
    }
}

/// Regions, a gas and plastic flow in one body.
#[test]
fn a_ring_of_metal_and_rubber_with_a_gas_restored_after_every_step_never_differs() {
    let mut run = everything();
    let law = J2Plasticity::plane_strain(2e5, 0.3, 50.0).with_hardening(4e4);
    let ring = FlexBodyBuilder::annulus(0.3, 0.5, 0.1)
        .material(rubber())
        .regions_by(|[x, y]| u32::from(x * x + y * y > 0.16))
        .region_material(
            1,
            HyperelasticSolid::new(law)
                .with_density(2000.0)
                .with_damping(Material::rayleigh(&rubber())),
        )
        .inner_pressure(InnerPressure::isothermal(500.0))
        .translation([0.0, 6.0])
        .angvel(3.0);
    let ring = run.flex_bodies.insert(ring, &mut run.world);
    let ring = ring.expect("the description is right");
    let log = Recorder::default();
    (0..20).for_each(|_| run.step(&log));
    assert!(run.flex_bodies[ring].max_plastic_strain() > 0.0);
    step_by_step(run, 40);
}

/// One of Hooke's law, among others.
#[test]
fn a_body_of_hookes_law_at_large_strain_restored_after_every_step_never_differs() {
    let mut run = everything();
    let jelly = FlexBodyBuilder::rectangle([0.4, 0.4], [3, 3])
        .material(LinearElastic::plane_stress(1e5, 0.3).density(1000.0))
        .large_strain()
        .translation([0.3, 6.5]);
    run.flex_bodies
        .insert(jelly, &mut run.world)
        .expect("the description is right");
    step_by_step(run, 120);
}

/// Enough contacts for the sparse problem, which goes on from patterns and factors of the step before.
#[test]
fn a_pile_restored_after_every_step_never_differs() {
    let mut run = Run::new();
    let plank = FlexBodyBuilder::rectangle([3.0, 0.2], [24, 2])
        .pin_where(|[x, _]| x == 0.0 || x == 3.0, Pin::both())
        .translation([-1.5, 0.5]);
    run.flexible(plank.material(rubber()).friction(0.5));
    for row in 0..5 {
        for column in 0..5 {
            let [x, y] = [f64::from(column), f64::from(row)];
            let at = [-1.0 + 0.45 * x + 0.07 * y, 1.0 + 0.42 * y];
            run.rigid(at, ColliderBuilder::cuboid(0.2, 0.2));
        }
    }
    step_by_step(run, 120);
}

/// Two islands of bodies of large and of small strain, whose sparse problems are kept beside each other; some boxes hang together.
#[test]
fn soft_piles_restored_after_every_step_never_differ() {
    let mut run = Run::new();
    let soft = LinearElastic::plane_stress(2e5, 0.3).density(500.0);
    for (x, is_small) in [(-3.0, false), (3.0, true)] {
        for row in 0..5 {
            let builder = FlexBodyBuilder::rectangle([0.6, 0.4], [3, 2]);
            let builder = match is_small {
                true => builder.small_strain(),
                false => builder,
            };
            let at = [x + 0.05 * f64::from(row), 0.22 + 0.43 * f64::from(row)];
            run.flexible(builder.material(soft).friction(0.5).translation(at));
        }
        let above = |row: f64| [x + 0.1, 2.5 + 0.45 * row];
        let [one, other] =
            [0.0, 1.0].map(|row| run.rigid(above(row), ColliderBuilder::cuboid(0.2, 0.2)));
        let hinge = RevoluteJointBuilder::new()
            .local_anchor1(vec2(0.2, 0.225))
            .local_anchor2(vec2(0.2, -0.225));
        run.world.insert_impulse_joint(one, other, hinge);
    }
    // Rapier saves joints when their islands know them.
    run.step(&Recorder::default());
    step_by_step(run, 100);
}

/// Gases and constant pressures, of which one is changed on the way, are saved with their bodies.
#[test]
fn inner_pressures_are_saved() {
    let mut world = PhysicsWorld::new();
    let floor = ColliderBuilder::cuboid(5.0, 0.5).translation(vec2(0.0, -0.5));
    world.insert_collider(floor, None);
    let mut flex_bodies = FlexBodySet::new();
    let rubber = LinearElastic::plane_strain(1e6, 0.4).density(1000.0);
    let mut tyres = Vec::new();
    for (place, pressure) in [
        InnerPressure::adiabatic(2e4, 1.4).outside(9e4),
        InnerPressure::constant(1e4),
    ]
    .into_iter()
    .enumerate()
    {
        let tyre = FlexBodyBuilder::annulus(0.25, 0.3, 0.1)
            .material(rubber)
            .inner_pressure(pressure)
            .linvel([0.3, 0.0])
            .translation([place as f64, 0.4]);
        let tyre = flex_bodies.insert(tyre, &mut world);
        tyres.push(tyre.expect("the description is right"));
    }
    let mut flex = FlexPipeline::new();
    for _ in 0..20 {
        flex.step(&mut world, &mut flex_bodies).expect("a step");
    }
    let body = flex_bodies.get_mut(tyres[1]).expect("it is there");
    body.set_inner_pressure(0, InnerPressure::isothermal(3e4))
        .expect("a gas");
    let saved = Snapshot::take(&world, &flex_bodies, &flex).expect("all laws are built in");
    let (mut other_world, mut others, mut other_flex) = saved.restore().expect("a sound one");
    for step in 0..40 {
        flex.step(&mut world, &mut flex_bodies).expect("a step");
        let outcome = other_flex.step(&mut other_world, &mut others);
        outcome.expect("a step");
        let same = motion_bits(&world, &flex_bodies) == motion_bits(&other_world, &others);
        assert!(same, "step {step}");
    }
    for tyre in tyres {
        let pressure = flex_bodies[tyre].gas_pressure(0).expect("a hole");
        assert_eq!(others[tyre].gas_pressure(0), Ok(pressure));
        assert!(pressure > 5e3);
    }
}
