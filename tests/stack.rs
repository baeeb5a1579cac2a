//! Stacks: heavy on light on flexible, and forces that a statically indeterminate box spreads evenly.

mod common;

use common::*;
use foil2d::pipeline::ContactReport;

/// A rigid box of half extents `half` (m), density 0 but for its `mass` (kg).
fn boxed(
    scene: &mut Scene,
    at: [f64; 2],
    half: [f64; 2],
    mass: f64,
) -> (RigidBodyHandle, ColliderHandle) {
    scene.rigid(
        RigidBodyBuilder::dynamic().translation(vec2(at[0], at[1])),
        ColliderBuilder::cuboid(real(half[0]), real(half[1]))
            .density(0.0)
            .mass(real(mass))
            .friction(0.5),
    )
}

#[test]
fn a_box_on_four_points_presses_evenly() {
    // Two feet, two points each: one more than statics decides on rigid ground, and symmetric on a flexible block.
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    let block = scene.flexible(
        FlexBodyBuilder::rectangle([2.0, 0.5], [16, 4]).material(
            LinearElastic::plane_stress(1e8, 0.3)
                .density(1000.0)
                .rayleigh(5e-3),
        ),
    );
    let body = RigidBodyBuilder::dynamic()
        .translation(vec2(1.0, 0.7))
        .can_sleep(false);
    let body = scene.world.insert_body(body);
    let feet = [-0.5, 0.5].map(|x| {
        let foot = ColliderBuilder::cuboid(0.11, 0.2).translation(vec2(x, 0.0));
        scene
            .world
            .insert_collider(foot.density(1000.0), Some(body))
    });
    scene.steps(1200);
    let half = 0.5 * scene.mass(body) * G;
    for foot in feet {
        let [_, force] = scene.force_on_collider(foot);
        assert!(
            (force / half - 1.0).abs() < 1e-3,
            "a foot presses {force} N, not {half} N"
        );
    }
    let report = scene.report();
    assert!(report.gap_violation() < by_precision(1e-6, 1e-9));
    // Mirrored about the middle, points carry the same force.
    let on_top: Vec<_> = report
        .contacts()
        .iter()
        .filter(|contact| contact.position[1] > 0.4)
        .collect();
    assert!(on_top.len() >= 4, "only {} points carry", on_top.len());
    for contact in &on_top {
        let mirrored =
            |other: &&&ContactReport| (contact.position[0] + other.position[0] - 2.0).abs() < 1e-4;
        let partners = on_top.iter().filter(mirrored);
        let other: f64 = partners.map(|other| other.normal_force).sum();
        let own: f64 = on_top
            .iter()
            .filter(|other| (contact.position[0] - other.position[0]).abs() < 1e-4)
            .map(|other| other.normal_force)
            .sum();
        assert!(
            (own / other - 1.0).abs() < 1e-2,
            "{own} N at {:?}, {other} N opposite",
            contact.position
        );
    }
    let total = (scene.mass(body) + scene.body(block).mass()) * G;
    let lifted: f64 = (0..scene.body(block).n_nodes())
        .map(|node| scene.body(block).contact_force(node)[1])
        .sum();
    assert!(
        (lifted / (total - 2.0 * half) - 1.0).abs() < 1e-3,
        "the block gets {lifted} N"
    );
}

#[test]
fn four_supports_under_a_rigid_box_share_its_weight_equally() {
    // Four equal flexible posts under one rigid box: three unknowns of statics, four forces, one symmetric answer.
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    let posts = [0.0, 1.0, 2.0, 3.0].map(|x| {
        scene.flexible(
            FlexBodyBuilder::rectangle([0.2, 0.4], [4, 8])
                .translation([x, 0.0])
                .material(
                    LinearElastic::plane_stress(1e8, 0.3)
                        .density(1000.0)
                        .rayleigh(5e-3),
                )
                .pin_where(|[_, y]| y == 0.0, Pin::both()),
        )
    });
    let (body, _) = boxed(&mut scene, [1.6, 0.6], [1.8, 0.2], 4000.0);
    scene.steps(1200);
    let quarter = 0.25 * scene.mass(body) * G;
    // A rigid box on equal springs shares by statics and symmetry alone if it stays level: (1/4, 1/4, 1/4, 1/4).
    for post in posts {
        let force = -scene.force_on_flexible(post)[1];
        assert!(
            (force / quarter - 1.0).abs() < 1e-3,
            "a post carries {force} N, not {quarter} N"
        );
    }
}
