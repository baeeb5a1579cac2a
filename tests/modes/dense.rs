//! All modes by dense matrices beside those of the sparse search.

use super::exact::dense;
use super::support::{KINDS, MASSES, describe, held, mapped, model, rectangle, soft};
use foil2d::fe::mesh::{CellKind, Mesh};
use foil2d::fe::model::{MassKind, Model};
use foil2d::fe::modes::{Modes, lowest_modes};

/// Frequencies to 1e-9 of each, the rigid ones zero; shapes that solve the problem and are orthonormal.
#[track_caller]
fn check(model: &Model, is_fixed: &[bool], n_modes: usize, n_rigid: usize) -> Modes {
    let exact = dense(model, is_fixed);
    let found = lowest_modes(model, is_fixed, n_modes, 1e-11).expect("they are found");
    assert_eq!(found.modes.len(), n_modes);
    assert_eq!(found.n_rigid, n_rigid.min(n_modes));
    for (k, (mode, exact)) in found.modes.iter().zip(&exact).enumerate() {
        if k < n_rigid {
            assert_eq!(mode.square, 0.0);
            // What the dense solver leaves of zero.
            assert!(exact.abs() < 1e-9 * exact.max(found.modes[n_modes - 1].square));
            continue;
        }
        let error = (mode.frequency() / exact.sqrt() - 1.0).abs();
        assert!(error < 1e-9, "mode {k}: {} for {exact}", mode.square);
        let limit = mode.error + 1e-10 * exact;
        let away = (mode.square - exact).abs();
        assert!(away <= limit, "mode {k}: {away} of {}", mode.error);
        assert!(mode.error < 1e-8 * exact);
    }
    check_shapes(model, is_fixed, &found);
    found
}

fn check_shapes(model: &Model, is_fixed: &[bool], found: &Modes) {
    let n_dofs = model.n_dofs();
    for (k, mode) in found.modes.iter().enumerate() {
        for (l, other) in found.modes.iter().enumerate() {
            let product = model.mass().inner(&mode.shape, &other.shape);
            let expected = f64::from(u8::from(k == l));
            assert!((product - expected).abs() < 1e-9, "{k} {l}: {product}");
        }
        let mut force = vec![0.0; n_dofs];
        model.stiffness().multiply(&mode.shape, &mut force);
        let size = force.iter().fold(0.0f64, |most, f| most.max(f.abs()));
        model
            .mass()
            .multiply_add(-mode.square, &mode.shape, &mut force);
        for (dof, force) in force.iter().enumerate() {
            if is_fixed.get(dof).copied().unwrap_or(false) {
                assert_eq!(mode.shape[dof], 0.0);
            } else if mode.square > 0.0 {
                let left = force.abs();
                assert!(left < 1e-6 * size, "mode {k}, dof {dof}: {left} of {size}");
            }
        }
        let largest = mode.shape.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        let smallest = mode.shape.iter().copied().fold(0.0, f64::min);
        assert!(-smallest <= largest * (1.0 + 1e-5));
    }
}

fn distorted(kind: CellKind) -> Mesh {
    let mesh = rectangle([1.0, 0.6], [5, 3], kind);
    mapped(&mesh, kind, |[x, y]| {
        [
            x + 0.03 * (7.0 * x + 5.0 * y).sin(),
            y + 0.03 * (6.0 * x - 8.0 * y).cos(),
        ]
    })
}

#[test]
fn free_bodies_of_every_element_and_mass_have_the_modes_of_dense_matrices() {
    for kind in KINDS {
        for mass in MASSES {
            let body = model(distorted(kind), soft(0.3), mass);
            check(&body, &[], 14, 3);
        }
    }
}

#[test]
fn held_bodies_of_every_element_and_mass_have_the_modes_of_dense_matrices() {
    for kind in KINDS {
        for mass in MASSES {
            let mesh = rectangle([1.0, 0.6], [5, 3], kind);
            let is_fixed = held(&mesh, |[x, _]| x == 0.0);
            let body = model(mesh, soft(0.3), mass);
            check(&body, &is_fixed, 12, 0);
        }
    }
}

#[test]
fn nodes_without_mass_follow_quasi_statically() {
    let mesh = rectangle([1.0, 1.0], [6, 6], CellKind::Quad4);
    let on_side = |x: &[f64; 2]| x[1] == 0.0 || x[0] == 1.0;
    let massless: Vec<bool> = mesh.nodes().iter().map(on_side).collect();
    let is_fixed = held(&mesh, |[x, y]| x == 0.0 && y < 0.4);
    for mass in MASSES {
        let body = describe(mesh.clone(), soft(0.3), mass, massless.clone());
        assert!((0..body.n_nodes()).any(|node| body.is_massless(node)));
        check(&body, &[], 10, 3);
        check(&body, &is_fixed, 10, 0);
    }
}

#[test]
fn all_modes_there_are_can_be_asked_for() {
    let mesh = rectangle([1.0, 0.7], [2, 2], CellKind::Quad4);
    let is_fixed = held(&mesh, |[x, _]| x == 0.0);
    let body = model(mesh, soft(0.3), MassKind::Lumped);
    check(&body, &[], 18, 3);
    check(&body, &is_fixed, 12, 0);
}
