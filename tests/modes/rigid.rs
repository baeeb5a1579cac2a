//! Rigid motions that nothing holds have the frequency zero; and what is refused.

use super::support::{model, rectangle, soft};
use foil2d::fe::mesh::CellKind;
use foil2d::fe::model::MassKind;
use foil2d::fe::modes::{ModesError, lowest_modes};

#[test]
fn holds_take_away_the_rigid_motions_that_they_hold() {
    let mesh = rectangle([1.0, 0.6], [4, 3], CellKind::Quad4);
    let at = |place: [f64; 2]| {
        let is_it = |x: &[f64; 2]| (x[0] - place[0]).hypot(x[1] - place[1]) < 1e-9;
        mesh.nodes().iter().position(is_it).expect("a node")
    };
    let (left, right, upper) = (at([0.0, 0.0]), at([1.0, 0.0]), at([0.0, 0.6]));
    let body = model(mesh.clone(), soft(0.3), MassKind::Lumped);
    for (dofs, n_rigid) in [
        (&[][..], 3),
        (&[2 * left], 2),
        // A hinge, and a rail.
        (&[2 * left, 2 * left + 1], 1),
        (&[2 * left, 2 * upper], 1),
        // Two rollers whose normals meet in a point leave a turn about it.
        (&[2 * left + 1, 2 * upper], 1),
        (&[2 * left, 2 * left + 1, 2 * right + 1], 0),
        (&[2 * left, 2 * left + 1, 2 * right, 2 * upper], 0),
    ] {
        let mut is_fixed = vec![false; body.n_dofs()];
        dofs.iter().for_each(|&dof| is_fixed[dof] = true);
        let found = lowest_modes(&body, &is_fixed, 5, 1e-10).expect("they are found");
        assert_eq!(found.n_rigid, n_rigid, "{dofs:?}");
        for mode in &found.modes[..n_rigid] {
            assert_eq!((mode.square, mode.frequency()), (0.0, 0.0));
            assert!(body.elastic_energy(&mode.shape) < 1e-12 * found.modes[4].square);
        }
        assert!(found.modes[n_rigid].square > 1.0);
    }
}

#[test]
fn what_cannot_be_found_is_refused() {
    let body = model(
        rectangle([1.0, 1.0], [2, 2], CellKind::Quad4),
        soft(0.3),
        MassKind::Lumped,
    );
    for bad in [0.0, -1.0, f64::NAN, 1.0] {
        let error = lowest_modes(&body, &[], 3, bad).expect_err("out of range");
        assert!(matches!(error, ModesError::Tolerance(_)));
    }
    let error = lowest_modes(&body, &[], 19, 1e-9).expect_err("18 dofs");
    assert_eq!(
        error,
        ModesError::TooMany {
            asked: 19,
            available: 18
        }
    );
    let none = lowest_modes(&body, &[], 0, 1e-9).expect("nothing to do");
    assert!(none.modes.is_empty() && none.n_factorizations == 0);
    let held = vec![true; body.n_dofs()];
    let error = lowest_modes(&body, &held, 1, 1e-9).expect_err("no dof is free");
    assert!(matches!(error, ModesError::TooMany { available: 0, .. }));
}
