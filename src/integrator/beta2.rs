//! The Beta-2 method (Eq. C.5): `q0 = x + dt v + dt²/2 a`, `q1 = v + dt a`, `q2 = a`,
//! `b0 = dt²/2 β0`, `b1 = dt β1`, `b2 = 1`.
//!
//! The unknown of (C.5) is the increment of acceleration `Δa`; the state advances by
//! `x' = q0 + b0 Δa`, `v' = q1 + b1 Δa`, `a' = q2 + b2 Δa`. Newmark's parameters are `β = β0/2`, `γ = β1`.

use super::beta_m::BetaM;
use super::error::IntegratorError;

/// The weights `b0` (s²) and `b1` (s) of one step; `b2 = 1`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Weights {
    /// `dt²/2 β0`, the position reached per unit increment of acceleration (s²).
    pub b0: f64,
    /// `dt β1`, the velocity reached per unit increment of acceleration (s).
    pub b1: f64,
}

impl Weights {
    /// Those of the member `β0 = β1 = 1`: forces act wholly, and evenly, within the step that finds them, and stored accelerations cancel out.
    pub fn within(dt: f64) -> Self {
        Self {
            b0: 0.5 * dt * dt,
            b1: dt,
        }
    }
}

/// A member of the Beta-2 family: implicit with `β0 > 0`, explicit with `β0 = 0`.
///
/// The three members that section C.4 names are [`Beta2::linear_acceleration`], [`Beta2::trapezoidal`] and
/// [`Beta2::central_difference`].
///
/// The default is [`Beta2::damped`] with `rho_infinity = 0.9`: vibrations that the step cannot resolve die out within a second
/// at 60 Hz, while the motion of a free body's frame is not damped at all. The trapezoidal rule keeps the energy of vibrations,
/// but also keeps the remainder of every impact alternating in the contact forces of stiff bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Beta2 {
    beta0: f64,
    beta1: f64,
}

impl Default for Beta2 {
    fn default() -> Self {
        // damped(0.9)
        Self {
            beta0: 2.0 / (1.9 * 1.9),
            beta1: 2.1 / 3.8,
        }
    }
}

impl Beta2 {
    /// Any implicit member; [`Beta2::explicit`] makes the others.
    ///
    /// # Errors
    /// If a parameter is not finite, `beta0` is outside `(0, 2]` or `beta1` outside `[1/2, 3/2]`:
    /// `beta0 = 0` makes (C.5) singular, `beta1 < 1/2` grows at every step length.
    pub fn new(beta0: f64, beta1: f64) -> Result<Self, IntegratorError> {
        if !(beta0 > 0.0 && beta0 <= 2.0) {
            return Err(IntegratorError::Parameter {
                name: "beta0",
                value: beta0,
                range: "(0, 2]",
            });
        }
        if !(0.5..=1.5).contains(&beta1) {
            return Err(IntegratorError::Parameter {
                name: "beta1",
                value: beta1,
                range: "[1/2, 3/2]",
            });
        }
        Ok(Self { beta0, beta1 })
    }

    /// Any explicit member, `β0 = 0`: the position at the end of a step follows from its beginning alone.
    ///
    /// # Errors
    /// If `beta1` is not finite or outside `[1/2, 3/2]`.
    pub fn explicit(beta1: f64) -> Result<Self, IntegratorError> {
        let Self { beta1, .. } = Self::new(1.0, beta1)?;
        Ok(Self { beta0: 0.0, beta1 })
    }

    /// The trapezoidal rule (constant acceleration), `β0 = β1 = 1/2`: second order, unconditionally
    /// stable, and without numerical damping.
    pub const fn trapezoidal() -> Self {
        Self {
            beta0: 0.5,
            beta1: 0.5,
        }
    }

    /// The linear-acceleration method, `β0 = 1/3`, `β1 = 1/2`: second order, stable only while
    /// `ω dt <= 3.464`, and unstable in persistent contact between masses at every step length.
    pub const fn linear_acceleration() -> Self {
        Self {
            beta0: 1.0 / 3.0,
            beta1: 0.5,
        }
    }

    /// The central difference method, `β0 = 0`, `β1 = 1/2`: second order, stable while `ω dt <= 2`, and explicit:
    /// with a lumped mass a step solves nothing. (C.5) is singular for it, see [`Beta2::require_implicit`]; the pipeline
    /// takes multipliers at the forward increment instead.
    pub const fn central_difference() -> Self {
        Self {
            beta0: 0.0,
            beta1: 0.5,
        }
    }

    /// The member that multiplies the highest frequencies by `rho_infinity` per step, with the least
    /// loss at the low ones: `β1 = (3 - ρ) / (2 + 2ρ)`, `β0 = 2 / (1 + ρ)²`.
    ///
    /// `rho_infinity = 1` is the trapezoidal rule; below 1 the order drops to one.
    ///
    /// # Errors
    /// If `rho_infinity` is not in `[0, 1]`.
    pub fn damped(rho_infinity: f64) -> Result<Self, IntegratorError> {
        if !(0.0..=1.0).contains(&rho_infinity) {
            return Err(IntegratorError::Parameter {
                name: "rho_infinity",
                value: rho_infinity,
                range: "[0, 1]",
            });
        }
        let sum = 1.0 + rho_infinity;
        Self::new(2.0 / (sum * sum), (3.0 - rho_infinity) / (2.0 * sum))
    }

    /// The parameter β0.
    pub const fn beta0(&self) -> f64 {
        self.beta0
    }

    /// The parameter β1.
    pub const fn beta1(&self) -> f64 {
        self.beta1
    }

    /// `χ` of the stress that makes vibrations of large strain decay as this member does those of small strain: with `β0 = 2/(1 + ρ)²` it is
    /// `(1 - ρ)/(1 + ρ)`.
    pub fn decay(&self) -> f64 {
        ((2.0 * self.beta0).sqrt() - 1.0).max(0.0)
    }

    /// Whether `b0 = 0`: no effective stiffness, and no position that contact forces of the step could correct.
    pub fn is_explicit(&self) -> bool {
        self.beta0 == 0.0
    }

    /// Refuses an explicit member where (C.5) is to be solved.
    ///
    /// # Errors
    /// [`IntegratorError::Explicit`] if `b0 = 0`.
    pub fn require_implicit(&self) -> Result<(), IntegratorError> {
        if self.is_explicit() {
            return Err(IntegratorError::Explicit);
        }
        Ok(())
    }

    /// The same member as one of the generalized family, with `m = 2`.
    pub const fn family(&self) -> BetaM<3> {
        BetaM::from_parameters([self.beta0, self.beta1, 1.0])
    }

    /// The weights of a step of `dt` (s).
    pub fn weights(&self, dt: f64) -> Weights {
        Weights {
            b0: 0.5 * dt * dt * self.beta0,
            b1: dt * self.beta1,
        }
    }

    /// Whether every frequency is stable at every step length: `β0 >= β1 >= 1/2`.
    pub fn is_unconditionally_stable(&self) -> bool {
        self.beta0 >= self.beta1 - 1e-15
    }

    /// The largest stable `ω dt` without damping: infinite if unconditionally stable, else `sqrt(2 / (β1 - β0))`,
    /// which is 2 for the central difference method and `sqrt(12)` for linear acceleration.
    pub fn critical_sampling(&self) -> f64 {
        if self.is_unconditionally_stable() {
            f64::INFINITY
        } else {
            (2.0 / (self.beta1 - self.beta0)).sqrt()
        }
    }

    /// The longest stable step (s) of an explicit member for a system whose frequencies without damping do not exceed `frequency` (rad/s), with damping
    /// of `damping` (s) times its stiffness, which takes its rate from the half step before:
    ///
    /// ```text
    /// (ω dt)² + 2 c ω · ω dt <= 2/β1
    /// ```
    ///
    /// as the motion that changes its sign in every step then does not grow. Without damping it is `critical_sampling() / frequency`.
    pub fn explicit_critical_step(&self, frequency: f64, damping: f64) -> f64 {
        let ratio = damping * frequency;
        // The root without a difference of large numbers.
        let most = 2.0 / self.beta1;
        most / (ratio + (ratio * ratio + most).sqrt()) / frequency
    }

    /// Refuses a step too long for a system whose frequencies do not exceed `frequency` (rad/s).
    ///
    /// # Errors
    /// [`IntegratorError::Unstable`] with the critical step; [`IntegratorError::MasslessSurface`] if there is none, as the frequency is infinite.
    pub fn check_step(&self, dt: f64, frequency: f64) -> Result<(), IntegratorError> {
        let critical = self.critical_sampling() / frequency;
        if frequency == f64::INFINITY && critical == 0.0 {
            return Err(IntegratorError::MasslessSurface);
        }
        if dt > critical {
            return Err(IntegratorError::Unstable {
                dt,
                critical,
                frequency,
            });
        }
        Ok(())
    }

    /// Writes the operators `q0` (m) and `q1` (m/s); `q2` is `acceleration` itself.
    ///
    /// All slices have one entry per dof.
    ///
    /// # Panics
    /// If the lengths differ.
    pub fn predict(
        dt: f64,
        [position, velocity, acceleration]: [&[f64]; 3],
        q0: &mut [f64],
        q1: &mut [f64],
    ) {
        let n = position.len();
        assert!(
            velocity.len() == n && acceleration.len() == n && q0.len() == n && q1.len() == n,
            "the operators need one entry per dof"
        );
        let half = 0.5 * dt * dt;
        for dof in 0..n {
            q0[dof] = position[dof] + dt * velocity[dof] + half * acceleration[dof];
            q1[dof] = velocity[dof] + dt * acceleration[dof];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Advances `a = -omega² x` by `n` steps and returns the position.
    fn oscillate(method: Beta2, omega: f64, dt: f64, n: usize) -> f64 {
        let (mut x, mut v, mut a) = ([1.0], [0.0], [-omega * omega]);
        let w = method.weights(dt);
        let (mut q0, mut q1) = ([0.0], [0.0]);
        for _ in 0..n {
            Beta2::predict(dt, [&x, &v, &a], &mut q0, &mut q1);
            let increment = (-omega * omega * q0[0] - a[0]) / (1.0 + omega * omega * w.b0);
            x[0] = q0[0] + w.b0 * increment;
            v[0] = q1[0] + w.b1 * increment;
            a[0] += increment;
        }
        x[0]
    }

    #[test]
    fn second_order_members_halve_the_step_and_quarter_the_error() {
        for method in [
            Beta2::trapezoidal(),
            Beta2::linear_acceleration(),
            Beta2::central_difference(),
            Beta2 {
                beta0: 1.0,
                beta1: 0.5,
            },
        ] {
            let error = |n: usize| (oscillate(method, 3.0, 1.0 / n as f64, n) - 3f64.cos()).abs();
            let order = (error(200) / error(400)).log2();
            assert!((order - 2.0).abs() < 0.05, "order {order} of {method:?}");
        }
    }

    #[test]
    fn the_critical_step_separates_bounded_from_growing_motion() {
        let method = Beta2::linear_acceleration();
        let critical = method.critical_sampling();
        assert!((critical - 12f64.sqrt()).abs() < 1e-12);
        assert!(oscillate(method, 1.0, 0.99 * critical, 400).abs() < 10.0);
        assert!(oscillate(method, 1.0, 1.01 * critical, 400).abs() > 1e6);
    }

    /// One damped oscillator, with the rate of half a step before in its force.
    #[test]
    fn the_critical_step_of_damped_explicit_members_separates_bounded_from_growing_motion() {
        for beta1 in [0.5, 0.75, 1.0, 1.5] {
            for damping in [0.0, 0.1, 1.0, 10.0] {
                let method = Beta2::explicit(beta1).expect("in range");
                let omega: f64 = 3.0;
                let critical = method.explicit_critical_step(omega, damping);
                let size = |dt: f64| {
                    let force = |x: f64, rate: f64| -omega * omega * (x + damping * rate);
                    let (mut x, mut v, mut a) = (1.0, 0.0, force(1.0, 0.0));
                    for _ in 0..4000 {
                        x += dt * v + 0.5 * dt * dt * a;
                        let next = force(x, v + 0.5 * dt * a);
                        v += dt * ((1.0 - beta1) * a + beta1 * next);
                        a = next;
                    }
                    f64::abs(x)
                };
                let [below, above] = [0.99, 1.01].map(|share| size(share * critical));
                assert!(below < 10.0, "{beta1} {damping}: {below}");
                assert!(above.is_nan() || above > 1e3, "{beta1} {damping}: {above}");
            }
        }
    }

    #[test]
    fn the_damped_member_multiplies_the_stiffest_mode_by_rho() {
        for rho in [0.5, 0.8, 1.0] {
            let method = Beta2::damped(rho).expect("rho is in range");
            let (omega, dt) = (1e6, 1.0);
            let ratio = (oscillate(method, omega, dt, 41) / oscillate(method, omega, dt, 40)).abs();
            // A double root approaches its limit like (1 + 1/n).
            assert!((ratio - rho).abs() < 0.04 * rho, "{ratio} for {rho}");
        }
        assert_eq!(Beta2::damped(1.0), Ok(Beta2::trapezoidal()));
        let default = Beta2::damped(0.9).expect("0.9 is in range");
        assert!((default.beta0 - Beta2::default().beta0).abs() < 1e-15);
        assert!((default.beta1 - Beta2::default().beta1).abs() < 1e-15);
    }

    #[test]
    fn the_explicit_members_are_recognized_and_refused_where_c5_is_singular() {
        let central = Beta2::central_difference();
        assert_eq!(Beta2::explicit(0.5), Ok(central));
        assert!(central.is_explicit() && central.weights(0.1).b0 == 0.0);
        assert_eq!(central.critical_sampling(), 2.0);
        assert_eq!(central.require_implicit(), Err(IntegratorError::Explicit));
        assert!(Beta2::default().require_implicit().is_ok());
    }

    #[test]
    fn parameters_out_of_range_are_refused_by_name() {
        assert!(matches!(
            Beta2::new(0.0, 0.5),
            Err(IntegratorError::Parameter { name: "beta0", .. })
        ));
        assert!(matches!(
            Beta2::new(0.5, 0.4),
            Err(IntegratorError::Parameter { name: "beta1", .. })
        ));
        assert!(Beta2::new(f64::NAN, 0.5).is_err());
        assert!(Beta2::damped(1.1).is_err());
        assert!(Beta2::explicit(0.4).is_err());
        assert!(Beta2::explicit(f64::INFINITY).is_err());
        assert!(Beta2::linear_acceleration().check_step(0.1, 100.0).is_err());
        assert!(Beta2::trapezoidal().check_step(1e3, 1e9).is_ok());
    }
}
