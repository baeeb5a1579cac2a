//! The return by its definition, the pair by its work, derivatives by differences.

use super::super::conformance::check_law;
use super::*;
use crate::math::{exp, ln, sin_cos};

fn laws() -> [J2Plasticity; 3] {
    let law = J2Plasticity::plane_strain(1e5, 0.3, 300.0);
    [
        law,
        law.with_hardening(2e3),
        law.with_hardening(500.0).with_saturation(900.0, 12.0),
    ]
}

/// A state that has flowed in two directions, and the elastic gradient it is left with.
fn flowed_state(law: &J2Plasticity) -> (PlasticState, [f64; 4]) {
    let mut state = PlasticState::VIRGIN;
    let ways = [[1.02, 0.05, 0.01, 0.97], [0.95, 0.2, -0.1, 1.08]];
    for gradient in ways {
        state = law.flow(&state, state.elastic(gradient)).state;
    }
    (state, state.elastic(ways[1]))
}

/// Elastic trial gradients from a small elastic one to flow by a third.
const ENDS: [[f64; 4]; 4] = [
    [1.0005, 0.0002, 0.0, 0.9999],
    [1.004, 0.003, -0.001, 0.998],
    [1.05, -0.02, 0.01, 0.97],
    [1.4, 0.1, 0.3, 0.8],
];

fn potential(law: &J2Plasticity, state: &PlasticState, at: [f64; 4]) -> f64 {
    let flow = law.flow(state, at);
    flow.stored + flow.dissipated
}

fn turned(angle: f64, [xx, xy, yx, yy]: [f64; 4]) -> [f64; 4] {
    let (sin, cos) = sin_cos(angle);
    [
        cos * xx - sin * yx,
        cos * xy - sin * yy,
        sin * xx + cos * yx,
        sin * xy + cos * yy,
    ]
}

#[test]
fn the_elastic_part_conforms() {
    for law in laws() {
        assert_eq!(check_law(&law), Ok(()));
    }
}

/// From a state on the yield surface: the work of the pair is the gain of elastic energy and what is dissipated.
#[test]
fn the_work_of_the_pair_is_stored_or_dissipated() {
    for law in laws() {
        for (state, start) in [
            (PlasticState::VIRGIN, [1.0, 0.0, 0.0, 1.0]),
            flowed_state(&law),
        ] {
            let before = law.flow(&state, start);
            assert!(before.dissipated < 1e-12, "{:e}", before.dissipated);
            for end in ENDS {
                let ([a, b], _) = law.between(&state, [start, end]);
                let [from, to] = [start, end].map(Invariants::of);
                let work = a * (to.t - from.t) + b * (to.j - from.j);
                let after = law.flow(&state, end);
                let due = after.stored - before.stored + after.dissipated;
                assert!(after.dissipated >= 0.0);
                // Of two terms of the size of the moduli little is left.
                let size = 1e5 * ((to.t - from.t).abs() + (to.j - from.j).abs());
                assert!((work - due).abs() < 1e-15 * (1e5 + size), "{work} {due}");
            }
        }
    }
}

/// Central differences over 1e-6: rounding of some 1e-9 of the moduli, truncation less.
#[test]
fn stress_and_moduli_are_derivatives_of_the_potential() {
    for law in laws() {
        let (state, start) = flowed_state(&law);
        for end in ENDS {
            let ([a, b], second) = law.at(&state, end);
            let [xx, xy, yx, yy] = end;
            let stress = [
                2.0 * a * xx + b * yy,
                2.0 * a * xy - b * yx,
                2.0 * a * yx - b * xy,
                2.0 * a * yy + b * xx,
            ];
            for (entry, stress) in stress.into_iter().enumerate() {
                let [above, below] = [1e-6, -1e-6].map(|step| {
                    let mut at = end;
                    at[entry] += step;
                    potential(&law, &state, at)
                });
                let error = (above - below) / 2e-6 - stress;
                assert!(error.abs() < 1e-3, "{error:e} of {stress}");
            }
            check_slopes(second, |at| law.at(&state, at).0, end);
            let (_, pair) = law.between(&state, [start, end]);
            let twice = pair.map(|slope| 0.5 * slope);
            check_slopes(twice, |at| law.between(&state, [start, at]).0, end);
        }
    }
}

/// Differences of a pair along stretches of a diagonal gradient with the same invariants.
fn check_slopes(found: [f64; 3], pair: impl Fn([f64; 4]) -> [f64; 2], end: [f64; 4]) {
    let Invariants { t, j } = Invariants::of(end);
    let of = |t: f64, j: f64| {
        let (sum, difference) = ((t + 2.0 * j).sqrt(), (t - 2.0 * j).sqrt());
        let (first, second) = (0.5 * (sum + difference), 0.5 * (sum - difference));
        pair([first, 0.0, 0.0, second])
    };
    let step = 1e-4 * (t - 2.0 * j);
    let by_t = [0, 1].map(|k: usize| (of(t + step, j)[k] - of(t - step, j)[k]) / (2.0 * step));
    let by_j = [0, 1].map(|k: usize| (of(t, j + step)[k] - of(t, j - step)[k]) / (2.0 * step));
    let due = [by_t[0], 0.5 * (by_t[1] + by_j[0]), by_j[1]];
    let size = due.iter().fold(1e5, |most: f64, x| most.max(x.abs()));
    for (found, due) in found.into_iter().zip(due) {
        assert!((found - due).abs() < 1e-6 * size, "{found} {due}");
    }
}

/// The definition, without the closed map: stretches of the new elastic gradient by the eigenvalues of its `C`.
#[test]
fn flow_keeps_the_volume_and_ends_at_the_yield_stress() {
    for law in laws() {
        let (state, _) = flowed_state(&law);
        for end in ENDS {
            let flow = law.flow(&state, end).state;
            // end = F Fp⁻¹: the new one is end Fp Fp'⁻¹.
            let [a, b, c, d] = state.inverse;
            let volume = a * d - b * c;
            let back = [d / volume, -b / volume, -c / volume, a / volume];
            let gradient = PlasticState {
                inverse: back,
                ..PlasticState::VIRGIN
            }
            .elastic(end);
            let [a, b, c, d] = flow.inverse;
            assert!(((a * d - b * c) * exp(flow.lateral) - 1.0).abs() < 1e-14);
            let [xx, xy, yx, yy] = flow.elastic(gradient);
            let (c11, c22, c12) = (xx * xx + yx * yx, xy * xy + yy * yy, xx * xy + yx * yy);
            let radius = (0.25 * (c11 - c22) * (c11 - c22) + c12 * c12).sqrt();
            let middle = 0.5 * (c11 + c22);
            let [first, second] =
                [middle + radius, middle - radius].map(|square: f64| 0.5 * ln(square));
            let mean = (first + second + flow.lateral) / 3.0;
            let squares = [first, second, flow.lateral].map(|e| (e - mean) * (e - mean));
            let mises = 2.0 * law.constants().mu() * (1.5 * squares.iter().sum::<f64>()).sqrt();
            let yields = law.yield_stress_at(flow.strain);
            match flow.strain > state.strain {
                true => assert!((mises / yields - 1.0).abs() < 1e-10, "{mises} {yields}"),
                false => assert!(mises <= yields),
            }
        }
    }
}

/// What is seen turned flows as it does unturned.
#[test]
fn flow_is_indifferent_to_the_frame() {
    for law in laws() {
        let (state, start) = flowed_state(&law);
        for end in ENDS {
            let [plain, seen] = [end, turned(0.8, end)].map(|end| law.flow(&state, end));
            assert!((plain.stored - seen.stored).abs() < 1e-13 * 1e5);
            assert!((plain.state.strain - seen.state.strain).abs() < 1e-13);
            for k in 0..4 {
                let error = plain.state.inverse[k] - seen.state.inverse[k];
                assert!(error.abs() < 1e-13);
            }
            let [plain, seen] =
                [0.0, 0.8].map(|a| law.between(&state, [turned(a, start), turned(a, end)]).0);
            assert!(
                (plain[0] - seen[0]).abs() < 1e-9 * 1e5,
                "{plain:?} {seen:?}"
            );
        }
    }
}

#[test]
fn parameters_out_of_range_are_refused_by_name() {
    let law = J2Plasticity::plane_strain(1e5, 0.3, 300.0);
    let refused = |law: J2Plasticity| law.validate().map_err(|error| error.to_string());
    assert!(refused(law).is_ok());
    let told = |law, part: &str| refused(law).is_err_and(|text| text.contains(part));
    assert!(told(
        J2Plasticity::plane_strain(1e5, 0.3, 0.0),
        "yield stress"
    ));
    assert!(told(law.with_hardening(-1.0), "modulus"));
    assert!(told(law.with_saturation(200.0, 5.0), "saturation"));
    assert!(told(law.with_saturation(400.0, f64::NAN), "rate"));
    assert!(told(J2Plasticity::plane_strain(-1.0, 0.3, 1.0), "Young"));
}
