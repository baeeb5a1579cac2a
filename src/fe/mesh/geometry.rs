//! Plane vectors and the area moments of a cell, `A = 1/2 ∮ (x dy - y dx)`.

use super::CellKind;
use crate::math::{hypot, rounding};

/// Two lengths closer than this, relative to the diagonal of the bounding box, count as equal.
///
/// Far above the rounding of coordinates (1e-16) and far below any useful edge.
pub(super) const RELATIVE_TOLERANCE: f64 = rounding::ITERATED;

pub(super) fn sub(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

pub(super) fn lerp(a: [f64; 2], b: [f64; 2], t: f64) -> [f64; 2] {
    [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]
}

pub(super) fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(super) fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

pub(super) fn length(a: [f64; 2]) -> f64 {
    hypot(a[0], a[1])
}

pub(super) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    length(sub(a, b))
}

/// Distance (m) of `point` from the segment `a`-`b`.
pub(super) fn distance_to_segment(point: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let along = sub(b, a);
    let square = dot(along, along);
    let t = if square > 0.0 {
        (dot(sub(point, a), along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    distance(point, lerp(a, b, t))
}

/// Lower and upper corner of the bounding box (m).
pub(super) fn bounds(points: impl IntoIterator<Item = [f64; 2]>) -> [[f64; 2]; 2] {
    let mut low = [f64::INFINITY; 2];
    let mut high = [f64::NEG_INFINITY; 2];
    for point in points {
        for axis in 0..2 {
            low[axis] = low[axis].min(point[axis]);
            high[axis] = high[axis].max(point[axis]);
        }
    }
    [low, high]
}

/// Length (m) below which two points count as one: [`RELATIVE_TOLERANCE`] times the diagonal.
pub(super) fn tolerance(points: impl IntoIterator<Item = [f64; 2]>) -> f64 {
    let [low, high] = bounds(points);
    RELATIVE_TOLERANCE * distance(low, high)
}

/// Signed area (m^2) of a closed polygon, positive when counter-clockwise.
pub(super) fn polygon_area(points: &[[f64; 2]]) -> f64 {
    let Some(&origin) = points.first() else {
        return 0.0;
    };
    let mut twice_area = 0.0;
    for pair in points.windows(2) {
        twice_area += cross(sub(pair[0], origin), sub(pair[1], origin));
    }
    0.5 * twice_area
}

/// Signed area (m^2) and first moments (m^3) about the first point of a cell.
///
/// Edges with a midside node are parabolas, as the shape functions make them.
pub(super) fn cell_moments(kind: CellKind, points: &[[f64; 2]]) -> (f64, [f64; 2]) {
    let origin = points[0];
    let mut area = 0.0;
    let mut moment = [0.0; 2];
    for edge in kind.edges() {
        let a = sub(points[edge.from], origin);
        let b = sub(points[edge.to], origin);
        let bulge = match edge.midside {
            Some(midside) => sub(sub(points[midside], origin), lerp(a, b, 0.5)),
            None => [0.0; 2],
        };
        // x(t) = a + t (b - a) + 4 t (1 - t) bulge, integrated exactly by three Gauss points (degree 5)
        for (t, weight) in GAUSS_3 {
            let blend = 4.0 * t * (1.0 - t);
            let slope = 4.0 * (1.0 - 2.0 * t);
            let at = [
                a[0] + t * (b[0] - a[0]) + blend * bulge[0],
                a[1] + t * (b[1] - a[1]) + blend * bulge[1],
            ];
            let tangent = [
                b[0] - a[0] + slope * bulge[0],
                b[1] - a[1] + slope * bulge[1],
            ];
            area += weight * 0.5 * cross(at, tangent);
            moment[0] += weight * 0.5 * at[0] * at[0] * tangent[1];
            moment[1] -= weight * 0.5 * at[1] * at[1] * tangent[0];
        }
    }
    (area, moment)
}

/// Gauss–Legendre points and weights on the unit interval.
const GAUSS_3: [(f64, f64); 3] = [
    (0.112_701_665_379_258_31, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// Determinants (m^2) of the Jacobian of a cell at its nodes, in node order.
///
/// Natural coordinates run over the unit triangle, or over the unit square for a quadrilateral, so
/// that an undistorted cell has twice, respectively once, its area everywhere.
pub(super) fn nodal_jacobians(kind: CellKind, points: &[[f64; 2]]) -> [f64; 8] {
    let mut jacobians = [0.0; 8];
    match kind {
        CellKind::Tri3 | CellKind::Quad4 => {
            let n = kind.n_corners();
            for corner in 0..n {
                let forward = sub(points[(corner + 1) % n], points[corner]);
                let backward = sub(points[(corner + n - 1) % n], points[corner]);
                jacobians[corner] = cross(forward, backward);
            }
        }
        CellKind::Tri6 => {
            for (jacobian, [xi, eta]) in jacobians.iter_mut().zip(TRI6_NATURAL) {
                *jacobian = tri6_jacobian(points, xi, eta);
            }
        }
        CellKind::Quad8 => {
            for (jacobian, at) in jacobians.iter_mut().zip(QUAD8_NATURAL) {
                *jacobian = quad8_jacobian(points, at);
            }
        }
    }
    jacobians
}

const TRI6_NATURAL: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [1.0, 0.0],
    [0.0, 1.0],
    [0.5, 0.0],
    [0.5, 0.5],
    [0.0, 0.5],
];

const QUAD8_NATURAL: [[f64; 2]; 8] = [
    [-1.0, -1.0],
    [1.0, -1.0],
    [1.0, 1.0],
    [-1.0, 1.0],
    [0.0, -1.0],
    [1.0, 0.0],
    [0.0, 1.0],
    [-1.0, 0.0],
];

fn quad8_jacobian(points: &[[f64; 2]], [xi, eta]: [f64; 2]) -> f64 {
    let mut x_xi = [0.0; 2];
    let mut x_eta = [0.0; 2];
    for (point, [a, b]) in points.iter().zip(QUAD8_NATURAL) {
        let (along, across) = (1.0 + xi * a, 1.0 + eta * b);
        let [by_xi, by_eta] = if a == 0.0 {
            [-xi * across, 0.5 * b * (1.0 - xi * xi)]
        } else if b == 0.0 {
            [0.5 * a * (1.0 - eta * eta), -eta * along]
        } else {
            [
                0.25 * a * across * (2.0 * xi * a + eta * b),
                0.25 * b * along * (xi * a + 2.0 * eta * b),
            ]
        };
        for axis in 0..2 {
            // differences to the first node keep small cells far from the origin accurate
            let x = point[axis] - points[0][axis];
            x_xi[axis] += by_xi * x;
            x_eta[axis] += by_eta * x;
        }
    }
    // the natural square has four times the area of the unit square
    4.0 * cross(x_xi, x_eta)
}

fn tri6_jacobian(points: &[[f64; 2]], xi: f64, eta: f64) -> f64 {
    let rest = 1.0 - xi - eta;
    let by_xi = [
        1.0 - 4.0 * rest,
        4.0 * xi - 1.0,
        0.0,
        4.0 * (rest - xi),
        4.0 * eta,
        -4.0 * eta,
    ];
    let by_eta = [
        1.0 - 4.0 * rest,
        0.0,
        4.0 * eta - 1.0,
        -4.0 * xi,
        4.0 * xi,
        4.0 * (rest - eta),
    ];
    let mut x_xi = [0.0; 2];
    let mut x_eta = [0.0; 2];
    for node in 0..6 {
        for axis in 0..2 {
            // differences to the first node keep small cells far from the origin accurate
            let x = points[node][axis] - points[0][axis];
            x_xi[axis] += by_xi[node] * x;
            x_eta[axis] += by_eta[node] * x;
        }
    }
    cross(x_xi, x_eta)
}
