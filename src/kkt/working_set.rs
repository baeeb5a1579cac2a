//! The working set of an island: where blocks are under the multipliers at hand, and how far the laws are from holding there.

mod measure;

use super::gathered;
use super::island::scene;
use super::island::{ActiveContact, Island, SolveSettings};
use super::tolerances::{OVERLAPPED, PARTING_RATE};
use crate::constraint::contact::{ContactMemory, Kinematics};
use crate::math::{Vec2, exp, rounding};
use crate::system::Block;

/// Round-off of gaps, relative to the extent of the scene.
pub(super) const ROUND_OFF: f64 = 2.0 * rounding::SUM;

/// Times that a contact without a gap is let go within a step.
const LET_GO: u8 = 2;

/// How far frames have turned since the iterate before.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Turned {
    /// Of the one that has turned farthest (rad).
    pub angle: f64,
    /// By how much that changes the places that were found, at most (m).
    pub way: f64,
}

/// Puts the bodies and the working set back to where the step begins.
pub(super) fn start_again(
    island: &mut Island,
    settings: &SolveSettings,
    tolerance: f64,
    memory: &ContactMemory,
) {
    for block in &mut island.blocks {
        if let Block::Flex(block) = block {
            block.restart();
        }
    }
    open_working_set(island, settings, tolerance, memory);
}

/// Empties the working set but for what pressed in the last step.
pub(super) fn open_working_set(
    island: &mut Island,
    settings: &SolveSettings,
    tolerance: f64,
    memory: &ContactMemory,
) {
    let kept = exp(-PARTING_RATE * settings.dt);
    island.contacts.clear();
    island.is_working.clear();
    island.is_working.resize(island.candidates.len(), false);
    island.joints.open(&mut island.blocks, settings);
    remember_contacts(island, OVERLAPPED * tolerance, kept, memory);
}

/// Round-off of a gap: positions of this size, and their predictions, are no better known.
pub(super) fn gap_tolerance(island: &Island, settings: &SolveSettings) -> f64 {
    ROUND_OFF * extent(island, settings)
}

/// How far positions are from the origin, and a unit of length (m): what rounding is a share of.
pub(super) fn extent(island: &Island, settings: &SolveSettings) -> f64 {
    let size = island
        .blocks
        .iter()
        .fold(0.0f64, |size, block| match block {
            Block::Flex(block) => size.max(block.extent()),
            Block::Rigid(block) => size.max(block.start().centre.amax()),
        });
    settings.length_unit + size
}

/// Opens the working set with what pressed in the last step.
fn remember_contacts(island: &mut Island, slop: f64, kept: f64, memory: &ContactMemory) {
    island.pressed_before.clear();
    let scene = scene(&island.blocks, &island.parts, &island.segments);
    for (index, candidate) in island.candidates.iter().enumerate() {
        // By another point too: what they stored of their forces still acts.
        if memory.has_pressed(candidate.key.owners()) {
            island.pressed_before.push(candidate.pair.blocks());
        }
        let remembered = memory.recall(&candidate.key);
        if remembered.normal <= 0.0 {
            continue;
        }
        if let Some(kinematics) = candidate.evaluate(&scene, &remembered) {
            let friction = candidate.law.friction;
            let blocks = &island.blocks;
            let mut contact = ActiveContact::new(index, kinematics, remembered, friction, blocks);
            contact.allow_overlap(kept, slop, candidate, &scene);
            if island.joints.holds_fast(&island.blocks, &kinematics) {
                continue;
            }
            island.is_working[index] = true;
            island.contacts.push(contact);
        }
    }
}

/// Moves all blocks by the multipliers; returns how far the frames have turned.
pub(super) fn correct(island: &mut Island) -> Turned {
    gathered::clear_wrenches(island);
    for block in &mut island.blocks {
        if let Block::Flex(block) = block {
            block.clear_contact_force();
        }
    }
    for contact in &island.contacts {
        let is_late = contact.kinematics.is_quasi_static();
        let wrenches = (!is_late).then_some(&mut island.wrenches[..]);
        gathered::spread(
            &mut island.blocks,
            &contact.kinematics,
            contact.multiplier,
            wrenches,
            |block, node, force, lever| block.add_stage_force(node, force, lever, is_late),
        );
    }
    island
        .joints
        .spread(&mut island.blocks, &mut island.wrenches);
    let mut turned = Turned::default();
    for (block, wrench) in island.blocks.iter_mut().zip(&island.wrenches) {
        match block {
            Block::Flex(block) => {
                let angle = block.solve();
                turned.angle = turned.angle.max(angle);
                let way = angle * block.turning_share() * block.size();
                turned.way = turned.way.max(way);
            }
            Block::Rigid(block) => block.set_position_increment(*wrench),
        }
    }
    turned
}

/// Measures the working set where the blocks are now; returns how far the laws are from holding (m): overlaps, gaps
/// of pressing contacts, slip of sticking ones, and slip that friction drives instead of opposing.
///
/// The forces keep acting along the rows they have: gaps are true, and Newton's matrix is that of the rows. With
/// `extrapolates` gaps follow the rows too, which always converges.
pub(super) fn measure(island: &mut Island, extrapolates: bool) -> f64 {
    let error = island.joints.measure(&island.blocks);
    error.max(measure_contacts(island, extrapolates))
}

/// Measures the working set under the multipliers of the last step; returns how far the laws are from holding, extrapolated from the
/// beginning of the step (m).
pub(super) fn measure_guess(island: &mut Island) -> f64 {
    let error = island.joints.extrapolate(&island.blocks);
    error.max(measure_contacts(island, true))
}

/// Measures the signed contacts where the blocks are now; returns how far their laws are from holding there in truth (m).
pub(super) fn measure_signed(island: &mut Island) -> f64 {
    let scene = scene(&island.blocks, &island.parts, &island.segments);
    let signed = island.contacts.iter_mut().filter(|one| one.base.is_none());
    let errors =
        signed.map(|contact| contact.measure(&island.candidates[contact.candidate], &scene, false));
    errors.fold(0.0, f64::max)
}

fn measure_contacts(island: &mut Island, extrapolates: bool) -> f64 {
    let mut error = 0.0f64;
    let scene = scene(&island.blocks, &island.parts, &island.segments);
    for contact in &mut island.contacts {
        let candidate = &island.candidates[contact.candidate];
        error = error.max(match contact.base {
            Some(base) => {
                let onward = island.path.onward(&contact.kinematics, &island.blocks);
                contact.measure_from(base, onward, candidate.law.friction)
            }
            None => contact.measure(candidate, &scene, extrapolates),
        });
    }
    error
}

/// Makes the measured geometry the rows that forces act along.
pub(super) fn refresh_rows(island: &mut Island) {
    for contact in &mut island.contacts {
        let gap = contact.kinematics.gap;
        contact.applied = contact.kinematics;
        contact.kinematics = contact.measured;
        contact.kinematics.gap = gap;
        contact.known = None;
    }
    island.joints.turn_rows(&island.blocks);
}

/// Adds candidates that overlap now; returns whether there were any.
pub(super) fn add_violated(
    island: &mut Island,
    tolerance: f64,
    kept: f64,
    memory: &ContactMemory,
) -> bool {
    let before = island.contacts.len();
    let scene = scene(&island.blocks, &island.parts, &island.segments);
    for (index, candidate) in island.candidates.iter().enumerate() {
        // Near pairs of the path come after the signed candidates.
        if island.is_working.get(index).is_none_or(|works| *works) {
            continue;
        }
        let remembered = memory.recall(&candidate.key);
        let found = candidate.evaluate(&scene, &remembered);
        let Some(kinematics) = found.filter(|found| found.gap < -tolerance) else {
            continue;
        };
        let friction = candidate.law.friction;
        let mut contact =
            ActiveContact::new(index, kinematics, remembered, friction, &island.blocks);
        let slop = OVERLAPPED * tolerance;
        contact.allow_overlap(kept, slop, candidate, &scene);
        let is_left_alone = island.joints.holds_fast(&island.blocks, &kinematics);
        if !is_left_alone && contact.kinematics.gap < -tolerance {
            island.is_working[index] = true;
            island.contacts.push(contact);
        }
    }
    island.contacts.len() > before
}

/// What friction that is wedged against itself has given way by; see `follow::consistent` (m).
pub(super) fn slip_violation(island: &Island) -> f64 {
    let slips = island
        .contacts
        .iter()
        .map(|contact| contact.yielding[1] * contact.multiplier[1].abs());
    slips.fold(0.0, f64::max)
}

/// Largest overlap that is left at a contact (m): where the blocks are, which is the base of the path where the step `is_stopped` there, and else
/// what was found last.
pub(super) fn gap_violation(island: &Island, is_stopped: bool) -> f64 {
    island
        .contacts
        .iter()
        .filter(|contact| !contact.is_lost || contact.multiplier[0] > 0.0)
        .map(|contact| match contact.base {
            Some(base) if is_stopped => base.gap,
            _ => contact.gap(),
        })
        .fold(0.0, |worst, gap| worst.max(-gap))
}

/// Tangential motion of the point against the target's material since the beginning of the step (m).
pub(super) fn slip(kinematics: &Kinematics, blocks: &[Block]) -> f64 {
    moved(kinematics, blocks).dot(&kinematics.tangent())
}

/// Motion of the point against the target since the beginning of the step, linear in the dofs of rigid blocks (m).
fn moved(kinematics: &Kinematics, blocks: &[Block]) -> Vec2 {
    kinematics.relative(blocks, |block, grip| block.displacement(grip))
}
