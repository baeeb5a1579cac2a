//! What the crate promises, beside what was measured.

use crate::measure::Timing;
use crate::scene::{Phase, Scene};

/// Sides in the order they are run.
const CONSTRAINTS: usize = 2;
const CONVERGED_FEM: usize = 4;
const TIGHT_FEM: usize = 5;

/// A promise about one scene.
struct Bar {
    phase: Phase,
    divisions: [usize; 2],
    kind: Promise,
}

enum Promise {
    /// At least this many times faster than that side.
    Faster(f64, usize),
    /// The stage itself takes at most twice as long as a bare prototype of the method: that one's time, and the time of
    /// rapier's Constraints in the run in which it was measured (µs). The latter tells how fast a machine is.
    Stage(f64, f64),
}

const BARS: [Bar; 19] = [
    Bar::new(Phase::Clamped, [20, 2], Promise::Faster(2.0, CONSTRAINTS)),
    Bar::new(Phase::Clamped, [80, 8], Promise::Faster(12.0, CONSTRAINTS)),
    Bar::new(
        Phase::Clamped,
        [200, 20],
        Promise::Faster(20.0, CONSTRAINTS),
    ),
    Bar::new(
        Phase::Clamped,
        [200, 20],
        Promise::Faster(200.0, CONVERGED_FEM),
    ),
    Bar::new(Phase::Clamped, [200, 20], Promise::Faster(200.0, TIGHT_FEM)),
    Bar::new(Phase::Clamped, [20, 2], Promise::Stage(2.1, 55.0)),
    Bar::new(Phase::Clamped, [80, 8], Promise::Stage(21.0, 799.0)),
    Bar::new(Phase::Clamped, [200, 20], Promise::Stage(165.0, 4849.0)),
    Bar::new(Phase::Bending, [20, 2], Promise::Faster(6e+00, CONSTRAINTS)),
    Bar::new(Phase::Bending, [80, 8], Promise::Faster(5e+00, CONSTRAINTS)),
    Bar::new(
        Phase::Bending,
        [200, 20],
        Promise::Faster(4e+00, CONSTRAINTS),
    ),
    Bar::new(
        Phase::Swinging,
        [20, 2],
        Promise::Faster(3e+00, CONSTRAINTS),
    ),
    Bar::new(
        Phase::Swinging,
        [80, 8],
        Promise::Faster(2e+00, CONSTRAINTS),
    ),
    Bar::new(
        Phase::Swinging,
        [200, 20],
        Promise::Faster(2e+00, CONSTRAINTS),
    ),
    Bar::new(
        Phase::Swinging,
        [20, 2],
        Promise::Faster(6e+00, CONVERGED_FEM),
    ),
    Bar::new(
        Phase::Swinging,
        [80, 8],
        Promise::Faster(1e+01, CONVERGED_FEM),
    ),
    Bar::new(
        Phase::Swinging,
        [200, 20],
        Promise::Faster(2e+01, CONVERGED_FEM),
    ),
    Bar::new(Phase::Landed, [16, 16], Promise::Faster(3.0, CONSTRAINTS)),
    Bar::new(Phase::Landed, [64, 64], Promise::Faster(5.0, CONSTRAINTS)),
];

impl Bar {
    const fn new(phase: Phase, divisions: [usize; 2], kind: Promise) -> Self {
        Self {
            phase,
            divisions,
            kind,
        }
    }

    fn print(&self, scene: &Scene, timings: &[Timing]) {
        let (what, measured): (String, [Option<(f64, bool)>; 2]) = match self.kind {
            Promise::Faster(least, side) => {
                let what = format!("at least {least} times faster than {}", timings[side].label);
                let judge = |own: &Timing| {
                    let ratio = timings[side].ratio_to(own)?;
                    Some((ratio, ratio >= least))
                };
                (what, [judge(&timings[0]), judge(&timings[1])])
            }
            Promise::Stage(bare, constraints) => {
                let judge = |own: &Timing| {
                    let slowness = timings[CONSTRAINTS].ratio_to(own)? * own.whole()? / constraints;
                    let time = own.own()? / slowness;
                    Some((time, time <= 2.0 * bare))
                };
                let most = 2.0 * bare;
                let what = format!("stage <= {most} us where Constraints take {constraints}");
                (what, [judge(&timings[0]), judge(&timings[1])])
            }
        };
        let verdict = |measured: Option<(f64, bool)>| match measured {
            Some((value, true)) => format!("{value:.1} met"),
            Some((value, false)) => format!("{value:.1} MISSED"),
            None => "no measurement".to_owned(),
        };
        println!(
            "  {:<38} {:<47} {:>14} {:>14}",
            scene.name(),
            what,
            verdict(measured[0]),
            verdict(measured[1])
        );
    }
}

/// Prints every bar whose scene was run.
pub fn print(outcomes: &[(Scene, Vec<Timing>)]) {
    println!(
        "\n{:<40} {:<47} {:>14} {:>14}",
        "Bars", "", "Tri3 or Tri6", "Quad4"
    );
    for bar in &BARS {
        let outcome = outcomes
            .iter()
            .find(|(scene, _)| scene.phase == bar.phase && scene.divisions == bar.divisions);
        if let Some((scene, timings)) = outcome {
            bar.print(scene, timings);
        }
    }
}
