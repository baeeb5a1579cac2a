//! Laws of joint rows at a step's length: where a row is to be at its end, how far its force lets it give way, and between what bounds the force is.

use crate::constraint::geometry::RESTING;
use crate::constraint::joint::{JointLaw, JointRow, Spring};
use crate::kkt::settings::SolveSettings;
use crate::kkt::tolerances::PARTING_RATE;
use crate::linalg::complementarity::RowKind;
use crate::math::{exp, judged::NEGLIGIBLE};

/// What the velocity stage does about a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::kkt) enum Finish {
    /// `G'v' = rate`, for rows that hold, or drive with bounds.
    Hold {
        /// Velocity (m/s or rad/s).
        rate: f64,
    },
    /// `0 <= P ⊥ G'v' >= 0` where the row is closed.
    Limit,
    /// A resolved spring: the force of the position stage acts at the end too.
    Spring,
    /// A spring or damper that the step does not resolve, implicit once more.
    Stiff(Spring),
    /// Nothing: a spring at a flexible block.
    Nothing,
}

/// The law of a row at this step length.
pub(super) struct Resolved {
    pub goal: f64,
    /// Where the row is to be in the end (m or rad), which what was put elsewhere comes to over several steps.
    pub target: f64,
    /// By how much the step brings what was put elsewhere nearer (m or rad).
    pub closing: f64,
    pub give: f64,
    pub kind: RowKind,
    pub finish: Finish,
}

/// Distance from which ends count as put apart, or an angle where the unit is one (m or rad): farther than what rests on each other.
pub(in crate::kkt) fn put_apart(length_unit: f64) -> f64 {
    RESTING * length_unit
}

/// The law of a row that measures `start` when the step begins, of which its force explains that it is off by `yielded`; it has this mobility, and this
/// one with what is attached to its bodies.
pub(super) fn resolve(
    row: &JointRow,
    is_hard: bool,
    ([start, yielded], mobility, swinging): ([f64; 2], f64, f64),
    settings: &SolveSettings,
) -> Resolved {
    // A force over the step, λ, is `scale` times the multiplier.
    let scale = if is_hard {
        2.0 * settings.b0 / (settings.dt * settings.dt)
    } else {
        1.0
    };
    // Ends that are farther apart than what rests on each other have been put there.
    let slack = match row.measure.is_turn() {
        true => put_apart(1.0),
        false => put_apart(settings.length_unit),
    };
    match row.law {
        JointLaw::Rigid { goal, rate } => {
            let (goal, rate) = (row.sign * goal, row.sign * rate);
            let off = start + settings.dt * rate - goal;
            let off_itself = (off - yielded).abs();
            let [left, closing] = closed((row, is_hard), off, [off_itself, slack], settings.dt);
            Resolved {
                goal: goal + left,
                target: goal,
                closing,
                give: 0.0,
                kind: RowKind::Bilateral,
                finish: Finish::Hold { rate },
            }
        }
        JointLaw::Limit { bound } => {
            let bound = row.sign * bound;
            let off = start - bound;
            let off_itself = yielded - off;
            let [left, closing] = closed(
                (row, is_hard),
                off.min(0.0),
                [off_itself, slack],
                settings.dt,
            );
            Resolved {
                goal: bound + left,
                target: bound,
                closing,
                give: 0.0,
                kind: RowKind::Unilateral,
                finish: Finish::Limit,
            }
        }
        JointLaw::Drive { rate, most } => Resolved {
            goal: start + settings.dt * rate,
            target: start + settings.dt * rate,
            closing: 0.0,
            give: 0.0,
            kind: bounded(most / scale),
            finish: Finish::Hold { rate },
        },
        JointLaw::Spring(spring) => {
            let spring = spring.absolute(mobility);
            let is_mean = is_hard || settings.is_within;
            resolve_spring(
                spring,
                (is_hard, is_mean),
                (start, swinging, scale),
                settings.dt,
            )
        }
    }
}

/// How far a row that is off is left open at the end of the step, and how far it moves towards its place because it was put elsewhere, as it goes on to do
/// until it is there: by a share of what it is off by, at last of the slack. What rigid bodies are off by in the first step of a row is not what its
/// own steps have left: someone has put them there, or rapier has.
fn closed(
    (row, is_hard): (&JointRow, bool),
    off: f64,
    [off_itself, slack]: [f64; 2],
    dt: f64,
) -> [f64; 2] {
    let left = exp(-PARTING_RATE * dt);
    if off_itself > slack {
        return [left * off, (left - 1.0) * off];
    }
    let is_there = is_hard && off_itself <= NEGLIGIBLE.get() * slack;
    let was_put = row.remembered.map_or(is_hard, |last| last.closes);
    if is_there || !was_put {
        return [0.0; 2];
    }
    let nearer = match is_hard {
        true => off.abs().min((1.0 - left) * slack),
        false => off.abs(),
    };
    let left = off - nearer.copysign(off);
    [left, left - off]
}

/// A spring that the step resolves acts with its mean force, `q` in the middle of the step, where multipliers act wholly within the step
/// or on rigid blocks only; others with that of the end.
fn resolve_spring(
    spring: Spring,
    (is_hard, is_mean): (bool, bool),
    (start, mobility, scale): (f64, f64, f64),
    dt: f64,
) -> Resolved {
    let Spring {
        stiffness: k,
        damping: c,
        rest,
        rate,
        most,
        ..
    } = spring;
    let sampling = mobility * (0.25 * dt * dt * k + 0.5 * dt * c);
    let is_resolved = is_mean && sampling <= 1.0;
    let share = if is_resolved { 0.5 } else { 1.0 };
    let total = share * k + c / dt;
    let held = k * (rest - (1.0 - share) * start) + c * (start / dt + rate);
    let (goal, give, kind) = if total > 0.0 {
        (held / total, scale / total, bounded(most / scale))
    } else {
        let none = RowKind::Box {
            low: 0.0,
            high: 0.0,
        };
        (start, 0.0, none)
    };
    let finish = match (is_hard, is_resolved) {
        (false, _) => Finish::Nothing,
        (true, true) => Finish::Spring,
        (true, false) => Finish::Stiff(spring),
    };
    Resolved {
        goal,
        target: goal,
        closing: 0.0,
        give,
        kind,
        finish,
    }
}

/// The law of a row whose multiplier is at most `most`, either way.
pub(super) fn bounded(most: f64) -> RowKind {
    if most.is_finite() {
        RowKind::Box {
            low: -most,
            high: most,
        }
    } else {
        RowKind::Bilateral
    }
}
