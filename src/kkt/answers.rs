//! What joints of rigid bodies answer to contacts of rigid bodies: velocities feel neither.
//!
//! The multipliers of these contacts move positions only; in velocities the impact law takes their place (`kkt/velocity.rs`). RATTLE's
//! multiplier `λ` of a joint holds against them all the same, and would be felt: the velocity stage had to take it back along the rows of the step's
//! end, which have turned by `ω dt` since, and a body would keep `r λ ω dt²` of it. Where friction jams what is hinged, as a box that tips on the one
//! that it is hinged to, `λ` is of any size. So the part that answers,
//!
//! ```text
//! W λᵃ + N p = 0
//! ```
//!
//! with `W` the mobility of the joints' rows and `N p` what the contacts move them by, is left out of the velocities, and of the torques by which
//! blocks resist turning in the same proportion. What is left is what holds the bodies in their motion without contact; joints answer to
//! impacts where these are found.

use super::active_contact::ActiveContact;
use super::closing::{parted, solve_closings};
use super::gathered;
use super::island::{Island, KktError, SolveSettings};
use super::joints::ActiveJoint;
use crate::linalg::complementarity::RowKind;

/// Finds the part of every multiplier of joints that answers to contacts of rigid bodies.
///
/// # Errors
/// If a number is not finite.
pub(super) fn find_answers(island: &mut Island, settings: &SolveSettings) -> Result<(), KktError> {
    let has_answers = island.joints.ties.iter().any(ActiveJoint::answers);
    if settings.is_explicit || !has_answers || !island.contacts.iter().any(acts) {
        return Ok(());
    }
    answer(island, settings, false)?;
    if island.joints.leave_felt_torques() {
        answer(island, settings, true)?;
    }
    gathered::clear_wrenches(island);
    Ok(())
}

/// Whether a contact moves positions of rigid bodies that do not part.
fn acts(contact: &ActiveContact) -> bool {
    contact.is_hard && !contact.is_parting() && contact.is_closed()
}

/// Finds what the joints answer to the contacts, and to the torques that are not felt if these are known.
fn answer(
    island: &mut Island,
    settings: &SolveSettings,
    knows_torques: bool,
) -> Result<(), KktError> {
    gathered::clear_wrenches(island);
    for contact in island.contacts.iter().filter(|contact| acts(contact)) {
        let wrenches = Some(&mut island.wrenches[..]);
        let (rows, forces) = (&contact.applied, contact.multiplier);
        gathered::spread(&mut island.blocks, rows, forces, wrenches, |_, _, _, _| {});
    }
    if knows_torques {
        let torques = island.joints.unfelt_torques();
        for (wrench, torque) in island.wrenches.iter_mut().zip(torques) {
            wrench[2] += torque;
        }
    }
    island.problem.clear_rows();
    island.problem.acted.clear();
    let (blocks, wrenches) = (&island.blocks[..], &island.wrenches[..]);
    island.joints.list(&mut island.problem, |joints, tie| {
        let law = || {
            let moved = parted((blocks, wrenches), &joints.grips, tie);
            (moved, RowKind::Bilateral, 0.0)
        };
        tie.answers().then(law)
    });
    solve_closings(island, settings)?;
    let found = island.problem.of_joints();
    for (&index, answer) in island.joints.listed.iter().zip(found) {
        island.joints.ties[index].answer = *answer;
    }
    Ok(())
}
