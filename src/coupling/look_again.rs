//! Looking again: members that have left the boxes they were looked for in, because something has thrown them or let them go.
//!
//! What they meet there was not in the problem that was solved. If there is anything ([`super::unlisted`]), the boxes grow by what was left
//! of them, and the step is solved again.

use super::claim::Claims;
use super::ends::Ends;
use super::places::travel_of;
use super::sets::RapierSets;
use super::unlisted::Listed;
use crate::body::FlexBodySet;
use crate::math::judged::Judged;
use crate::rapier::math::Real;

/// By how much more the boxes grow than they were left by: with more members the motion is another one.
const MORE: Judged = Judged::new("coupling::MORE", 1.5);

/// How far beyond their boxes members are thrown where a step has to be cut, relative to the farthest way that one of them was to go in it.
const THROWN: Judged = Judged::new("coupling::THROWN", 0.25);

impl Claims {
    /// By how much members have left the boxes they were looked for in (m).
    pub fn excess(&self) -> f64 {
        f64::from(self.excess)
    }

    /// By how much members are likely to leave the boxes that they are looked for in where a step has to be cut; zero if they have grown
    /// already (m).
    pub fn likely_excess(&self, sets: &RapierSets<'_>) -> Real {
        if self.excess > 0.0 {
            return 0.0;
        }
        let dt = sets.integration_parameters.dt;
        let rigid = self.walk.members.rigid().iter();
        let rigid = rigid.filter_map(|&handle| Some(travel_of(sets.bodies.get(handle)?, dt)));
        let flexible = self.flex.iter().map(|own| own.travel);
        THROWN * rigid.chain(flexible).fold(0.0, Real::max)
    }

    /// By how much members have left the boxes that they were looked for in; zero if none has (m).
    pub fn left_by(&self, ends: &Ends<'_>, sets: &RapierSets<'_>) -> Real {
        ends.left_by(&self.flex, self.excess, sets)
    }

    /// Whether a member that has left its box meets something on the way that was not in the problem.
    pub fn meets_more(&mut self, ends: &Ends<'_>, sets: &RapierSets<'_>) -> bool {
        let listed = Listed {
            flex: &self.flex,
            changes: &self.changes,
            attached: &self.attached,
            pairs: &self.walk.pairs,
            excess: self.excess,
        };
        listed.lacks_what_is_met(ends, sets, (&mut self.walk.answers, &mut self.strikes))
    }

    /// Grows the boxes, of which members have left `excess` (m), and wakes what sleeps in them.
    pub fn widen(&mut self, excess: Real, sets: &mut RapierSets<'_>, flex_bodies: &FlexBodySet) {
        let grown = self.excess + MORE * excess;
        self.grow(MORE * excess);
        while self.wake_met(sets) {
            self.look_ahead(sets, flex_bodies);
            self.grow(grown);
        }
    }

    fn grow(&mut self, by: Real) {
        self.excess += by;
        self.flex.grow(by);
    }
}
