//! What the solved islands of a step want to commit, before anything is.

use super::solved::{Entry, SolvedPart};
use crate::body::{FlexBodySet, KeptForce};
use crate::constraint::joint::{JointOwner, Measure};
use crate::coupling::{
    FlexPool, JointImpulse, Landing, RapierSets, keep_awake, keep_landing_awake, wake_moving,
};
use crate::kkt::{LateForce, late_forces};
use crate::rapier::prelude::ImpulseJointHandle;
use crate::system::Block;

/// The end of a flexible body.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlexEnd {
    /// Its slot in the set.
    pub index: u32,
    /// Energy that contact may return to it (J).
    pub reserve: f64,
    /// Whether the step of its island is not finished.
    pub is_unfinished: bool,
}

/// The ends of the members of all islands of a step.
#[derive(Debug, Default)]
pub(super) struct Outcome {
    /// Where flexible bodies end.
    pub flexible: Vec<FlexEnd>,
    /// Where claimed rigid bodies end.
    pub landings: Vec<Landing>,
    /// Forces that flexible bodies keep, by their slots in the set.
    pub kept_forces: Vec<(u32, KeptForce)>,
    /// Impulses on rapier's joints.
    pub joint_impulses: Vec<JointImpulse>,
    /// Forces that act on in the next step, by the blocks of an island: scratch.
    late: Vec<LateForce>,
}

impl Outcome {
    /// Begins anew.
    pub fn clear(&mut self) {
        self.flexible.clear();
        self.landings.clear();
        self.kept_forces.clear();
        self.joint_impulses.clear();
    }

    /// Enters a part of an island's step as solved; with the last one its members end.
    pub fn enter(&mut self, part: &SolvedPart<'_>, entry: &Entry) {
        self.add_joint_impulses(part, entry);
        if !part.span.is_last() {
            return;
        }
        let island = part.island;
        late_forces(island, &part.step, &mut self.late);
        for &(block, handle) in part.seats.claimed() {
            let late = self.late[block];
            if let Block::Rigid(block) = &island.blocks[block] {
                self.landings
                    .push(Landing::new(handle, block, late, entry.is_unfinished));
            }
        }
        part.seats.add_kept_forces(island, &mut self.kept_forces);
        for (index, reserve) in island.flex_index.iter().zip(&island.reserves) {
            let end = index.map(|index| FlexEnd {
                index,
                reserve: *reserve,
                is_unfinished: entry.is_unfinished,
            });
            self.flexible.extend(end);
        }
    }

    /// Adds the impulses of a part to those of the parts before it.
    fn add_joint_impulses(&mut self, part: &SolvedPart<'_>, entry: &Entry) {
        let dt = part.step.dt;
        for tie in &part.island.joints.ties {
            let JointOwner::Impulse(index, generation) = tie.row.key.owner else {
                continue;
            };
            let handle = ImpulseJointHandle::from_raw_parts(index, generation);
            let impulse = dt * tie.force(dt);
            let row = tie.row.key.row;
            let mut noted = self.joint_impulses[entry.first_impulse..].iter_mut();
            let known = if part.span.is_first() {
                None
            } else {
                noted.find(|one| one.handle == handle && one.row == row)
            };
            match known {
                Some(known) => known.impulse += impulse,
                None => self.joint_impulses.push(JointImpulse {
                    handle,
                    row,
                    is_world: matches!(tie.row.measure, Measure::Along(_)),
                    impulse,
                }),
            }
        }
    }

    /// Keeps what moves, or is not finished, awake: the carriers of flexible bodies, and claimed rigid bodies.
    pub fn keep_awake(
        &self,
        pool: &FlexPool,
        sets: &mut RapierSets<'_>,
        flex_bodies: &FlexBodySet,
    ) {
        for end in &self.flexible {
            let block = pool.block(end.index);
            if let (Some(block), Some((handle, body))) = (block, flex_bodies.at_index(end.index)) {
                let is_restless = end.is_unfinished || flex_bodies.is_attached(handle);
                keep_awake(body, block.velocities(), is_restless, sets);
            }
        }
        for landing in &self.landings {
            let is_attached = || flex_bodies.has_attached(landing.handle);
            keep_landing_awake(landing, is_attached, sets);
        }
    }

    /// Wakes carriers that rapier has put to sleep while their bodies move.
    pub fn wake_moving(
        &self,
        pool: &FlexPool,
        sets: &mut RapierSets<'_>,
        flex_bodies: &FlexBodySet,
    ) {
        for end in &self.flexible {
            let block = pool.block(end.index);
            if let (Some(block), Some((handle, body))) = (block, flex_bodies.at_index(end.index)) {
                let is_restless = end.is_unfinished || flex_bodies.is_attached(handle);
                wake_moving(body, block.velocities(), is_restless, sets);
            }
        }
    }
}
