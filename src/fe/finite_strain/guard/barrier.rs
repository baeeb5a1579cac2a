//! The energy `W = κ V f(J/J0)` of a guarded place, and what it pushes with.

use crate::fe::LEAST_LEFT;
use crate::fe::finite_strain::Form;
use crate::math::judged::Judged;

/// `J0`, below which a place is guarded (-): a crushed rectangle is left to its law until nine tenths of its area are gone.
pub(super) const FLAT: Judged = LEAST_LEFT;

/// Change of `J` by itself below which the slope of the energy is its derivative in the middle (-): the error is its square by 24.
const SMALL: f64 = 1e-4;

/// Energy of a place of which the share `j` is left (J); infinite if none is.
pub(super) fn guard_energy(unit: f64, j: f64) -> f64 {
    if unit == 0.0 || j >= FLAT {
        return 0.0;
    }
    unit * barrier(j)
}

/// `f(J/J0)`.
fn barrier(j: f64) -> f64 {
    let z = j / FLAT;
    if z >= 1.0 {
        return 0.0;
    }
    if z <= 0.0 {
        return f64::INFINITY;
    }
    (1.0 - z) * (1.0 - z) * (1.0 - z) / z
}

/// First and second derivatives of [`barrier`].
fn derivatives(j: f64) -> [f64; 2] {
    let z = j / FLAT;
    if z >= 1.0 {
        return [0.0; 2];
    }
    let by = (1.0 - z) / z;
    [
        -by * by * (1.0 + 2.0 * z) / FLAT,
        2.0 * (1.0 / (z * z * z) - 1.0) / (FLAT.get() * FLAT.get()),
    ]
}

/// The slope that a step between two `J` does its work with, and what it rises by with the last.
pub(super) fn slopes(form: Form, before: f64, after: f64) -> [f64; 2] {
    // What begins turned, as a state that was read may be, is pushed as at its end.
    if form == Form::Equilibrium || before <= 0.0 {
        let [slope, rise] = derivatives(after);
        return [slope, form.share_of_end() * rise];
    }
    let change = after - before;
    if change.abs() <= SMALL * before.min(after) {
        let [slope, rise] = derivatives(0.5 * (before + after));
        return [slope, 0.5 * rise];
    }
    let slope = (barrier(after) - barrier(before)) / change;
    [slope, (derivatives(after)[0] - slope) / change]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_barrier_has_the_derivatives_that_it_says() {
        for j in [1e-3, 0.02, 0.05, 0.0999, 0.1001] {
            let size = 1e-5 * j;
            let rise = |f: &dyn Fn(f64) -> f64| (f(j + size) - f(j - size)) / (2.0 * size);
            let [first, second] = derivatives(j);
            let [slope, bend] = [rise(&barrier), rise(&|j| derivatives(j)[0])];
            assert!((slope - first).abs() < 1e-6 * first.abs() + 1e-6, "{j}");
            assert!((bend - second).abs() < 1e-5 * second.abs() + 1e-1, "{j}");
        }
    }

    #[test]
    fn the_slope_of_a_step_does_the_work_that_the_energy_rises_by() {
        let form = Form::EnergyMomentum { decay: 0.1 };
        for before in [0.005, 0.05, 0.2] {
            for after in [0.004, 0.05 + 1e-7, 0.05 + 1e-5, 0.0999, 0.3] {
                let [slope, rise] = slopes(form, before, after);
                let error = slope * (after - before) - (barrier(after) - barrier(before));
                assert!(error.abs() < 1e-12, "{before} to {after}: {error:e}");
                let size = 1e-4 * after;
                let of = |after| slopes(form, before, after)[0];
                let actual = (of(after + size) - of(after - size)) / (2.0 * size);
                assert!(
                    (actual - rise).abs() < 1e-3 * rise.abs() + 1e-6,
                    "{before} to {after}: {actual} {rise}"
                );
            }
        }
    }
}
