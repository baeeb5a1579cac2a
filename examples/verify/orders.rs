//! Observed orders: every integrator on an oscillator, with the step halved.
//!
//! `ẍ + 2 ζ ω ẋ + ω² x = 0`, ω = 3, ζ = 0.1, error of position and velocity at t = 1 against the closed form; the theta
//! methods on `ẋ + 2 x = 0`. All derivatives start from their exact values.
//!
//! Expected: as `integrator` derives them. Excellent: ±.05 between 1/200 and 1/400 s.

use super::Outcome;
use super::figure::Figure;
use super::sheet::Sheet;
use foil2d::integrator::{Beta1, Beta2, Beta3, BetaM};

/// Coefficients of `x`, `ẋ` and `ẍ`.
type Equation = [f64; 3];

const DECAY: Equation = [2.0, 1.0, 0.0];
const OSCILLATOR: Equation = [9.0, 0.6, 1.0];

/// The derivatives `x, ẋ, ...` of the solution that starts at 1 (and, for the oscillator, is the real part of `exp(s t)`).
fn exact<const N: usize>([k, c, m]: Equation, t: f64) -> [f64; N] {
    let (re, im) = if m == 0.0 {
        (-k / c, 0.0)
    } else {
        let half = 0.5 * c / m;
        (-half, (k / m - half * half).sqrt())
    };
    let size = (re * t).exp();
    let mut value = (size * (im * t).cos(), size * (im * t).sin());
    std::array::from_fn(|_| {
        let derivative = value.0;
        value = (re * value.0 - im * value.1, re * value.1 + im * value.0);
        derivative
    })
}

/// The error at `t = 1` after `n` steps: the increment makes the equation hold at the end of each.
fn error<const N: usize>(method: BetaM<N>, equation: Equation, n: usize) -> f64 {
    let dt = 1.0 / n as f64;
    let mut state: [f64; N] = exact(equation, 0.0);
    let weight: f64 = equation
        .iter()
        .zip(method.weights(dt))
        .map(|(w, b)| w * b)
        .sum();
    for _ in 0..n {
        method.predict_in_place(dt, state.each_mut().map(std::slice::from_mut));
        let residual: f64 = equation.iter().zip(&state).map(|(w, q)| w * q).sum();
        let slices = state.each_mut().map(std::slice::from_mut);
        method.correct_in_place(dt, &[-residual / weight], slices);
    }
    let end: [f64; N] = exact(equation, 1.0);
    (state[0] - end[0]).hypot(state[1] - end[1])
}

fn judge<const N: usize>(
    sheet: &mut Sheet,
    name: &str,
    method: BetaM<N>,
    equation: Equation,
    order: f64,
) -> Vec<[f64; 2]> {
    let found = (error(method, equation, 200) / error(method, equation, 400)).log2();
    sheet.absolute(format!("order, {name}"), order, found, 0.05);
    let steps = [10, 20, 50, 100, 200, 400];
    steps
        .map(|n| [1.0 / n as f64, error(method, equation, n)])
        .to_vec()
}

pub fn run(sheet: &mut Sheet) -> Outcome {
    let axes = ["step (s)", "error at t = 1 s (-)"];
    let mut figure = Figure::new("orders", "observed orders of the integrators", axes).log();
    for (theta, order) in [(0.0, 1.0), (0.5, 2.0), (1.0, 1.0)] {
        let name = format!("Beta-1, theta = {theta}");
        judge(sheet, &name, Beta1::theta(theta)?, DECAY, order);
    }
    let members = [
        ("trapezoidal", Beta2::trapezoidal(), 2.0),
        ("linear acceleration", Beta2::linear_acceleration(), 2.0),
        ("central difference", Beta2::central_difference(), 2.0),
        ("(1, 1/2)", Beta2::new(1.0, 0.5)?, 2.0),
        ("damped(0.9)", Beta2::damped(0.9)?, 1.0),
        ("damped(0.5)", Beta2::damped(0.5)?, 1.0),
    ];
    for (name, member, order) in members {
        let points = judge(sheet, name, member.family(), OSCILLATOR, order);
        figure = figure.line(name, points);
    }
    let members = [
        ("Beta-3, Houbolt", Beta3::houbolt(), 2.0),
        ("Beta-3, Wilson 1.4", Beta3::wilson(1.4)?, 2.0),
        (
            "Beta-3, beta1 = beta2 - 1/6",
            Beta3::third_order(0.3, 0.8)?,
            3.0,
        ),
    ];
    for (name, member, order) in members {
        let points = judge(sheet, name, member, OSCILLATOR, order);
        figure = figure.line(name, points);
    }
    sheet.figure(figure);
    Ok(())
}
