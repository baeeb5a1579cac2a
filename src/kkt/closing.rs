//! Joints whose ends were put apart: they close over several steps, and what closes them leaves no velocity.
//!
//! A position stage that moves a row by `c` because its ends do not meet yet does so with a multiplier `W⁻¹ c / b0` beyond what
//! the law of motion asks for. That part acts on positions only, as the pseudo-velocities do with which rigid-body engines correct theirs: ends that are
//! `d` apart would fly at each other with `d/dt` otherwise, and a chain of such joints at its far end with the sum of all. What joints answer to
//! contacts that part bodies is taken out in the same way: these are not felt by velocities either. The next step begins without both.

use super::active_contact::ActiveContact;
use super::island::{Island, KktError, SolveSettings};
use super::joints::{ActiveJoint, add_wrench};
use super::joints::{Among, Rows};
use super::sparse::Asked;
use super::summary::IslandSummary;
use super::{cones, gathered, impulses};
use crate::constraint::joint::{JointGrip, unit_wrench};
use crate::linalg::complementarity::RowKind;
use crate::system::{Block, Point, Response};

/// Takes what closes joints out of velocities and accelerations.
///
/// # Errors
/// If a number is not finite.
pub(super) fn take_out_closings(
    island: &mut Island,
    settings: &SolveSettings,
) -> Result<(), KktError> {
    if settings.is_explicit || !(closes(island) || parts_joined(island)) {
        return Ok(());
    }
    gather_partings(island);
    island.problem.clear_rows();
    island.problem.acted.clear();
    let (blocks, wrenches) = (&island.blocks[..], &island.wrenches[..]);
    island.joints.list(&mut island.problem, |joints, tie| {
        let law = || {
            let achieved = if tie.closing == 0.0 {
                0.0
            } else {
                tie.closing + tie.gap
            };
            let parted = parted((blocks, wrenches), &joints.grips, tie);
            (parted - achieved / settings.b0, RowKind::Bilateral, 0.0)
        };
        tie.holds().then(law)
    });
    solve_closings(island, settings)?;
    let found = island.problem.of_joints();
    for (&index, closer) in island.joints.listed.iter().zip(found) {
        island.joints.ties[index].closer = *closer;
    }
    gathered::clear_impulses(island);
    gathered::clear_wrenches(island);
    for at in 0..island.joints.ties.len() {
        let tie = island.joints.ties[at];
        if !tie.is_hard && tie.closer != 0.0 {
            gather_closer(island, &tie, settings.b1);
        }
    }
    gathered::add_to_rigid(island, Response::Velocity, settings.b1);
    gathered::respond(island);
    gathered::add_to_flexible(island, Response::Velocity, 1.0);
    if !settings.is_within {
        gathered::add_to_rigid(island, Response::Acceleration, 1.0);
        gathered::add_to_flexible(island, Response::Acceleration, 1.0);
    }
    gathered::clear_impulses(island);
    Ok(())
}

/// Whether bodies that joints hold too are parted by contacts: these multipliers are no forces, nor is what joints answer to them.
fn parts_joined(island: &Island) -> bool {
    let parts = |contact: &ActiveContact| contact.is_parting() && contact.is_closed();
    !island.joints.ties.is_empty() && island.contacts.iter().any(parts)
}

/// Gathers the wrenches of the contacts that part rigid bodies.
fn gather_partings(island: &mut Island) {
    gathered::clear_wrenches(island);
    for contact in island
        .contacts
        .iter()
        .filter(|contact| contact.is_parting())
    {
        let wrenches = Some(&mut island.wrenches[..]);
        let (rows, forces) = (&contact.kinematics, contact.multiplier);
        gathered::spread(&mut island.blocks, rows, forces, wrenches, |_, _, _, _| {});
    }
}

/// How contacts whose wrenches are gathered move a joint row, over `b0` (N/kg, or N m/(kg m²) of what keeps an angle).
pub(super) fn parted(
    (blocks, wrenches): (&[Block], &[[f64; 3]]),
    grips: &[JointGrip],
    tie: &ActiveJoint,
) -> f64 {
    let is_turn = tie.row.measure.is_turn();
    let grips = grips[tie.row.grips.0..tie.row.grips.1].iter();
    let moved = grips.map(|grip| match &blocks[grip.block] {
        Block::Rigid(block) => {
            let wrench = unit_wrench(grip, tie.direction, is_turn);
            block.mobility_between(wrench, wrenches[grip.block])
        }
        Block::Flex(_) => 0.0,
    });
    moved.sum()
}

/// Whether ends that were put apart come nearer in this step.
pub(super) fn closes(island: &Island) -> bool {
    island.joints.ties.iter().any(|tie| tie.closing != 0.0)
}

/// Elastic energy that closing has stored, no more than its forces have done on their way: who has put ends apart has brought it (J).
pub(super) fn stretched_by_closing(island: &Island, summary: &IslandSummary) -> f64 {
    let works = island.joints.ties.iter().map(|tie| {
        let force = tie.multiplier.abs().max(tie.row.last_multiplier().abs());
        force * tie.closes_by()
    });
    let stored = summary.end_energy[1] - summary.start_energy[1];
    stored.min(works.sum()).max(0.0)
}

/// Solves the joint rows that are listed.
pub(super) fn solve_closings(
    island: &mut Island,
    settings: &SolveSettings,
) -> Result<(), KktError> {
    let n = island.problem.kinds.len();
    island.problem.acted.resize(n, 0.0);
    if cones::is_sparse(island, n) {
        island.problem.multipliers.clear();
        island.problem.multipliers.resize(n, 0.0);
        let asked = Asked {
            of: Response::Velocity,
            which: Rows::Kept,
            unit: settings.dt,
            give: 0.0,
        };
        cones::solve_sparse(island, asked)?;
        return Ok(());
    }
    island.problem.delassus.clear();
    let among = Among {
        blocks: &island.blocks,
        contacts: &island.contacts,
    };
    island
        .joints
        .expand(&mut island.problem, among, (Response::Velocity, Rows::Kept));
    impulses::solve_rows(island)
}

/// Takes the force that closes a row back.
fn gather_closer(island: &mut Island, tie: &ActiveJoint, b1: f64) {
    let is_turn = tie.row.measure.is_turn();
    for grip in &island.joints.grips[tie.row.grips.0..tie.row.grips.1] {
        match (&mut island.blocks[grip.block], grip.point) {
            (Block::Flex(block), Point::Node(node)) => {
                let force = -tie.closer * grip.weight * tie.direction;
                block.gather_impulse(Response::Velocity, node, b1 * force, grip.lever);
                block.gather_impulse(Response::Acceleration, node, force, grip.lever);
            }
            _ => add_wrench(
                &mut island.wrenches[grip.block],
                -tie.closer,
                unit_wrench(grip, tie.direction, is_turn),
            ),
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::constraint::contact::{Kinematics, Remembered};
    use crate::kkt::answers::find_answers;
    use crate::kkt::calm::tests::join;
    use crate::kkt::together::tests::rigid;
    use crate::linalg::complementarity::Method;
    use crate::math::Vec2;
    use crate::path::samples::Random;
    use crate::system::Point;

    pub(in crate::kkt) const SETTINGS: SolveSettings = SolveSettings {
        dt: 1e-2,
        whole: 1e-2,
        b0: 5e-5,
        b1: 1e-2,
        is_within: false,
        is_explicit: false,
        insists: false,
        impact: crate::kkt::ImpactTreatment::Stabilized,
        contact: crate::kkt::ContactMethod::Lagrange,
        solver: Method::ActiveSet,
        restitution_threshold: 0.0,
        max_newton: 10,
        may_be_cut: false,
        length_unit: 1.0,
    };

    /// A joint holds two bodies along `x`, and a contact pushes them apart along a line by `force`: all the joint's force answers to that.
    #[test]
    fn what_answers_to_contacts_that_part_is_no_force() {
        for (slant, asked) in [(0.0, -0.01), (0.5, -0.01), (0.5, 0.0)] {
            let mut random = Random::new(3);
            let mut island = Island::default();
            for x in [0.0, 1.0] {
                island.blocks.push(rigid(&mut random, Vec2::new(x, 0.0)).0);
            }
            join(&mut island, [0, 1]);
            island.joints.ties[0].is_hard = true;
            island.joints.list_holders(&island.blocks);
            let (force, normal) = (7.0, Vec2::new(1.0, slant).normalize());
            let grips = [(0, 1.0), (1, -1.0)]
                .map(|(block, weight)| (block, Point::Arm(Vec2::zeros()), weight, Vec2::zeros()));
            let row = Kinematics::with_levers(0.0, normal, Vec2::zeros(), &grips);
            let mut contact =
                ActiveContact::new(0, row, Remembered::default(), 0.0, &island.blocks);
            (contact.asked, contact.multiplier) = (asked, [force, 0.0]);
            island.contacts.push(contact);
            assert!(take_out_closings(&mut island, &SETTINGS).is_ok());
            let expected = if asked < 0.0 { -force * normal.x } else { 0.0 };
            let found = island.joints.ties[0].closer;
            assert!((found - expected).abs() < 1e-12, "{slant}: {found}");
            // What does not part is answered too, and not felt.
            assert!(find_answers(&mut island, &SETTINGS).is_ok());
            let tie = island.joints.ties[0];
            let answer = -force * normal.x - expected;
            assert!(
                (tie.answer - answer).abs() < 1e-12,
                "{slant}: {}",
                tie.answer
            );
            let felt = tie.multiplier + force * normal.x;
            assert!((tie.felt() - felt).abs() < 1e-12, "{slant}: {}", tie.felt());
        }
    }
}
