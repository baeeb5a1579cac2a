//! The constraint functions `w(g, λ)` and `v(u̇, τ)`, without dimensions, and their derivatives.

use crate::math::atan;
use std::f64::consts::FRAC_2_PI;

/// A function of two variables at a point: its value and both derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Value {
    pub value: f64,
    /// By the motion: gap or slip.
    pub by_motion: f64,
    /// By the multiplier: `λ` or `τ`.
    pub by_multiplier: f64,
}

/// `w(g, λ) = (g + λ)/2 - sqrt(((g - λ)/2)² + ε)`: the smaller of both, rounded off where they are alike.
///
/// Its derivatives lie between 0 and 1 and add up to 1.
pub(super) fn normal(gap: f64, multiplier: f64, epsilon: f64) -> Value {
    let (mean, half) = (0.5 * (gap + multiplier), 0.5 * (gap - multiplier));
    let root = (half * half + epsilon).sqrt();
    // Where both are positive, `mean - root` would cancel.
    let value = if mean > 0.0 {
        (gap * multiplier - epsilon) / (mean + root)
    } else {
        mean - root
    };
    // 1 - half/root without cancelling.
    let small = 0.5 * epsilon / (root * (root + half.abs()));
    let [by_motion, by_multiplier] = if half > 0.0 {
        [small, 1.0 - small]
    } else {
        [1.0 - small, small]
    };
    Value {
        value,
        by_motion,
        by_multiplier,
    }
}

/// `v(u̇, τ)`, the root of `τ + v = (2/π) atan((u̇ - v)/ε)`: the slip while `|τ + u̇| < 1`, else what `τ` lacks of ±1.
///
/// With `y = (u̇ - v)/ε` the equation is `(2/π) atan y + ε y = τ + u̇`, odd and concave for `y > 0`.
pub(super) fn tangential(slip: f64, ratio: f64, epsilon: f64) -> Value {
    let sum = ratio + slip;
    let y = stretched(sum.abs(), epsilon).copysign(sum);
    // ∂atan term over ε: large while it sticks.
    let steep = FRAC_2_PI / (epsilon * (1.0 + y * y));
    Value {
        value: slip - epsilon * y,
        by_motion: steep / (1.0 + steep),
        by_multiplier: -1.0 / (1.0 + steep),
    }
}

/// The root `y >= 0` of `(2/π) atan y + ε y = sum`, for `sum >= 0`.
///
/// From the left, Newton's iterates of a concave function rise to the root and never pass it.
fn stretched(sum: f64, epsilon: f64) -> f64 {
    // The arc tangent contributes less than 1.
    let mut y = ((sum - 1.0) / epsilon).max(0.0);
    for _ in 0..MOST_ITERATIONS {
        let excess = sum - FRAC_2_PI * atan(y) - epsilon * y;
        let rise = excess / (FRAC_2_PI / (1.0 + y * y) + epsilon);
        if rise <= 4.0 * f64::EPSILON * y {
            break;
        }
        y += rise;
    }
    y
}

/// Near `sum = 1` the iterates double until `y = 1/sqrt(ε)`.
const MOST_ITERATIONS: usize = 100;

#[cfg(test)]
mod tests {
    use super::*;

    /// Central differences of `f` at `(x, y)`, with steps far below the scale on which it bends.
    fn differences(f: impl Fn(f64, f64) -> f64, x: f64, y: f64, h: f64) -> [f64; 2] {
        [
            (f(x + h, y) - f(x - h, y)) / (2.0 * h),
            (f(x, y + h) - f(x, y - h)) / (2.0 * h),
        ]
    }

    #[test]
    fn w_vanishes_where_gap_times_force_is_epsilon_and_nowhere_else() {
        for epsilon in [1e-2, 1e-6, 1e-12] {
            for gap in [1e-9, 1e-3, 0.5, 7.0] {
                let found = normal(gap, epsilon / gap, epsilon);
                assert!(
                    found.value.abs() <= 1e-15 * gap,
                    "{gap} {epsilon}: {found:?}"
                );
            }
            // Both negative, or one: never zero.
            for (gap, force) in [(-1e-3, -1e-3), (-1.0, 1.0), (1.0, -1e-6)] {
                assert!(normal(gap, force, epsilon).value < 0.0);
            }
        }
    }

    #[test]
    fn w_tends_to_the_smaller_of_gap_and_force() {
        for (gap, force) in [(0.3, 2.0), (2.0, 0.3), (-1.0, 0.5), (0.5, -1.0)] {
            let found = normal(gap, force, 1e-14).value;
            // |w - min| <= ε/|g - λ|.
            assert!((found - f64::min(gap, force)).abs() < 1e-13);
        }
    }

    #[test]
    fn derivatives_of_w_are_its_slopes_and_add_up_to_one() {
        for (gap, force) in [
            (0.3, 0.1),
            (0.1, 0.3),
            (-0.2, 0.4),
            (0.2, 0.2),
            (-0.3, -0.1),
        ] {
            let epsilon = 1e-3;
            let found = normal(gap, force, epsilon);
            let w = |g, p| normal(g, p, epsilon).value;
            let [by_gap, by_force] = differences(w, gap, force, 1e-5);
            // Central differences: h² w'''/6, with w''' up to ε^-1.
            assert!((found.by_motion - by_gap).abs() < 1e-7);
            assert!((found.by_multiplier - by_force).abs() < 1e-7);
            assert!((found.by_motion + found.by_multiplier - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn v_vanishes_on_the_arc_tangent() {
        for epsilon in [1e-1, 1e-3, 1e-6, 1e-9] {
            for stretch in [0.0f64, 1e-3, 0.7, 30.0, 1e3] {
                for sign in [1.0, -1.0] {
                    let slip = sign * epsilon * stretch;
                    let ratio = FRAC_2_PI * atan(sign * stretch);
                    let found = tangential(slip, ratio, epsilon).value;
                    // The ratio is known to 1e-16, which the arc tangent stretches by ε (1 + y²) at most.
                    let known = 1e-15 * (epsilon * (1.0 + stretch * stretch)).min(1.0);
                    assert!(
                        found.abs() <= known + 1e-15 * slip.abs() + 1e-16 * epsilon,
                        "{epsilon} {stretch}: {found}"
                    );
                }
            }
        }
    }

    #[test]
    fn v_is_the_slip_while_it_sticks_and_what_the_ratio_lacks_while_it_slides() {
        let epsilon = 1e-12;
        assert!((tangential(1e-3, 0.5, epsilon).value - 1e-3).abs() < 1e-11);
        assert!((tangential(0.9, 0.5, epsilon).value - 0.5).abs() < 1e-6);
        assert!((tangential(-0.9, -0.5, epsilon).value + 0.5).abs() < 1e-6);
        assert!((tangential(0.2, 1.3, epsilon).value + 0.3).abs() < 1e-6);
    }

    #[test]
    fn derivatives_of_v_are_its_slopes() {
        for (slip, ratio) in [
            (0.1, 0.2),
            (0.8, 0.5),
            (-0.8, -0.5),
            (-0.3, 0.9),
            (0.0, 0.0),
        ] {
            let epsilon = 0.05;
            let found = tangential(slip, ratio, epsilon);
            let v = |s, t| tangential(s, t, epsilon).value;
            let [by_slip, by_ratio] = differences(v, slip, ratio, 1e-5);
            // h²/6 times the third derivative, up to ε^-2.
            assert!((found.by_motion - by_slip).abs() < 1e-7);
            assert!((found.by_multiplier - by_ratio).abs() < 1e-7);
        }
    }
}
