//! Soft bodies of rapier described as flexible bodies: the same triangles, mass and moduli, and statics that are right.

mod common;

use common::*;
use foil2d::coupling::SoftBodyError;
use foil2d::large::{LargeSettings, LoadCase, LoadStepper};
use std::sync::Arc;

const YOUNG: f64 = 1e6;
const POISSON: f64 = 0.3;

/// A grid of triangles with moduli: `size` (m) about `centre`, `[nx, ny]` particles.
fn grid(centre: [f64; 2], size: [f64; 2], [nx, ny]: [usize; 2]) -> SoftBodyBuilder {
    let half = vec2(0.5 * size[0], 0.5 * size[1]);
    let mut body = SoftBodyBuilder::grid(vec2(centre[0], centre[1]), half, nx, ny)
        .cell_model(SoftBodyCellModel::Corotational)
        .mass((1000.0 * size[0] * size[1]) as _);
    body.material.young_modulus = YOUNG as _;
    body.material.poisson_ratio = POISSON as _;
    body
}

#[test]
fn a_soft_body_becomes_a_body_of_its_particles_cells_and_mass() {
    for cell_model in [
        SoftBodyCellModel::Corotational,
        SoftBodyCellModel::NeoHookean,
    ] {
        let soft = grid([1.0, 2.0], [1.5, 0.5], [7, 4]).cell_model(cell_model);
        let mut scene = Scene::in_free_space(1.0 / 60.0);
        let body = FlexBodyBuilder::from_soft_body(&soft, CellKind::Tri3).expect("it has moduli");
        let body = scene.flexible(body);
        let body = scene.body(body);
        assert!((body.mass() / 750.0 - 1.0).abs() < 1e-6);
        assert_eq!(body.n_nodes(), soft.positions.len());
        for (node, at) in soft.positions.iter().enumerate() {
            assert_eq!(body.position(node), [f64::from(at.x), f64::from(at.y)]);
        }
        assert_eq!(body.mesh().n_cells(), soft.cells.len());
        for (cell, soft) in body.mesh().cells().zip(&soft.cells) {
            let mut nodes = cell.nodes.to_vec();
            let mut particles = soft.map(|particle| particle as usize).to_vec();
            nodes.sort_unstable();
            particles.sort_unstable();
            assert_eq!(nodes, particles);
        }
        let law = body.large().expect("of large strain").law();
        let is_corotated = cell_model == SoftBodyCellModel::Corotational;
        assert_eq!(
            law.name().contains("orotated"),
            is_corotated,
            "{}",
            law.name()
        );
        let constants = law.constants();
        let expected = YOUNG / (2.0 * (1.0 + POISSON));
        assert!((constants.mu() / expected - 1.0).abs() < 1e-6);
        let expected = YOUNG * POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON));
        assert!((constants.lambda() / expected - 1.0).abs() < 1e-6);
    }
}

/// The tip of a cantilever under a load at its end, against the beam of plane strain with its shear.
#[test]
fn the_statics_of_a_soft_cantilever_are_right() {
    let (length, height, load) = (4.0, 0.4, 2.0);
    let [nx, ny] = [33, 5];
    let mut soft = grid([0.5 * length, 0.0], [length, height], [nx, ny]);
    soft.pinned = (0..ny as u32).collect();
    let mut scene = Scene::in_free_space(1.0 / 60.0);
    let body = FlexBodyBuilder::from_soft_body(&soft, CellKind::Tri6).expect("it has moduli");
    let end = (nx - 1) * ny;
    let body = (end..end + ny).fold(body, |body, node| {
        body.nodal_force(node, [0.0, -load / ny as f64])
    });
    let body = scene.flexible(body);
    let held = scene.body(body).fixed_dofs().iter().filter(|&&held| held);
    assert_eq!(
        held.count(),
        2 * (2 * ny - 1),
        "corners and middles of the left side"
    );
    let body = scene.body(body);
    let model = body.large().expect("of large strain");
    let mut at = model.rest_positions().to_vec();
    let case = LoadCase {
        from: &vec![0.0; at.len()],
        to: body.nodal_forces(),
        is_held: body.fixed_dofs(),
        places: &at.clone(),
        n_increments: 1,
    };
    LoadStepper::new(Arc::clone(model), LargeSettings::conserving())
        .and_then(|mut statics| statics.solve(case, &mut at))
        .expect("an equilibrium");
    let tip = -at[2 * (end + ny / 2) + 1];
    let stiff = YOUNG / (1.0 - POISSON * POISSON);
    let shear = YOUNG / (2.0 * (1.0 + POISSON));
    let bending = load * length.powi(3) / (3.0 * stiff * height.powi(3) / 12.0);
    let expected = bending + load * length / (5.0 / 6.0 * shear * height);
    assert!(
        (tip / expected - 1.0).abs() < 1e-2,
        "{tip} m against {expected} m"
    );
}

/// One right triangle of unit legs: its three strains, by hand.
#[test]
fn the_damping_ratio_becomes_the_stiffness_damping_that_rapier_gives_its_cells() {
    let corners = vec![vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(0.0, 1.0)];
    let mut soft = SoftBodyBuilder::new(corners)
        // Clockwise: rapier turns it.
        .cells(vec![[0, 2, 1]])
        .cell_model(SoftBodyCellModel::Corotational)
        .particle_mass(2.0)
        .linear_damping(0.25);
    soft.material.young_modulus = 1e4;
    soft.material.poisson_ratio = 0.25;
    soft.material.elastic_damping_ratio = 0.5;
    let body = FlexBodyBuilder::from_soft_body(&soft, CellKind::Tri3).expect("it has moduli");
    let body = body.build().expect("a body");
    let (shear, lame): (f64, f64) = (4e3, 4e3);
    let area = 0.5;
    // Gradients (-1, -1), (1, 0), (0, 1), over 2 kg each.
    let normal = ((2.0 * shear + lame) * area * (1.0 + 1.0) / 2.0).sqrt();
    let sheared = (4.0 * shear * area * 0.25 * (2.0 + 1.0 + 1.0) / 2.0).sqrt();
    let expected = 2.0 * 0.5 / ((2.0 * normal + sheared) / 3.0);
    let found = body.model().material().rayleigh();
    assert!((found.stiffness / expected - 1.0).abs() < 1e-6);
    assert_eq!(found.mass, 0.25);
    assert!((body.mass() - 6.0).abs() < 1e-12);
}

/// A blob of rapier's and the body made of it, each dropped by itself, come to rest with their middles at the same height.
#[test]
fn a_soft_blob_and_the_body_made_of_it_sag_alike() {
    let soft = grid([0.0, 0.52], [1.0, 1.0], [13, 13]);
    let heights = [false, true].map(|is_flexible| {
        let mut scene = Scene::new(1.0 / 60.0);
        scene.ground(0.5);
        scene.world.integration_parameters.dt = (1.0 / 240.0) as _;
        if is_flexible {
            let body = FlexBodyBuilder::from_soft_body(&soft, CellKind::Tri3).expect("moduli");
            let body = scene.flexible(body);
            scene.steps(1200);
            scene.body(body).centre_of_mass()[1]
        } else {
            let body = scene.world.insert_soft_body(soft.clone());
            scene.steps(1200);
            f64::from(scene.world.soft_bodies[body].center_of_mass().y)
        }
    });
    let [own, flexible] = heights;
    assert!((own - flexible).abs() < 5e-4, "{own} and {flexible} m");
    let unloaded = 0.5 + f64::from(soft.particle_radius);
    assert!(flexible < unloaded - 2e-3, "it sags: {flexible} m");
}

/// Two columns of three blobs in a bin that keeps them upright: rapier's, and the bodies made of them. The lowest carry three times their weight, so that moduli are seen: the columns
/// sink by 46 mm. Rapier's iterations leave some of the stiffness of the triangles over, about 3 % here.
#[test]
fn a_pile_of_soft_blobs_and_of_the_bodies_made_of_them_rest_alike() {
    let (side, young) = (0.5, 2e5);
    let blobs: Vec<SoftBodyBuilder> = (0..6)
        .map(|k| {
            let [column, row] = [f64::from(k % 2), f64::from(k / 2)];
            let at = [(column - 0.5) * 1.01 * side, (row + 0.5) * 1.02 * side];
            let mut blob = grid(at, [side, side], [7, 7]).particle_radius(1e-3);
            blob.material.young_modulus = young as _;
            blob
        })
        .collect();
    let heights = [false, true].map(|is_flexible| {
        let mut scene = Scene::new(1.0 / 240.0);
        scene.ground(0.5);
        for x in [-0.76, 0.76] {
            let wall = ColliderBuilder::cuboid(0.25, 2.0).translation(vec2(x, 2.0));
            scene.fixed(wall.friction(0.0));
        }
        if is_flexible {
            let bodies: Vec<_> = blobs
                .iter()
                .map(|blob| {
                    let body = FlexBodyBuilder::from_soft_body(blob, CellKind::Tri3);
                    scene.flexible(body.expect("it has moduli"))
                })
                .collect();
            scene.steps(1200);
            assert!(is_solved(scene.report()));
            let heights = bodies
                .iter()
                .map(|&body| scene.body(body).centre_of_mass()[1]);
            heights.collect::<Vec<f64>>()
        } else {
            let bodies: Vec<_> = blobs
                .iter()
                .map(|blob| scene.world.insert_soft_body(blob.clone()))
                .collect();
            scene.steps(1200);
            let soft = &scene.world.soft_bodies;
            let heights = bodies
                .iter()
                .map(|&body| f64::from(soft[body].center_of_mass().y));
            heights.collect()
        }
    });
    let [own, flexible] = heights;
    for (k, (own, flexible)) in own.iter().zip(&flexible).enumerate() {
        let [below, radius] = [(k / 2) as f64, 1e-3];
        let unloaded = (below + 0.5) * side + (2.0 * below + 1.0) * radius;
        let [own, flexible] = [unloaded - own, unloaded - flexible];
        assert!(flexible > 0.01, "it is pressed: {flexible} m");
        assert!(
            (own / flexible - 1.0).abs() < 0.05,
            "blob {k} sinks by {own} and {flexible} m"
        );
    }
}

#[test]
fn what_holds_a_soft_body_holds_the_body_made_of_it() {
    let mut scene = Scene::new(1.0 / 60.0);
    let hook = scene
        .world
        .bodies
        .insert(RigidBodyBuilder::fixed().translation(vec2(0.0, 3.0)));
    let soft = grid([0.0, 2.0], [1.0, 1.0], [5, 5]);
    let handle = scene.world.insert_soft_body(soft.clone());
    // The middle of the top.
    let particle = 2 * 5 + 4;
    let world = &mut scene.world;
    world.soft_bodies[handle].attach_particle(particle, hook, &world.bodies);
    let body = FlexBodyBuilder::from_soft_body(&soft, CellKind::Tri6).expect("it has moduli");
    let body = scene.flexible(body);
    let soft_body = &scene.world.soft_bodies[handle];
    let attachments = AttachmentBuilder::of_soft_body(soft_body, body);
    assert_eq!(attachments.len(), 1);
    scene.world.remove_soft_body(handle);
    for attachment in attachments {
        let held = scene.bodies.attach(attachment, &scene.world.bodies);
        held.expect("it is where the particle is");
    }
    scene.steps(120);
    let [x, y] = scene.body(body).position(particle);
    assert!(
        x.abs() < 1e-3 && (y - 2.5).abs() < 1e-3,
        "it hangs at {x}, {y}"
    );
    assert!(scene.body(body).centre_of_mass()[1] > 1.8);
}

#[test]
fn what_has_no_counterpart_is_refused_by_its_name() {
    let whole = || grid([0.0, 0.0], [1.0, 1.0], [3, 3]);
    let refused = |soft: SoftBodyBuilder| {
        FlexBodyBuilder::from_soft_body(&soft, CellKind::Tri3).expect_err("it is refused")
    };
    let named = |change: &dyn Fn(&mut SoftBodyBuilder), name: &str| {
        let mut soft = whole();
        change(&mut soft);
        match refused(soft) {
            SoftBodyError::NoCounterpart { what, .. } => assert!(what.contains(name), "{what}"),
            other => panic!("{name}: {other}"),
        }
    };
    named(&|soft| soft.edges = vec![[0, 1]], "edges");
    named(&|soft| soft.bend_edges = vec![[0, 2]], "bend_edges");
    named(&|soft| soft.volume_factor = 1.5, "volume_factor");
    named(
        &|soft| soft.volume_preservation = true,
        "volume_preservation",
    );
    named(&|soft| soft.shape_matching = true, "shape_matching");
    named(&|soft| soft.material.plastic_yield = 0.1, "plastic_yield");
    named(&|soft| soft.material.tear_strain = Some(0.5), "tear_strain");
    named(&|soft| soft.material.tear_force = Some(0.5), "tear_force");
    named(
        &|soft| soft.material.deformation_damping = 1.0,
        "deformation_damping",
    );
    named(
        &|soft| soft.particle_settings.dominance_group = 1,
        "dominance_group",
    );
    let skin = || Some((vec![vec2(0.0, 0.0), vec2(1.0, 0.0)], vec![[0, 1]]));
    named(
        &|soft| (soft.skin, soft.skin_collision) = (skin(), true),
        "skin_collision",
    );
    let rope = SoftBodyBuilder::rope(vec2(0.0, 0.0), vec2(1.0, 0.0), 5);
    assert_eq!(refused(rope), SoftBodyError::NoCells);
    let springs = whole().cell_model(SoftBodyCellModel::Volume);
    assert_eq!(refused(springs), SoftBodyError::NoModulus);
    assert_eq!(
        refused(whole().particle_mass(0.0).masses(vec![])),
        SoftBodyError::Mass(0.0)
    );
    let mut foreign = whole();
    foreign.cells.push([0, 1, 99]);
    assert_eq!(
        refused(foreign),
        SoftBodyError::Particle {
            particle: 99,
            n_particles: 9
        }
    );
    let quadrilaterals = FlexBodyBuilder::from_soft_body(&whole(), CellKind::Quad4);
    assert_eq!(
        quadrilaterals.expect_err("triangles"),
        SoftBodyError::Kind(CellKind::Quad4)
    );
    let mut flat = whole();
    flat.positions.iter_mut().for_each(|at| at.y = 0.0);
    assert!(matches!(refused(flat), SoftBodyError::Mesh(_)));
}

#[test]
fn the_surface_meets_as_the_soft_bodys_collider_does() {
    let group = InteractionGroups::new(Group::GROUP_2, Group::GROUP_3, InteractionTestMode::And);
    let template = ColliderBuilder::ball(0.1)
        .friction(0.9)
        .restitution(0.25)
        .collision_groups(group)
        .sensor(true);
    let soft = grid([0.0, 0.0], [1.0, 1.0], [3, 3])
        .surface_collider(template)
        .particle_radius(0.01);
    let body = FlexBodyBuilder::from_soft_body(&soft, CellKind::Tri3).expect("it has moduli");
    let body = body.build().expect("a body");
    let settings = body.contact_settings();
    assert!((settings.friction - 0.9).abs() < 1e-7);
    assert_eq!(settings.restitution, 0.25);
    assert_eq!(settings.collision_groups, group);
    assert!((settings.contact_skin - 0.01).abs() < 1e-8 && settings.is_sensor);
    let bare = grid([0.0, 0.0], [1.0, 1.0], [3, 3]).no_surface_collider();
    let body = FlexBodyBuilder::from_soft_body(&bare, CellKind::Tri3).expect("it has moduli");
    let body = body.build().expect("a body");
    assert_eq!(
        body.contact_settings().collision_groups,
        InteractionGroups::none()
    );
}
