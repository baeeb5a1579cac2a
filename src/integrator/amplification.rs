//! What a step does to one mode: `s' = A s` with the scaled derivatives `s_i = dt^i x⁽ⁱ⁾`, `A = P - l (wᵀP)/(wᵀl)`.
//!
//! `P_ij = 1/(j-i)!` is the operator `q`, `l_i = β_i/(m-i)!` the weights, and `w` the equation at the end of the step,
//! `wᵀ s' = 0`. Eigenvalues of `A` tell stability (none outside the unit circle) and, against `exp(i ω dt)`, period error and
//! numerical damping. One eigenvalue is always zero: the derivatives at the end of a step fit the equation.

use super::{Beta2, BetaM};
use nalgebra::{Complex, DMatrix, Schur};

/// An equation whose exact solution is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TestEquation {
    /// `ẋ + λ x = 0`, with `decay = λ dt` (-).
    FirstOrder {
        /// `λ dt` (-).
        decay: f64,
    },
    /// `ẍ + 2 ζ ω ẋ + ω² x = 0`, with `sampling = ω dt` (-).
    SecondOrder {
        /// `ω dt` (-).
        sampling: f64,
        /// The damping ratio `ζ` (-).
        damping: f64,
    },
}

impl TestEquation {
    /// The undamped oscillator with `ω dt = sampling` (-).
    pub const fn oscillator(sampling: f64) -> Self {
        Self::SecondOrder {
            sampling,
            damping: 0.0,
        }
    }

    /// The coefficients of `s_0`, `s_1`, `s_2` in the equation, scaled to at most one.
    fn coefficients(&self) -> [f64; 3] {
        let [w0, w1, w2] = match *self {
            Self::FirstOrder { decay } => [decay, 1.0, 0.0],
            Self::SecondOrder { sampling, damping } => {
                [sampling * sampling, 2.0 * damping * sampling, 1.0]
            }
        };
        let largest = w0.abs().max(w1.abs()).max(w2);
        [w0 / largest, w1 / largest, w2 / largest]
    }

    /// The factor of the exact solution over one step.
    fn exact_root(&self) -> Complex<f64> {
        match *self {
            Self::FirstOrder { decay } => Complex::new((-decay).exp(), 0.0),
            Self::SecondOrder { sampling, damping } => {
                let (rate, turn) = (-damping * sampling, sampling * damped_part(damping));
                Complex::new(rate, turn).exp()
            }
        }
    }
}

/// `sqrt(1 - ζ²)`, zero from critical damping on.
fn damped_part(damping: f64) -> f64 {
    (1.0 - damping * damping).max(0.0).sqrt()
}

/// The amplification matrix of one member for one test equation.
#[derive(Clone, Debug, PartialEq)]
pub struct Amplification {
    matrix: DMatrix<f64>,
    equation: TestEquation,
}

/// The numerical motion of a mode, read off the eigenvalue that stands for the exact solution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// `exp((-ζ ω + i ω_d) dt)` as the method has it (-).
    pub root: Complex<f64>,
    /// Relative error of the period: 0.01 if the numerical motion takes 1 % longer (-). Zero for motion without one.
    pub period_error: f64,
    /// Damping ratio that the mode shows, its physical damping included (-).
    pub damping_ratio: f64,
}

impl Amplification {
    /// The matrix `A` over `[x, dt ẋ, dt² ẍ, ...]`.
    pub fn matrix(&self) -> &DMatrix<f64> {
        &self.matrix
    }

    /// The coefficients `[c_0, ..., c_{N-1}, 1]` of `det(z - A) = Σ c_k z^k`, by Faddeev and Le Verrier.
    ///
    /// Every derivative of a free motion obeys `Σ_k c_k x_{n+k} = 0` (Cayley and Hamilton).
    pub fn polynomial(&self) -> Vec<f64> {
        let size = self.matrix.nrows();
        let mut coefficients = vec![1.0; size + 1];
        let mut power = DMatrix::<f64>::identity(size, size);
        for k in 1..=size {
            let product = &self.matrix * &power;
            let coefficient = -product.trace() / k as f64;
            coefficients[size - k] = coefficient;
            power = product + DMatrix::identity(size, size) * coefficient;
        }
        coefficients
    }

    /// The eigenvalues of `A`; empty in the case that the QR iterations do not converge.
    pub fn eigenvalues(&self) -> Vec<Complex<f64>> {
        const MOST_ITERATIONS: usize = 10_000;
        let schur = Schur::try_new(self.matrix.clone(), f64::EPSILON, MOST_ITERATIONS);
        schur.map_or_else(Vec::new, |schur| {
            schur.complex_eigenvalues().iter().copied().collect()
        })
    }

    /// The largest modulus of an eigenvalue: motion stays bounded if it is below one, and for simple eigenvalues at one.
    ///
    /// Double eigenvalues on the unit circle are known to half the digits, 1e-8.
    pub fn spectral_radius(&self) -> f64 {
        self.eigenvalues()
            .iter()
            .map(|root| root.norm())
            .reduce(f64::max)
            .unwrap_or(f64::NAN)
    }

    /// The eigenvalue nearest to the exact factor of a step, as period and damping; none if there is no eigenvalue.
    ///
    /// Meant for resolved modes, `ω dt` below one or so: beyond, the nearest root need not stand for the solution.
    pub fn mode(&self) -> Option<Mode> {
        let exact = self.equation.exact_root();
        let distance = |root: &Complex<f64>| (root - exact).norm();
        let root = self
            .eigenvalues()
            .into_iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        let exponent = root.ln();
        let exact_turn = match self.equation {
            TestEquation::FirstOrder { .. } => 0.0,
            TestEquation::SecondOrder { sampling, damping } => sampling * damped_part(damping),
        };
        let period_error = if exact_turn > 0.0 {
            exact_turn / exponent.im.abs() - 1.0
        } else {
            0.0
        };
        Some(Mode {
            root,
            period_error,
            damping_ratio: -exponent.re / exponent.norm(),
        })
    }
}

/// Growth per step below this is taken for the rounding of a double eigenvalue on the unit circle.
const GROWTH: f64 = 1e-7;
/// The stability limit is looked for between these values of `ω dt`.
const SAMPLINGS: [f64; 2] = [1e-2, 1e4];
/// Samples per factor of ten of that range: gaps of stability narrower than 6 % are not seen.
const SAMPLES_PER_DECADE: usize = 40;

impl<const N: usize> BetaM<N> {
    /// The amplification matrix for a test equation.
    ///
    /// # Panics
    /// If the equation has more derivatives than the member.
    pub fn amplification(&self, equation: TestEquation) -> Amplification {
        let w = equation.coefficients();
        assert!(
            N >= 3 || w[2] == 0.0,
            "an equation of second order needs m = 2 or more"
        );
        let w = |i: usize| w.get(i).copied().unwrap_or(0.0);
        let p = DMatrix::from_fn(
            N,
            N,
            |i, j| {
                if j < i { 0.0 } else { 1.0 / factorial(j - i) }
            },
        );
        let l = self.weights(1.0);
        let weight: f64 = (0..N).map(|i| w(i) * l[i]).sum();
        let residual = |j: usize| (0..N).map(|i| w(i) * p[(i, j)]).sum::<f64>() / weight;
        let matrix = DMatrix::from_fn(N, N, |i, j| p[(i, j)] - l[i] * residual(j));
        Amplification { matrix, equation }
    }

    /// The smallest `ω dt` at which the undamped oscillator grows, from the amplification matrix.
    ///
    /// Infinite for a member that is stable at all of them; zero for one that grows from the beginning. Growth of less than
    /// 1e-7 per step is not seen.
    ///
    /// # Panics
    /// If `m = 1`: the oscillator needs `m = 2` or more.
    pub fn critical_sampling(&self) -> f64 {
        self.critical_sampling_damped(0.0)
    }

    /// The smallest `ω dt` at which an oscillator of damping ratio `damping` (-) grows, as [`BetaM::critical_sampling`].
    ///
    /// Damping at the end of the step, `b1 C`, does not move the limit of members with `β1 = 1/2` and raises that of the others.
    ///
    /// # Panics
    /// If `m = 1`.
    pub fn critical_sampling_damped(&self, damping: f64) -> f64 {
        let grows = |sampling: f64| {
            let amplification = self.amplification(TestEquation::SecondOrder { sampling, damping });
            let radius = amplification.spectral_radius();
            radius.is_nan() || radius > 1.0 + GROWTH
        };
        let [first, last] = SAMPLINGS;
        let n_samples = (SAMPLES_PER_DECADE as f64 * (last / first).log10()).round() as i32;
        let sample = |k: i32| first * (last / first).powf(f64::from(k) / f64::from(n_samples));
        match (0..=n_samples).find(|&k| grows(sample(k))) {
            None => f64::INFINITY,
            Some(0) => 0.0,
            Some(k) => bisect(grows, sample(k - 1), sample(k)),
        }
    }
}

impl Beta2 {
    /// The amplification matrix for a test equation.
    pub fn amplification(&self, equation: TestEquation) -> Amplification {
        self.family().amplification(equation)
    }
}

/// The border between `stable` and `unstable`, to rounding.
fn bisect(grows: impl Fn(f64) -> bool, mut stable: f64, mut unstable: f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (stable + unstable);
        if grows(middle) {
            unstable = middle;
        } else {
            stable = middle;
        }
    }
    stable
}

fn factorial(n: usize) -> f64 {
    (1..=n).map(|k| k as f64).product()
}
