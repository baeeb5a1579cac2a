//! Impacts of rigid bodies within the step act where the bodies met, and what rebounds goes on from there.
//!
//! The position stage moves bodies that would overlap at the end of the step by `δ` along the normal, until they touch. An impulse `P` at a
//! time `s` before the end moves them by `s P / m`: at the time for which this is `δ` it keeps angular momentum, which the `δ n × m v` of bodies that
//! slide about each other does not. Rows of the end have turned on since, and frictionless balls that are hit beside their centres would spin.
//!
//! That is so for bodies of which nothing else takes hold. They end the step where the impulse at the time of impact leads them, if the path goes there
//! and loads do not press them together again; else where they touch, and the impulse acts in the part of the time since for which that is so. What
//! joints or other contacts hold as well is struck at the end of the step, in which all of these agree: rows of another time would strike it twice.

use super::active_contact::ActiveContact;
use super::gathered;
use super::island::{Island, SolveSettings};
use super::passes::Hit;
use super::rebound::rebound;
use crate::constraint::contact::Kinematics;
use crate::math::{Vec2, perp, rounding};
use crate::path::NearPair;
use crate::system::{Block, RigidBlock};

/// Newton's steps towards the time of an impact: gaps are smooth in it.
const NEWTON_STEPS: usize = 3;

/// Puts the rows of hits where these happened, until [`end_rows`].
pub(super) fn meet(island: &mut Island, settings: &SolveSettings) {
    island.passes.hits.clear();
    for contact in &mut island.contacts {
        contact.rebound = None;
    }
    if settings.is_explicit || !island.contacts.iter().any(is_hit) {
        return;
    }
    note_carried(island);
    for index in 0..island.contacts.len() {
        if let Some(met) = met(island, index, settings) {
            let contact = &mut island.contacts[index];
            contact.rebound = met.rebound;
            island.passes.hits.push(Hit {
                contact: index,
                other: std::mem::replace(&mut contact.kinematics, met.row),
                since: met.since,
            });
        }
    }
}

/// Puts the rows back to the end of the step.
pub(super) fn end_rows(island: &mut Island) {
    for hit in &mut island.passes.hits {
        std::mem::swap(&mut hit.other, &mut island.contacts[hit.contact].kinematics);
    }
}

/// Whether a contact of rigid bodies along the path has closed within the step, which began with them apart.
fn is_hit(contact: &ActiveContact) -> bool {
    contact.is_hard
        && contact.multiplier[0] > f64::MIN_POSITIVE
        && !contact.is_parting()
        && contact.remembered.normal <= 0.0
        && contact.base.is_some_and(|base| !base.is_meeting)
}

/// Notes which bodies nothing but hits takes hold of, nor of any that they hit.
fn note_carried(island: &mut Island) {
    let carried = &mut island.passes.carried;
    carried.clear();
    let is_rigid = |block: &Block| matches!(block, Block::Rigid(_));
    carried.extend(island.blocks.iter().map(is_rigid));
    let stays = |block: &Block| matches!(block, Block::Rigid(block) if is_still(block));
    for tie in &island.joints.ties {
        for grip in &island.joints.grips[tie.row.grips.0..tie.row.grips.1] {
            carried[grip.block] = stays(&island.blocks[grip.block]);
        }
    }
    loop {
        let mut is_settled = true;
        for contact in island.contacts.iter().filter(|one| one.is_closed()) {
            let grips = || contact.kinematics.attachments().iter();
            let goes_on = is_hit(contact) && grips().all(|grip| carried[grip.block]);
            for grip in grips().filter(|_| !goes_on) {
                if carried[grip.block] && !stays(&island.blocks[grip.block]) {
                    (carried[grip.block], is_settled) = (false, false);
                }
            }
        }
        if is_settled {
            return;
        }
    }
}

/// What a hit is where its bodies met.
struct Met {
    row: Kinematics,
    /// For how long its impulse moves them (s).
    since: f64,
    /// The velocity that what goes on parts with at the end of the step (m/s).
    rebound: Option<f64>,
}

/// Finds where the bodies of a hit met; `None` where the contact is none, they did not, or something else holds one of them.
fn met(island: &mut Island, index: usize, settings: &SolveSettings) -> Option<Met> {
    let contact = &island.contacts[index];
    let base = contact.base.filter(|_| is_hit(contact))?;
    let end = contact.kinematics;
    let law = island.candidates[contact.candidate].law;
    let rebound = rebound(island, index, settings);
    let mut grips = end.attachments().iter();
    if !grips.all(|grip| island.passes.carried[grip.block]) {
        return None;
    }
    let (mut since, mut gap) = (0.0, -along(island, &end, pushed));
    let mut row = end;
    for _ in 0..NEWTON_STEPS {
        let closing = -along(island, &row, rates) - since * faster(island, &row, settings);
        if closing <= 0.0 {
            return None;
        }
        since = (since - gap / closing).clamp(0.0, settings.dt);
        row = row_before(island, &base.near, [since, 1.0, settings.dt]);
        gap = row.gap - end.gap;
    }
    // What has gone around something else since has no row there.
    let turned = row.normal.dot(&end.normal);
    if turned.is_nan() || turned <= 0.0 || since == 0.0 {
        return None;
    }
    let (closing, faster) = (-along(island, &row, rates), faster(island, &row, settings));
    // What loads alone may have brought there within a step has rested.
    let by_loads = settings.dt * drive(island, &row).max(faster);
    if closing <= 0.0 || closing - faster * since <= by_loads {
        return None;
    }
    let restitution = if rebound > 0.0 { law.restitution } else { 0.0 };
    let at_end = restitution * (closing - faster * since) - faster * since;
    if at_end >= -rounding::SOLVED * closing {
        let rebound = Some(at_end.max(0.0));
        return Some(Met {
            row,
            since,
            rebound,
        });
    }
    let part = closing / (rebound + closing);
    Some(Met {
        row: row_before(island, &base.near, [since, part, settings.dt]),
        since: part * since,
        rebound: None,
    })
}

/// The row of a near pair where its bodies would have been this long before the end of the step if nothing had pushed them (s), or that part of the
/// way to there from where they end.
fn row_before(island: &mut Island, near: &NearPair, [since, part, dt]: [f64; 3]) -> Kinematics {
    let places = island.path.blocks_of(near).map(|block| {
        let block = &island.blocks[block];
        let [end, pushed, rates, start] =
            [pose(block), pushed(block), rates(block), start_rates(block)];
        let [x, y, angle]: [f64; 3] = std::array::from_fn(|i| {
            let slower = 0.5 * since * since * (rates[i] - start[i]) / dt;
            end[i] - part * (pushed[i] + since * rates[i] - slower)
        });
        (Vec2::new(x, y), angle)
    });
    island.path.kinematics_at(near, places)
}

/// What a motion of the blocks is along the normal of a row.
fn along(island: &Island, row: &Kinematics, motion: fn(&Block) -> [f64; 3]) -> f64 {
    let grips = row.attachments().iter();
    let motions = grips.map(|a| {
        let [x, y, turn] = motion(&island.blocks[a.block]);
        a.weight
            * row
                .normal
                .dot(&(Vec2::new(x, y) + turn * perp(a.grip.lever)))
    });
    motions.sum()
}

/// How much the loads of both bodies may speed up the approach at a row, whatever else holds them (m/s²).
fn drive(island: &Island, row: &Kinematics) -> f64 {
    let drives = row.attachments().iter().map(|a| {
        let [x, y, turn] = of_rigid(&island.blocks[a.block], RigidBlock::drive);
        a.weight.abs() * (Vec2::new(x, y).norm() + turn.abs() * a.grip.lever.norm())
    });
    drives.sum()
}

/// By how much loads have sped up the approach along a row (m/s²).
fn faster(island: &Island, row: &Kinematics, settings: &SolveSettings) -> f64 {
    (along(island, row, start_rates) - along(island, row, rates)) / settings.dt
}

/// Lets what rebounds go on to the end of the step, as far as nothing is in its way.
pub(super) fn carry_on(island: &mut Island) {
    gathered::clear_wrenches(island);
    let mut goes_on = false;
    for hit in &island.passes.hits {
        let contact = &island.contacts[hit.contact];
        goes_on |= contact.rebound.is_some();
        gathered::spread(
            &mut island.blocks,
            &hit.other,
            contact.impulse.map(|impulse| hit.since * impulse),
            Some(&mut island.wrenches),
            |_, _, _, _| {},
        );
    }
    if !goes_on {
        return;
    }
    let carried = &mut island.passes.carried;
    carried.fill(false);
    for hit in &island.passes.hits {
        let contact = &island.contacts[hit.contact];
        for grip in hit.other.attachments() {
            carried[grip.block] |= contact.rebound.is_some();
        }
    }
    island.path.keep_base(&mut island.passes.touching);
    for (index, block) in island.blocks.iter_mut().enumerate() {
        if let Block::Rigid(block) = block
            && carried[index]
        {
            block.let_go_on(island.wrenches[index]);
        }
    }
    let arrives = island.path.advance(&island.blocks);
    island.path.list_near();
    let is_free = arrives && island.path.are_apart(carried);
    if !is_free {
        island.path.return_to(&island.passes.touching);
        island.path.stop_rigid(&mut island.blocks, carried);
    }
}

/// Centre (m) and angle of a rigid block.
fn pose(block: &Block) -> [f64; 3] {
    of_rigid(block, |block| {
        let now = block.current();
        [now.centre.x, now.centre.y, now.angle]
    })
}

/// See [`RigidBlock::pushed`].
fn pushed(block: &Block) -> [f64; 3] {
    of_rigid(block, RigidBlock::pushed)
}

/// Velocity and spin before the impulses (m/s, rad/s).
fn rates(block: &Block) -> [f64; 3] {
    of_rigid(block, RigidBlock::rates)
}

/// Velocity and spin at the beginning of the step (m/s, rad/s).
fn start_rates(block: &Block) -> [f64; 3] {
    of_rigid(block, |block| {
        let start = block.start();
        [start.velocity.x, start.velocity.y, start.spin]
    })
}

fn of_rigid(block: &Block, value: impl Fn(&RigidBlock) -> [f64; 3]) -> [f64; 3] {
    match block {
        Block::Rigid(block) => value(block),
        Block::Flex(_) => [0.0; 3],
    }
}

/// Whether nothing moves a body: its motion is given, or all of its axes are locked.
fn is_still(block: &RigidBlock) -> bool {
    block.is_prescribed() || block.moves_along() == [false; 3]
}
