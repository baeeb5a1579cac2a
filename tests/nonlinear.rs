//! Steps of `M ẍ + Q(x, ẋ) = R` with springs and drags that are not linear.

use foil2d::integrator::Beta2;
use foil2d::nonlinear::{
    CubicSpring, InternalForce, Motion, NewtonSettings, NonLinearError, NonLinearStepper,
    QuadraticDrag, Sum, TangentSource,
};

const DUFFING: CubicSpring = CubicSpring {
    linear: 4.0,
    cubic: 30.0,
    damping: 0.3,
};
const MASS: f64 = 1.5;

fn tight() -> NewtonSettings {
    NewtonSettings {
        tolerance: 1e-13,
        ..NewtonSettings::default()
    }
}

/// The harmonic load on the oscillator (N).
fn load(t: f64) -> f64 {
    2.0 * (1.3 * t).cos()
}

/// Duffing's oscillator from 1 m at rest: position and velocity at `t = 2` by `n` steps of a Beta-2 member.
fn duffing(method: Beta2, law: &dyn InternalForce, n: usize) -> [f64; 2] {
    let mut stepper = NonLinearStepper::lumped(&[MASS], method, tight()).expect("sound");
    let mut motion = stepper
        .start(law, &[load(0.0)], vec![1.0], vec![0.0])
        .expect("massive");
    let dt = 2.0 / n as f64;
    for k in 1..=n {
        let load = load(k as f64 * dt);
        stepper
            .step(dt, law, &[load], &mut motion)
            .expect("it converges");
    }
    [motion.position[0], motion.velocity[0]]
}

/// The same by the classical Runge–Kutta method of fourth order.
fn duffing_reference(n: usize) -> [f64; 2] {
    let rate = |t: f64, [x, v]: [f64; 2]| {
        let CubicSpring {
            linear,
            cubic,
            damping,
        } = DUFFING;
        let force = linear * x + cubic * x * x * x + damping * v;
        [v, (load(t) - force) / MASS]
    };
    let along = |s: [f64; 2], h: f64, d: [f64; 2]| [s[0] + h * d[0], s[1] + h * d[1]];
    let h = 2.0 / n as f64;
    let mut state = [1.0, 0.0];
    for k in 0..n {
        let t = k as f64 * h;
        let a = rate(t, state);
        let b = rate(t + 0.5 * h, along(state, 0.5 * h, a));
        let c = rate(t + 0.5 * h, along(state, 0.5 * h, b));
        let d = rate(t + h, along(state, h, c));
        for i in 0..2 {
            state[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
        }
    }
    state
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[test]
fn duffing_s_oscillator_is_followed_with_order_two_by_the_named_members() {
    let exact = duffing_reference(20_000);
    // The reference itself is good to rounding: h^4 = 1e-16.
    assert!(distance(exact, duffing_reference(10_000)) < 1e-11);
    for method in [
        Beta2::trapezoidal(),
        Beta2::linear_acceleration(),
        Beta2::central_difference(),
    ] {
        let error = |n: usize| distance(duffing(method, &DUFFING, n), exact);
        let order = (error(1000) / error(2000)).log2();
        assert!((order - 2.0).abs() < 0.05, "order {order} of {method:?}");
    }
}

#[test]
fn a_body_in_quadratic_drag_slows_down_as_one_over_time() {
    // v = v0 / (1 + k v0 t), x = ln(1 + k v0 t) / k, with k = c/m.
    let (speed, drag, mass) = (8.0, 0.6, 2.0);
    let law = QuadraticDrag { coefficient: drag };
    let end = |n: usize| {
        let method = Beta2::trapezoidal();
        let mut stepper = NonLinearStepper::lumped(&[mass], method, tight()).expect("sound");
        let mut motion = stepper
            .start(&law, &[0.0], vec![0.0], vec![speed])
            .expect("massive");
        for _ in 0..n {
            stepper
                .step(3.0 / n as f64, &law, &[0.0], &mut motion)
                .expect("it converges");
        }
        [motion.position[0], motion.velocity[0]]
    };
    let k = drag / mass;
    let slowed = 1.0 + k * speed * 3.0;
    let exact = [slowed.ln() / k, speed / slowed];
    let [coarse, fine] = [600, 1200].map(|n| distance(end(n), exact));
    let order = (coarse / fine).log2();
    assert!((order - 2.0).abs() < 0.05, "order {order}");
    // dt² times the third derivative of the beginning, 6 k³ v0⁴ over 12.
    assert!(fine < 3e-4, "{fine}");
}

/// A law that keeps its tangent to itself.
struct WithoutTangent<F>(F);

impl<F: InternalForce> InternalForce for WithoutTangent<F> {
    fn force(&self, position: &[f64], velocity: &[f64], force: &mut [f64]) {
        self.0.force(position, velocity, force);
    }
}

/// Two masses between springs, the middle one cubic, with drag on the relative motion: couples its dofs.
#[derive(Clone, Copy)]
struct Chain;

impl InternalForce for Chain {
    fn force(&self, x: &[f64], v: &[f64], force: &mut [f64]) {
        let (stretch, rate) = (x[1] - x[0], v[1] - v[0]);
        let pull = 5.0 * stretch + 40.0 * stretch.powi(3) + 0.8 * rate.abs() * rate;
        force.copy_from_slice(&[10.0 * x[0] - pull, 10.0 * x[1] + pull]);
    }

    fn tangent(&self, x: &[f64], v: &[f64], k: &mut [f64], c: &mut [f64]) -> TangentSource {
        let (stretch, rate) = (x[1] - x[0], v[1] - v[0]);
        let stiffness = 5.0 + 120.0 * stretch * stretch;
        let damping = 1.6 * rate.abs();
        k.copy_from_slice(&[10.0 + stiffness, -stiffness, -stiffness, 10.0 + stiffness]);
        c.copy_from_slice(&[damping, -damping, -damping, damping]);
        TangentSource::Supplied
    }
}

/// The chain after 200 steps of 0.02 s, and the iterations it took.
fn chain(law: &dyn InternalForce) -> (Motion, usize, TangentSource) {
    let mass = vec![2.0, 0.3, 0.3, 1.0];
    let mut stepper = NonLinearStepper::new(mass, 2, Beta2::trapezoidal(), tight()).expect("sound");
    let mut motion = stepper
        .start(law, &[0.0, 1.0], vec![0.5, -0.7], vec![1.0, 0.0])
        .expect("massive");
    let mut iterations = 0;
    for _ in 0..200 {
        let report = stepper
            .step(0.02, law, &[0.0, 1.0], &mut motion)
            .expect("it converges");
        iterations += report.n_iterations();
    }
    (motion, iterations, stepper.report().tangent)
}

#[test]
fn tangents_by_finite_differences_lead_to_the_same_motion_in_as_many_iterations() {
    let (supplied, iterations, source) = chain(&Chain);
    assert_eq!(source, TangentSource::Supplied);
    let (found, more, source) = chain(&WithoutTangent(Chain));
    assert_eq!(source, TangentSource::FiniteDifferences);
    for (a, b) in [
        (&supplied.position, &found.position),
        (&supplied.velocity, &found.velocity),
        (&supplied.acceleration, &found.acceleration),
    ] {
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() < 1e-9, "{a} {b}");
        }
    }
    assert!(more <= iterations + iterations / 5, "{more} {iterations}");
}

#[test]
fn a_linear_force_takes_one_iteration_of_c5() {
    let law = CubicSpring {
        linear: 50.0,
        cubic: 0.0,
        damping: 0.4,
    };
    let settings = NewtonSettings::default();
    let mut stepper =
        NonLinearStepper::lumped(&[2.0], Beta2::trapezoidal(), settings).expect("sound");
    let mut motion = stepper
        .start(&law, &[3.0], vec![0.1], vec![-1.0])
        .expect("massive");
    let before = motion.clone();
    let report = stepper
        .step(0.05, &law, &[3.0], &mut motion)
        .expect("linear");
    assert_eq!((report.n_iterations(), report.n_force_evaluations), (1, 2));
    // (b2 M + b1 C + b0 K) Δ = R - [M q2 + C q1 + K q0]
    let (x, v, a) = (
        before.position[0],
        before.velocity[0],
        before.acceleration[0],
    );
    let (q0, q1) = (x + 0.05 * v + 0.00125 * a, v + 0.05 * a);
    let increment = (3.0 - 2.0 * a - 0.4 * q1 - 50.0 * q0) / (2.0 + 0.4 * 0.025 + 50.0 * 0.000625);
    assert!((motion.acceleration[0] - (a + increment)).abs() < 1e-13);
}

#[test]
fn residuals_fall_quadratically() {
    // A step so long that the predictor is far off.
    let mut stepper =
        NonLinearStepper::lumped(&[1.0], Beta2::trapezoidal(), tight()).expect("sound");
    let law = CubicSpring {
        linear: 1.0,
        cubic: 8.0,
        damping: 0.0,
    };
    let mut motion = stepper
        .start(&law, &[0.0], vec![1.0], vec![0.0])
        .expect("massive");
    let report = stepper
        .step(0.6, &law, &[0.0], &mut motion)
        .expect("it converges");
    let r = &report.residuals;
    assert!(report.n_iterations() >= 4, "{r:?}");
    // Three in a row close to the end, the last ten times above the rounding of forces of 10 N.
    let [.., a, b, c] = r[..] else {
        panic!("{r:?}");
    };
    assert!(a < 1e-2 && c > 1e-14, "{r:?}");
    let order = (c / b).ln() / (b / a).ln();
    assert!((order - 2.0).abs() < 0.05, "order {order} of {r:?}");
}

/// `Q = atan(40 x)`: whole Newton steps from afar overshoot and run away.
struct Saturating;

impl InternalForce for Saturating {
    fn force(&self, position: &[f64], _velocity: &[f64], force: &mut [f64]) {
        force[0] = (40.0 * position[0]).atan();
    }

    fn tangent(&self, x: &[f64], _v: &[f64], k: &mut [f64], _c: &mut [f64]) -> TangentSource {
        k[0] = 40.0 / (1.0 + 1600.0 * x[0] * x[0]);
        TangentSource::Supplied
    }
}

#[test]
fn the_line_search_saves_steps_that_whole_increments_lose() {
    // Hardly any mass: the step solves atan(40 x) = 0 from x = 1.
    let step = |max_cuts: usize| {
        let settings = NewtonSettings {
            max_cuts,
            ..NewtonSettings::default()
        };
        let method = Beta2::trapezoidal();
        let mut stepper = NonLinearStepper::lumped(&[1e-9], method, settings).expect("sound");
        let mut motion = Motion {
            position: vec![1.0],
            velocity: vec![0.0],
            acceleration: vec![0.0],
        };
        let before = motion.clone();
        let result = stepper.step(0.1, &Saturating, &[0.0], &mut motion).cloned();
        (result, motion, before)
    };
    let (result, motion, _) = step(12);
    let report = result.expect("cut increments arrive");
    assert!(report.line_search_cuts > 0 && motion.position[0].abs() < 1e-6);
    assert!(report.residuals.windows(2).all(|r| r[1] < r[0]));
    let (result, motion, before) = step(0);
    assert!(result.is_err());
    assert_eq!(motion, before);
}

#[test]
fn what_stops_a_step_is_named_and_leaves_the_motion_alone() {
    let method = Beta2::trapezoidal();
    let start = Motion {
        position: vec![1.0],
        velocity: vec![0.0],
        acceleration: vec![0.0],
    };
    let attempt = |mass: f64, law: &dyn InternalForce, settings: NewtonSettings| {
        let mut stepper = NonLinearStepper::lumped(&[mass], method, settings).expect("sound");
        let mut motion = start.clone();
        let error = stepper
            .step(0.1, law, &[0.0], &mut motion)
            .map(|report| report.n_iterations())
            .expect_err("it cannot be solved");
        assert_eq!(motion, start);
        error
    };
    let one = NewtonSettings {
        max_iterations: 1,
        ..tight()
    };
    let error = attempt(1.0, &DUFFING, one);
    assert!(matches!(
        error,
        NonLinearError::NotConverged { iterations: 1, .. }
    ));
    assert!(error.to_string().contains("shorten the step"), "{error}");

    /// A root of what may be negative.
    struct Root;
    impl InternalForce for Root {
        fn force(&self, position: &[f64], _: &[f64], force: &mut [f64]) {
            force[0] = (position[0] - 2.0).sqrt();
        }
    }
    let error = attempt(1.0, &Root, tight());
    assert!(matches!(error, NonLinearError::NotFinite { dof: 0, .. }));

    /// Constant thrust on something without mass.
    struct Thrust;
    impl InternalForce for Thrust {
        fn force(&self, _: &[f64], _: &[f64], force: &mut [f64]) {
            force[0] = 1.0;
        }
    }
    let error = attempt(0.0, &Thrust, tight());
    assert!(matches!(
        error,
        NonLinearError::SingularTangent { dof: 0, .. }
    ));

    /// A tangent of the wrong sign leads uphill.
    struct Uphill;
    impl InternalForce for Uphill {
        fn force(&self, position: &[f64], _: &[f64], force: &mut [f64]) {
            force[0] = 1e6 * position[0];
        }
        fn tangent(&self, _: &[f64], _: &[f64], k: &mut [f64], _: &mut [f64]) -> TangentSource {
            k[0] = -1e6;
            TangentSource::Supplied
        }
    }
    let error = attempt(1.0, &Uphill, tight());
    assert!(matches!(
        error,
        NonLinearError::Stalled { iteration: 1, .. }
    ));
    assert!(error.to_string().contains("check the tangent"), "{error}");
}

#[test]
fn wrong_lengths_steps_and_settings_are_refused() {
    let method = Beta2::trapezoidal();
    let bad = NewtonSettings {
        tolerance: 0.0,
        ..NewtonSettings::default()
    };
    assert!(matches!(
        NonLinearStepper::lumped(&[1.0], method, bad),
        Err(NonLinearError::Setting(_))
    ));
    let shape = NonLinearStepper::new(vec![1.0; 3], 2, method, tight());
    assert!(matches!(
        shape,
        Err(NonLinearError::Length { expected: 4, .. })
    ));
    let mut stepper = NonLinearStepper::lumped(&[1.0], method, tight()).expect("sound");
    let mut motion = stepper
        .start(&DUFFING, &[0.0], vec![1.0], vec![0.0])
        .expect("massive");
    for dt in [0.0, -1.0, f64::NAN] {
        let error = stepper
            .step(dt, &DUFFING, &[0.0], &mut motion)
            .map(|_| ())
            .expect_err("not a step");
        assert!(matches!(error, NonLinearError::StepLength(_)));
    }
    let error = stepper
        .step(0.1, &DUFFING, &[0.0, 0.0], &mut motion)
        .map(|_| ())
        .expect_err("one dof");
    assert!(matches!(error, NonLinearError::Length { found: 2, .. }));
    motion.velocity[0] = f64::NAN;
    let error = stepper
        .step(0.1, &DUFFING, &[0.0], &mut motion)
        .map(|_| ())
        .expect_err("not a number");
    assert!(matches!(error, NonLinearError::NotFinite { .. }));
}

#[test]
fn forces_add_up_whether_or_not_their_tangents_are_known() {
    let drag = QuadraticDrag { coefficient: 0.4 };
    let end = |law: &dyn InternalForce| duffing(Beta2::trapezoidal(), law, 400);
    let both = end(&Sum(DUFFING, drag));
    let differences = end(&Sum(WithoutTangent(DUFFING), drag));
    let half = end(&Sum(drag, WithoutTangent(DUFFING)));
    assert!(distance(both, differences) < 1e-9 && distance(both, half) < 1e-9);
    // The drag takes energy: the amplitude is not that of the spring alone.
    assert!(distance(both, end(&DUFFING)) > 1e-3);
}
