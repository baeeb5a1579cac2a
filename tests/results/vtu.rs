//! Files for ParaView, read back and held against the bodies. `tests/data/vtu/read_back.py` reads them with VTK and meshio; the environment
//! variable `FOIL2D_KEEP` names a folder where they are left for it.

use super::grid::{Arrays, read};
use foil2d::fe::mesh::{CellKind, generate};
use foil2d::io::{History, Scene, VtuEncoding, VtuSeries, write_vtu};
use foil2d::pipeline::Participant;
use foil2d::prelude::*;
use foil2d::rapier::prelude::*;
use std::error::Error;
use std::path::PathBuf;

type Outcome = Result<(), Box<dyn Error>>;

/// A folder of the test's own, removed in the end unless it is to be kept.
struct Folder(PathBuf, bool);

impl Folder {
    fn new(name: &str) -> Self {
        match std::env::var_os("FOIL2D_KEEP") {
            Some(kept) => Self(PathBuf::from(kept).join(name), true),
            None => {
                let own = format!("foil2d-{name}-{}", std::process::id());
                Self(std::env::temp_dir().join(own), false)
            }
        }
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if !self.1 {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }
}

/// A strip of triangles and a block of six-node triangles on the ground, a ball thrown onto the strip, a turning box.
fn scene() -> Result<(PhysicsWorld, FlexBodySet, [FlexBodyHandle; 2]), Box<dyn Error>> {
    let mut world = PhysicsWorld::new();
    world.integration_parameters.dt = 1.0 / 120.0;
    let ground = ColliderBuilder::cuboid(3.0, 0.1).translation(Vector::new(0.0, -0.1));
    world.insert_collider(ground, None);
    world.insert_collider(
        ColliderBuilder::new(SharedShape::halfspace(Vector::Y)).translation(Vector::new(0.0, -2.0)),
        None,
    );
    world.insert(
        RigidBodyBuilder::dynamic()
            .translation(Vector::new(0.5, 0.35))
            .linvel(Vector::new(0.0, -2.0)),
        ColliderBuilder::ball(0.1).density(500.0),
    );
    world.insert(
        RigidBodyBuilder::dynamic()
            .translation(Vector::new(-2.0, 1.0))
            .angvel(3.0),
        ColliderBuilder::cuboid(0.2, 0.1).translation(Vector::new(0.1, 0.0)),
    );
    let mut bodies = FlexBodySet::new();
    let strip = generate::rectangle([1.0, 0.2], [8, 2], CellKind::Tri3)?;
    let strip = FlexBodyBuilder::mesh(strip)
        .material(LinearElastic::plane_strain(2e5, 0.3).density(900.0))
        .pin_where(|[x, _]| x == 0.0, Pin::both());
    let strip = bodies.insert(strip, &mut world)?;
    let block = generate::rectangle([0.4, 0.4], [2, 2], CellKind::Tri6)?;
    let block = FlexBodyBuilder::mesh(block)
        .material(LinearElastic::plane_stress(1e6, 0.3).density(900.0))
        .small_strain()
        .translation([-0.8, 0.0])
        .linvel([0.0, -1.0]);
    let block = bodies.insert(block, &mut world)?;
    Ok((world, bodies, [strip, block]))
}

fn assert_close(what: &str, found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let largest = expected
        .iter()
        .fold(0.0f64, |largest, value| largest.max(value.abs()));
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found - expected).abs() <= 1e-12 * largest,
            "{what}: {found} {expected}"
        );
    }
}

fn in_space(vectors: impl Iterator<Item = [f64; 2]>) -> Vec<f64> {
    vectors.flat_map(|[x, y]| [x, y, 0.0]).collect()
}

fn check_flexible(piece: &Arrays, body: &FlexBody) -> Outcome {
    let nodes = || 0..body.n_nodes();
    assert_eq!(piece["NumberOfPoints"], [body.n_nodes() as f64]);
    assert_eq!(piece["NumberOfCells"], [body.mesh().n_cells() as f64]);
    assert_close(
        "Points",
        &piece["Points"],
        &in_space(nodes().map(|node| body.position(node))),
    );
    let fields = [
        (
            "displacement",
            in_space(nodes().map(|node| body.displacement(node))),
        ),
        (
            "velocity",
            in_space(nodes().map(|node| body.velocity(node))),
        ),
        (
            "contact_force",
            in_space(nodes().map(|node| body.contact_force(node))),
        ),
        (
            "reaction",
            in_space(nodes().map(|node| body.reaction(node))),
        ),
    ];
    for (name, expected) in fields {
        assert_close(name, &piece[name], &expected);
    }
    assert_close("von_mises", &piece["von_mises"], &body.von_mises()?);
    // Turning the axes changes neither the trace nor the determinant.
    for (tensor, own) in piece["cauchy_stress"].chunks(6).zip(body.stress()?) {
        let [xx, yy, zz, xy, yz, xz] = *tensor else {
            panic!("six components");
        };
        assert_eq!([yz, xz], [0.0; 2]);
        let size = own.von_mises().abs() + 1e-9;
        assert!((xx + yy - own.xx - own.yy).abs() < 1e-10 * size.max(own.xx.abs() + own.yy.abs()));
        assert!((zz - own.zz).abs() < 1e-12 * size.max(zz.abs()));
        let [found, expected] = [xx * yy - xy * xy, own.xx * own.yy - own.xy * own.xy];
        assert!((found - expected).abs() < 1e-9 * (size * size).max(own.xx * own.xx));
    }
    let connectivity: Vec<f64> = body
        .mesh()
        .cells()
        .flat_map(|cell| {
            cell.nodes
                .iter()
                .map(|&node| node as f64)
                .collect::<Vec<_>>()
        })
        .collect();
    assert_eq!(piece["connectivity"], connectivity);
    let kind = match body.mesh().cell(0).kind {
        CellKind::Tri3 => 5.0,
        CellKind::Tri6 => 22.0,
        other => panic!("{other} is not in the scene"),
    };
    assert!(piece["types"].iter().all(|&one| one == kind));
    Ok(())
}

#[test]
fn files_hold_what_the_bodies_have() -> Outcome {
    let folder = Folder::new("series");
    let encodings = [
        VtuEncoding::Ascii,
        VtuEncoding::Base64,
        VtuEncoding::Appended,
    ];
    let mut all: Vec<Vec<Arrays>> = Vec::new();
    for encoding in encodings {
        let (mut world, mut bodies, handles) = scene()?;
        let mut pipeline = FlexPipeline::new();
        let mut series =
            VtuSeries::new(folder.0.join(format!("{encoding:?}"))).with_encoding(encoding);
        let mut history = History::new(["largest von Mises (Pa)", "contact force y (N)"]);
        for step in 1..=12 {
            pipeline.step(&mut world, &mut bodies)?;
            if step % 6 == 0 {
                let time = f64::from(step) / 120.0;
                series.record(time, &Scene::of(&world, &bodies, pipeline.report()))?;
                let [mut largest, mut force] = [0.0; 2];
                for (_, body) in bodies.iter() {
                    largest = body.von_mises()?.into_iter().fold(largest, f64::max);
                    force += body.total_contact_force()[1];
                }
                history.record(time, [largest, force])?;
            }
        }
        history.write(folder.0.join(format!("{encoding:?}.csv")))?;
        let index = std::fs::read_to_string(series.finish()?)?;
        assert_eq!(index.matches("<DataSet").count(), 6);
        let entry = format!(
            "<DataSet timestep=\"0.1\" group=\"\" part=\"1\" name=\"rigid\" file=\"{encoding:?}_rigid_000001.vtu\"/>"
        );
        assert!(index.contains(&entry), "{index}");
        let load = |part: &str| -> Result<Vec<Arrays>, std::io::Error> {
            let name = format!("{encoding:?}_{part}_000001.vtu");
            Ok(read(&std::fs::read(folder.0.join(name))?))
        };

        let flexible = load("flexible")?;
        assert_eq!(flexible.len(), 2);
        for (piece, handle) in flexible.iter().zip(handles) {
            check_flexible(piece, &bodies[handle])?;
        }
        assert!(
            flexible[0]["contact_force"]
                .iter()
                .any(|force| *force != 0.0),
            "the ball has not come down"
        );

        let rigid = load("rigid")?;
        assert_eq!(rigid.len(), 4);
        for (piece, (handle, collider)) in rigid.iter().zip(rigid_colliders(&world, &bodies)) {
            check_rigid(piece, &world, collider);
            let force = pipeline.report().force_on(Participant::Rigid(handle));
            assert_close("force", &piece["contact_force"], &[force[0], force[1], 0.0]);
        }

        let contacts = load("contacts")?;
        let told = pipeline.report().contacts();
        assert!(!told.is_empty());
        assert_close(
            "contacts",
            &contacts[0]["Points"],
            &in_space(told.iter().map(|one| one.position)),
        );
        assert_close(
            "forces",
            &contacts[0]["force"],
            &in_space(told.iter().map(|one| one.force())),
        );
        all.push([flexible, rigid, contacts].concat());
    }
    assert_eq!(all[0], all[1], "text has all digits");
    assert_eq!(all[0], all[2]);
    Ok(())
}

fn rigid_colliders<'a>(
    world: &'a PhysicsWorld,
    bodies: &'a FlexBodySet,
) -> impl Iterator<Item = (ColliderHandle, &'a Collider)> {
    let colliders = world.colliders.iter();
    colliders.filter(|(handle, _)| bodies.of_collider(*handle).is_none())
}

/// The points lie on the surface, and move as rapier says.
fn check_rigid(piece: &Arrays, world: &PhysicsWorld, collider: &Collider) {
    assert_eq!(piece["types"].len(), 1);
    let body = collider.parent().map(|parent| &world.bodies[parent]);
    for (point, velocity) in piece["Points"].chunks(3).zip(piece["velocity"].chunks(3)) {
        let at = Vector::new(point[0] as Real, point[1] as Real);
        let nearest = collider
            .shape()
            .project_point(collider.position(), at, false)
            .point;
        assert!((nearest - at).length() < 1e-5, "{at} {nearest}");
        let expected = body.map_or(Vector::ZERO, |body| body.velocity_at_point(at));
        let found = Vector::new(velocity[0] as Real, velocity[1] as Real);
        assert!((found - expected).length() < 1e-5, "{found} {expected}");
    }
}

/// Stress of a turned body from its places alone: `F` of every triangle, its rotation `R` and stretch `U`, `s = R C (U - 1) Rᵀ`, averaged at nodes
/// by area. Strains of a thousandth make a difference of that order between measures of strain.
#[test]
fn stress_is_told_in_the_axes_of_the_world() -> Outcome {
    let (young, poisson) = (1e7, 0.3);
    for is_large in [false, true] {
        let mesh = generate::rectangle([0.6, 0.2], [6, 2], CellKind::Tri3)?;
        let spin = 20.0;
        let velocities = mesh
            .nodes()
            .iter()
            .map(|[x, y]| [0.4 * (x - 0.3) - spin * (y - 0.1), spin * (x - 0.3)]);
        let velocities = velocities.collect();
        let material = LinearElastic::plane_stress(young, poisson).density(1000.0);
        let builder = FlexBodyBuilder::mesh(mesh)
            .material(material)
            .velocities(velocities);
        let builder = if is_large {
            builder.large_strain()
        } else {
            builder.small_strain()
        };
        let mut world = PhysicsWorld::new();
        world.gravity = Vector::ZERO;
        world.integration_parameters.dt = 1e-3;
        let mut bodies = FlexBodySet::new();
        let handle = bodies.insert(builder, &mut world)?;
        let mut pipeline = FlexPipeline::new();
        for _ in 0..30 {
            pipeline.step(&mut world, &mut bodies)?;
        }
        let body = &bodies[handle];
        let folder = Folder::new(if is_large { "large" } else { "small" });
        let path = folder.0.join("turned.vtu");
        write_vtu(&path, body, VtuEncoding::Appended)?;
        let piece = &read(&std::fs::read(&path)?)[0];
        let expected = stress_of_places(body, young, poisson);
        let largest = expected
            .iter()
            .flatten()
            .fold(0.0f64, |largest, s| largest.max(s.abs()));
        assert!(largest > 1e3, "nothing to see: {largest}");
        for (found, expected) in piece["cauchy_stress"].chunks(6).zip(&expected) {
            let found = [found[0], found[1], found[3]];
            for (found, expected) in found.iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 0.01 * largest,
                    "{found} {expected} of {largest}"
                );
            }
        }
    }
    Ok(())
}

/// `[xx, yy, xy]` (Pa) at the nodes of a body of triangles.
fn stress_of_places(body: &FlexBody, young: f64, poisson: f64) -> Vec<[f64; 3]> {
    let rest = body.mesh().nodes();
    let mut sums = vec![[0.0; 4]; body.n_nodes()];
    for cell in body.mesh().cells() {
        let [a, b, c] = *cell.nodes else {
            panic!("triangles only");
        };
        let sides = |at: &dyn Fn(usize) -> [f64; 2]| {
            let [[ax, ay], [bx, by], [cx, cy]] = [a, b, c].map(at);
            [bx - ax, by - ay, cx - ax, cy - ay]
        };
        let [ux, uy, vx, vy] = sides(&|node| rest[node]);
        let [px, py, qx, qy] = sides(&|node| body.position(node));
        let double = ux * vy - uy * vx;
        let f = [
            [(px * vy - qx * uy) / double, (qx * ux - px * vx) / double],
            [(py * vy - qy * uy) / double, (qy * ux - py * vx) / double],
        ];
        let angle = (f[1][0] - f[0][1]).atan2(f[0][0] + f[1][1]);
        let (sin, cos) = angle.sin_cos();
        let stretch = [
            cos * f[0][0] + sin * f[1][0] - 1.0,
            cos * f[1][1] - sin * f[0][1] - 1.0,
            cos * f[0][1] + sin * f[1][1],
        ];
        let factor = young / (1.0 - poisson * poisson);
        let xx = factor * (stretch[0] + poisson * stretch[1]);
        let yy = factor * (stretch[1] + poisson * stretch[0]);
        let xy = young / (1.0 + poisson) * stretch[2];
        let turned = [
            cos * cos * xx + sin * sin * yy - 2.0 * sin * cos * xy,
            sin * sin * xx + cos * cos * yy + 2.0 * sin * cos * xy,
            sin * cos * (xx - yy) + (cos * cos - sin * sin) * xy,
        ];
        for node in [a, b, c] {
            for (sum, value) in sums[node].iter_mut().zip(turned) {
                *sum += double * value;
            }
            sums[node][3] += double;
        }
    }
    sums.iter()
        .map(|[xx, yy, xy, area]| [xx / area, yy / area, xy / area])
        .collect()
}

/// VTK wants a piece in every file.
#[test]
fn an_empty_world_gives_files_with_an_empty_piece() -> Outcome {
    let folder = Folder::new("empty");
    let (world, bodies, pipeline) = (PhysicsWorld::new(), FlexBodySet::new(), FlexPipeline::new());
    let mut series = VtuSeries::new(folder.0.join("empty"));
    series.record(0.0, &Scene::of(&world, &bodies, pipeline.report()))?;
    for part in ["flexible", "rigid", "contacts"] {
        let pieces = read(&std::fs::read(
            folder.0.join(format!("empty_{part}_000000.vtu")),
        )?);
        assert_eq!(pieces.len(), 1);
        assert_eq!(pieces[0]["NumberOfPoints"], [0.0]);
    }
    Ok(())
}

#[test]
fn a_table_quotes_names_and_keeps_all_digits() {
    let mut history = History::new(["a, \"b\"", "c"]);
    history
        .record(0.1 + 0.2, [1e-20, f64::MIN_POSITIVE])
        .expect("two numbers");
    assert_eq!(
        history.to_csv(),
        "time (s),\"a, \"\"b\"\"\",c\n0.30000000000000004,1e-20,2.2250738585072014e-308\n"
    );
    assert!(history.record(0.0, [0.0; 3]).is_err());
    assert_eq!(history.times().len(), 1);
}
