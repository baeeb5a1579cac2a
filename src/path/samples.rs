//! Random surfaces and plain counterparts of the searches, for tests.

use super::{MotionKind, Surfaces};
use crate::math::{Vec2, exp, mix, sin_cos};

/// Numbers that look random and are the same every time.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(mix(0, seed))
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 = mix(self.0, 1);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// In [-size, size).
    pub fn within(&mut self, size: f64) -> f64 {
        size * (2.0 * self.unit() - 1.0)
    }

    pub fn index(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }

    pub fn point(&mut self, size: f64) -> Vec2 {
        Vec2::new(self.within(size), self.within(size))
    }

    /// A walk of `n` points with steps of some size; it may cross itself.
    pub fn chain(&mut self, n: usize, step: f64) -> Vec<Vec2> {
        let mut at = self.point(0.5);
        let points = (0..n).map(|_| {
            at += self.point(step);
            at
        });
        points.collect()
    }

    /// A star-shaped counter-clockwise loop about a centre, with radii between half of `radius` and `radius`.
    pub fn star(&mut self, n: usize, centre: Vec2, radius: f64) -> Vec<Vec2> {
        let turn = self.within(3.0);
        let points = (0..n).map(|k| {
            let (sin, cos) = sin_cos(turn + std::f64::consts::TAU * k as f64 / n as f64);
            centre + Vec2::new(cos, sin) * (radius * (0.5 + 0.5 * self.unit()))
        });
        points.collect()
    }

    /// One of ball, capsule, box, star of 5 to 12 points, or open chain of 3 to 6.
    pub fn member(
        &mut self,
        surfaces: &mut Surfaces,
        kind: MotionKind,
        centre: Vec2,
        radius: f64,
    ) -> usize {
        match self.index(5) {
            0 => surfaces.add_chain(kind, false, &[centre], false),
            1 => {
                let arm = self.point(radius);
                surfaces.add_chain(kind, false, &[centre - arm, centre + arm], false)
            }
            2 => {
                let half = Vec2::new(
                    radius * (0.2 + 0.5 * self.unit()),
                    radius * (0.2 + 0.5 * self.unit()),
                );
                let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
                let corners = corners.map(|[x, y]| centre + Vec2::new(x * half.x, y * half.y));
                surfaces.add_chain(kind, true, &corners, true)
            }
            3 => {
                let n = 5 + self.index(8);
                let star = self.star(n, centre, radius);
                surfaces.add_chain(kind, true, &star, true)
            }
            _ => {
                let n = 3 + self.index(4);
                let chain: Vec<Vec2> = self.star(12, centre, radius)[..n].to_vec();
                surfaces.add_chain(kind, false, &chain, false)
            }
        }
    }
}

/// `10^exponent`.
pub fn power_of_ten(exponent: f64) -> f64 {
    exp(std::f64::consts::LN_10 * exponent)
}

/// Least distance of two members (m), all points against all edges. Not zero where they cross.
pub fn distance(surfaces: &Surfaces, points: &[Vec2], one: usize, other: usize) -> f64 {
    let mut least = f64::INFINITY;
    for [of, against] in [[one, other], [other, one]] {
        for point in surfaces.members()[of].points.clone() {
            for edge in surfaces.members()[against].edges.clone() {
                let [a, b] = surfaces.edges()[edge].map(|end| points[end as usize]);
                let (way, edge) = (points[point] - a, b - a);
                let xi =
                    (way.dot(&edge) / edge.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
                least = least.min((way - edge * xi).norm());
            }
        }
    }
    least
}
