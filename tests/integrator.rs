//! The Beta-m family by itself: orders, stability limits, period and damping, all measured.

use foil2d::integrator::{Beta1, Beta2, Beta3, BetaM, IntegratorError, TestEquation};
use nalgebra::{Matrix2, Matrix3, Vector2};

/// A linear test equation with an exact solution: `ẋ = -λ x`, or the damped oscillator.
#[derive(Clone, Copy)]
enum Problem {
    Decay { rate: f64 },
    Oscillator { omega: f64, zeta: f64 },
}

impl Problem {
    /// The derivatives `x, ẋ, ...` at time `t`.
    fn exact<const N: usize>(self, t: f64) -> [f64; N] {
        // Powers of the complex exponent (re, im) act on exp(exponent t); the real part solves the equation.
        let (re, im) = match self {
            Self::Decay { rate } => (-rate, 0.0),
            Self::Oscillator { omega, zeta } => (-zeta * omega, omega * (1.0 - zeta * zeta).sqrt()),
        };
        let mut value = (
            (re * t).exp() * (im * t).cos(),
            (re * t).exp() * (im * t).sin(),
        );
        std::array::from_fn(|_| {
            let derivative = value.0;
            value = (re * value.0 - im * value.1, re * value.1 + im * value.0);
            derivative
        })
    }

    /// Coefficients of `x`, `ẋ` and `ẍ`.
    fn coefficients(self) -> [f64; 3] {
        match self {
            Self::Decay { rate } => [rate, 1.0, 0.0],
            Self::Oscillator { omega, zeta } => [omega * omega, 2.0 * zeta * omega, 1.0],
        }
    }
}

/// Advances the derivatives by one step: the increment makes the equation hold at its end.
fn step<const N: usize>(method: BetaM<N>, problem: Problem, dt: f64, state: &mut [f64; N]) {
    method.predict_in_place(dt, state.each_mut().map(std::slice::from_mut));
    let weights = method.weights(dt);
    let w = problem.coefficients();
    let residual: f64 = w.iter().zip(state.iter()).map(|(w, q)| w * q).sum();
    let weight: f64 = w.iter().zip(weights).map(|(w, b)| w * b).sum();
    let slices = state.each_mut().map(std::slice::from_mut);
    method.correct_in_place(dt, &[-residual / weight], slices);
}

/// The error of position and velocity at `t = 1` after `n` steps from the exact derivatives.
fn error<const N: usize>(method: BetaM<N>, problem: Problem, n: usize) -> f64 {
    let dt = 1.0 / n as f64;
    let mut state: [f64; N] = problem.exact(0.0);
    for _ in 0..n {
        step(method, problem, dt, &mut state);
    }
    let exact: [f64; N] = problem.exact(1.0);
    (state[0] - exact[0]).hypot(state[1] - exact[1])
}

/// Halves the step of 1/200 and asks for the order to 0.05, which leaves room for the next term of the error.
#[track_caller]
fn assert_order<const N: usize>(method: BetaM<N>, problem: Problem, expected: f64) {
    let order = (error(method, problem, 200) / error(method, problem, 400)).log2();
    assert!(
        (order - expected).abs() < 0.05,
        "order {order}, expected {expected}: {method:?}"
    );
}

const DECAY: Problem = Problem::Decay { rate: 2.0 };
const OSCILLATOR: Problem = Problem::Oscillator {
    omega: 3.0,
    zeta: 0.0,
};
const DAMPED: Problem = Problem::Oscillator {
    omega: 3.0,
    zeta: 0.1,
};

#[test]
fn beta_1_is_of_second_order_at_one_half_and_of_first_order_elsewhere() {
    for theta in [0.0, 0.3, 0.7, 1.0] {
        assert_order(Beta1::theta(theta).expect("in range"), DECAY, 1.0);
    }
    assert_order(Beta1::theta(0.5).expect("in range"), DECAY, 2.0);
}

#[test]
fn the_three_named_members_of_beta_2_are_of_second_order_and_damped_ones_of_first() {
    for problem in [OSCILLATOR, DAMPED] {
        assert_order(Beta2::trapezoidal().family(), problem, 2.0);
        assert_order(Beta2::linear_acceleration().family(), problem, 2.0);
        assert_order(Beta2::central_difference().family(), problem, 2.0);
        let damped = Beta2::damped(0.5).expect("in range");
        assert_order(damped.family(), problem, 1.0);
    }
}

#[test]
fn beta_2_solves_first_order_equations_with_order_two_and_three_on_one_line() {
    let member = |beta0, beta1| BetaM::new([beta0, beta1, 1.0]).expect("finite");
    assert_order(member(0.5, 0.7), DECAY, 2.0);
    assert_order(member(1.0, 0.8), DECAY, 2.0);
    assert_order(member(0.8 - 1.0 / 6.0, 0.8), DECAY, 3.0);
}

#[test]
fn beta_3_is_of_second_order_and_of_third_where_beta1_is_beta2_less_a_sixth() {
    for problem in [OSCILLATOR, DAMPED] {
        assert_order(Beta3::houbolt(), problem, 2.0);
        assert_order(Beta3::wilson(1.4).expect("in range"), problem, 2.0);
        assert_order(
            Beta3::new([1.0, 0.9, 0.8, 1.0]).expect("finite"),
            problem,
            2.0,
        );
        assert_order(Beta3::third_order(0.5, 1.0).expect("finite"), problem, 3.0);
        assert_order(Beta3::third_order(0.3, 0.8).expect("finite"), problem, 3.0);
    }
}

#[test]
fn beta_3_solves_first_order_equations_with_order_three_and_four_on_one_plane() {
    let member = |beta| Beta3::new(beta).expect("finite");
    assert_order(member([1.0, 1.0, 1.0, 1.0]), DECAY, 4.0);
    assert_order(member([1.2, 1.0, 1.0, 1.0]), DECAY, 3.0);
}

/// Advances `M ẍ + C ẋ + K x = 0` with matrices, and the derivatives above its order from those below at the start.
fn march<const N: usize>(
    method: BetaM<N>,
    matrices: [Matrix2<f64>; 3],
    start: [Vector2<f64>; N],
    dt: f64,
    n_steps: usize,
) -> Vector2<f64> {
    let weights = method.weights(dt);
    let order = matrices.iter().rposition(|m| *m != Matrix2::zeros());
    let used = ..=order.expect("an equation");
    let effective: Matrix2<f64> = matrices[used]
        .iter()
        .zip(weights)
        .map(|(matrix, weight)| matrix * weight)
        .sum();
    let inverse = effective.try_inverse().expect("a regular step");
    let mut state = start;
    for _ in 0..n_steps {
        let slices = state.each_mut().map(|x| x.as_mut_slice());
        method.predict_in_place(dt, slices);
        let forces = matrices[used].iter().zip(&state).map(|(m, q)| m * q);
        let increment = -inverse * forces.sum::<Vector2<f64>>();
        let slices = state.each_mut().map(|x| x.as_mut_slice());
        method.correct_in_place(dt, increment.as_slice(), slices);
    }
    state[0]
}

#[test]
fn systems_of_first_and_second_order_are_marched_as_vectors() {
    let stiffness = Matrix2::new(3.0, -1.0, -1.0, 3.0);
    let unit = Matrix2::identity();
    // Eigenvectors (1, 1) and (1, -1) with eigenvalues 2 and 4.
    let modes = [
        (Vector2::new(1.0, 1.0), 2.0),
        (Vector2::new(1.0, -1.0), 4.0),
    ];
    let combined = |f: &dyn Fn(f64) -> f64| -> Vector2<f64> {
        modes.iter().map(|(mode, value)| mode * f(*value)).sum()
    };
    let decaying: [Vector2<f64>; 3] =
        std::array::from_fn(|i| combined(&|k: f64| (-k).powi(i as i32)));
    let method = Beta2::trapezoidal().family();
    let error = |n: usize| {
        let matrices = [stiffness, unit, Matrix2::zeros()];
        let end = march(method, matrices, decaying, 1.0 / n as f64, n);
        (end - combined(&|k: f64| (-k).exp())).norm()
    };
    let order = (error(200) / error(400)).log2();
    assert!((order - 2.0).abs() < 0.05, "first order system: {order}");

    // x = cos(sqrt(k) t): the derivatives at the start are 1, 0, -k, 0.
    let swinging: [Vector2<f64>; 4] = [1, 0, -1, 0]
        .map(|sign| combined(&|k: f64| f64::from(sign) * if sign < 0 { k } else { 1.0 }));
    let error = |n: usize| {
        let matrices = [stiffness, Matrix2::zeros(), unit];
        let end = march(Beta3::houbolt(), matrices, swinging, 1.0 / n as f64, n);
        (end - combined(&|k: f64| k.sqrt().cos())).norm()
    };
    let order = (error(200) / error(400)).log2();
    assert!((order - 2.0).abs() < 0.05, "second order system: {order}");
}

#[test]
fn the_stability_limits_of_the_named_members_come_out_of_the_amplification_matrix() {
    let limit = |method: Beta2| method.family().critical_sampling();
    assert!((limit(Beta2::linear_acceleration()) - 12f64.sqrt()).abs() < 1e-6);
    assert!((limit(Beta2::central_difference()) - 2.0).abs() < 1e-6);
    assert_eq!(limit(Beta2::trapezoidal()), f64::INFINITY);
    assert_eq!(limit(Beta2::default()), f64::INFINITY);
    // Members between: the closed form sqrt(2 / (beta1 - beta0)).
    for (beta0, beta1) in [(0.2, 0.5), (0.1, 0.5), (0.3, 0.6), (0.6, 0.9)] {
        let method = Beta2::new(beta0, beta1).expect("in range");
        let found = limit(method);
        let expected = method.critical_sampling();
        assert!(
            (found - expected).abs() < 1e-6 * expected,
            "{found} {expected}"
        );
    }
}

#[test]
fn damping_moves_the_stability_limit_as_the_root_at_minus_one_says() {
    // Newmark's polynomial at z = -1 vanishes where Omega² (beta1 - beta0)/2 - zeta Omega (2 beta1 - 1) - 1 = 0.
    let zeta = 0.2;
    for (beta0, beta1) in [(0.0, 0.5), (1.0 / 3.0, 0.5), (0.3, 0.6), (0.0, 0.8)] {
        let method = BetaM::new([beta0, beta1, 1.0]).expect("finite");
        let (curve, slope) = (0.5 * (beta1 - beta0), zeta * (2.0 * beta1 - 1.0));
        let expected = (slope + f64::sqrt(slope * slope + 4.0 * curve)) / (2.0 * curve);
        let found = method.critical_sampling_damped(zeta);
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    }
}

#[test]
fn houbolt_and_wilson_are_stable_at_every_step_and_wilson_only_from_1_366_on() {
    assert_eq!(Beta3::houbolt().critical_sampling(), f64::INFINITY);
    for theta in [1.37, 1.4, 2.0] {
        let wilson = Beta3::wilson(theta).expect("in range");
        assert_eq!(wilson.critical_sampling(), f64::INFINITY, "theta {theta}");
    }
    let wilson = Beta3::wilson(1.36).expect("in range");
    assert!(wilson.critical_sampling().is_finite());
    // With theta = 1 it is the linear acceleration method.
    let limit = Beta3::wilson(1.0).expect("in range").critical_sampling();
    assert!((limit - 12f64.sqrt()).abs() < 1e-6, "{limit}");
}

#[test]
fn members_of_third_order_are_stable_for_short_steps_only() {
    for (beta0, beta2) in [(0.5, 1.0), (0.3, 0.8), (0.5, 1.2), (0.8, 2.0), (0.0, 0.6)] {
        let method = Beta3::third_order(beta0, beta2).expect("in range");
        let limit = method.critical_sampling();
        assert!(limit > 1.0 && limit < 10.0, "{beta0} {beta2}: {limit}");
        let sampling = 0.05;
        let equation = TestEquation::oscillator(sampling);
        let mode = method.amplification(equation).mode().expect("a mode");
        // The next term is smaller by sampling² = 2.5e-3 times a constant of one or two.
        let expected = (0.5 * beta2 - beta0) * sampling.powi(3) / 12.0;
        let error = (mode.damping_ratio - expected).abs();
        assert!(error < 1e-2 * expected + 1e-13, "{mode:?} {expected}");
    }
    // beta0 > beta2/2, which the constructor refuses: growth of (beta0 - beta2/2) sampling⁴/12 per step.
    let growing = Beta3::new([1.0, 1.0 - 1.0 / 6.0, 1.0, 1.0]).expect("finite");
    let radius = growing
        .amplification(TestEquation::oscillator(0.1))
        .spectral_radius();
    assert!(radius > 1.0 + 4e-6, "{radius}");
}

#[test]
fn numerov_s_method_is_a_member_of_beta_3() {
    let numerov = Beta3::third_order(0.5, 1.0).expect("in range");
    assert!((numerov.critical_sampling() - 6f64.sqrt()).abs() < 1e-6);
    // z² - 2 z + 1 + Omega² (z² + 10 z + 1)/12, times z², over its first coefficient.
    let square = 0.7f64 * 0.7 / 12.0;
    let polynomial = numerov
        .amplification(TestEquation::oscillator(0.7))
        .polynomial();
    let expected = [0.0, 0.0, 1.0 + square, -2.0 + 10.0 * square, 1.0 + square];
    for (found, expected) in polynomial.iter().zip(expected) {
        assert!((found - expected / (1.0 + square)).abs() < 1e-14);
    }
}

#[test]
fn a_member_that_always_grows_has_no_stable_step() {
    let growing = BetaM::new([0.5, 0.4, 1.0]).expect("finite");
    assert_eq!(growing.critical_sampling(), 0.0);
}

#[test]
fn free_motion_obeys_the_amplification_polynomial_and_its_matrix() {
    // Rounding of the coefficients, which stay below 10, over four terms.
    fn check<const N: usize>(method: BetaM<N>) {
        let (omega, zeta, dt) = (3.0, 0.07, 0.2);
        let problem = Problem::Oscillator { omega, zeta };
        let amplification = method.amplification(TestEquation::SecondOrder {
            sampling: omega * dt,
            damping: zeta,
        });
        let mut state: [f64; N] = problem.exact(0.0);
        let mut positions = vec![state[0]];
        for _ in 0..12 {
            let before = state;
            step(method, problem, dt, &mut state);
            positions.push(state[0]);
            for (i, row) in amplification.matrix().row_iter().enumerate() {
                let scaled = |j: usize, x: f64| x * dt.powi(j as i32);
                let product: f64 = (0..N).map(|j| row[j] * scaled(j, before[j])).sum();
                assert!((product - scaled(i, state[i])).abs() < 1e-13);
            }
        }
        let polynomial = amplification.polynomial();
        for window in positions.windows(N + 1) {
            let sum: f64 = polynomial.iter().zip(window).map(|(c, x)| c * x).sum();
            assert!(sum.abs() < 1e-13, "{sum:e} of {method:?}");
        }
    }
    check(Beta2::linear_acceleration().family());
    check(Beta2::central_difference().family());
    check(Beta2::default().family());
    check(Beta3::houbolt());
    check(Beta3::wilson(1.4).expect("in range"));
}

#[test]
fn the_polynomial_of_houbolt_is_that_of_its_backward_difference() {
    // (2 x1 - 5 x0 + 4 x-1 - x-2) + Omega² x1 = 0, times z for the derivative that follows from the equation.
    for sampling in [0.1f64, 1.0, 30.0] {
        let square = sampling * sampling;
        let expected = [0.0, -1.0, 4.0, -5.0, 2.0 + square].map(|c| c / (2.0 + square));
        let polynomial = Beta3::houbolt()
            .amplification(TestEquation::oscillator(sampling))
            .polynomial();
        for (found, expected) in polynomial.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-13, "{found} {expected}");
        }
    }
}

#[test]
fn the_wilson_member_amplifies_as_wilson_s_own_procedure() {
    for theta in [1.2, 1.4, 1.8] {
        for sampling in [0.3, 2.0, 20.0] {
            let square: f64 = sampling * sampling;
            // Linear acceleration over theta steps, then back to one: state [x, dt v, dt² a].
            let extended = 1.0 + square * theta * theta / 6.0;
            let at_theta = [1.0, theta, theta * theta / 3.0].map(|c| -square * c / extended);
            let mut rows = Matrix3::zeros();
            for column in 0..3 {
                let old = f64::from(u8::from(column == 2));
                rows[(2, column)] = old + (at_theta[column] - old) / theta;
                rows[(1, column)] =
                    f64::from(u8::from(column == 1)) + 0.5 * (old + rows[(2, column)]);
                rows[(0, column)] =
                    f64::from(u8::from(column <= 1)) + (2.0 * old + rows[(2, column)]) / 6.0;
            }
            let own = rows.complex_eigenvalues().map(|z| z.norm()).max();
            let member = Beta3::wilson(theta).expect("in range");
            let found = member
                .amplification(TestEquation::oscillator(sampling))
                .spectral_radius();
            assert!((found - own).abs() < 1e-9, "{found} {own} at {theta}");
        }
    }
}

#[test]
fn period_errors_of_the_named_members_are_those_of_theory() {
    // The next term is of the order of sampling^4 = 1e-4 of which a hundredth part is allowed.
    let sampling = 0.1;
    for (method, expected) in [
        (Beta2::trapezoidal(), 1.0 / 12.0),
        (Beta2::linear_acceleration(), 1.0 / 24.0),
        (Beta2::central_difference(), -1.0 / 24.0),
    ] {
        let mode = method
            .amplification(TestEquation::oscillator(sampling))
            .mode()
            .expect("three eigenvalues");
        let expected = expected * sampling * sampling;
        assert!((mode.period_error - expected).abs() < 2e-6, "{mode:?}");
        assert!(mode.damping_ratio.abs() < 1e-12, "{mode:?}");
    }
}

#[test]
fn a_march_shows_the_period_and_the_damping_that_the_eigenvalues_promise() {
    let (omega, zeta, dt) = (2.0, 0.03, 0.15);
    let problem = Problem::Oscillator { omega, zeta };
    let equation = TestEquation::SecondOrder {
        sampling: omega * dt,
        damping: zeta,
    };
    for method in [Beta2::damped(0.6).expect("in range"), Beta2::trapezoidal()] {
        let mode = method.amplification(equation).mode().expect("a mode");
        let mut state: [f64; 3] = problem.exact(0.0);
        // A free motion is x_n = Re(c z^n): from three positions x_{n+1} - 2 Re(z) x_n + |z|² x_{n-1} = 0.
        let mut x = Vec::new();
        for _ in 0..10 {
            step(method.family(), problem, dt, &mut state);
            x.push(state[0]);
        }
        let root = mode.root;
        for w in x.windows(3) {
            let sum = w[2] - 2.0 * root.re * w[1] + root.norm_sqr() * w[0];
            assert!(sum.abs() < 1e-13, "{sum:e}");
        }
        let turn = root.arg().abs();
        let exact = omega * dt * (1.0 - zeta * zeta).sqrt();
        assert!((mode.period_error - (exact / turn - 1.0)).abs() < 1e-14);
    }
    // First-order damping of the members with beta1 > 1/2: (beta1 - 1/2) Omega / 2.
    let method = Beta2::damped(0.6).expect("in range");
    let mode = method.amplification(TestEquation::oscillator(0.01)).mode();
    let expected = 0.5 * (method.beta1() - 0.5) * 0.01;
    let damping = mode.expect("a mode").damping_ratio;
    assert!((damping - expected).abs() < 0.01 * expected, "{damping}");
}

#[test]
fn decay_is_amplified_by_the_rational_function_of_the_theta_method() {
    for (theta, decay) in [(0.0, 0.1), (0.5, 0.1), (0.5, 100.0), (1.0, 3.0)] {
        let method = Beta1::theta(theta).expect("in range");
        let amplification = method.amplification(TestEquation::FirstOrder { decay });
        let expected: f64 = (1.0 - (1.0 - theta) * decay) / (1.0 + theta * decay);
        assert!((amplification.spectral_radius() - expected.abs()).abs() < 1e-14);
        if decay < 1.0 {
            assert!((amplification.mode().expect("a root").root.re - expected).abs() < 1e-14);
        }
    }
}

#[test]
fn the_family_with_m_2_is_beta_2_bit_by_bit_in_its_weights_and_to_rounding_in_its_operators() {
    let method = Beta2::linear_acceleration();
    let family = BetaM::from(method);
    let (dt, state) = (0.013, [1.25, -3.5, 7.75]);
    let weights = method.weights(dt);
    let [b0, b1, b2] = family.weights(dt);
    assert!((b0 - weights.b0).abs() < 1e-19 && b1 == weights.b1 && b2 == 1.0);
    let (mut q0, mut q1) = ([0.0], [0.0]);
    let [x, v, a] = state.map(|value| [value]);
    Beta2::predict(dt, [&x, &v, &a], &mut q0, &mut q1);
    let mut operators = state;
    family.predict_in_place(dt, operators.each_mut().map(std::slice::from_mut));
    assert!((operators[0] - q0[0]).abs() < 1e-15 && (operators[1] - q1[0]).abs() < 1e-15);
    assert_eq!(operators[2], a[0]);
}

#[test]
fn parameters_that_make_no_member_are_refused_by_name() {
    let named = |result: Result<Beta3, IntegratorError>| match result {
        Err(IntegratorError::Parameter { name, .. }) => name,
        other => panic!("{other:?}"),
    };
    assert_eq!(named(Beta3::new([-1.0, 0.5, 0.5, 1.0])), "beta0");
    assert_eq!(named(Beta3::new([1.0, 0.5, f64::NAN, 1.0])), "beta2");
    assert!(named(Beta3::new([1.0, 0.5, 0.5, 2.0])).starts_with("beta_m"));
    assert_eq!(named(Beta3::wilson(0.9)), "theta");
    assert_eq!(named(Beta3::third_order(0.0, 0.4)), "beta2");
    assert_eq!(named(Beta3::third_order(0.6, 1.0)), "beta0");
    assert!(Beta1::theta(1.1).is_err() && Beta1::theta(f64::NAN).is_err());
}
