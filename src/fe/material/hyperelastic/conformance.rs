//! What every hyperelastic law must satisfy: derivatives, the conserving pair, Hooke's law at rest, and energy that grows.

use super::{Hyperelastic, Invariants};
use crate::fe::material::Material;
pub use crate::fe::material::conformance::ConformanceFailure;
use crate::fe::material::conformance::at_most;

/// Gradients of deformation `[F_xx, F_xy, F_yx, F_yy]`: pulls, crushing to a fifth, shear, turns, and material inside out.
const STATES: [[f64; 4]; 12] = [
    [1.0, 0.0, 0.0, 1.0],
    [1.01, 0.0, 0.003, 0.99],
    [1.3, 0.0, 0.0, 0.8],
    [0.2, 0.0, 0.0, 1.1],
    [3.0, 0.1, -0.2, 0.6],
    [1.0, 1.5, 0.0, 1.0],
    [0.0, -1.2, 0.9, 0.0],
    [-1.1, 0.2, -0.1, -0.8],
    [0.35, 0.1, -0.1, 0.3],
    [-0.4, 0.1, 0.2, 1.2],
    [1.5, 0.2, 0.1, -0.7],
    [1.0, 0.5, 1.0, 0.5],
];

/// Checks a law over a spread of states; those that it does not [admit](Hyperelastic::admits) are left out.
///
/// | checks | measured against |
/// |---|---|
/// | energy and stress are zero at rest, moduli are Hooke's | [`ElasticConstants`](super::ElasticConstants) |
/// | gradient and Hessian are derivatives | central differences |
/// | the pair does the work that the energy rises by, is symmetric, and has the gradient as its limit | rounding |
/// | the derivatives that a step uses are those of the pair | central differences |
/// | sums of the pair and energies of gradients are those of their invariants | rounding |
/// | energy is positive beside rest, also without its volumetric part, and grows with the stretch | |
///
/// # Errors
/// The first check that fails, with what was measured and what is allowed.
pub fn check_law(law: &dyn Hyperelastic) -> Result<(), ConformanceFailure> {
    let stiffness = law.constants().lambda().abs() + 2.0 * law.constants().mu();
    check_rest(law, stiffness)?;
    let states = || {
        let invariants = STATES.into_iter().map(Invariants::of);
        invariants.filter(|at| law.admits(*at))
    };
    for at in states() {
        check_derivatives(law, at, stiffness)?;
        for to in states() {
            check_pair(law, at, to, stiffness)?;
            check_pair_derivatives(law, at, to, stiffness)?;
        }
        check_near_pair(law, at, stiffness)?;
    }
    check_gradients(law, stiffness)?;
    check_growth(law)
}

/// What is asked of gradients is what their invariants tell, where both are known to rounding.
fn check_gradients(law: &dyn Hyperelastic, stiffness: f64) -> Result<(), ConformanceFailure> {
    let states = || {
        let states = STATES.into_iter();
        states.filter(|state| law.admits(Invariants::of(*state)))
    };
    for from in states() {
        let at = Invariants::of(from);
        let energy = law.energy_density(at);
        let size = energy.abs() + stiffness * at.t;
        let error = (law.energy_of(from) - energy).abs() / size;
        at_most(
            "the energy of a gradient is that of its invariants",
            error,
            1e-14,
        )?;
        for to in states() {
            let [a, b] = law.conserving_pair(at, Invariants::of(to));
            let [sum, difference] = law.conserving_sums(from, to);
            let error = (sum - (2.0 * a + b)).abs() + (difference - (2.0 * a - b)).abs();
            let size = a.abs() + b.abs() + stiffness;
            at_most("the sums are those of the pair", error / size, 1e-13)?;
        }
    }
    Ok(())
}

/// As [`check_derivatives`], with the pair of two states as a function of the second.
fn check_pair_derivatives(
    law: &dyn Hyperelastic,
    from: Invariants,
    to: Invariants,
    stiffness: f64,
) -> Result<(), ConformanceFailure> {
    let step = step_at(to);
    let along = |axis| {
        let [above, below] =
            [step, -step].map(|step| law.conserving_pair(from, moved(to, axis, step)));
        [0, 1].map(|row: usize| (above[row] - below[row]) / step)
    };
    let ([tt, jt], [tj, jj]) = (along(0), along(1));
    let due = [tt, 0.5 * (jt + tj), jj];
    let found = law.conserving_hessian(from, to);
    let size = due.iter().map(|due| due.abs()).sum::<f64>() + stiffness;
    let error = (0..3).fold(0.0, |most, k| f64::max(most, (found[k] - due[k]).abs()));
    at_most(
        "the derivatives of the pair are those of its differences",
        error / size,
        1e-6,
    )
}

fn check_rest(law: &dyn Hyperelastic, stiffness: f64) -> Result<(), ConformanceFailure> {
    let rest = Invariants::REST;
    let energy = law.energy_density(rest).abs() / stiffness;
    at_most("energy is zero at rest", energy, 1e-15)?;
    let [a, b] = law.gradient(rest);
    at_most(
        "stress is zero at rest",
        (2.0 * a + b).abs() / stiffness,
        1e-15,
    )?;
    let [tt, tj, jj] = law.hessian(rest);
    let hooke = law.constants().linear(1.0);
    for [xx, xy, yx, yy] in [
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0, 1.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 1.0, -1.0, 0.0],
        [0.3, -0.8, 0.5, 0.6],
    ] {
        // Along I + e H: t' = 2 tr H, J' = tr H, t'' = 2 |H|², J'' = 2 det H.
        let trace = xx + yy;
        let first = trace * trace * (4.0 * tt + 4.0 * tj + jj);
        let Invariants { t: squared, j: det } = Invariants::of([xx, xy, yx, yy]);
        let second = first + 2.0 * a * squared + 2.0 * b * det;
        let linear = 2.0 * hooke.energy_density([xx, yy, xy + yx]);
        at_most(
            "the moduli at rest are those of linear elasticity",
            (second - linear).abs() / stiffness,
            1e-14,
        )?;
    }
    Ok(())
}

/// Central differences over 1e-4: truncation of some 1e-8 of the third derivative, rounding 1e-12.
fn check_derivatives(
    law: &dyn Hyperelastic,
    at: Invariants,
    stiffness: f64,
) -> Result<(), ConformanceFailure> {
    let step = step_at(at);
    let [a, b] = law.gradient(at);
    let [tt, tj, jj] = law.hessian(at);
    let size = a.abs() + b.abs() + stiffness * at.t;
    let steepness = tt.abs() + tj.abs() + jj.abs() + stiffness;
    for (axis, slope, slopes) in [(0, a, [tt, tj]), (1, b, [tj, jj])] {
        let [above, below] = [step, -step].map(|step| moved(at, axis, step));
        let rise = law.energy_density(above) - law.energy_density(below);
        let error = (rise / (2.0 * step) - slope).abs() / size;
        at_most("the gradient is the derivative of the energy", error, 1e-6)?;
        let (above, below) = (law.gradient(above), law.gradient(below));
        for row in 0..2 {
            let found = (above[row] - below[row]) / (2.0 * step);
            let error = (found - slopes[row]).abs() / steepness;
            at_most("the Hessian is the derivative of the gradient", error, 1e-6)?;
        }
    }
    Ok(())
}

/// A law for J > 0 only changes over lengths of J; mirror images of corotated laws over t + 2 J.
fn step_at(at: Invariants) -> f64 {
    let room = at.j.abs().min((at.t + 2.0 * at.j).abs()).min(1.0);
    1e-4 * room.max(0.1)
}

fn moved(at: Invariants, axis: usize, step: f64) -> Invariants {
    match axis {
        0 => Invariants {
            t: at.t + step,
            ..at
        },
        _ => Invariants {
            j: at.j + step,
            ..at
        },
    }
}

fn check_pair(
    law: &dyn Hyperelastic,
    from: Invariants,
    to: Invariants,
    stiffness: f64,
) -> Result<(), ConformanceFailure> {
    let [a, b] = law.conserving_pair(from, to);
    let (along_t, along_j) = (a * (to.t - from.t), b * (to.j - from.j));
    let energies = [from, to].map(|at| law.energy_density(at));
    let error = along_t + along_j - (energies[1] - energies[0]);
    // Each term has some ten roundings; energies are differences of terms of the size of t.
    let size = along_t.abs() + along_j.abs() + energies[0].abs() + energies[1].abs();
    at_most(
        "the work of the pair is the change of energy",
        error.abs() / (size + stiffness * (from.t + to.t)),
        1e-14,
    )?;
    let back = law.conserving_pair(to, from);
    let skew = (back[0] - a).abs() + (back[1] - b).abs();
    at_most(
        "the pair is symmetric in both states",
        skew / (a.abs() + b.abs() + stiffness),
        1e-14,
    )
}

/// Between neighbours the pair is the gradient in their middle, up to the square of the distance: no quotient has cancelled.
fn check_near_pair(
    law: &dyn Hyperelastic,
    at: Invariants,
    stiffness: f64,
) -> Result<(), ConformanceFailure> {
    for distance in [0.0, 1e-12, 1e-9, 1e-6] {
        let to = Invariants {
            t: at.t + distance,
            j: at.j - 0.5 * distance,
        };
        let pair = law.conserving_pair(at, to);
        let middle = law.gradient(at.mean(to));
        let error = (pair[0] - middle[0]).abs() + (pair[1] - middle[1]).abs();
        let size = pair[0].abs() + pair[1].abs() + stiffness;
        at_most(
            "between neighbours the pair is the gradient in the middle",
            error / size,
            1e-14 + 1e3 * distance * distance,
        )?;
    }
    Ok(())
}

fn check_growth(law: &dyn Hyperelastic) -> Result<(), ConformanceFailure> {
    for direction in [[1.0, 1.0], [1.0, 0.0], [0.5, -0.2]] {
        let mut last = 0.0;
        for stretch in [0.1, 0.5, 2.0, 10.0, 100.0] {
            let [xx, yy] = direction.map(|part: f64| 1.0 + part * stretch);
            let at = Invariants::of([xx, 0.0, 0.0, yy]);
            if !law.admits(at) {
                continue;
            }
            let energy = law.energy_density(at);
            at_most("energy grows with the stretch", last / energy, 1.0)?;
            at_most("energy is positive beside rest", -energy, 0.0)?;
            last = energy;
        }
    }
    for state in STATES {
        let at = Invariants::of(state);
        if at.j > 0.0 && law.admits(at) {
            let energy = law.energy_density(at);
            at_most("energy is positive beside rest", -energy, 0.0)?;
            let of_volume = law.volumetric().map_or(0.0, |part| part.energy(at.j - 1.0));
            at_most(
                "what is left beside the volumetric part is positive",
                (of_volume - energy) / energy.max(f64::MIN_POSITIVE),
                1e-12,
            )?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::{Corotated, ElasticConstants};
    use super::*;

    /// The corotated law with one thing wrong.
    #[derive(Debug)]
    struct Wrong {
        law: Corotated,
        /// The gradient in the middle instead of the conserving pair.
        pair_is_gradient: bool,
        /// A thousandth more in one second derivative.
        hessian_is_off: bool,
        /// The Hessian in the middle instead of the derivatives of the pair.
        slopes_are_hessian: bool,
    }

    impl Hyperelastic for Wrong {
        fn name(&self) -> &'static str {
            "wrong"
        }

        fn constants(&self) -> ElasticConstants {
            self.law.constants()
        }

        fn energy_density(&self, at: Invariants) -> f64 {
            self.law.energy_density(at)
        }

        fn gradient(&self, at: Invariants) -> [f64; 2] {
            self.law.gradient(at)
        }

        fn hessian(&self, at: Invariants) -> [f64; 3] {
            let [tt, tj, jj] = self.law.hessian(at);
            let factor = if self.hessian_is_off { 1.001 } else { 1.0 };
            [tt, tj, factor * jj]
        }

        fn conserving_pair(&self, from: Invariants, to: Invariants) -> [f64; 2] {
            if self.pair_is_gradient {
                self.law.gradient(from.mean(to))
            } else {
                self.law.conserving_pair(from, to)
            }
        }

        fn conserving_hessian(&self, from: Invariants, to: Invariants) -> [f64; 3] {
            if self.slopes_are_hessian {
                self.law.hessian(from.mean(to))
            } else {
                self.law.conserving_hessian(from, to)
            }
        }
    }

    #[test]
    fn a_law_with_one_thing_wrong_is_refused_for_it() {
        let failed_check = |[pair_is_gradient, hessian_is_off, slopes_are_hessian]: [bool; 3]| {
            let law = Corotated::plane_strain(1e6, 0.3);
            let wrong = Wrong {
                law,
                pair_is_gradient,
                hessian_is_off,
                slopes_are_hessian,
            };
            check_law(&wrong).err().map(|failure| failure.check)
        };
        assert_eq!(failed_check([false; 3]), None);
        let pair = "the work of the pair is the change of energy";
        assert_eq!(failed_check([true, false, false]), Some(pair));
        let slopes = "the derivatives of the pair are those of its differences";
        assert_eq!(failed_check([false, false, true]), Some(slopes));
        let moduli = "the moduli at rest are those of linear elasticity";
        assert_eq!(failed_check([false, true, false]), Some(moduli));
    }
}
