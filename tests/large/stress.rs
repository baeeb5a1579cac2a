//! Stresses and stretches at points and nodes, of laws in plane strain and of sheets.

use super::statics::pull;
use super::support::{KINDS, deformed, laws, plate, warped_plate};
use foil2d::fe::finite_strain::FiniteStrainModel;
use foil2d::fe::material::hyperelastic::{
    Gent, Hyperelastic, HyperelasticSolid, Invariants, MooneyRivlin, MooneyRivlinSheet,
    NeoHookeanSheet,
};
use foil2d::fe::material::{LinearElastic, Plane};
use foil2d::fe::recovery::{PointState, Stress};
use foil2d::large::{LargeSettings, LargeStepper, WorldMotion};
use foil2d::prelude::*;
use foil2d::rapier::prelude::PhysicsWorld;
use std::sync::Arc;

const STRETCHED: [f64; 4] = [1.4, 0.3, -0.2, 0.8];

fn all_laws() -> Vec<Arc<dyn Hyperelastic>> {
    let more: [Arc<dyn Hyperelastic>; 4] = [
        Arc::new(NeoHookeanSheet::plane_stress(1e5, 0.4)),
        Arc::new(MooneyRivlin::plane_strain(1.2e4, 5e3, 0.4)),
        Arc::new(MooneyRivlinSheet::plane_stress(1.2e4, 5e3)),
        Arc::new(Gent::plane_strain(1e5, 0.3, 20.0)),
    ];
    laws(1e5, 0.3).into_iter().chain(more).collect()
}

/// `σ = ∂W/∂F Fᵀ/(J z)` by central differences over 1e-6 (Pa).
fn cauchy(law: &dyn Hyperelastic, gradient: [f64; 4]) -> [f64; 4] {
    let energy = |at: [f64; 4]| law.energy_density(Invariants::of(at));
    let p: [f64; 4] = std::array::from_fn(|k| {
        let [mut above, mut below] = [gradient; 2];
        above[k] += 1e-6;
        below[k] -= 1e-6;
        (energy(above) - energy(below)) / 2e-6
    });
    let at = Invariants::of(gradient);
    let volume = at.j * law.thickness_stretch(at);
    let [xx, xy, yx, yy] = gradient;
    [
        (p[0] * xx + p[1] * xy) / volume,
        (p[0] * yx + p[1] * yy) / volume,
        (p[2] * xx + p[3] * xy) / volume,
        (p[2] * yx + p[3] * yy) / volume,
    ]
}

#[test]
fn points_of_a_homogeneous_state_have_the_stress_of_its_energy_and_its_stretches() {
    // Singular values of the state: the roots of s⁴ - t s² + J².
    let at = Invariants::of(STRETCHED);
    let root = (at.t * at.t - 4.0 * at.j * at.j).sqrt();
    let stretches = [1.0, -1.0].map(|sign| (0.5 * (at.t + sign * root)).sqrt());
    for kind in KINDS {
        for law in all_laws() {
            let name = law.name();
            let due = cauchy(law.as_ref(), STRETCHED);
            let size = due
                .iter()
                .fold(0.0, |most, part| f64::max(most, part.abs()));
            let model = warped_plate(kind, Arc::clone(&law));
            let positions = deformed(&model, STRETCHED, 0.0);
            for state in model.cell_states(3, &positions) {
                let Stress { xx, yy, xy, zz } = state.stress;
                for (found, due) in [(xx, due[0]), (xy, due[1]), (xy, due[2]), (yy, due[3])] {
                    assert!((found - due).abs() < 1e-7 * size, "{name}: {found} {due}");
                }
                if law.plane() == Plane::Stress {
                    assert_eq!(zz, 0.0, "{name}");
                }
                let (longest, shortest, angle) = state.stretch.principal();
                for (found, due) in [longest, shortest].into_iter().zip(stretches) {
                    assert!((found - due).abs() < 1e-12, "{name}: {found} {due}");
                }
                // Of an isotropic law stress and stretch have the same axes.
                let (_, _, of_stress) = state.stress.principal();
                assert!((of_stress - angle).abs() < 1e-9, "{name}");
                let thickness = law.thickness_stretch(at);
                assert!((state.stretch.volume() / (at.j * thickness) - 1.0).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn stresses_turn_with_the_body() {
    let angle: f64 = 0.7;
    let (sin, cos) = angle.sin_cos();
    let [xx, xy, yx, yy] = STRETCHED;
    let turned = [
        cos * xx - sin * yx,
        cos * xy - sin * yy,
        sin * xx + cos * yx,
        sin * xy + cos * yy,
    ];
    for law in all_laws() {
        let name = law.name();
        let model = warped_plate(CellKind::Tri6, law);
        let [before, after] = [STRETCHED, turned].map(|state| {
            let positions = deformed(&model, state, 0.0);
            model.cell_states(0, &positions)[0]
        });
        let due = before.stress.turned(angle);
        let pairs = [
            (after.stress.xx, due.xx),
            (after.stress.yy, due.yy),
            (after.stress.xy, due.xy),
            (after.stress.zz, due.zz),
            (after.stress.von_mises(), before.stress.von_mises()),
            (
                1e5 * after.stretch.principal().0,
                1e5 * before.stretch.principal().0,
            ),
        ];
        for (found, due) in pairs {
            assert!((found - due).abs() < 1e-9 * 1e5, "{name}: {found} {due}");
        }
    }
}

/// A spinning plate of each sheet keeps what one of a slice keeps.
#[test]
fn a_spinning_sheet_keeps_its_energy_and_its_angular_momentum() {
    for law in [4, 5, 6, 7].map(|which| Arc::clone(&all_laws()[which])) {
        let name = law.name();
        let model = Arc::new(warped_plate(CellKind::Tri6, law));
        let mut motion = WorldMotion::at_rest(&model);
        for (x, v) in motion.position.chunks(2).zip(motion.velocity.chunks_mut(2)) {
            (v[0], v[1]) = (-5.0 * x[1] + 3.0 * x[0], 5.0 * x[0]);
        }
        let before = [motion.energy(&model), motion.angular_momentum(&model)];
        let load = vec![0.0; model.n_dofs()];
        let settings = LargeSettings::conserving().with_tolerance(1e-11);
        let mut stepper = LargeStepper::new(Arc::clone(&model), settings).expect("settings");
        let mut most = 0.0;
        for _ in 0..100 {
            stepper
                .step(1.0 / 60.0, &load, &mut motion)
                .expect("a step");
            most = f64::max(most, model.elastic_energy(&motion.position));
        }
        assert!(most > 1e-2 * before[0], "{name}: it is stretched");
        let after = [motion.energy(&model), motion.angular_momentum(&model)];
        for (after, before) in after.into_iter().zip(before) {
            assert!(
                (after / before - 1.0).abs() < 1e-9,
                "{name}: {after} {before}"
            );
        }
    }
}

/// A body all of whose nodes are pinned, put to an affine displacement `H X`.
fn held(builder: FlexBodyBuilder, [xx, xy, yx, yy]: [f64; 4]) -> (FlexBodySet, FlexBodyHandle) {
    let mut world = PhysicsWorld::new();
    let mut bodies = FlexBodySet::new();
    let builder = builder.pin_where(|_| true, Pin::both());
    let handle = bodies.insert(builder, &mut world).expect("a body");
    let body = bodies.get_mut(handle).expect("it is there");
    for node in 0..body.n_nodes() {
        let [x, y] = body.position(node);
        let displacement = [xx * x + xy * y, yx * x + yy * y];
        body.set_pin_displacement(node, displacement)
            .expect("it is pinned");
    }
    FlexPipeline::new()
        .step(&mut world, &mut bodies)
        .expect("a step");
    (bodies, handle)
}

#[test]
fn nodes_and_points_of_a_body_tell_one_homogeneous_state() {
    let sheet = NeoHookeanSheet::plane_stress(1e6, 0.45);
    let solid = HyperelasticSolid::new(sheet).with_density(1000.0);
    for kind in KINDS {
        let builder =
            FlexBodyBuilder::rectangle_of([1.0, 0.5], [4, 3], kind).material(solid.clone());
        let change = [0.1, 0.02, -0.05, -0.08];
        let (bodies, handle) = held(builder, change);
        let body = &bodies[handle];
        let gradient = [1.1, 0.02, -0.05, 0.92];
        let due = cauchy(&sheet, gradient);
        let at = Invariants::of(gradient);
        let state: PointState = body.point_states(1).expect("a cell")[0];
        assert!((state.stretch.thickness - sheet.thickness_stretch(at)).abs() < 1e-7);
        let (strain, stress) = body.cell_stress(1).expect("a cell")[0];
        assert!((strain[0] - 0.5 * (1.1 * 1.1 + 0.05 * 0.05 - 1.0)).abs() < 1e-7);
        assert_eq!(stress, state.stress);
        let (stresses, principal) = (body.stress(), body.principal_stress());
        let nodes = stresses.iter().flatten().zip(principal.iter().flatten());
        for (stress, (larger, smaller, _)) in nodes {
            assert!(
                (stress.xx - due[0]).abs() < 1e-6 * 1e6 && stress.zz == 0.0,
                "{kind}"
            );
            assert!(
                (larger + smaller - due[0] - due[3]).abs() < 1e-6 * 1e6,
                "{kind}"
            );
        }
        for stretch in body.stretch().expect("stretches") {
            let (longest, shortest, _) = stretch.principal();
            assert!((longest * shortest / at.j - 1.0).abs() < 1e-6, "{kind}");
            assert!((stretch.thickness - sheet.thickness_stretch(at)).abs() < 1e-6);
        }
    }
}

/// A small strain in a sheet that lies turned by 0.5 rad: stresses in the world's axes are those of the strain there.
#[test]
fn points_of_a_body_of_small_strain_are_told_in_the_axes_of_the_world() {
    let law = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
    let builder = FlexBodyBuilder::rectangle([1.0, 0.5], [4, 3])
        .material(law)
        .rotation(0.5)
        .small_strain();
    let (bodies, handle) = held(builder, [1e-4, 2e-4, 2e-4, -3e-4]);
    let body = &bodies[handle];
    let strain = [1e-4, -3e-4, 4e-4];
    let due = law.stress(strain);
    for state in body.point_states(5).expect("a cell") {
        let Stress { xx, yy, xy, zz } = state.stress;
        for (found, due) in [(xx, due[0]), (yy, due[1]), (xy, due[2]), (zz, 0.0)] {
            // What displacements and the frame are to the second order.
            assert!((found - due).abs() < 1e-2, "{found} {due}");
        }
        let thickness = 1.0 + 0.3 / 0.7 * 2e-4;
        assert!((state.stretch.thickness - thickness).abs() < 1e-8);
        assert!((state.stretch.xy - 2e-4).abs() < 1e-7);
    }
}

/// Benchmark B45 in plane stress: the nominal stress P/E of a sheet, E = 1, ν = .3, and its stretch across.
#[test]
fn a_sheet_has_the_digits_of_homogeneous_strain_in_plane_stress() {
    let known = [
        (0.5, -0.9353520569),
        (0.7, -0.4052304243),
        (1.3, 0.2484958826),
        (2.0, 0.6467446602),
    ];
    for kind in KINDS {
        for (stretch, expected) in known {
            let law = Arc::new(NeoHookeanSheet::plane_stress(1.0, 0.3));
            let (stress, side) = pull(plate([1.0, 1.0], [3, 3], kind, law), stretch);
            let error = stress / expected - 1.0;
            assert!(error.abs() < 1e-8, "{kind:?} {stretch}: {stress}");
            if stretch == 0.5 {
                assert!((side - 1.210767391).abs() < 1e-8, "{side}");
            }
        }
    }
}

/// Assembled as an error, not as a body: a law out of its range.
#[test]
fn a_sheet_out_of_its_range_is_no_body() {
    let mesh = foil2d::fe::mesh::generate::rectangle([1.0, 1.0], [1, 1], CellKind::Quad4);
    let sheet = NeoHookeanSheet::plane_stress(1e5, -0.2);
    let description =
        foil2d::fe::finite_strain::FiniteStrainDescription::new(mesh.expect("a mesh"), sheet, 1.0);
    let error = FiniteStrainModel::assemble(description).expect_err("out of range");
    assert!(error.to_string().contains("0 to 0.5"), "{error}");
}
