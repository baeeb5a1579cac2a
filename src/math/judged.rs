//! Values of judgement: chosen where nothing derives them, each for the reason that stands beside it.
//!
//! They are declared as such so that they can be counted, and so that a test can ask what depends on them: in unit tests `tests::with` makes one of
//! them larger or smaller. Anywhere else such a value is the number that it holds.

use std::cmp::Ordering;
use std::fmt;
use std::ops::{Div, Mul, Neg};

/// Share of what it belongs to below which a law, a way or an error is no matter (-): results are meant to some thousandths, and nothing that is
/// asked of them sees the difference.
pub(crate) const NEGLIGIBLE: Judged = Judged::new("math::NEGLIGIBLE", 1e-3);

/// A value of judgement, in the unit that stands beside it.
#[derive(Clone, Copy)]
pub(crate) struct Judged {
    /// What tests know it by.
    name: &'static str,
    value: f64,
}

impl Judged {
    /// A value and the name that tests know it by.
    pub const fn new(name: &'static str, value: f64) -> Self {
        Self { name, value }
    }

    /// A multiple of it, which is no judgement of its own.
    pub const fn times(mut self, factor: f64) -> Self {
        self.value *= factor;
        self
    }

    /// The number.
    #[cfg(not(test))]
    #[inline]
    pub const fn get(self) -> f64 {
        self.value
    }

    #[cfg(test)]
    pub fn get(self) -> f64 {
        self.value * tests::scale_of(self.name)
    }
}

impl fmt::Debug for Judged {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {:e}", self.name, self.value)
    }
}

impl Mul<f64> for Judged {
    type Output = f64;

    #[inline]
    fn mul(self, other: f64) -> f64 {
        self.get() * other
    }
}

impl Mul<f32> for Judged {
    type Output = f32;

    #[inline]
    fn mul(self, other: f32) -> f32 {
        self.get() as f32 * other
    }
}

impl Div<f64> for Judged {
    type Output = f64;

    #[inline]
    fn div(self, other: f64) -> f64 {
        self.get() / other
    }
}

impl Div<Judged> for f64 {
    type Output = f64;

    #[inline]
    fn div(self, other: Judged) -> f64 {
        self / other.get()
    }
}

impl Neg for Judged {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        self.times(-1.0)
    }
}

impl PartialEq<Judged> for f64 {
    fn eq(&self, other: &Judged) -> bool {
        *self == other.get()
    }
}

impl PartialOrd<Judged> for f64 {
    #[inline]
    fn partial_cmp(&self, other: &Judged) -> Option<Ordering> {
        self.partial_cmp(&other.get())
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use std::cell::{Cell, RefCell};
    use std::collections::BTreeSet;

    thread_local! {
        static SCALED: Cell<Option<(&'static str, f64)>> = const { Cell::new(None) };
        static ASKED: RefCell<BTreeSet<&'static str>> = const { RefCell::new(BTreeSet::new()) };
    }

    pub fn scale_of(name: &'static str) -> f64 {
        ASKED.with_borrow_mut(|asked| asked.insert(name));
        match SCALED.get() {
            Some((scaled, scale)) if scaled == name => scale,
            _ => 1.0,
        }
    }

    /// Runs with one value of judgement multiplied; returns what that gives, and the names of all values that were asked for.
    pub fn with<T>(
        scaled: Option<(&'static str, f64)>,
        run: impl FnOnce() -> T,
    ) -> (T, BTreeSet<&'static str>) {
        ASKED.take();
        SCALED.set(scaled);
        let found = run();
        SCALED.set(None);
        (found, ASKED.take())
    }

    #[test]
    fn one_value_is_scaled_and_its_multiples_with_it() {
        const ONE: super::Judged = super::Judged::new("one", 3.0);
        const OTHER: super::Judged = super::Judged::new("other", 5.0);
        let (found, asked) = with(Some(("one", 2.0)), || [ONE.times(10.0) * 1.0, OTHER * 1.0]);
        assert_eq!(found, [60.0, 5.0]);
        assert_eq!(asked.into_iter().collect::<Vec<_>>(), ["one", "other"]);
        assert_eq!(ONE.get(), 3.0);
    }
}
