//! The forces that acted, and the angular momentum of bodies that touch each other, or themselves, and nothing else.
//!
//! The multipliers of a contact have no resultant and no couple, so linear momentum is kept to rounding. Angular momentum
//! `Σ (x - C) × m (v - V) + L` is not: a contact that closes within the step acts at the levers of the step's end, and
//! positions are corrected without their velocities. The error, of the first order in the step, is taken out by turning the
//! velocities of the whole group rigidly, which changes no relative velocity at any contact.

use super::island::{Island, SolveSettings};
use super::joint_rows::{ActiveJoint, add_wrench};
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

impl Island {
    /// Counts what lasting forces do beyond their time in a part of a step. `1 - β1` of a force acts in the part that follows, as long as that
    /// is, and is counted where it is found, as if that were as long as the step: sums over any parts balance momentum then, and what rests
    /// carries its weight in each of them.
    pub(super) fn count_late_forces(&mut self, settings: &SolveSettings) {
        let late = (1.0 - settings.b1 / settings.dt) * (settings.whole - settings.dt);
        for contact in &mut self.contacts {
            if !contact.is_hard {
                let (now, before) = (contact.lasting(), contact.remembered.lasting);
                contact.late = [0, 1].map(|axis| late * (now[axis] - before[axis]));
            }
        }
    }

    /// What soft contacts and joints with flexible blocks that store accelerations have done to every rigid one, and do on in the next step.
    pub fn late_forces(&self, step: &Step, late: &mut Vec<LateForce>) {
        let none = LateForce {
            is_stored: !step.is_within(),
            ..LateForce::default()
        };
        late.clear();
        late.resize(self.blocks.len(), none);
        let stores = |block: usize| matches!(&self.blocks[block], Block::Flex(body) if !body.is_large() && !body.is_explicit());
        for contact in self.contacts.iter().filter(|contact| !contact.is_hard) {
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
                late[grip.block].add(wrench, self.flex_index[partner]);
            }
        }
        for tie in self.ties.iter().filter(|tie| !tie.is_hard) {
            let grips = &self.joint_grips[tie.row.grips.0..tie.row.grips.1];
            let Some(partner) = grips
                .iter()
                .map(|grip| grip.block)
                .find(|&block| stores(block))
            else {
                continue;
            };
            for grip in grips {
                let wrench = unit_wrench(grip, tie.direction, tie.row.measure.is_turn());
                let force = tie.multiplier - tie.closer;
                late[grip.block].add(wrench.map(|part| force * part), self.flex_index[partner]);
            }
        }
    }

    /// Leaves on every flexible block the contact forces that acted, those of impulses included.
    pub(super) fn publish_forces(&mut self, dt: f64) {
        for block in &mut self.blocks {
            if let Block::Flex(block) = block {
                block.clear_contact_force();
            }
        }
        for contact in &self.contacts {
            let force = contact.force(dt);
            Self::spread(
                &mut self.blocks,
                &contact.kinematics,
                force,
                None,
                |block, node, force, lever| block.add_contact_force(node, force, lever),
            );
        }
        self.publish_joint_forces(dt);
    }

    /// Leaves the forces of soft joints on the flexible blocks.
    pub(super) fn publish_joint_forces(&mut self, dt: f64) {
        for tie in self.ties.iter().filter(|tie| !tie.is_hard) {
            let force = tie.force(dt) * tie.row.sign;
            for grip in &self.joint_grips[tie.row.grips.0..tie.row.grips.1] {
                if let (Block::Flex(block), Point::Node(node)) =
                    (&mut self.blocks[grip.block], grip.point)
                {
                    let share: Vec2 = force * grip.weight * tie.direction;
                    block.add_contact_force(node, share, grip.lever);
                }
            }
        }
    }

    /// Mean force of a joint row over the step in the world, on the side of positive weights, or its torque (N or N m).
    pub fn joint_force(&self, tie: &ActiveJoint, dt: f64) -> (Vec2, f64) {
        let force = tie.force(dt);
        if tie.row.measure.is_turn() {
            return (Vec2::zeros(), force);
        }
        if !tie.is_hard {
            return (force * tie.row.sign * tie.direction, 0.0);
        }
        let sum = (tie.kick * tie.direction + tie.impulse * tie.end) / dt;
        (sum, 0.0)
    }

    /// Restores the angular momentum of every group of free bodies that touch, each other or themselves.
    pub(super) fn balance_angular_momentum(&mut self) {
        self.groups.clear();
        self.groups.extend(0..self.blocks.len());
        self.touch_themselves.clear();
        self.touch_themselves.resize(self.blocks.len(), false);
        let closed = self.contacts.iter().filter(|contact| contact.is_closed());
        let pressed = closed.map(|contact| self.candidates[contact.candidate].pair.blocks());
        let tied = self.ties.iter().map(|tie| {
            let (first, last) = tie.row.grips;
            [first, last - 1].map(|grip| self.joint_grips[grip].block)
        });
        for pair in pressed
            .chain(self.pressed_before.iter().copied())
            .chain(tied)
        {
            self.touch_themselves[pair[0]] |= pair[0] == pair[1];
            let [one, other] = pair.map(|block| root(&self.groups, block));
            self.groups[one.max(other)] = one.min(other);
        }
        for block in 0..self.groups.len() {
            self.groups[block] = root(&self.groups, block);
        }
        for block in 0..self.groups.len() {
            let has_partner = self.groups[block + 1..].contains(&block);
            if self.groups[block] == block && (has_partner || self.touch_themselves[block]) {
                self.balance_group(block);
            }
        }
    }

    fn balance_group(&mut self, group: usize) {
        let mut common = None;
        let (mut start, mut end) = (Sum::default(), Sum::default());
        let members = || (0..self.groups.len()).filter(|&block| self.groups[block] == group);
        for block in members() {
            // One acceleration for all has no moment about the centre of mass.
            let own = self.blocks[block].uniform_acceleration();
            if own.is_none() || *common.get_or_insert(own) != own {
                return;
            }
            start.add(&self.blocks[block].start_moments());
            end.add(&self.blocks[block].end_moments());
        }
        let centre = end.centre();
        let (mut gained, mut inertia) = (0.0, 0.0);
        for block in members() {
            gained -= start.angular_momentum(&self.blocks[block].start_moments());
            let moments = self.blocks[block].end_moments();
            gained += end.angular_momentum(&moments);
            inertia += moments.inertia + moments.mass * (moments.centre - centre).norm_squared();
        }
        let spin = -gained / inertia;
        for block in 0..self.groups.len() {
            if self.groups[block] == group {
                let lever = self.blocks[block].centre() - centre;
                self.blocks[block].add_rigid_velocity(spin * perp(lever), spin);
            }
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
