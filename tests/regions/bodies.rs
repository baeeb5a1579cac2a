//! What is said of a body of several materials: mass, motion, records, errors.

use crate::common::*;
use foil2d::body::{BuildError, Region};
use foil2d::fe::mesh::MeshError;
use foil2d::fe::mesh::generate::rectangle;
use foil2d::fe::model::ModelError;

fn elastic(young: f64, density: f64) -> LinearElastic {
    LinearElastic::plane_strain(young, 0.3).density(density)
}

fn halves(kind: CellKind) -> FlexBodyBuilder {
    FlexBodyBuilder::rectangle_of([2.0, 1.0], [4, 2], kind).regions_by(|[x, _]| u32::from(x > 1.0))
}

/// A plate 2 x 1 m of 1000 kg/m³ on its left and 3000 kg/m³ on its right, .1 m thick.
#[test]
fn mass_centre_and_moment_are_those_of_the_two_densities() {
    for kind in [CellKind::Tri3, CellKind::Tri6, CellKind::Quad4] {
        let plate = || {
            halves(kind)
                .material(elastic(1e6, 1000.0))
                .region_material(1, elastic(1e6, 3000.0))
                .thickness(0.1)
        };
        let (mass, centre) = (400.0, 1.25);
        // Each half has m (1 + 1)/12 about its own centre, 1/2 and 3/2.
        let polar = 400.0 * 2.0 / 12.0 + 100.0 * 0.75f64.powi(2) + 300.0 * 0.25f64.powi(2);
        let consistent = plate().small_strain().mass_kind(MassKind::Consistent);
        let bodies = [plate().large_strain(), plate().small_strain(), consistent];
        for (which, body) in bodies.into_iter().enumerate() {
            let body = body.build().expect("a plate");
            assert_eq!(body.large().is_some(), which == 0);
            let of = format!("{kind}, body {which}");
            assert!((body.mass() / mass - 1.0).abs() < 1e-13, "{of}");
            let [x, y] = body.centre_of_mass();
            assert!(
                (x - centre).abs() < 1e-12 && (y - 0.5).abs() < 1e-12,
                "{of}: {x} {y}"
            );
            if which == 2 {
                assert!((body.polar_moment() / polar - 1.0).abs() < 1e-12, "{of}");
            }
            if let Some(large) = body.large() {
                let sum: f64 = large.masses().iter().sum();
                assert!((sum / mass - 1.0).abs() < 1e-13, "{of}");
            }
        }
    }
}

/// Lands on a floor, and goes on for a while.
fn fallen(builder: FlexBodyBuilder) -> (Vec<f64>, [f64; 2]) {
    let mut scene = Scene::new(1.0 / 60.0);
    scene.ground(0.5);
    let body = builder.translation([0.0, 0.02]).rotation(0.05);
    let handle = scene.flexible(body);
    (0..30).for_each(|_| {
        scene.step();
    });
    let body = scene.body(handle);
    let all = body.positions().iter().chain(body.velocities());
    (all.copied().collect(), body.total_contact_force())
}

#[test]
fn regions_of_one_material_are_one_region_to_the_bit() {
    for kind in [CellKind::Tri6, CellKind::Quad4] {
        for is_large in [true, false] {
            let of = |builder: FlexBodyBuilder| match is_large {
                true => builder.large_strain(),
                false => builder.small_strain(),
            };
            let plain = FlexBodyBuilder::rectangle_of([2.0, 1.0], [4, 2], kind);
            let one = fallen(of(plain.material(elastic(1e6, 1000.0))));
            let split = halves(kind)
                .region_material(0, elastic(1e6, 1000.0))
                .region_material(1, elastic(1e6, 1000.0));
            assert_eq!(one, fallen(of(split)), "{kind}, large {is_large}");
            let other = halves(kind)
                .material(elastic(1e6, 1000.0))
                .region_material(1, elastic(2e6, 1000.0));
            assert_ne!(one.0, fallen(of(other)).0, "{kind}, large {is_large}");
        }
    }
}

/// Cells and nodes in reverse order, and regions under other numbers: the same body but for rounding.
#[test]
fn numbers_of_nodes_cells_and_regions_do_not_matter() {
    let mesh = rectangle([2.0, 1.0], [4, 2], CellKind::Quad4).expect("a rectangle");
    let last = mesh.n_nodes() - 1;
    let nodes: Vec<[f64; 2]> = mesh.nodes().iter().rev().copied().collect();
    let cells: Vec<Vec<usize>> = mesh.cells().map(|cell| cell.nodes.to_vec()).collect();
    let cells: Vec<Vec<usize>> = cells
        .iter()
        .rev()
        .map(|cell| cell.iter().map(|node| last - node).collect())
        .collect();
    let turned = Mesh::from_cells(nodes, CellKind::Quad4, &cells).expect("the same cells");
    let (stiff, soft) = (elastic(2e6, 3000.0), elastic(1e6, 1000.0));
    for is_large in [true, false] {
        let motion = |mesh: Mesh, numbers: [u32; 2]| {
            let mut scene = Scene::in_free_space(1.0 / 60.0);
            let body = FlexBodyBuilder::mesh(mesh)
                .regions_by(|[x, _]| numbers[usize::from(x > 1.0)])
                .region_material(numbers[0], soft)
                .region_material(numbers[1], stiff)
                .angvel(3.0);
            let body = match is_large {
                true => body.large_strain(),
                false => body.small_strain(),
            };
            let handle = scene.flexible(body);
            (0..20).for_each(|_| {
                scene.step();
            });
            scene.body(handle).positions().to_vec()
        };
        let one = motion(mesh.clone(), [0, 1]);
        let other = motion(turned.clone(), [7, 2]);
        for node in 0..=last {
            for axis in 0..2 {
                let apart = one[2 * node + axis] - other[2 * (last - node) + axis];
                assert!(apart.abs() < 1e-9, "large {is_large}: {apart:e}");
            }
        }
    }
}

/// A free spinning plate of a stiff and a soft half keeps energy and angular momentum as one of a single law does.
#[test]
fn a_spinning_body_of_two_laws_conserves_energy_and_momentum() {
    let mut scene = Scene::in_free_space(1.0 / 60.0).with_integrator(Beta2::trapezoidal());
    for kind in [CellKind::Quad4, CellKind::Tri6] {
        let body = halves(kind)
            .region_material(
                0,
                HyperelasticSolid::new(NeoHookean::plane_strain(1e5, 0.3)).with_density(1000.0),
            )
            .region_material(
                1,
                HyperelasticSolid::new(StableNeoHookean::plane_strain(4e5, 0.4))
                    .with_density(2000.0),
            )
            .angvel(5.0);
        let handle = scene.flexible(body);
        let of = |scene: &Scene| {
            let body = scene.body(handle);
            let energy = body.energy();
            let centre = body.centre_of_mass();
            [
                energy.kinetic + energy.elastic,
                body.angular_momentum(centre),
            ]
        };
        let before = of(&scene);
        (0..60).for_each(|_| {
            scene.step();
        });
        let elastic = scene.body(handle).energy().elastic;
        assert!(elastic > 1e-2 * before[0], "it is stretched: {elastic}");
        for (now, before) in of(&scene).into_iter().zip(before) {
            assert!((now / before - 1.0).abs() < 1e-8, "{kind}: {now} {before}");
        }
        let removed = scene.bodies.remove(handle, &mut scene.world);
        removed.expect("it is there");
    }
}

#[test]
fn regions_have_names_and_wrong_ones_are_refused() {
    let mesh = || {
        rectangle([2.0, 1.0], [4, 2], CellKind::Quad4)
            .expect("a rectangle")
            .with_regions_by(|[x, _]| 3 * u32::from(x > 1.0))
    };
    let named = mesh().with_region_name(3, "rubber").expect("it has cells");
    assert_eq!(named.region_named("rubber"), Some(3));
    assert_eq!(named.region_names().collect::<Vec<_>>(), [(3, "rubber")]);
    assert_eq!(
        mesh().with_region_name(1, "no"),
        Err(MeshError::NoRegion { region: 1 })
    );
    let twice = named.clone().with_region_name(0, "rubber");
    let refused = MeshError::RegionName {
        name: "rubber".to_owned(),
        regions: [3, 0],
    };
    assert_eq!(twice, Err(refused));
    let wrong = mesh().with_regions(vec![0; 3]);
    assert_eq!(
        wrong,
        Err(MeshError::RegionCount {
            found: 3,
            expected: 8
        })
    );

    let build = |builder: FlexBodyBuilder| builder.build().map(|body| body.mass());
    let of = || FlexBodyBuilder::mesh(named.clone());
    let (light, heavy) = (elastic(1e6, 1.0), elastic(1e6, 2.0));
    let mass = build(of().material(light).region_material("rubber", heavy));
    assert!((mass.expect("a body") - 3.0).abs() < 1e-12);
    let mass = build(of().region_material(0, light).region_material(3, heavy));
    assert!((mass.expect("a body") - 3.0).abs() < 1e-12);
    let region: Region = "steel".into();
    let known = vec![0, 3];
    assert_eq!(
        build(of().material(light).region_material("steel", heavy)),
        Err(BuildError::NoRegion { region, known })
    );
    assert_eq!(
        build(of().region_material("rubber", heavy)),
        Err(BuildError::RegionWithoutMaterial { region: 0 })
    );
    assert_eq!(build(of()), Err(BuildError::NoMaterial));
    let damped = heavy.rayleigh(1e-3);
    assert_eq!(
        build(of().material(light).region_material(3, damped)),
        Err(BuildError::Model(ModelError::RegionDamping(3)))
    );
    // A law of large strain in one region asks for one in all: Hooke's has one.
    let rubber = HyperelasticSolid::new(NeoHookean::plane_strain(1e5, 0.3)).with_density(1.0);
    let body = of().material(light).region_material(3, rubber).build();
    assert!(body.expect("a body").large().is_some());
}

#[test]
fn a_region_is_made_of_another_material_between_steps() {
    for is_large in [true, false] {
        let builder = halves(CellKind::Tri6).material(elastic(1e6, 1000.0));
        let builder = match is_large {
            true => builder.large_strain(),
            false => builder.small_strain(),
        };
        let mut body = builder.clone().build().expect("a body");
        body.set_region_material(1, elastic(2e6, 3000.0))
            .expect("a region");
        let anew = builder.clone().region_material(1, elastic(2e6, 3000.0));
        let anew = anew.build().expect("a body");
        assert_eq!(body.mass(), anew.mass());
        let diagonal = |body: &FlexBody| {
            let block = |node| body.model().stiffness().block(node, node).copied();
            (0..body.n_nodes()).map(block).collect::<Vec<_>>()
        };
        assert_eq!(diagonal(&body), diagonal(&anew));
        assert_eq!(
            body.large().map(|one| one.masses()),
            anew.large().map(|one| one.masses())
        );
        let refused = body.set_region_material(5, elastic(1e6, 1.0));
        assert!(matches!(refused, Err(BuildError::NoRegion { .. })));
        assert_eq!(body.mass(), anew.mass());
        body.set_material(elastic(1e6, 1000.0))
            .expect("one material");
        assert_eq!(body.mass(), builder.build().expect("a body").mass());
    }
}

/// On an interface the stress along it jumps, by the ratio of the moduli under one strain.
#[test]
fn stresses_are_recovered_on_both_sides_of_an_interface() {
    for is_large in [true, false] {
        let builder = FlexBodyBuilder::rectangle([2.0, 1.0], [4, 2])
            .regions_by(|[_, y]| u32::from(y > 0.5))
            .material(LinearElastic::plane_stress(1e6, 0.0).density(1.0))
            .region_material(1, LinearElastic::plane_stress(3e6, 0.0).density(1.0));
        let builder = match is_large {
            true => builder.large_strain(),
            false => builder.small_strain(),
        };
        let mut scene = Scene::in_free_space(1.0 / 60.0);
        let handle = scene.flexible(builder.pin_where(|_| true, Pin::both()));
        let body = scene.bodies.get_mut(handle).expect("two layers");
        for node in 0..body.n_nodes() {
            let along = 1e-4 * body.mesh().nodes()[node][0];
            body.set_pin_displacement(node, [along, 0.0])
                .expect("it is pinned");
        }
        scene.step();
        let body = scene.body(handle);
        let [lower, upper] = [0, 1].map(|region| body.region_stress(region).expect("a region"));
        let mean = body.stress().expect("stresses");
        for (node, at) in body.mesh().nodes().iter().enumerate() {
            let [low, high] = [lower[node], upper[node]].map(|found| found.map(|one| one.xx));
            assert_eq!(
                (low.is_some(), high.is_some()),
                (at[1] <= 0.5, at[1] >= 0.5)
            );
            for (found, exact) in [(low, 100.0), (high, 300.0)] {
                assert!(
                    found.is_none_or(|found| (found / exact - 1.0).abs() < 1e-3),
                    "{found:?}"
                );
            }
            let both = low.into_iter().chain(high);
            let exact = both.clone().sum::<f64>() / both.count() as f64;
            assert!((mean[node].xx / exact - 1.0).abs() < 1e-12);
        }
    }
}
