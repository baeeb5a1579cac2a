//! Whether passes that are left can still end a step.

use crate::kkt::tolerances::{CLOSE_ENOUGH, FEW_PASSES};

/// What the last passes lacked of the laws, relative to the margins (-).
#[derive(Clone, Copy, Debug)]
pub(super) struct Trend {
    lacks: [f64; FEW_PASSES],
    next: usize,
}

impl Trend {
    /// Nothing is known.
    pub fn new() -> Self {
        Self {
            lacks: [f64::INFINITY; FEW_PASSES],
            next: 0,
        }
    }

    /// Takes in what a pass lacks; returns whether it would still be more than [`CLOSE_ENOUGH`] after `n_left` more, if these gained as much as
    /// the last ones have. Rows that are left as they are may lead to and fro between two places for ever.
    pub fn is_hopeless(&mut self, lack: f64, n_left: usize) -> bool {
        let worst = self.lacks.iter().copied().fold(0.0, f64::max);
        self.lacks[self.next] = lack;
        self.next = (self.next + 1) % FEW_PASSES;
        let gain = (lack / worst).min(1.0);
        let rounds = 0..n_left.div_ceil(FEW_PASSES);
        lack.is_finite() && rounds.fold(lack, |left, _| left * gain) > CLOSE_ENOUGH
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pass in which passes with such lacks are given up, of `n` in all.
    fn given_up(lacks: impl Fn(usize) -> f64, n: usize) -> Option<usize> {
        let mut trend = Trend::new();
        (0..n).find(|&pass| trend.is_hopeless(lacks(pass), n - pass - 1))
    }

    #[test]
    fn what_goes_to_and_fro_is_given_up_once_that_is_known() {
        let alternating = |pass: usize| if pass.is_multiple_of(2) { 0.3 } else { 0.2 };
        assert_eq!(given_up(alternating, 34), Some(FEW_PASSES));
    }

    #[test]
    fn what_gets_there_in_time_is_not_given_up() {
        // A tenth a pass reaches 1.0 to .05 after 29 passes.
        let slow = |pass: usize| 0.9f64.powi(pass as i32);
        assert_eq!(given_up(slow, 34), None);
        // And half as fast does not.
        let slower = |pass: usize| 0.95f64.powi(pass as i32);
        assert_eq!(given_up(slower, 34), Some(FEW_PASSES));
        // Nor what the path has stopped since.
        assert_eq!(given_up(|_| f64::INFINITY, 34), None);
        // What has been as near as asked for is left to the other conditions.
        assert_eq!(given_up(|_| CLOSE_ENOUGH, 34), None);
    }
}
