//! Several numbers side by side.

use std::ops::{Add, AddAssign, Mul, Neg, Sub};

/// How many numbers stand side by side: what a register of AVX2 holds.
pub(crate) const LANES: usize = 4;

/// A number, or several side by side: formulas written for it give the same digits either way.
pub(crate) trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + Neg<Output = Self>
    + AddAssign
{
    const ZERO: Self;
    const ONE: Self;
}

impl Number for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
}

/// Numbers side by side, each answered for by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Wide(pub [f64; LANES]);

impl Wide {
    /// One number of each lane.
    #[inline(always)]
    pub fn from_fn(mut of: impl FnMut(usize) -> f64) -> Self {
        // What is not written out is not always inlined, and then not in registers.
        Self([of(0), of(1), of(2), of(3)])
    }

    /// The larger one of each lane.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        Self::from_fn(|lane| {
            if self.0[lane] > other.0[lane] {
                self.0[lane]
            } else {
                other.0[lane]
            }
        })
    }

    /// The square root of each lane.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self::from_fn(|lane| self.0[lane].sqrt())
    }
}

impl Number for Wide {
    const ZERO: Self = Self([0.0; LANES]);
    const ONE: Self = Self([1.0; LANES]);
}

impl Add for Wide {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::from_fn(|lane| self.0[lane] + other.0[lane])
    }
}

impl Sub for Wide {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::from_fn(|lane| self.0[lane] - other.0[lane])
    }
}

impl Mul for Wide {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::from_fn(|lane| self.0[lane] * other.0[lane])
    }
}

impl Mul<f64> for Wide {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        Self::from_fn(|lane| self.0[lane] * other)
    }
}

impl Neg for Wide {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::from_fn(|lane| -self.0[lane])
    }
}

impl AddAssign for Wide {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}
