//! Elementary functions, in one place: the operating system's differ from one another in the last digit. With the feature
//! `enhanced-determinism` they are those of `libm`, which is compiled from the same source everywhere.
//!
//! Sums, products, quotients and roots need none of this: IEEE 754 rounds them the same way everywhere.

macro_rules! functions {
    ($($(#[$doc:meta])* $name:ident($($argument:ident),+) = $libm:ident;)*) => {
        $($(#[$doc])*
        #[inline]
        pub fn $name($($argument: f64),+) -> f64 {
            #[cfg(feature = "enhanced-determinism")]
            return libm::$libm($($argument),+);
            #[cfg(not(feature = "enhanced-determinism"))]
            functions!(@std $name, $($argument),+)
        })*
    };
    (@std $name:ident, $first:ident) => { $first.$name() };
    (@std $name:ident, $first:ident, $second:ident) => { $first.$name($second) };
}

functions! {
    /// Sine of an angle (rad).
    sin(angle) = sin;
    /// Cosine of an angle (rad).
    cos(angle) = cos;
    /// Tangent of an angle (rad).
    tan(angle) = tan;
    /// Angle of a tangent, in (-π/2, π/2) (rad).
    atan(tangent) = atan;
    /// Angle of the direction `(x, y)`, in (-π, π] (rad).
    atan2(y, x) = atan2;
    /// `e` to a power.
    exp(power) = exp;
    /// Natural logarithm.
    ln(value) = log;
    /// `e` to a power, less one.
    exp_m1(power) = expm1;
    /// Natural logarithm of one and a value.
    ln_1p(value) = log1p;
    /// `√(x² + y²)`.
    hypot(x, y) = hypot;
}

/// Sine and cosine of an angle (rad).
#[inline]
pub fn sin_cos(angle: f64) -> (f64, f64) {
    #[cfg(feature = "enhanced-determinism")]
    return libm::sincos(angle);
    #[cfg(not(feature = "enhanced-determinism"))]
    angle.sin_cos()
}
