//! An island: blocks that touch, with the candidates between them, solved as one system.

pub use super::active_contact::ActiveContact;
pub(super) use super::active_contact::AtBase;
use super::constraint_function::Newton;
use super::feasible::FeasiblePath;
use super::joints::Joints;
use super::ledgers::Ledgers;
use super::passes::Passes;
use super::problem::RowProblem;
pub use super::settings::{KktError, SolveSettings};
#[cfg(feature = "serde-serialize")]
use super::sparse::KeptRecord;
use super::sparse::Sparse;
use super::work::{self, JointWork, KeptOn, WorkGrips};
use crate::constraint::contact::{Candidate, ContactKey, PlacedPart, Scene};
#[cfg(feature = "serde-serialize")]
use crate::fe::model::Model;
use crate::math::{HashMap, Vec2};
use crate::system::Block;
#[cfg(feature = "serde-serialize")]
use std::sync::Arc;

/// A set of blocks and candidates, and the buffers to solve them.
#[derive(Debug, Default)]
pub struct Island {
    /// Members; taken over for the step and handed back after it.
    pub blocks: Vec<Block>,
    /// For each block the index of its body in the flexible set, if it is flexible.
    pub flex_index: Vec<Option<u32>>,
    /// Convex parts of the rigid members.
    pub parts: Vec<PlacedPart>,
    /// Lists of near boundary segments.
    pub segments: Vec<u32>,
    /// Pairs that may touch.
    pub candidates: Vec<Candidate>,
    /// Surfaces that are led along a feasible path.
    pub path: FeasiblePath,
    /// Candidates of near pairs, by their names.
    pub(super) near_candidates: HashMap<ContactKey, usize>,
    /// What the passes along the path go by.
    pub(super) passes: Passes,
    /// The working set after a solve.
    pub contacts: Vec<ActiveContact>,
    /// Joints between the members and with the world.
    pub joints: Joints,
    /// Candidates that are at work.
    pub(super) is_working: Vec<bool>,
    /// The problem at hand.
    pub(super) problem: RowProblem,
    pub(super) sparse: Sparse,
    /// Wrenches gathered on rigid blocks, by block (N, N, N m, or their impulses).
    pub(super) wrenches: Vec<[f64; 3]>,
    /// For each block the energy that contact has taken from it and may give back (J); debts are negative, and those of rigid ones zero.
    pub reserves: Vec<f64>,
    /// Whose energy is told together, and reserves as they were.
    pub(super) ledgers: Ledgers,
    /// What flexible bodies have kept of their forces on driven blocks from the step before: it acts on in the first part of the step.
    pub kept_on: Vec<KeptOn>,
    /// For each block the first of those that touch it, directly or by others.
    pub(super) groups: Vec<usize>,
    /// Blocks with contacts of their own surface.
    pub(super) touch_themselves: Vec<bool>,
    /// Blocks of the contacts that pressed in the last step: their forces still act from the stored accelerations.
    pub(super) pressed_before: Vec<[usize; 2]>,
    /// Newton's iterations by constraint functions.
    pub(super) newton: Newton,
}

impl Island {
    /// Empties the island, keeping its buffers.
    pub fn clear(&mut self) {
        self.blocks.clear();
        self.flex_index.clear();
        self.reserves.clear();
        self.parts.clear();
        self.segments.clear();
        self.candidates.clear();
        self.near_candidates.clear();
        self.path.clear();
        self.contacts.clear();
        self.joints.clear();
        self.kept_on.clear();
    }

    /// Forgets what is kept of sparse problems that the step before did not ask for.
    pub fn begin_step(&mut self) {
        self.sparse.forget_unused();
    }

    /// Whether some block is of large strain, whose equilibrium is found to a residual.
    pub fn has_large(&self) -> bool {
        let is_large = |block: &Block| matches!(block, Block::Flex(block) if block.is_large());
        self.blocks.iter().any(is_large)
    }

    /// Whether joints leave forces in stored accelerations, which swing from step to step.
    pub fn has_swinging_joints(&self, is_within: bool) -> bool {
        !self.joints.ties.is_empty() && !is_within
    }

    /// Whether contacts press bodies that joints hold, so that forces of both may be of any size.
    pub(super) fn presses_joined(&self) -> bool {
        let mut contacts = self.contacts.iter();
        contacts.any(|contact| contact.is_closed() && self.joints.joins(contact))
    }

    /// Work of applied forces and of the contact forces of driven bodies (J).
    pub(super) fn actual_work(&self, settings: &SolveSettings) -> f64 {
        let blocks = (self.blocks.iter(), |_| true);
        self.own_work(settings, blocks, self.contacts.iter())
    }

    /// The same of some blocks, which count, and contacts.
    pub(super) fn own_work<'a>(
        &'a self,
        settings: &SolveSettings,
        own: (impl Iterator<Item = &'a Block>, impl Fn(usize) -> bool),
        contacts: impl Iterator<Item = &'a ActiveContact>,
    ) -> f64 {
        let contacts = contacts.map(|contact| (contact, &self.candidates[contact.candidate]));
        work::actual_work(&self.blocks, own, contacts, &self.kept_on, settings)
    }

    /// Energy that contact has taken from the blocks and may give back (J).
    pub fn reserve(&self) -> f64 {
        self.reserves.iter().sum()
    }

    /// Work of the joints on what is not driven from outside.
    pub(super) fn joint_work(&self, settings: &SolveSettings) -> JointWork {
        let grips = WorkGrips {
            start: &self.joints.grips,
            end: &self.joints.end_grips,
        };
        work::joint_work(
            &self.blocks,
            &self.joints.ties,
            grips,
            [settings.dt, settings.b1],
        )
    }

    /// Where a contact is at the end of the step (m).
    pub fn place_of(&self, contact: &ActiveContact) -> Vec2 {
        match &contact.base {
            Some(base) => self.path.place(&base.near, contact.gap(), &self.blocks),
            None => contact.measured.position,
        }
    }

    /// What plastic flow dissipates in the step, which is in the elastic energy of its end (J).
    pub fn flow_energy(&self) -> f64 {
        work::flow_energy(&self.blocks)
    }
}

/// What a snapshot writes of it.
#[cfg(feature = "serde-serialize")]
impl Island {
    /// What is kept of islands that the last step has solved, to go on from.
    ///
    /// - `index_of`: the index of the flexible body of a model.
    pub(crate) fn kept_records(
        &self,
        index_of: impl Fn(&Arc<Model>) -> Option<u32>,
    ) -> Vec<KeptRecord> {
        self.sparse.record(index_of)
    }

    /// Keeps what was recorded, `None` if a body of it does not exist.
    ///
    /// - `model_of`: the model of the flexible body at an index.
    pub(crate) fn restore_kept(
        &mut self,
        records: Vec<KeptRecord>,
        model_of: impl Fn(u32) -> Option<Arc<Model>>,
    ) -> Option<()> {
        self.sparse.restore(records, model_of)
    }
}

/// Where candidates are evaluated.
pub(super) fn scene<'a>(
    blocks: &'a [Block],
    parts: &'a [PlacedPart],
    segments: &'a [u32],
) -> Scene<'a> {
    Scene {
        blocks,
        parts,
        segments,
    }
}
