//! The measurement: sides of a scene take turns, and are compared turn by turn.

use crate::scene::Scene;

pub use crate::clock::{Clock, median};

/// Turns per side.
const N_TURNS: usize = 25;
/// Length of a side's turn (µs): long enough for its data to be in the caches again.
const TURN: f64 = 2_000.0;
/// Longest time one side may take for all its turns (µs); a slower side takes fewer.
const PATIENCE: f64 = 5e6;
/// Fewest turns of a side.
const LEAST_TURNS: usize = 5;

/// What may go wrong goes to `main`.
pub type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

/// How much to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plan {
    /// Measure.
    Measure,
    /// See that it runs.
    Glance,
}

/// Median times of the steps of one turn (µs).
#[derive(Clone, Copy, Debug)]
pub struct Burst {
    /// The whole step.
    pub whole: f64,
    /// Rapier's part of it, for a flexible body.
    pub rapier: Option<f64>,
}

/// Something that steps a scene.
pub trait Side {
    /// Who it is.
    fn label(&self) -> String;
    /// Steps to take before the clock runs.
    fn n_warm_up(&self) -> usize;
    /// Steps without the clock.
    fn advance(&mut self, n_steps: usize) -> Outcome<()>;
    /// Steps with the clock; `None` if no step was one of those that count.
    fn burst(&mut self, n_steps: usize, clock: &Clock) -> Outcome<Option<Burst>>;
    /// How far the tip of the cantilever hangs below where it was built (m).
    fn tip_deflection(&self) -> f64;
}

/// What was measured of one side.
#[derive(Debug)]
pub struct Timing {
    pub label: String,
    /// By turn; `None` where the side sat out or nothing counted.
    bursts: Vec<Option<Burst>>,
    /// Deflection of the tip after the warm-up (m).
    pub deflection: f64,
}

impl Timing {
    /// Median time of a step (µs).
    pub fn whole(&self) -> Option<f64> {
        self.median_of(|burst| Some(burst.whole))
    }

    /// Median time of rapier's two steps within it (µs).
    pub fn rapier(&self) -> Option<f64> {
        self.median_of(|burst| burst.rapier)
    }

    /// Median time of the flexible stage itself (µs).
    pub fn own(&self) -> Option<f64> {
        self.median_of(|burst| Some(burst.whole - burst.rapier?))
    }

    /// How many times longer this side takes than `other`: the median over the turns of both.
    pub fn ratio_to(&self, other: &Self) -> Option<f64> {
        let pairs = self.bursts.iter().zip(&other.bursts);
        let ratio = |(own, other): (&Option<Burst>, &Option<Burst>)| {
            Some(own.as_ref()?.whole / other.as_ref()?.whole)
        };
        median(&mut pairs.filter_map(ratio).collect::<Vec<_>>())
    }

    fn median_of(&self, part: impl Fn(&Burst) -> Option<f64>) -> Option<f64> {
        median(
            &mut self
                .bursts
                .iter()
                .flatten()
                .filter_map(part)
                .collect::<Vec<_>>(),
        )
    }
}

/// Times all sides of a scene.
pub fn compare(scene: &Scene, mut sides: Vec<Box<dyn Side>>, plan: Plan) -> Outcome<Vec<Timing>> {
    let n_turns = match plan {
        Plan::Measure => N_TURNS,
        Plan::Glance => 1,
    };
    let mut timings = Vec::new();
    let mut turns = Vec::new();
    for side in &mut sides {
        side.advance(match plan {
            Plan::Measure => side.n_warm_up(),
            Plan::Glance => 2,
        })?;
        timings.push(Timing {
            label: side.label(),
            bursts: vec![None; n_turns],
            deflection: side.tip_deflection(),
        });
        let (step, outcome) = Clock::plain().time(|| side.advance(1));
        outcome?;
        turns.push(Turns::plan(scene, step, n_turns));
    }
    for turn in 0..n_turns {
        for ((side, timing), turns) in sides.iter_mut().zip(&mut timings).zip(&turns) {
            if turn % turns.every == 0 {
                timing.bursts[turn] = side.burst(turns.n_steps, &turns.clock)?;
            }
        }
    }
    Ok(timings)
}

/// How a side takes its turns.
#[derive(Debug)]
struct Turns {
    clock: Clock,
    /// Steps a turn.
    n_steps: usize,
    /// 1 to take every turn, 2 for every other one, ...
    every: usize,
}

impl Turns {
    /// For a side whose step takes about `step` (µs).
    fn plan(scene: &Scene, step: f64, n_turns: usize) -> Self {
        let n_steps = ((TURN / step) as usize).clamp(1, 40);
        let n_affordable = (PATIENCE / (step * n_steps as f64)) as usize;
        let n_taken = n_affordable.clamp(LEAST_TURNS.min(n_turns), n_turns);
        Self {
            clock: Clock::for_steps_of(step),
            n_steps: n_steps.min(scene.n_timed / n_turns),
            every: n_turns.div_ceil(n_taken),
        }
    }
}
