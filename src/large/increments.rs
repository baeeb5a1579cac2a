//! How far the increments of a load case go.

/// Where a load case stands: increments are halved where no equilibrium is found, and grow again.
#[derive(Clone, Copy, Debug)]
pub(super) struct Increments {
    done: f64,
    part: f64,
    share: f64,
    last: f64,
    largest: f64,
    smallest: f64,
}

impl Increments {
    pub(super) fn new(n_increments: usize, max_cutbacks: usize) -> Self {
        let largest = 1.0 / n_increments.max(1) as f64;
        Self {
            done: 0.0,
            part: 0.0,
            share: largest,
            last: 0.0,
            largest,
            smallest: largest * 0.5_f64.powi(max_cutbacks as i32),
        }
    }

    /// The share of the case reached by the next increment, and its length over that of the last one, zero for the first; none when all is done.
    pub(super) fn next(&mut self) -> Option<[f64; 2]> {
        if self.done >= 1.0 {
            return None;
        }
        // A remainder by rounding is not an increment of its own.
        self.part = match self.done + 1.001 * self.share >= 1.0 {
            true => 1.0 - self.done,
            false => self.share,
        };
        let ahead = match self.last > 0.0 {
            true => self.part / self.last,
            false => 0.0,
        };
        Some([self.reached(), ahead])
    }

    fn reached(&self) -> f64 {
        let reached = self.done + self.part;
        if reached >= 1.0 { 1.0 } else { reached }
    }

    /// The increment was solved.
    pub(super) fn accept(&mut self) {
        (self.done, self.last) = (self.reached(), self.part);
        self.share = self.largest.min(2.0 * self.share);
    }

    /// Halves the increment; not if it would be too small.
    pub(super) fn halve(&mut self) -> bool {
        if 0.5 * self.share < self.smallest {
            return false;
        }
        self.share *= 0.5;
        true
    }
}
