//! Quadrature on the reference cells: `int f dA ~ sum_q w_q f(xi_q)`.
//!
//! The triangle is `(0,0), (1,0), (0,1)` with weights that sum to 1/2; the square is `[-1, 1]^2` with
//! weights that sum to 4.

/// A point of a quadrature rule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadraturePoint {
    /// Natural coordinates (-).
    pub at: [f64; 2],
    /// Weight (-): a share of the area of the reference cell.
    pub weight: f64,
}

const fn point(xi: f64, eta: f64, weight: f64) -> QuadraturePoint {
    QuadraturePoint {
        at: [xi, eta],
        weight,
    }
}

/// The centroid of the triangle: exact to degree 1.
pub const TRIANGLE_1: [QuadraturePoint; 1] = [point(1.0 / 3.0, 1.0 / 3.0, 0.5)];

/// Three interior points of the triangle, nearest to corners 0, 1, 2: exact to degree 2.
pub const TRIANGLE_3: [QuadraturePoint; 3] = [
    point(1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0),
    point(2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0),
    point(1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0),
];

// Radon (1948): a = (6 - sqrt 15)/21 and b = (6 + sqrt 15)/21, weights (155 -+ sqrt 15)/2400 and 9/80.
const SQRT_15: f64 = 3.872983346207417;
const A: f64 = (6.0 - SQRT_15) / 21.0;
const B: f64 = (6.0 + SQRT_15) / 21.0;
const WEIGHT_A: f64 = (155.0 - SQRT_15) / 2400.0;
const WEIGHT_B: f64 = (155.0 + SQRT_15) / 2400.0;

/// Radon's seven points of the triangle: exact to degree 5.
pub const TRIANGLE_7: [QuadraturePoint; 7] = [
    point(1.0 / 3.0, 1.0 / 3.0, 9.0 / 80.0),
    point(A, A, WEIGHT_A),
    point(1.0 - 2.0 * A, A, WEIGHT_A),
    point(A, 1.0 - 2.0 * A, WEIGHT_A),
    point(B, B, WEIGHT_B),
    point(1.0 - 2.0 * B, B, WEIGHT_B),
    point(B, 1.0 - 2.0 * B, WEIGHT_B),
];

const GAUSS: f64 = 0.577_350_269_189_625_8; // 1 / sqrt 3

/// The centre of the square: exact to degree 1 in each direction.
pub const SQUARE_1: [QuadraturePoint; 1] = [point(0.0, 0.0, 4.0)];

/// Two by two Gauss points of the square, nearest to corners 0, 1, 2, 3: exact to degree 3 in each direction.
pub const SQUARE_4: [QuadraturePoint; 4] = [
    point(-GAUSS, -GAUSS, 1.0),
    point(GAUSS, -GAUSS, 1.0),
    point(GAUSS, GAUSS, 1.0),
    point(-GAUSS, GAUSS, 1.0),
];

// The points of Gauss on a line, 0 and √(3/5), with weights 8/9 and 5/9.
const OUTER: f64 = 0.774_596_669_241_483_4;
const MIDDLE_WEIGHT: f64 = 8.0 / 9.0;
const OUTER_WEIGHT: f64 = 5.0 / 9.0;

/// Three by three Gauss points of the square, nearest to corners and midsides, and the centre: exact to degree 5 in each direction.
pub const SQUARE_9: [QuadraturePoint; 9] = [
    point(-OUTER, -OUTER, OUTER_WEIGHT * OUTER_WEIGHT),
    point(OUTER, -OUTER, OUTER_WEIGHT * OUTER_WEIGHT),
    point(OUTER, OUTER, OUTER_WEIGHT * OUTER_WEIGHT),
    point(-OUTER, OUTER, OUTER_WEIGHT * OUTER_WEIGHT),
    point(0.0, -OUTER, MIDDLE_WEIGHT * OUTER_WEIGHT),
    point(OUTER, 0.0, OUTER_WEIGHT * MIDDLE_WEIGHT),
    point(0.0, OUTER, MIDDLE_WEIGHT * OUTER_WEIGHT),
    point(-OUTER, 0.0, OUTER_WEIGHT * MIDDLE_WEIGHT),
    point(0.0, 0.0, MIDDLE_WEIGHT * MIDDLE_WEIGHT),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// The exact integral of `x^i y^j` over the reference triangle: `i! j! / (i + j + 2)!`.
    fn triangle_moment(i: u64, j: u64) -> f64 {
        let factorial = |k: u64| (1..=k).product::<u64>() as f64;
        factorial(i) * factorial(j) / factorial(i + j + 2)
    }

    fn apply(rule: &[QuadraturePoint], i: u64, j: u64) -> f64 {
        let power = |x: f64, k: u64| x.powi(k as i32);
        rule.iter()
            .map(|q| q.weight * power(q.at[0], i) * power(q.at[1], j))
            .sum()
    }

    #[test]
    fn triangle_rules_are_exact_to_their_degree() {
        let rules: [(&[QuadraturePoint], u64); 3] =
            [(&TRIANGLE_1, 1), (&TRIANGLE_3, 2), (&TRIANGLE_7, 5)];
        for (rule, degree) in rules {
            for i in 0..=degree {
                for j in 0..=degree - i {
                    let error = apply(rule, i, j) - triangle_moment(i, j);
                    assert!(
                        error.abs() < 1e-16,
                        "degree {degree}, x^{i} y^{j}: {error:e}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_square_rules_are_exact_to_degrees_three_and_five_in_each_direction() {
        let line = |k: u64| {
            if k.is_multiple_of(2) {
                2.0 / (k as f64 + 1.0)
            } else {
                0.0
            }
        };
        let rules: [(&[QuadraturePoint], u64); 2] = [(&SQUARE_4, 3), (&SQUARE_9, 5)];
        for (rule, degree) in rules {
            for i in 0..=degree {
                for j in 0..=degree {
                    let error = apply(rule, i, j) - line(i) * line(j);
                    assert!(error.abs() < 2e-15, "x^{i} y^{j}: {error:e}");
                }
            }
        }
    }
}
