//! Boxes with sides along the axes.

use crate::math::Vec2;

// One instruction each, unlike `f64::min` and `max`, which ask for numbers that are none.
#[inline]
fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

#[inline]
fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// A box, empty at first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub low: Vec2,
    pub high: Vec2,
}

impl Bounds {
    pub const EMPTY: Self = Self {
        low: Vec2::new(f64::INFINITY, f64::INFINITY),
        high: Vec2::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    #[inline]
    pub fn of([a, b]: [Vec2; 2]) -> Self {
        Self {
            low: Vec2::new(lesser(a.x, b.x), lesser(a.y, b.y)),
            high: Vec2::new(greater(a.x, b.x), greater(a.y, b.y)),
        }
    }

    #[inline]
    pub fn join(&mut self, other: &Self) {
        self.low = Vec2::new(
            lesser(self.low.x, other.low.x),
            lesser(self.low.y, other.low.y),
        );
        self.high = Vec2::new(
            greater(self.high.x, other.high.x),
            greater(self.high.y, other.high.y),
        );
    }

    #[inline]
    pub fn grown(&self, by: f64) -> Self {
        Self {
            low: Vec2::new(self.low.x - by, self.low.y - by),
            high: Vec2::new(self.high.x + by, self.high.y + by),
        }
    }

    /// Whether the boxes share a point, their sides included.
    #[inline]
    pub fn meets(&self, other: &Self) -> bool {
        (self.low.x <= other.high.x)
            & (other.low.x <= self.high.x)
            & (self.low.y <= other.high.y)
            & (other.low.y <= self.high.y)
    }

    #[inline]
    pub fn contains(&self, point: Vec2) -> bool {
        self.meets(&Self {
            low: point,
            high: point,
        })
    }
}
