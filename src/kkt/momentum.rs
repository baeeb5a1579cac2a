//! The forces that acted, and the angular momentum of bodies that touch each other, or themselves, and nothing else.
//!
//! The multipliers of a contact have no resultant and no couple, so linear momentum is kept to rounding. Angular momentum
//! `Σ (x - C) × m (v - V) + L` is not: a contact that closes within the step acts at the levers of the step's end, and
//! positions are corrected without their velocities. The error, of the first order in the step, is taken out by turning the
//! velocities of the whole group rigidly, which changes no relative velocity at any contact.

use super::gathered;
use super::island::{Island, SolveSettings};
use super::joints::add_wrench;
use crate::constraint::contact::ContactMemory;
use crate::constraint::joint::unit_wrench;
use crate::math::{Vec2, cross, perp};
use crate::system::{Block, Moments, Point, Step};

/// Forces of flexible bodies on a rigid one that these keep in their stored accelerations.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serde-serialize",
    derive(serde::Serialize, serde::Deserialize)
)]
pub struct LateForce {
    /// Whether the rigid body has them in its own as well.
    pub is_stored: bool,
    /// Their sum (N, N, N m).
    pub wrench: [f64; 3],
    /// One of the flexible bodies, by its index.
    pub partner: Option<u32>,
}

impl LateForce {
    fn add(&mut self, wrench: [f64; 3], partner: Option<u32>) {
        if wrench != [0.0; 3] {
            self.partner = self.partner.or(partner);
            add_wrench(&mut self.wrench, 1.0, wrench);
        }
    }
}

/// Counts what lasting forces do beyond their time in a part of a step. `1 - β1` of a force acts in the part that follows, as long as that
/// is, and is counted where it is found, as if that were as long as the step: sums over any parts balance momentum then, and what rests
/// carries its weight in each of them.
///
/// What a contact has left before is asked for here: a row that comes to the step in one of its later passes begins without.
pub(super) fn count_late_forces(
    island: &mut Island,
    settings: &SolveSettings,
    memory: &ContactMemory,
) {
    let late = (1.0 - settings.b1 / settings.dt) * (settings.whole - settings.dt);
    for contact in &mut island.contacts {
        if !contact.is_hard {
            let key = &island.candidates[contact.candidate].key;
            let (now, before) = (contact.lasting(), memory.recall(key).lasting);
            contact.late = [0, 1].map(|axis| late * (now[axis] - before[axis]));
        }
    }
}

/// What soft contacts and joints with flexible blocks that store accelerations have done to every rigid one, and do on in the next step.
pub fn late_forces(island: &Island, step: &Step, late: &mut Vec<LateForce>) {
    let none = LateForce {
        is_stored: !step.is_within(),
        ..LateForce::default()
    };
    late.clear();
    late.resize(island.blocks.len(), none);
    let stores = |block: usize| matches!(&island.blocks[block], Block::Flex(body) if !body.is_large() && !body.is_explicit());
    for contact in island.contacts.iter().filter(|contact| !contact.is_hard) {
        let kinematics = &contact.kinematics;
        let [normal, tangent] = contact.lasting();
        let force = normal * kinematics.normal + tangent * kinematics.tangent();
        let grips = || kinematics.attachments().iter();
        let Some(partner) = grips().map(|grip| grip.block).find(|&block| stores(block)) else {
            continue;
        };
        for grip in grips() {
            let share = grip.weight * force;
            let wrench = [share.x, share.y, cross(grip.grip.lever, share)];
            late[grip.block].add(wrench, island.flex_index[partner]);
        }
    }
    for tie in island.joints.ties.iter().filter(|tie| !tie.is_hard) {
        let grips = &island.joints.grips[tie.row.grips.0..tie.row.grips.1];
        let Some(partner) = grips
            .iter()
            .map(|grip| grip.block)
            .find(|&block| stores(block))
        else {
            continue;
        };
        for grip in grips {
            let wrench = unit_wrench(grip, tie.direction, tie.row.measure.is_turn());
            let force = tie.lasting();
            late[grip.block].add(wrench.map(|part| force * part), island.flex_index[partner]);
        }
    }
}

/// What of the forces of a flexible block's contacts acts on in the next step on a block that is moved as it must, along some axis at least.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LeftOnDriven {
    /// Index of the flexible body.
    pub flex: u32,
    /// The block that it acts on.
    pub block: usize,
    /// Force and torque about its centre (N, N, N m).
    pub wrench: [f64; 3],
}

/// What contacts of flexible blocks that store accelerations leave to act on driven blocks in the next step, contact by contact.
pub(crate) fn left_on_driven(island: &Island) -> impl Iterator<Item = LeftOnDriven> + '_ {
    let stores = |block: usize| match &island.blocks[block] {
        Block::Flex(body) if !body.is_large() && !body.is_explicit() => island.flex_index[block],
        _ => None,
    };
    let soft = island.contacts.iter().filter(|contact| !contact.is_hard);
    soft.flat_map(move |contact| {
        let kinematics = &contact.kinematics;
        let [normal, tangent] = contact.lasting();
        let force = normal * kinematics.normal + tangent * kinematics.tangent();
        let mut grips = kinematics.attachments().iter();
        let flex = grips.find_map(|grip| stores(grip.block));
        let flex = flex.filter(|_| force != Vec2::zeros());
        kinematics.attachments().iter().filter_map(move |grip| {
            let is_driven = matches!(&island.blocks[grip.block], Block::Rigid(block) if block.moves_along() != [true; 3]);
            let share = grip.weight * force;
            Some(LeftOnDriven {
                flex: flex.filter(|_| is_driven)?,
                block: grip.block,
                wrench: [share.x, share.y, cross(grip.grip.lever, share)],
            })
        })
    })
}

/// Leaves on every flexible block the contact forces that acted, those of impulses included.
pub(super) fn publish_forces(island: &mut Island, dt: f64) {
    for block in &mut island.blocks {
        if let Block::Flex(block) = block {
            block.clear_contact_force();
        }
    }
    for contact in &island.contacts {
        let [told, midway] = [contact.force(dt), contact.midway_force(dt)];
        let force = [0, 1].map(|axis| told[axis] + midway[axis]);
        gathered::spread(
            &mut island.blocks,
            &contact.kinematics,
            force,
            None,
            |block, node, force, lever| block.add_contact_force(node, force, lever),
        );
    }
    publish_joint_forces(island, dt);
}

/// Leaves the forces of soft joints on the flexible blocks.
pub(super) fn publish_joint_forces(island: &mut Island, dt: f64) {
    for tie in island.joints.ties.iter().filter(|tie| !tie.is_hard) {
        let force = tie.force(dt) * tie.row.sign;
        for grip in &island.joints.grips[tie.row.grips.0..tie.row.grips.1] {
            if let (Block::Flex(block), Point::Node(node)) =
                (&mut island.blocks[grip.block], grip.point)
            {
                let share: Vec2 = force * grip.weight * tie.direction;
                block.add_contact_force(node, share, grip.lever);
            }
        }
    }
}

/// Restores the angular momentum of every group of free bodies that touch, each other or themselves.
pub(super) fn balance_angular_momentum(island: &mut Island) {
    island.groups.clear();
    island.groups.extend(0..island.blocks.len());
    island.touch_themselves.clear();
    island.touch_themselves.resize(island.blocks.len(), false);
    let closed = island.contacts.iter().filter(|contact| contact.is_closed());
    let pressed = closed.map(|contact| island.candidates[contact.candidate].pair.blocks());
    let tied = island.joints.ties.iter().map(|tie| {
        let (first, last) = tie.row.grips;
        [first, last - 1].map(|grip| island.joints.grips[grip].block)
    });
    for pair in pressed
        .chain(island.pressed_before.iter().copied())
        .chain(tied)
    {
        island.touch_themselves[pair[0]] |= pair[0] == pair[1];
        let [one, other] = pair.map(|block| root(&island.groups, block));
        island.groups[one.max(other)] = one.min(other);
    }
    for block in 0..island.groups.len() {
        island.groups[block] = root(&island.groups, block);
    }
    for block in 0..island.groups.len() {
        let has_partner = island.groups[block + 1..].contains(&block);
        if island.groups[block] == block && (has_partner || island.touch_themselves[block]) {
            balance_group(island, block);
        }
    }
}

fn balance_group(island: &mut Island, group: usize) {
    let mut common = None;
    let (mut start, mut end) = (Sum::default(), Sum::default());
    let members = || (0..island.groups.len()).filter(|&block| island.groups[block] == group);
    for block in members() {
        // One acceleration for all has no moment about the centre of mass.
        let own = island.blocks[block].uniform_acceleration();
        if own.is_none() || *common.get_or_insert(own) != own {
            return;
        }
        start.add(&island.blocks[block].start_moments());
        end.add(&island.blocks[block].end_moments());
    }
    let centre = end.centre();
    let (mut gained, mut inertia) = (0.0, 0.0);
    for block in members() {
        gained -= start.angular_momentum(&island.blocks[block].start_moments());
        let moments = island.blocks[block].end_moments();
        gained += end.angular_momentum(&moments);
        inertia += moments.inertia + moments.mass * (moments.centre - centre).norm_squared();
    }
    let spin = -gained / inertia;
    for block in 0..island.groups.len() {
        if island.groups[block] == group {
            let lever = island.blocks[block].centre() - centre;
            island.blocks[block].add_rigid_velocity(spin * perp(lever), spin);
        }
    }
}

fn root(groups: &[usize], mut block: usize) -> usize {
    while groups[block] != block {
        block = groups[block];
    }
    block
}

/// Mass, first moment and momentum of a group.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    mass: f64,
    moment: Vec2,
    momentum: Vec2,
}

impl Sum {
    fn add(&mut self, moments: &Moments) {
        self.mass += moments.mass;
        self.moment += moments.mass * moments.centre;
        self.momentum += moments.mass * moments.velocity;
    }

    fn centre(&self) -> Vec2 {
        self.moment / self.mass
    }

    /// What a member has about the group's moving centre of mass.
    fn angular_momentum(&self, member: &Moments) -> f64 {
        let velocity = member.velocity - self.momentum / self.mass;
        member.spin_momentum + member.mass * cross(member.centre - self.centre(), velocity)
    }
}
