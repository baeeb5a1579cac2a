//! Rayleigh damping from two modal ratios, read back from the decay of a free vibration.

use foil2d::fe::material::{DampingError, LinearElastic, Material, Rayleigh};
use foil2d::integrator::Beta2;
use std::f64::consts::TAU;

/// The logarithmic decrement of one dof of unit mass, `K = omega²`, `C = alpha + beta K`, by the trapezoidal rule.
fn decrement(omega: f64, damping: Rayleigh, steps_per_period: usize) -> f64 {
    let (k, c) = (
        omega * omega,
        damping.mass + damping.stiffness * omega * omega,
    );
    let dt = TAU / omega / steps_per_period as f64;
    let method = Beta2::trapezoidal();
    let w = method.weights(dt);
    let (mut x, mut v, mut a) = ([1.0], [0.0], [-k]);
    let (mut q0, mut q1) = ([0.0], [0.0]);
    // The times and heights of maxima from the parabola through three samples.
    let mut samples = vec![x[0]];
    for _ in 0..11 * steps_per_period {
        Beta2::predict(dt, [&x, &v, &a], &mut q0, &mut q1);
        let increment = -(a[0] + c * q1[0] + k * q0[0]) / (1.0 + c * w.b1 + k * w.b0);
        x[0] = q0[0] + w.b0 * increment;
        v[0] = q1[0] + w.b1 * increment;
        a[0] += increment;
        samples.push(x[0]);
    }
    let peaks: Vec<f64> = samples
        .windows(3)
        .filter(|s| s[1] > s[0] && s[1] >= s[2])
        .map(|s| s[1] + (s[2] - s[0]).powi(2) / (8.0 * (2.0 * s[1] - s[0] - s[2])))
        .collect();
    let n = 9;
    (peaks[0] / peaks[n]).ln() / n as f64
}

#[test]
fn both_modes_decay_with_the_ratios_asked_for() {
    for (first, second) in [
        ((10.0, 0.02), (80.0, 0.05)),
        ((80.0, 0.03), (10.0, 0.03)),
        ((5.0, 0.1), (6.0, 0.1)),
    ] {
        let damping = Rayleigh::from_ratios(first, second).expect("both parts are positive");
        for (omega, zeta) in [first, second] {
            assert!((damping.ratio(omega) - zeta).abs() < 1e-14);
            // δ = 2 π ζ / sqrt(1 - ζ²). The trapezoidal rule errs by Omega²/12 = 3e-6 at 1,000 steps per period.
            let exact = TAU * zeta / f64::sqrt(1.0 - zeta * zeta);
            let found = decrement(omega, damping, 1000);
            assert!((found - exact).abs() < 1e-5 * exact, "{found} {exact}");
        }
    }
}

#[test]
fn the_limits_of_the_range_give_pure_mass_and_pure_stiffness_damping() {
    let mass = Rayleigh::from_ratios((10.0, 0.03), (30.0, 0.01)).expect("at the limit");
    assert!(mass.stiffness.abs() < 1e-18 && (mass.mass - 0.6).abs() < 1e-15);
    let stiffness = Rayleigh::from_ratios((10.0, 0.01), (30.0, 0.03)).expect("at the limit");
    assert!(stiffness.mass.abs() < 1e-15 && (stiffness.stiffness - 2e-3).abs() < 1e-18);
    assert_eq!(
        Rayleigh::from_ratios((1.0, 0.0), (2.0, 0.0)),
        Ok(Rayleigh::NONE)
    );
}

#[test]
fn ratios_that_would_feed_energy_are_refused_with_the_ratio_that_would_do() {
    let error = Rayleigh::from_ratios((10.0, 0.01), (30.0, 0.04)).expect_err("alpha < 0");
    let DampingError::NegativeMassPart {
        alpha,
        frequency,
        most,
    } = error
    else {
        panic!("{error:?}");
    };
    assert!(alpha < 0.0 && frequency == 30.0 && (most - 0.03).abs() < 1e-15);
    assert!(Rayleigh::from_ratios((10.0, 0.01), (30.0, most)).is_ok());

    let error = Rayleigh::from_ratios((30.0, 0.01), (10.0, 0.04)).expect_err("beta < 0");
    let DampingError::NegativeStiffnessPart {
        beta,
        frequency,
        least,
    } = error
    else {
        panic!("{error:?}");
    };
    assert!(beta < 0.0 && frequency == 30.0);
    assert!(Rayleigh::from_ratios((30.0, least), (10.0, 0.04)).is_ok());
    assert!(error.to_string().contains("stiffness part"), "{error}");
}

#[test]
fn frequencies_and_ratios_out_of_range_are_refused_by_number() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let first = Rayleigh::from_ratios((bad, 0.01), (2.0, 0.01));
        assert!(matches!(
            first,
            Err(DampingError::Frequency { index: 1, .. })
        ));
        let second = Rayleigh::from_ratios((1.0, 0.01), (bad, 0.01));
        assert!(matches!(
            second,
            Err(DampingError::Frequency { index: 2, .. })
        ));
    }
    for bad in [-0.1, f64::NAN, f64::INFINITY] {
        let second = Rayleigh::from_ratios((1.0, 0.01), (2.0, bad));
        assert!(matches!(second, Err(DampingError::Ratio { index: 2, .. })));
    }
    let equal = Rayleigh::from_ratios((3.0, 0.01), (3.0, 0.02));
    assert_eq!(equal, Err(DampingError::EqualFrequencies(3.0)));
}

#[test]
fn a_material_takes_the_damping_as_a_whole() {
    let damping = Rayleigh::from_ratios((10.0, 0.02), (80.0, 0.05)).expect("both positive");
    let steel = LinearElastic::plane_stress(2.1e11, 0.3)
        .density(7800.0)
        .damping(damping);
    assert!(steel.validate().is_ok());
    assert_eq!(Material::rayleigh(&steel), damping);
}
