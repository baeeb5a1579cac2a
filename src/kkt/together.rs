//! The end of a step that nothing else ends: everybody where the step began, and what touches moves on together.
//!
//! The places are those of the step before, so nothing overlaps that did not. Bodies that touch or are joined get the motion of one rigid
//! body with the momentum and the angular momentum that they have together: no motion with these has less energy. Where one of them touches
//! what is held or led, they move as that does, as the slowest if there are several; what is held joins nobody with others that touch it, and springs
//! join nobody. Where nobody else is near they go that way under their loads, as one body: what was put into
//! each other and finds no way out flies and falls.

use super::follow::joint_violation;
use super::group::Group;
use super::island::{Island, SolveSettings};
use super::joints::ActiveJoint;
use super::summary::IslandSummary;
use super::work::end_energy;
use crate::math::Vec2;
use crate::system::{Block, Moments, RigidMotion, RigidRates, RigidWay};

/// Moments of a block at the beginning of the step, or the motion that it keeps whatever happens.
fn moments_of(block: &Block) -> Result<Moments, RigidMotion> {
    match block {
        Block::Flex(body) => {
            let start = body.start_frame();
            let motion = RigidMotion {
                centre: start.centre,
                angle: start.angle,
                velocity: start.velocity,
                spin: start.spin,
            };
            if body.is_pinned() || body.is_explicit() {
                let rest = RigidMotion {
                    velocity: Vec2::zeros(),
                    spin: 0.0,
                    ..motion
                };
                return Err(rest);
            }
            let (mass, polar) = body.inertia();
            Ok(moments(mass, polar, &motion))
        }
        Block::Rigid(body) => {
            let motion = *body.start();
            let is_free = body.moves_along().iter().all(|moves| *moves);
            if body.is_prescribed() || !is_free {
                return Err(motion);
            }
            let [mass, _, polar] = body.mass();
            Ok(moments(mass, polar, &motion))
        }
    }
}

fn moments(mass: f64, inertia: f64, motion: &RigidMotion) -> Moments {
    Moments {
        mass,
        centre: motion.centre,
        velocity: motion.velocity,
        spin_momentum: inertia * motion.spin,
        inertia,
    }
}

fn rates_of(motion: &RigidMotion) -> RigidRates {
    RigidRates {
        about: motion.centre,
        velocity: motion.velocity,
        spin: motion.spin,
    }
}

/// Ends the step where it began; returns whether it does.
///
/// Not if loads beyond all measure are to blame: then the step is to be refused.
///
/// - `dt`, `length_unit`: see [`SolveSettings`](super::SolveSettings) (s, m).
pub(super) fn end_together(
    island: &mut Island,
    (dt, length_unit): (f64, f64),
    summary: &mut IslandSummary,
) -> bool {
    let is_overloaded =
        |block: &Block| matches!(block, Block::Flex(block) if block.is_overloaded());
    if island.blocks.iter().any(is_overloaded) {
        return false;
    }
    (summary.is_cut, summary.is_stopped) = (false, true);
    // Explicit bodies wait at rest for their forces, and so does what they meet.
    let is_explicit = |block: &Block| matches!(block, Block::Flex(body) if body.is_explicit());
    let has_explicit = island.blocks.iter().any(is_explicit);
    let leaders = linked(
        island,
        |block| moments_of(block).is_ok(),
        |tie| !tie.is_spring(),
    );
    let mut groups = vec![Group::default(); island.blocks.len()];
    for (block, &leader) in island.blocks.iter().zip(&leaders) {
        let group = &mut groups[leader];
        match moments_of(block) {
            Ok(own) => group.add(&own),
            Err(motion) => group.anchor = Some(rates_of(&motion)),
        }
    }
    hold_by_anchors(island, &leaders, &mut groups);
    for (block, &leader) in island.blocks.iter().zip(&leaders) {
        if let Ok(own) = moments_of(block) {
            groups[leader].add_turning(&own);
        }
    }
    let may_go = !has_explicit && are_alone(island);
    let before = groups.clone();
    if may_go {
        for (block, &leader) in island.blocks.iter().zip(&leaders) {
            groups[leader].push(dt * block.resultant());
        }
    }
    island.contacts.clear();
    island.pressed_before.clear();
    let ties = std::mem::take(&mut island.joints.ties);
    for (block, &leader) in island.blocks.iter_mut().zip(&leaders) {
        let own = moments_of(block);
        let centre = own
            .as_ref()
            .map_or_else(|motion| motion.centre, |own| own.centre);
        let motion = groups[leader].motion();
        let (velocity, spin) = (motion.at(centre), motion.spin);
        let goes = may_go && own.is_ok() && groups[leader].anchor.is_none();
        if goes {
            let change = motion.velocity - before[leader].motion().velocity;
            let way = RigidWay {
                about: motion.about,
                shift: dt * (motion.velocity - 0.5 * change),
                turn: dt * spin,
                velocity: motion.velocity,
                spin,
                acceleration: change / dt,
            };
            match block {
                Block::Flex(body) => body.carry_on(&way),
                Block::Rigid(body) => body.carry_on(&way),
            }
            continue;
        }
        match block {
            Block::Flex(body) if body.is_pinned() || body.is_explicit() => body.hold(),
            Block::Flex(body) => body.move_on(velocity, spin),
            Block::Rigid(body) => {
                body.hold();
                if own.is_ok() && !has_explicit {
                    body.move_on(velocity, spin);
                }
            }
        }
    }
    island.joints.ties = ties;
    island.joints.measure(&island.blocks);
    summary.joint_violation = joint_violation(island, length_unit, true);
    island.joints.ties.clear();
    true
}

/// Gives every group that touches what is held or led the motion of that: of several, of the one that is slowest where the group is.
fn hold_by_anchors(island: &Island, leaders: &[usize], groups: &mut [Group]) {
    let holds = |tie: &ActiveJoint| !tie.is_spring();
    see_links(island, holds, |blocks| {
        let blocks: Vec<usize> = blocks.collect();
        for &block in &blocks {
            let Err(motion) = moments_of(&island.blocks[block]) else {
                continue;
            };
            let rates = rates_of(&motion);
            for &other in blocks
                .iter()
                .filter(|&&other| leaders[other] != leaders[block])
            {
                let group = &mut groups[leaders[other]];
                if group.mass == 0.0 {
                    continue;
                }
                let centre = group.centre();
                let speed = |rates: &RigidRates| rates.at(centre).norm();
                if group
                    .anchor
                    .is_none_or(|known| speed(&rates) < speed(&known))
                {
                    group.anchor = Some(rates);
                }
            }
        }
    });
}

/// Whether no two of those that might meet in the step are of different groups.
fn are_alone(island: &Island) -> bool {
    let leaders = groups_of(island, |_| true);
    let mut pairs = island.candidates.iter().map(|one| one.pair.blocks());
    island.path.is_empty() && pairs.all(|[one, other]| leaders[one] == leaders[other])
}

/// Makes velocities and energies known of members that have been put elsewhere after the stages.
pub(super) fn measure_ended(
    island: &mut Island,
    settings: &SolveSettings,
    summary: &mut IslandSummary,
) {
    for block in &mut island.blocks {
        if let Block::Flex(block) = block {
            block.place_velocities();
            block.measure_elastic_energy();
        }
    }
    let swings = island.blocks.iter().map(|block| block.swing()[1]);
    (summary.swing, summary.pending) = (swings.sum(), 0.0);
    summary.work = island.actual_work(settings);
    summary.stopped = 0.0;
    summary.end_energy = end_energy(&island.blocks);
}

/// For each block the first one of those that it touches or is joined with, directly or by others, joined only by blocks that count.
pub(super) fn groups_of(island: &Island, counts: impl Fn(&Block) -> bool) -> Vec<usize> {
    linked(island, counts, |_| true)
}

/// The same, of joints only by rows that hold.
fn linked(
    island: &Island,
    counts: impl Fn(&Block) -> bool,
    holds: impl Fn(&ActiveJoint) -> bool,
) -> Vec<usize> {
    let mut leaders: Vec<usize> = (0..island.blocks.len()).collect();
    see_links(island, holds, |blocks| {
        let mut first = None;
        for block in blocks.filter(|&block| counts(&island.blocks[block])) {
            let found = leader_of(&leaders, block);
            match first {
                None => first = Some(found),
                Some(other) => {
                    let (low, high) = (found.min(other), found.max(other));
                    leaders[high] = low;
                    first = Some(low);
                }
            }
        }
    });
    (0..island.blocks.len())
        .map(|block| leader_of(&leaders, block))
        .collect()
}

/// Shows the blocks of every contact that touches, and of every joint row that holds.
fn see_links(
    island: &Island,
    holds: impl Fn(&ActiveJoint) -> bool,
    mut see: impl FnMut(&mut dyn Iterator<Item = usize>),
) {
    let margin = island.path.least_margin();
    for contact in &island.contacts {
        let touches = contact.is_closed() || contact.base.is_some_and(|base| base.gap <= margin);
        if touches {
            let attachments = contact.kinematics.attachments().iter();
            see(&mut attachments.map(|attachment| attachment.block));
        }
    }
    for tie in island.joints.ties.iter().filter(|tie| holds(tie)) {
        let (from, to) = tie.row.grips;
        see(&mut island.joints.grips[from..to].iter().map(|grip| grip.block));
    }
}

fn leader_of(leaders: &[usize], mut block: usize) -> usize {
    while leaders[block] != block {
        block = leaders[block];
    }
    block
}

#[cfg(test)]
pub(super) mod tests;
