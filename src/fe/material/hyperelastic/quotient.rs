//! The slope of the logarithm between two points, `(ln b - ln a) / (b - a)`, without cancellation.

use crate::math::ln;

/// `(ln b - ln a) / (b - a)` for positive `a`, `b`; `1 / a` where they are equal.
///
/// With `y = (b - a)/(b + a)` it is `2 / (a + b) atanh(y) / y`. For `y² < 1e-3` the series of `atanh(y)/y` to `y¹⁰`
/// leaves out less than 1e-19; beyond, the logarithm of `(1 + y)/(1 - y)` loses at most two digits to its neighbourhood of one.
#[inline]
pub(super) fn slope_of_ln(a: f64, b: f64) -> f64 {
    let sum = a + b;
    let y = (b - a) / sum;
    let squared = y * y;
    let quotient = if squared < 1e-3 {
        let coefficients = [1.0 / 11.0, 1.0 / 9.0, 1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0, 1.0];
        coefficients
            .into_iter()
            .fold(0.0, |sum, coefficient| sum * squared + coefficient)
    } else {
        0.5 * ln(b / a) / y
    };
    2.0 * quotient / sum
}

#[cfg(test)]
mod tests {
    use super::slope_of_ln;
    use crate::math::ln;

    /// The branches meet, and the mean value theorem holds: the slope times the distance is the difference.
    #[test]
    fn the_slope_times_the_distance_is_the_difference_of_logarithms() {
        for a in [0.1, 1.0, 3.0] {
            for factor in [1.0 + 1e-12, 1.0 + 1e-4, 1.0653, 1.0654, 0.9387, 0.9386, 4.0] {
                let b = a * factor;
                // `ln b - ln a` has an absolute rounding of its own.
                let error = slope_of_ln(a, b) * (b - a) - (ln(b) - ln(a));
                assert!(error.abs() < 2e-15, "{a} to {b}: {error:e}");
            }
            assert!((slope_of_ln(a, a) * a - 1.0).abs() < 1e-15);
        }
    }
}
