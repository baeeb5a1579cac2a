//! Viscous damping that shares the modes of the undamped body: `C = alpha M + beta K`.

use thiserror::Error;

/// Rayleigh damping `C = alpha M + beta K`, the `C` of (C.4a).
///
/// A mode of circular frequency `w` has the damping ratio `alpha / (2 w) + beta w / 2`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct Rayleigh {
    /// The mass part alpha (1/s). It drags rigid motion too: leave it at zero for free bodies.
    pub mass: f64,
    /// The stiffness part beta (s): the damping ratio of a mode of circular frequency w is `beta w / 2`.
    pub stiffness: f64,
}

/// Damping ratios that no Rayleigh damping has.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum DampingError {
    /// A frequency is not a positive finite number.
    #[error(
        "circular frequency {index} is {value} rad/s: give a positive finite value, 2 pi times the frequency in Hz"
    )]
    Frequency {
        /// Which of the two, 1 or 2.
        index: usize,
        /// The value given (rad/s).
        value: f64,
    },
    /// A damping ratio is negative or not finite.
    #[error(
        "damping ratio {index} is {value}: give zero or a positive finite value, such as 0.02 for 2 % of critical"
    )]
    Ratio {
        /// Which of the two, 1 or 2.
        index: usize,
        /// The value given (-).
        value: f64,
    },
    /// Both frequencies are the same.
    #[error(
        "both circular frequencies are {0} rad/s: two different ones fix alpha and beta; for one alone set the stiffness part to 2 zeta / omega"
    )]
    EqualFrequencies(f64),
    /// The higher frequency would need a negative mass part.
    #[error(
        "the ratios grow faster than the frequencies, which asks for a negative mass part alpha = {alpha} 1/s and would feed energy into slow modes: lower the ratio at {frequency} rad/s to at most {most}"
    )]
    NegativeMassPart {
        /// The mass part (1/s).
        alpha: f64,
        /// The higher frequency (rad/s).
        frequency: f64,
        /// The largest ratio possible there (-).
        most: f64,
    },
    /// The higher frequency would need a negative stiffness part.
    #[error(
        "the ratios fall faster than 1 / frequency, which asks for a negative stiffness part beta = {beta} s and would feed energy into fast modes: raise the ratio at {frequency} rad/s to at least {least}"
    )]
    NegativeStiffnessPart {
        /// The stiffness part (s).
        beta: f64,
        /// The higher frequency (rad/s).
        frequency: f64,
        /// The smallest ratio possible there (-).
        least: f64,
    },
}

impl Rayleigh {
    /// No damping.
    pub const NONE: Self = Self {
        mass: 0.0,
        stiffness: 0.0,
    };

    /// The damping with given ratios at two circular frequencies, in either order: each is `(omega (rad/s), zeta (-))`.
    ///
    /// From `zeta_i = alpha / (2 w_i) + beta w_i / 2`:
    /// `alpha = 2 w1 w2 (zeta1 w2 - zeta2 w1) / (w2² - w1²)`, `beta = 2 (zeta2 w2 - zeta1 w1) / (w2² - w1²)`.
    /// Between the two frequencies ratios are lower, outside they are higher. Both parts are positive or zero if
    /// `w1/w2 <= zeta2/zeta1 <= w2/w1` (`w1 < w2`).
    ///
    /// # Errors
    /// [`DampingError`] for frequencies that are not positive or equal, negative ratios, and ratios that ask for a negative
    /// part.
    ///
    /// ```
    /// use foil2d::fe::material::Rayleigh;
    ///
    /// let damping = Rayleigh::from_ratios((10.0, 0.02), (100.0, 0.02))?;
    /// assert!((damping.ratio(10.0) - 0.02).abs() < 1e-15);
    /// assert!(damping.ratio(30.0) < 0.02);
    /// # Ok::<(), foil2d::fe::material::DampingError>(())
    /// ```
    pub fn from_ratios(first: (f64, f64), second: (f64, f64)) -> Result<Self, DampingError> {
        for (index, (omega, zeta)) in [(1, first), (2, second)] {
            if !(omega > 0.0 && omega.is_finite()) {
                let value = omega;
                return Err(DampingError::Frequency { index, value });
            }
            if !(zeta >= 0.0 && zeta.is_finite()) {
                return Err(DampingError::Ratio { index, value: zeta });
            }
        }
        let ((slow, slow_ratio), (fast, fast_ratio)) = if first.0 < second.0 {
            (first, second)
        } else {
            (second, first)
        };
        if slow == fast {
            return Err(DampingError::EqualFrequencies(slow));
        }
        // Divided by w2² so that large frequencies do not overflow.
        let ratio = slow / fast;
        let determinant = (1.0 - ratio) * (1.0 + ratio);
        let alpha = 2.0 * slow * (slow_ratio - fast_ratio * ratio) / determinant;
        let beta = 2.0 * (fast_ratio - slow_ratio * ratio) / (fast * determinant);
        // The limits of the range itself come out with the rounding of a difference of equal terms.
        let rounding = 4.0 * f64::EPSILON * slow_ratio.max(fast_ratio);
        if alpha < -2.0 * slow * rounding / determinant {
            return Err(DampingError::NegativeMassPart {
                alpha,
                frequency: fast,
                most: slow_ratio / ratio,
            });
        }
        if beta < -2.0 * rounding / (fast * determinant) {
            return Err(DampingError::NegativeStiffnessPart {
                beta,
                frequency: fast,
                least: slow_ratio * ratio,
            });
        }
        Ok(Self {
            mass: alpha.max(0.0),
            stiffness: beta.max(0.0),
        })
    }

    /// The damping ratio `alpha / (2 w) + beta w / 2` (-) of a mode of circular frequency `omega` (rad/s).
    pub fn ratio(&self, omega: f64) -> f64 {
        0.5 * (self.mass / omega + self.stiffness * omega)
    }
}
