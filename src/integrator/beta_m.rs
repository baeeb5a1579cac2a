//! The generalized Beta-m family (Katona and Zienkiewicz 1985), of which (C.5) uses `m = 2`:
//! `x⁽ⁱ⁾' = q_i + b_i Δ`, `q_i = Σ_{j>=i} dt^{j-i}/(j-i)! x⁽ʲ⁾`, `b_i = dt^{m-i} β_i/(m-i)!`, `β_m = 1`.
//!
//! `x⁽ⁱ⁾` is the i-th time derivative, `Δ` the increment of the highest one that is kept, `x⁽ᵐ⁾`. The family knows no
//! equation: the increment is what makes the equation hold at the end of the step,
//!
//! | equation | matrix of the increment | right-hand side |
//! |---|---|---|
//! | `C ẋ + K x = f`, `m >= 1` | `b1 C + b0 K` | `f - (C q1 + K q0)` |
//! | `M ẍ + C ẋ + K x = f`, `m >= 2` | `b2 M + b1 C + b0 K` | `f - (M q2 + C q1 + K q0)` |
//!
//! which for `m = 2` is the first row of (C.5). At the beginning all `m + 1` derivatives must fit the equation: those
//! above its order follow from differentiating it, such as `M x⁽³⁾ = ḟ - C ẍ - K ẋ`.

use super::{Beta2, IntegratorError};

/// A member of the generalized Beta-m family with `N = m + 1` derivatives, `x` among them.
///
/// # Order
/// The step is exact while the solution is a polynomial of degree `m`, so a first-order equation is solved with order `m`
/// and a second-order one with order `m - 1` at least. One condition more gives one order more. The error that a solution
/// `t^{m+1}` leaves behind is constant in the derivatives and must not accumulate in the lowest free one; with `d` the
/// error of `dt^i x⁽ⁱ⁾/i!` over `dt^{m+1}`, that is:
///
/// | m | equation | order | one more if |
/// |---|---|---|---|
/// | 1 | first | 1 | `β0 = 1/2` |
/// | 2 | first | 2 | `β0 = β1 - 1/6` |
/// | 2 | second | 1 | `β1 = 1/2` |
/// | 3 | first | 3 | `β0 = (3 β1 - β2)/2` |
/// | 3 | second | 2 | `β1 = β2 - 1/6` |
///
/// For `m = 3` and `M ẍ = f(t)`: the equation keeps `d2 = 0`; the increment of a steady state is that of `t⁴`, so
/// `d3 = 2 - 4 β2`; then `d1` grows per step by `3 d3 + 12 β1 - 4 = 12 (β1 - β2) + 2`. A growing `d1` is a velocity error
/// of `t dt²`.
/// Members that are stable at every step length have order two at most (Dahlquist).
///
/// ```
/// use foil2d::integrator::BetaM;
///
/// // x' = -x from 1 over ten steps of 0.1 s with the trapezoidal rule, C = K = 1.
/// let method = BetaM::<2>::theta(0.5)?;
/// let [b0, b1] = method.weights(0.1);
/// let (mut x, mut rate) = ([1.0], [-1.0]);
/// for _ in 0..10 {
///     method.predict_in_place(0.1, [&mut x, &mut rate]);
///     let increment = -(rate[0] + x[0]) / (b1 + b0);
///     method.correct_in_place(0.1, &[increment], [&mut x, &mut rate]);
/// }
/// assert!((x[0] - (-1f64).exp()).abs() < 4e-4);
/// # Ok::<(), foil2d::integrator::IntegratorError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BetaM<const N: usize> {
    beta: [f64; N],
}

/// The family with `m = 1`, known as the theta method.
pub type Beta1 = BetaM<2>;

/// The family with `m = 3`.
pub type Beta3 = BetaM<4>;

impl<const N: usize> BetaM<N> {
    /// Any member, from `[β_0, ..., β_m]` with `β_m = 1`.
    ///
    /// Nothing is said about stability: see [`BetaM::critical_sampling`].
    ///
    /// # Errors
    /// If a parameter is negative or not finite, or if `β_m` is not 1.
    pub fn new(beta: [f64; N]) -> Result<Self, IntegratorError> {
        for (name, value) in ["beta0", "beta1", "beta2"].into_iter().zip(beta) {
            if !(value.is_finite() && value >= 0.0) {
                return Err(IntegratorError::Parameter {
                    name,
                    value,
                    range: "[0, infinity)",
                });
            }
        }
        let last = beta[Self::M];
        if last != 1.0 {
            return Err(IntegratorError::Parameter {
                name: "beta_m, the last parameter,",
                value: last,
                range: "{1}",
            });
        }
        Ok(Self { beta })
    }

    /// A member whose parameters are known to be sound.
    pub(super) const fn from_parameters(beta: [f64; N]) -> Self {
        Self { beta }
    }

    /// The highest derivative kept, `m`.
    pub const M: usize = {
        assert!(N >= 2 && N <= 4, "m is 1, 2 or 3");
        N - 1
    };

    /// The parameters `[β_0, ..., β_m]`.
    pub const fn parameters(&self) -> [f64; N] {
        self.beta
    }

    /// The weights `b_i = dt^{m-i} β_i/(m-i)!` of a step of `dt` (s), in units of s^(m-i).
    pub fn weights(&self, dt: f64) -> [f64; N] {
        let mut scale = 1.0;
        let mut weights = self.beta;
        for derivative in (0..Self::M).rev() {
            scale *= dt / (Self::M - derivative) as f64;
            weights[derivative] *= scale;
        }
        weights
    }

    /// Replaces the derivatives `x⁽ⁱ⁾` at the beginning of the step by the operators `q_i`.
    ///
    /// - `derivatives`: `[x, ẋ, ...]`, one slice for each of the `m + 1`, one entry per dof.
    ///
    /// # Panics
    /// If the lengths differ.
    pub fn predict_in_place(&self, dt: f64, mut derivatives: [&mut [f64]; N]) {
        same_length(&derivatives);
        // q_i only needs derivatives that are not yet replaced.
        let mut rest = &mut derivatives[..];
        while let Some((own, higher)) = rest.split_first_mut() {
            let mut scale = 1.0;
            for (k, derivative) in higher.iter().enumerate() {
                scale *= dt / (k + 1) as f64;
                for (value, derivative) in own.iter_mut().zip(derivative.iter()) {
                    *value += scale * derivative;
                }
            }
            rest = higher;
        }
    }

    /// Replaces the operators `q_i` by the derivatives at the end of the step, `q_i + b_i Δ`.
    ///
    /// - `increment`: `Δ`, one entry per dof.
    ///
    /// # Panics
    /// If the lengths differ.
    pub fn correct_in_place(&self, dt: f64, increment: &[f64], operators: [&mut [f64]; N]) {
        assert_eq!(
            same_length(&operators),
            increment.len(),
            "the increment needs one entry per dof"
        );
        for (values, weight) in operators.into_iter().zip(self.weights(dt)) {
            for (value, increment) in values.iter_mut().zip(increment) {
                *value += weight * increment;
            }
        }
    }
}

fn same_length<const N: usize>(slices: &[&mut [f64]; N]) -> usize {
    let n_dofs = slices[0].len();
    assert!(
        slices.iter().all(|slice| slice.len() == n_dofs),
        "the derivatives need one entry per dof"
    );
    n_dofs
}

impl Beta1 {
    /// The theta method `x' = x + dt ((1 - θ) ẋ + θ ẋ')`: 0 is explicit Euler, 1/2 the trapezoidal rule (second order),
    /// 1 implicit Euler; stable at every step length from 1/2 on.
    ///
    /// # Errors
    /// If `theta` is not in `[0, 1]`.
    pub fn theta(theta: f64) -> Result<Self, IntegratorError> {
        if !(0.0..=1.0).contains(&theta) {
            return Err(IntegratorError::Parameter {
                name: "theta",
                value: theta,
                range: "[0, 1]",
            });
        }
        Self::new([theta, 1.0])
    }
}

impl From<Beta2> for BetaM<3> {
    fn from(member: Beta2) -> Self {
        member.family()
    }
}

impl Beta3 {
    /// Houbolt's method, `β = (6, 11/3, 2)`: the backward differences of the cubic through the last four positions.
    ///
    /// The cubics of two successive steps differ by `c s (s + 1) (s + 2)`, `s = (t - t_k)/dt`, whose derivatives at
    /// `s = 1` are 6, 11, 12, 6. Second order, stable at every step length; the stiffest modes vanish in three steps.
    pub const fn houbolt() -> Self {
        Self {
            beta: [6.0, 11.0 / 3.0, 2.0, 1.0],
        }
    }

    /// The member with the amplification of Wilson's theta method, `β = (θ³, θ², θ)`, which is stable at every step
    /// length from `θ = 1.366` on; 1.4 is usual. The load is taken at the end of the step.
    ///
    /// # Errors
    /// If `theta` is not in `[1, 2]`.
    pub fn wilson(theta: f64) -> Result<Self, IntegratorError> {
        if !(1.0..=2.0).contains(&theta) {
            return Err(IntegratorError::Parameter {
                name: "theta",
                value: theta,
                range: "[1, 2]",
            });
        }
        Self::new([theta * theta * theta, theta * theta, theta, 1.0])
    }

    /// The third-order member with given `β0` and `β2`; `β1 = β2 - 1/6`.
    ///
    /// Its numerical damping ratio is `(β2/2 - β0) (ω dt)³/12` for short steps, so that `β0 > β2/2` grows at every step length;
    /// for long ones all of them grow. At `β0 = β2/2` the amplification is right to fourth order, and `β2 = 1` then
    /// gives the positions of Numerov's method, stable while `ω dt <= sqrt(6)`.
    ///
    /// # Errors
    /// If `beta2` is below 1/2, `beta0` outside `[0, beta2/2]`, or one of them not finite.
    pub fn third_order(beta0: f64, beta2: f64) -> Result<Self, IntegratorError> {
        if !(beta2.is_finite() && beta2 >= 0.5) {
            return Err(IntegratorError::Parameter {
                name: "beta2",
                value: beta2,
                range: "[1/2, infinity)",
            });
        }
        if !(0.0..=0.5 * beta2).contains(&beta0) {
            return Err(IntegratorError::Parameter {
                name: "beta0",
                value: beta0,
                range: "[0, beta2/2]",
            });
        }
        Self::new([beta0, beta2 - 1.0 / 6.0, beta2, 1.0])
    }
}
