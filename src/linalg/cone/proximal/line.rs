//! The root of the slope along a Newton step.

/// The root of a rising function that is negative at 0; 1 if the function is small enough there.
///
/// - `start`: its value at 0.
pub(super) fn least(start: f64, slope: impl Fn(f64) -> f64) -> f64 {
    let full = slope(1.0);
    if full.abs() <= 0.1 * start.abs() {
        return 1.0;
    }
    let (mut low, mut at_low, mut high, mut at_high) = (0.0, start, 1.0, full);
    while at_high < 0.0 && high < 64.0 {
        (low, at_low) = (high, at_high);
        high *= 2.0;
        at_high = slope(high);
    }
    let mut length = high;
    for round in 0..40 {
        // a bisection now and then: the secant alone may creep along one piece
        length = if round % 3 == 2 {
            0.5 * (low + high)
        } else {
            low - at_low * (high - low) / (at_high - at_low)
        };
        let here = slope(length);
        if here.abs() < 0.02 * start.abs() {
            break;
        }
        if here > 0.0 {
            (high, at_high) = (length, here);
        } else {
            (low, at_low) = (length, here);
        }
    }
    if length.is_finite() { length } else { 1.0 }
}
