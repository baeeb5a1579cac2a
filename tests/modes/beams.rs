//! Beams: the slender limit, Timoshenko's equation, and what must not matter.

use super::support::{close, held, mapped, model, rectangle, soft};
use foil2d::fe::material::LinearElastic;
use foil2d::fe::mesh::{CellKind, Mesh};
use foil2d::fe::model::MassKind;
use foil2d::fe::modes::lowest_modes;
use std::f64::consts::PI;

/// `β L` of Euler and Bernoulli's cantilever and free beam.
const CLAMPED: [f64; 4] = [1.875104069, 4.694091133, 7.854757438, 10.995540735];
const FREE: [f64; 4] = [4.730040745, 7.853204624, 10.995607838, 14.137165491];

/// T6 with h/L = 1/400 and ν = 0, lumped and consistent: depth and shear take up to 1e-4 off.
#[test]
fn slender_beams_have_the_frequencies_of_euler_and_bernoulli() {
    let height = 2.5e-3;
    let stiff = (2e6f64 / 1200.0 * height * height / 12.0).sqrt();
    for mass in [MassKind::Lumped, MassKind::Consistent] {
        for (roots, is_clamped) in [(CLAMPED, true), (FREE, false)] {
            let mesh = rectangle([1.0, height], [120, 1], CellKind::Tri6);
            let is_fixed = held(&mesh, |[x, _]| is_clamped && x == 0.0);
            let body = model(mesh, soft(0.0), mass);
            let n_rigid = if is_clamped { 0 } else { 3 };
            let found = lowest_modes(&body, &is_fixed, n_rigid + 4, 1e-10).expect("a beam");
            assert_eq!(found.n_rigid, n_rigid);
            for (k, root) in roots.into_iter().enumerate() {
                let mode = &found.modes[n_rigid + k];
                let name = format!("{mass:?} {k}");
                close(&name, mode.frequency(), stiff * root * root, 3e-4);
                // Rounding of numbers that differ by ten orders, at most.
                assert!(mode.error < 1e-2 * mode.square, "{}", mode.error);
            }
        }
    }
}

/// The plane body of benchmark B31, L = 1, h = .1, E = 1 MPa, ν = .3: polynomials of degree 5 on cells that shrink towards the
/// corners of the clamp give these to six digits; the fourth stretches.
const STOUT: [f64; 6] = [3.188095, 19.12517, 49.72932, 50.37570, 91.54408, 139.6117];

#[test]
fn a_stout_cantilever_has_the_frequencies_of_the_plane_body() {
    let material = LinearElastic::plane_stress(1e6, 0.3).density(1000.0);
    let errors = [[20, 2], [40, 4]].map(|divisions| {
        let mesh = rectangle([1.0, 0.1], divisions, CellKind::Tri6);
        let is_fixed = held(&mesh, |[x, _]| x == 0.0);
        let body = model(mesh, material, MassKind::Consistent);
        let found = lowest_modes(&body, &is_fixed, 6, 1e-10).expect("a beam");
        let pairs = found.frequencies().into_iter().zip(STOUT);
        let errors: Vec<f64> = pairs.map(|(found, exact)| found / exact - 1.0).collect();
        println!("{errors:?}");
        errors
    });
    // From above, slower than the order of the element because of the corners of the clamp.
    for (coarse, fine) in errors[0].iter().zip(&errors[1]) {
        assert!(*fine > 0.0 && *fine < 0.4 * coarse && *fine < 8e-4);
    }
}

/// A bar between rollers, ν = 0: `ω = n π c / 2 L` for odd n, with a consistent mass of linear cells a little more.
#[test]
fn a_bar_has_its_textbook_frequencies() {
    let n = 24;
    let mesh = rectangle([2.0, 0.1], [n, 1], CellKind::Quad4);
    let is_fixed: Vec<bool> = mesh
        .nodes()
        .iter()
        .flat_map(|x| [x[0] == 0.0, true])
        .collect();
    let body = model(mesh, soft(0.0), MassKind::Lumped);
    let found = lowest_modes(&body, &is_fixed, 5, 1e-12).expect("a bar");
    let wave = (2e6f64 / 1200.0).sqrt();
    let edge = 2.0 / n as f64;
    for (k, mode) in found.modes.iter().enumerate() {
        // Of the chain of masses and springs, exactly.
        let phase = PI * (2 * k + 1) as f64 / (2 * n) as f64;
        let exact = 2.0 * wave / edge * (0.5 * phase).sin();
        close("bar", mode.frequency(), exact, 1e-11);
    }
}

/// Lengths times a, moduli times b, densities times c: frequencies times √(b/c)/a.
#[test]
fn units_do_not_matter() {
    let of = |length: f64, modulus: f64, density: f64| {
        let mesh = rectangle([length, 0.2 * length], [10, 2], CellKind::Tri6);
        let is_fixed = held(&mesh, |[x, _]| x == 0.0);
        let material = LinearElastic::plane_stress(modulus, 0.3).density(density);
        let body = model(mesh, material, MassKind::Lumped);
        [&is_fixed[..], &[]].map(|flags| {
            let found = lowest_modes(&body, flags, 8, 1e-11).expect("a beam");
            (found.frequencies(), found.n_rigid)
        })
    };
    let plain = of(1.0, 2e6, 1200.0);
    for [a, b, c] in [[1e3, 1.0, 1.0], [1e-4, 1e5, 1e-3], [1.0, 1e9, 1e12]] {
        let other = of(a, 2e6 * b, 1200.0 * c);
        let factor = (b / c).sqrt() / a;
        for (plain, other) in plain.iter().zip(&other) {
            assert_eq!(plain.1, other.1);
            for (plain, other) in plain.0.iter().zip(&other.0) {
                let error = (other - factor * plain).abs();
                assert!(error <= 1e-9 * factor * plain, "{other} for {plain}");
            }
        }
    }
}

/// Neither the numbers of the nodes, nor where the body is and how it is turned.
#[test]
fn numbering_place_and_direction_do_not_matter() {
    let mesh = rectangle([1.0, 0.3], [8, 3], CellKind::Quad4);
    let frequencies = |mesh: Mesh| {
        let body = model(mesh, soft(0.3), MassKind::Consistent);
        let found = lowest_modes(&body, &[], 12, 1e-11).expect("a plate");
        assert_eq!(found.n_rigid, 3);
        found.frequencies()
    };
    let plain = frequencies(mesh.clone());
    let n = mesh.n_nodes();
    let new = |node: usize| (7 * node + 3) % n;
    assert!(!n.is_multiple_of(7));
    let mut nodes = vec![[0.0; 2]; n];
    for (node, &x) in mesh.nodes().iter().enumerate() {
        nodes[new(node)] = x;
    }
    let cells = mesh.cells().map(|cell| {
        let nodes = cell.nodes.iter().map(|&node| new(node));
        nodes.collect::<Vec<usize>>()
    });
    let cells: Vec<Vec<usize>> = cells.collect();
    let renumbered = Mesh::from_cells(nodes, CellKind::Quad4, &cells).expect("a mesh");
    let (sin, cos) = 0.7f64.sin_cos();
    let moved = mapped(&mesh, CellKind::Quad4, |[x, y]| {
        [300.0 + cos * x - sin * y, -200.0 + sin * x + cos * y]
    });
    for (other, tolerance) in [(renumbered, 1e-10), (moved, 1e-9)] {
        for (k, (other, plain)) in frequencies(other).iter().zip(&plain).enumerate() {
            let error = (other - plain).abs();
            assert!(error <= tolerance * plain, "{k}: {other} for {plain}");
        }
    }
}

#[test]
fn the_same_bits_come_out_every_time_and_little_work_goes_in() {
    let mesh = rectangle([1.0, 0.3], [30, 9], CellKind::Tri6);
    let body = model(mesh, soft(0.3), MassKind::Lumped);
    let [one, other] = [(), ()].map(|()| lowest_modes(&body, &[], 10, 1e-10).expect("a plate"));
    assert_eq!(one, other);
    println!("{} solves, {} factors", one.n_solves, one.n_factorizations);
    assert!(one.n_solves <= 200 && one.n_factorizations <= 4);
}
