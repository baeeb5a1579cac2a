//! How far rows of flexible bodies turn from pass to pass.
//!
//! Gaps along a path are true, and a row that is off by an angle misses a gap by its square. Its force is off by the angle itself: a segment that
//! is pressed on a ball by `N` turns about its foot against a torque `N r` a radian, which may be more than what the segment itself is held by. With rows
//! of the pass before, turns then grow from pass to pass, and what lies still trembles in steps whose gaps hold to rounding.

use crate::constraint::contact::Kinematics;
use crate::kkt::island::Island;
use crate::kkt::tolerances::CLOSE_ENOUGH;
use crate::math::rounding;
use crate::system::Point;

/// Whether rows have settled in a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Settling {
    /// How far the rows turn by the forces of the last step, which is by the motion of this one: infinite where these mislead, as much has changed then.
    by_motion: f64,
}

impl Settling {
    /// Looks at the rows where the forces of the last step lead, unless they mislead.
    pub fn of_guess(island: &Island, misleads: bool) -> Self {
        Self {
            by_motion: if misleads {
                f64::INFINITY
            } else {
                largest_turn(island)
            },
        }
    }

    /// Whether the rows at hand are those that forces acted along, but for a small share of what they turn by in the step, or so that forces are right to
    /// six digits, as they are of what rests.
    pub fn has_settled(&self, island: &Island) -> bool {
        largest_turn(island) <= (CLOSE_ENOUGH * self.by_motion).max(rounding::SINGLE)
    }
}

/// By how much the rows of flexible bodies that carry forces have turned at most since these were found (-).
fn largest_turn(island: &Island) -> f64 {
    let contacts = island.contacts.iter();
    let led = contacts.filter(|one| one.base.is_some() && !one.is_hard && one.is_closed());
    let turns = led.map(|contact| turn_between(&contact.applied, &contact.kinematics));
    turns.fold(0.0, f64::max)
}

/// How far the normals of two rows differ, and the weights of their points (-).
fn turn_between(one: &Kinematics, other: &Kinematics) -> f64 {
    let both = one.attachments().iter().zip(other.attachments());
    let is_same = one.attachments().len() == other.attachments().len()
        && both.clone().all(|(a, b)| {
            let places = (a.grip.point, b.grip.point);
            a.block == b.block
                && (places.0 == places.1 || matches!(places, (Point::Arm(_), Point::Arm(_))))
        });
    if !is_same {
        return 1.0;
    }
    let shifts = both.map(|(a, b)| (a.weight - b.weight).abs());
    (one.normal - other.normal).norm() + shifts.sum::<f64>()
}
