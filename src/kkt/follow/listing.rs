//! The contacts of a pass: the near pairs of the base, with what they were in the pass before.

use super::Island;
use crate::constraint::contact::{
    Candidate, ContactKey, ContactLaw, ContactMemory, Kinematics, Pair, Remembered,
};
use crate::kkt::island::{ActiveContact, AtBase};
use crate::linalg::complementarity::Status;
use crate::path::NearPair;

/// How the near pairs of a base are listed.
#[derive(Clone, Copy)]
pub(super) struct Listing<'a> {
    /// Multipliers of the last step, for the first list of a step.
    pub memory: Option<&'a ContactMemory>,
    /// Passes of the step so far.
    pub pass: usize,
    /// Whether rows that are at work stay as they are.
    pub keeps_rows: bool,
    /// Whether no forces have been found since the last list.
    pub is_again: bool,
    /// Overlap beyond which a contact parts by and by (m), and the share of it that stays for this step.
    pub slop: f64,
    /// The same where bodies that deform were put into each other: pressed out at once, the rest would store energy in them (m).
    pub rest: f64,
    pub kept: f64,
}

/// A row of the base.
struct Listed {
    near: NearPair,
    key: ContactKey,
    law: ContactLaw,
    kinematics: Kinematics,
    base: AtBase,
}

/// Lists the near pairs of the base as contacts, and keeps the signed ones. A contact that is near no more stays for one solve, which
/// takes its force out.
pub(super) fn list_near(island: &mut Island, listing: &Listing<'_>) {
    if island.path.is_empty() {
        return;
    }
    part_meetings(island);
    island.path.list_near();
    std::mem::swap(&mut island.contacts, &mut island.passes.contacts_before);
    island.contacts.clear();
    island.passes.fresh.clear();
    island.passes.handed_over.clear();
    island.passes.slot_of.clear();
    island
        .passes
        .slot_of
        .resize(island.candidates.len(), u32::MAX);
    for (slot, contact) in island.passes.contacts_before.iter().enumerate() {
        island.passes.slot_of[contact.candidate] = slot as u32;
        if contact.base.is_none() {
            island.contacts.push(*contact);
        }
    }
    for near in 0..island.path.near().len() {
        let near = island.path.near()[near];
        if island.path.is_at_meeting(&near) {
            continue;
        }
        let kinematics = island.path.kinematics(&near);
        let law = island.path.law(&near);
        let listed = Listed {
            near,
            key: island.path.key(&near),
            law,
            kinematics,
            base: AtBase {
                gap: kinematics.gap,
                carried: law.carried,
                moved: island.path.moved(&kinematics, &island.blocks),
                near,
                is_meeting: false,
            },
        };
        list(island, &listed, listing);
    }
    for index in 0..island.path.n_meetings() {
        if let Some((near, kinematics, moved, law, key)) = island.path.held(index) {
            let base = AtBase {
                gap: kinematics.gap,
                carried: law.carried,
                moved,
                near,
                is_meeting: true,
            };
            let listed = Listed {
                near,
                key,
                law,
                kinematics,
                base,
            };
            list(island, &listed, listing);
        }
    }
    let before = std::mem::take(&mut island.passes.contacts_before);
    for contact in &before {
        let is_left = island.passes.slot_of[contact.candidate] != u32::MAX;
        if let Some(base) = contact.base
            && is_left
            && contact.multiplier != [0.0; 2]
        {
            follow_contact(island, contact, &base, listing);
        }
    }
    island.passes.contacts_before = before;
}

/// Hands what is near no more over to the pair that it has slid to, if there is one; else it stays for one solve.
fn follow_contact(
    island: &mut Island,
    contact: &ActiveContact,
    base: &AtBase,
    listing: &Listing<'_>,
) {
    let applied = if listing.is_again {
        contact.applied
    } else {
        contact.kinematics
    };
    let mut successors = std::mem::take(&mut island.passes.successors);
    successors.clear();
    if !base.is_meeting {
        list_successors(island, contact, base, &mut successors);
    }
    match successors
        .iter()
        .reduce(|a, b| if b.1 > a.1 { b } else { a })
    {
        Some(&(next, _)) => {
            let met = island.contacts[next];
            hand_over(island, (contact, applied), (next, base), &successors);
            if !listing.is_again {
                note_slide(island, contact, base, Some(&met), listing);
            }
        }
        None => {
            lose_contact(island, contact, applied);
            // Corners of rigid bodies lose forces for good.
            let may_meet =
                !contact.is_hard && !listing.is_again && !base.is_meeting && !contact.is_lost;
            if may_meet && !island.path.is_at_meeting(&base.near) {
                note_slide(island, contact, base, None, listing);
            }
        }
    }
    island.passes.successors = successors;
}

/// Hands the force of a contact, which acts along `applied`, over to the `next` one; all `successors` slide on from where it has stuck.
fn hand_over(
    island: &mut Island,
    (contact, applied): (&ActiveContact, Kinematics),
    (next, base): (usize, &AtBase),
    successors: &[(usize, f64)],
) {
    let met = island.contacts[next];
    if island.passes.handed_over.contains(&next) {
        // It has one force already, and takes one only; it slides on from between both.
        let forces = [met, *contact].map(|one| one.multiplier[0].max(0.0));
        let share = forces[1] / (forces[0] + forces[1]).max(f64::MIN_POSITIVE);
        let other = slip_before(island, contact, &met);
        island.contacts[next].slip_before += share * (other - met.slip_before);
        lose_contact(island, contact, applied);
        return;
    }
    for &(slot, _) in successors {
        if island.passes.handed_over.contains(&slot) {
            continue;
        }
        let slip_before = slip_before(island, contact, &island.contacts[slot]);
        island.contacts[slot].slip_before = slip_before;
    }
    let is_swapped = met
        .base
        .is_some_and(|now| now.near.point != base.near.point);
    let applied = if is_swapped {
        applied.swapped()
    } else {
        applied
    };
    island.passes.handed_over.push(next);
    island.contacts[next] = ActiveContact {
        candidate: met.candidate,
        kinematics: met.kinematics,
        base: met.base,
        applied,
        slip_before: island.contacts[next].slip_before,
        is_lost: false,
        ..*contact
    };
}

/// Keeps a contact that is near no more for one solve, which takes its force out.
fn lose_contact(island: &mut Island, contact: &ActiveContact, applied: Kinematics) {
    island.contacts.push(ActiveContact {
        applied,
        is_lost: true,
        ..*contact
    });
}

/// Notes that the force of a contact has slid to another one, or off a corner.
fn note_slide(
    island: &mut Island,
    contact: &ActiveContact,
    base: &AtBase,
    next: Option<&ActiveContact>,
    listing: &Listing<'_>,
) {
    let rows = [&contact.kinematics, &next.unwrap_or(contact).kinematics];
    let to = next.and_then(|next| next.base);
    if to.is_some() == next.is_some() {
        let to = to.as_ref().map(|to| &to.near);
        island
            .path
            .note_slide(&base.near, to, rows, contact.multiplier, listing.pass);
    }
}

/// What makes the slip at the base go on from that of a contact whose force the next one takes over.
///
/// Rows of one corner touch at places as far apart as the offset: where the bodies turn, each has slid another way since the step began,
/// and what sticks on the one would be dragged along by the other, to and fro.
fn slip_before(island: &Island, contact: &ActiveContact, next: &ActiveContact) -> f64 {
    let slid = |row: &Kinematics| row.tangent().dot(&island.path.moved(row, &island.blocks));
    contact.slip_before + slid(&contact.kinematics) - slid(&next.kinematics)
}

/// Lists the contacts, new in this list or without a force, of the vertices where another one has slid off, on its side, and how far their normals
/// point its way.
fn list_successors(
    island: &Island,
    contact: &ActiveContact,
    base: &AtBase,
    successors: &mut Vec<(usize, f64)>,
) {
    let Some(vertices) = island.path.slid_over(&base.near) else {
        return;
    };
    let normal = contact.kinematics.normal;
    let side = |near: &NearPair| {
        if near.point == base.near.point {
            1.0
        } else {
            -1.0
        }
    };
    let along = |slot: usize| {
        let next = &island.contacts[slot];
        let near = &next.base.as_ref()?.near;
        (near.pair == base.near.pair && island.path.is_at(near, vertices))
            .then(|| (slot, side(near) * next.kinematics.normal.dot(&normal)))
    };
    let is_free = |&slot: &usize| {
        let next = &island.contacts[slot];
        !next.is_lost && (next.multiplier == [0.0; 2] || island.passes.fresh.contains(&slot))
    };
    let found = (0..island.contacts.len()).filter(is_free).filter_map(along);
    successors.extend(found.filter(|&(_, along)| along > 0.0));
}

/// Adds a row of the base to the contacts, with what it was before.
fn list(island: &mut Island, listed: &Listed, listing: &Listing<'_>) {
    let &Listed {
        near,
        key,
        law,
        kinematics,
        base,
    } = listed;
    let candidates = &mut island.candidates;
    let candidate = *island.near_candidates.entry(key).or_insert_with(|| {
        let pair = Pair::Near {
            blocks: island.path.blocks_of(&near),
        };
        candidates.push(Candidate { key, pair, law });
        candidates.len() - 1
    });
    candidates[candidate].law = law;
    let known = island.passes.slot_of.get_mut(candidate);
    let slot = known.map_or(u32::MAX, |slot| std::mem::replace(slot, u32::MAX));
    let mut contact = match island.passes.contacts_before.get(slot as usize) {
        Some(&before) => ActiveContact {
            applied: if listing.is_again {
                before.applied
            } else {
                before.kinematics
            },
            kinematics: if listing.keeps_rows && !base.is_meeting {
                before.kinematics
            } else {
                kinematics
            },
            ..before
        },
        // What is at work stays at work until the step ends.
        None if island.joints.holds_fast(&island.blocks, &kinematics) => return,
        None => {
            let remembered = listing
                .memory
                .map_or(Remembered::default(), |memory| memory.recall(&key));
            let friction = law.friction;
            let mut contact =
                ActiveContact::new(candidate, kinematics, remembered, friction, &island.blocks);
            if let Some(memory) = listing.memory {
                let was_put = !contact.is_hard && memory.finds_overlap(&key);
                let slop = if was_put { listing.rest } else { listing.slop };
                if base.gap < -slop {
                    contact.allowance = listing.kept * base.gap;
                }
            } else {
                contact.allowance = late_allowance(island, &contact, &base, listing);
            }
            contact.asked = contact.allowance;
            island.passes.fresh.push(island.contacts.len());
            contact
        }
    };
    contact.base = Some(base);
    contact.is_lost = false;
    island.contacts.push(contact);
}

/// What a row that comes near within the step leaves of an overlap that rapier has handed over (m), zero or less: as much as the rest of
/// both bodies, which part by and by, and no more than there was along the row.
fn late_allowance(
    island: &Island,
    new: &ActiveContact,
    base: &AtBase,
    listing: &Listing<'_>,
) -> f64 {
    let began = base.gap - new.kinematics.normal.dot(&base.moved);
    let slop = if new.is_hard { listing.slop } else { 0.0 };
    if began >= -slop {
        return 0.0;
    }
    let is_of_both = |contact: &&ActiveContact| {
        contact
            .base
            .is_some_and(|other| other.near.pair == base.near.pair)
    };
    let others = island.passes.contacts_before.iter().filter(is_of_both);
    let left = others.fold(0.0, |least, contact| f64::min(least, contact.allowance));
    left.max(listing.kept * began)
}

/// Lets vertices go that need not be held together.
fn part_meetings(island: &mut Island) {
    for contact in &island.contacts {
        if let Some(base) = contact.base
            && base.is_meeting
            && !contact.is_lost
            && contact.status[1] != Status::Stick
        {
            island.path.let_go(&base.near);
        }
    }
}

#[cfg(test)]
mod tests;
