//! The slope of the logarithm between two points, `(ln b - ln a) / (b - a)`, without cancellation.

use crate::math::ln;

/// `y²` below which series take the place of logarithms.
const SERIES: f64 = 1e-3;

/// `(ln b - ln a) / (b - a)` for positive `a`, `b`; `1 / a` where they are equal.
///
/// With `y = (b - a)/(b + a)` it is `2 / (a + b) atanh(y) / y`. For `y² < 1e-3` the series of `atanh(y)/y` to `y¹⁰`
/// leaves out less than 1e-19; beyond, the logarithm of `(1 + y)/(1 - y)` loses at most two digits to its neighbourhood of one.
#[inline]
pub(super) fn slope_of_ln(a: f64, b: f64) -> f64 {
    2.0 * quotient((b - a) / (a + b)) / (a + b)
}

/// `atanh(y)/y`.
#[inline]
pub(super) fn quotient(y: f64) -> f64 {
    let squared = y * y;
    if squared < SERIES {
        let coefficients = [1.0 / 11.0, 1.0 / 9.0, 1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0, 1.0];
        coefficients
            .into_iter()
            .fold(0.0, |sum, coefficient| sum * squared + coefficient)
    } else {
        0.5 * ln((1.0 + y) / (1.0 - y)) / y
    }
}

/// `atanh(y)/y - 1`, with its own digits where it is small.
#[inline]
pub(super) fn quotient_less_one(y: f64) -> f64 {
    let squared = y * y;
    if squared < SERIES {
        let coefficients = [1.0 / 11.0, 1.0 / 9.0, 1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0];
        let fold = |sum, coefficient| sum * squared + coefficient;
        squared * coefficients.into_iter().fold(0.0, fold)
    } else {
        quotient(y) - 1.0
    }
}

/// The derivative of [`slope_of_ln`] by `b`.
///
/// With `q = atanh(y)/y` it is `2/(a + b)² (2 a q'/(a + b) - q)`, and `q' = (1/(1 - y²) - q)/y` or its series.
#[inline]
pub(super) fn rise_of_slope_of_ln(a: f64, b: f64) -> f64 {
    let sum = a + b;
    let y = (b - a) / sum;
    let squared = y * y;
    let value = quotient(y);
    let slope = if squared < SERIES {
        let coefficients = [10.0 / 11.0, 8.0 / 9.0, 6.0 / 7.0, 4.0 / 5.0, 2.0 / 3.0];
        let fold = |sum, coefficient| sum * squared + coefficient;
        y * coefficients.into_iter().fold(0.0, fold)
    } else {
        (1.0 / (1.0 - squared) - value) / y
    };
    2.0 / (sum * sum) * (2.0 * a * slope / sum - value)
}

#[cfg(test)]
mod tests {
    use super::{rise_of_slope_of_ln, slope_of_ln};
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

    /// Central differences over 1e-5 of `b`: truncation of some 1e-10.
    #[test]
    fn the_slope_rises_as_its_differences_do() {
        for a in [0.1, 1.0, 3.0] {
            for factor in [1e-3, 0.1, 0.9386, 0.9387, 1.0, 1.0653, 1.0654, 4.0, 1e3] {
                let b = a * factor;
                let step = 1e-5 * b;
                let rise = slope_of_ln(a, b + step) - slope_of_ln(a, b - step);
                let error = rise / (2.0 * step) / rise_of_slope_of_ln(a, b) - 1.0;
                assert!(error.abs() < 1e-8, "{a} to {b}: {error:e}");
            }
        }
    }
}
