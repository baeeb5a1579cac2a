//! Plates in their plane: modes that come in pairs, and NAFEMS' tapered membrane.

use super::support::{close, held, mapped, model, rectangle, soft};
use foil2d::fe::material::LinearElastic;
use foil2d::fe::mesh::{CellKind, generate};
use foil2d::fe::model::MassKind;
use foil2d::fe::modes::lowest_modes;
use std::f64::consts::TAU;

/// A free square, E = 2 MPa, ν = .3, 1200 kg/m³: polynomials of degree 7 on 4 x 4 cells (rad/s).
const SQUARE: [f64; 9] = [
    99.31239344,
    105.77550623,
    105.77550623,
    112.48706137,
    127.84826404,
    147.74233956,
    159.33460815,
    159.33460815,
    184.15479851,
];

#[test]
fn a_free_square_has_its_pairs() {
    let kind = CellKind::Quad4;
    let errors = [12, 24].map(|n| {
        let mesh = rectangle([1.0, 1.0], [n, n], kind);
        let body = model(mesh, soft(0.3), MassKind::Consistent);
        let found = lowest_modes(&body, &[], 12, 1e-11).expect("a square");
        assert_eq!(found.n_rigid, 3);
        let frequencies = &found.frequencies()[3..];
        // Of a mesh as symmetric as the square.
        close("first pair", frequencies[2], frequencies[1], 1e-9);
        close("second pair", frequencies[7], frequencies[6], 1e-9);
        let pairs = frequencies.iter().zip(SQUARE);
        let errors = pairs.map(|(found, exact)| (found / exact - 1.0).abs());
        errors.fold(0.0, f64::max)
    });
    println!("{errors:?}");
    // The order of the element: two.
    assert!(errors[0] < 3e-2 && errors[1] < 0.26 * errors[0]);
}

/// A free disc, R = 1 m: `φ = A J_n(h r) cos nθ`, `ψ = B J_n(k r) sin nθ` without stress at the rim (Love); those with n > 0 twice.
const DISC: [(f64, usize); 8] = [
    (59.38604594, 2),
    (69.22509743, 1),
    (87.68269422, 0),
    (91.17266347, 3),
    (107.46853493, 2),
    (118.71642168, 4),
    (130.02617199, 0),
    (144.53870914, 5),
];

#[test]
fn a_free_disc_has_its_pairs() {
    let mesh = generate::disc(1.0, 0.1, CellKind::Tri6).expect("a disc");
    let body = model(mesh, soft(0.3), MassKind::Consistent);
    let expected: Vec<f64> = DISC
        .iter()
        .flat_map(|&(frequency, n)| vec![frequency; if n > 0 { 2 } else { 1 }])
        .collect();
    let found = lowest_modes(&body, &[], 3 + expected.len(), 1e-10).expect("a disc");
    assert_eq!(found.n_rigid, 3);
    for (k, (mode, expected)) in found.modes[3..].iter().zip(expected).enumerate() {
        close(&format!("mode {k}"), mode.frequency(), expected, 2e-3);
    }
}

/// NAFEMS FV32: a cantilevered membrane 10 m long that tapers from 5 m to 1 m, .05 m thick (here .1, which cancels), E = 200 GPa, ν = .3,
/// 8000 kg/m³.
///
/// ```text
///  |----____
///  |        ----____|
///  |                |      NAFEMS: 44.623, 130.03, 162.70, 246.05, 379.90, 391.44 Hz on a coarse mesh
///  |    ____----
///  |----
/// ```
///
/// Ten by polynomials of degree 7 on cells that shrink towards the corners (Hz).
const TAPERED: [f64; 10] = [
    44.61702, 130.00945, 162.68874, 245.98580, 379.71702, 391.40418, 522.57927, 564.69847,
    606.78759, 660.69514,
];

#[test]
fn the_tapered_membrane_has_its_ten_lowest_frequencies() {
    let material = LinearElastic::plane_stress(200e9, 0.3).density(8000.0);
    let published = [44.623, 130.03, 162.70, 246.05, 379.90, 391.44];
    for (found, published) in TAPERED.into_iter().zip(published) {
        close("published", published, found, 6e-4);
    }
    for (mass, tolerance) in [(MassKind::Consistent, 2e-3), (MassKind::Lumped, 2e-3)] {
        let kind = CellKind::Tri6;
        let square = rectangle([1.0, 1.0], [24, 12], kind);
        let mesh = mapped(&square, kind, |[s, t]| {
            [10.0 * s, (t - 0.5) * (5.0 - 4.0 * s)]
        });
        let is_fixed = held(&mesh, |[x, _]| x == 0.0);
        let body = model(mesh, material, mass);
        let found = lowest_modes(&body, &is_fixed, 10, 1e-10).expect("a membrane");
        for (k, (mode, expected)) in found.modes.iter().zip(TAPERED).enumerate() {
            let frequency = mode.frequency() / TAU;
            close(&format!("{mass:?} {k}"), frequency, expected, tolerance);
        }
    }
}
