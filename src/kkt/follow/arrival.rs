//! Places that the whole of a step has reached, under forces that are not quite those of the laws.
//!
//! Where no forces hold to the laws, the best of these places ends the step: first one where gaps and slips miss them by less than the
//! margins of the ways, then one where a contact has slid off the surface that it pressed on, as if that went on. An implicit step has
//! no other end there: with the force the contact is over before the step is, and without it the bodies end in one another, however
//! short the step.

use super::{Island, Passed};
use crate::kkt::passes::Waypoint;
use crate::kkt::{follow, working_set};

/// How far the laws are from holding, relative to the margins of the ways (-), a number if all of them are; what has slid off counts only with
/// `counts_lost`.
pub(super) fn shortfall(island: &mut Island, counts_lost: bool) -> f64 {
    let least = island.passes.margin;
    let presses_joined = island.presses_joined();
    let of_joints = match presses_joined {
        true => least.min(island.passes.slack),
        false => least,
    };
    let mut worst = island.joints.measure(&island.blocks) / of_joints;
    let counted = |is_lost: bool| counts_lost || !is_lost;
    for contact in island.contacts.iter().filter(|one| counted(one.is_lost)) {
        let friction = island.candidates[contact.candidate].law.friction;
        let margin = contact
            .base
            .map_or(least, |base| island.path.margin(&base.near));
        // What is lost misses as much as there are numbers for, over a margin more: infinite is what nobody has measured.
        let missed = contact.shortfall(friction);
        let share = if missed == f64::MAX {
            missed
        } else {
            missed / margin
        };
        worst = worst.max(share);
    }
    worst
}

/// Keeps the base, which the whole of the step has reached, if it is the best of its kind so far.
pub(super) fn keep_arrival(island: &mut Island) {
    let has_left = follow::note_left(island);
    if follow::leads_around(island) {
        return;
    }
    let error = shortfall(island, false);
    let kept = if has_left {
        &mut island.passes.departure
    } else {
        &mut island.passes.arrival
    };
    if error >= 1.0 || kept.is_known && error >= kept.error {
        return;
    }
    let mut place = std::mem::take(kept);
    keep(island, &mut place, error);
    if has_left {
        island.passes.departure = place;
    } else {
        island.passes.arrival = place;
    }
}

/// Ends the step at the best place that the whole of it has reached, if there is one.
pub(super) fn end_at_arrival(island: &mut Island) -> Option<Passed> {
    let is_arrival = island.passes.arrival.is_known;
    if !is_arrival && !island.passes.departure.is_known {
        return None;
    }
    let kept = if is_arrival {
        &mut island.passes.arrival
    } else {
        &mut island.passes.departure
    };
    let place = std::mem::take(kept);
    return_to(island, &place);
    follow::keep_applied_rows(island);
    if is_arrival {
        island.passes.arrival = place;
    } else {
        island.passes.departure = place;
    }
    working_set::correct(island);
    Some(Passed::Arrived)
}

/// Keeps the base of the first impact of a step, and the forces that answer it.
pub(super) fn keep_impact(island: &mut Island) {
    let mut place = std::mem::take(&mut island.passes.impact);
    keep(island, &mut place, 0.0);
    island.passes.impact = place;
}

/// Goes back to the first impact; returns whether there was one.
pub(in crate::kkt) fn return_to_first_stop(island: &mut Island) -> bool {
    if !island.passes.impact.is_known {
        return false;
    }
    let place = std::mem::take(&mut island.passes.impact);
    return_to(island, &place);
    island.passes.impact = place;
    true
}

fn keep(island: &Island, place: &mut Waypoint, error: f64) {
    place.is_known = true;
    place.error = error;
    place.contacts.clone_from(&island.contacts);
    place.ties.clone_from(&island.joints.ties);
    place.grips.clone_from(&island.joints.grips);
    island.path.keep_base(&mut place.base);
}

/// Puts the forces and the blocks back. Forces alone do not tell where a body is that turns under them: what is found from them begins
/// there.
fn return_to(island: &mut Island, place: &Waypoint) {
    island.contacts.clone_from(&place.contacts);
    island.joints.ties.clone_from(&place.ties);
    island.joints.grips.clone_from(&place.grips);
    island.path.return_to(&place.base);
    island.path.stop(&mut island.blocks);
}

#[cfg(test)]
mod tests {
    use super::super::FEW_PASSES;
    use super::super::trend::Trend;
    use super::*;
    use crate::constraint::contact::{
        Candidate, ContactKey, ContactLaw, Kinematics, Owner, Pair, Remembered,
    };
    use crate::kkt::active_contact::ActiveContact;
    use crate::math::Vec2;

    /// A contact that is lost in every pass misses its law by a number, whatever the margin is, and the passes are given up.
    #[test]
    fn passes_that_what_is_lost_holds_up_are_given_up() {
        for margin in [1e-3, 10.0] {
            let mut island = Island::default();
            island.passes.margin = margin;
            island.candidates.push(Candidate {
                key: ContactKey {
                    contactor: Owner::Flex(0),
                    point: 0,
                    target: Owner::Collider(0),
                    part: 0,
                },
                pair: Pair::Near { blocks: [0, 1] },
                law: ContactLaw::default(),
            });
            let row = Kinematics::with_levers(0.0, Vec2::new(0.0, 1.0), Vec2::zeros(), &[]);
            let mut contact = ActiveContact::new(0, row, Remembered::default(), 0.0, &[]);
            contact.is_lost = true;
            island.contacts.push(contact);
            assert_eq!(shortfall(&mut island, false), 0.0);
            let mut trend = Trend::new();
            let given_up =
                (0..20).find(|pass| trend.is_hopeless(shortfall(&mut island, true), 19 - pass));
            assert_eq!(given_up, Some(FEW_PASSES), "margin {margin} m");
        }
    }
}
