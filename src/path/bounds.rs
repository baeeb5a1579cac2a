//! Boxes with sides along the axes.

use crate::math::Vec2;

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
    pub fn add(&mut self, point: Vec2) {
        self.low = Vec2::new(self.low.x.min(point.x), self.low.y.min(point.y));
        self.high = Vec2::new(self.high.x.max(point.x), self.high.y.max(point.y));
    }

    #[inline]
    pub fn join(&mut self, other: &Self) {
        self.add(other.low);
        self.add(other.high);
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
