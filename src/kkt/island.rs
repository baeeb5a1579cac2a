//! An island: blocks that touch, with the candidates between them, solved as one system.

pub use super::active_contact::ActiveContact;
pub(super) use super::active_contact::AtBase;
use super::constraint_function::Newton;
use super::delassus::RowDirection;
use super::feasible::FeasiblePath;
use super::follow::{Parting, Stage};
use super::gentle::GAINED;
use super::joined::Joined;
use super::joint_rows::ActiveJoint;
use super::joint_twist::Twists;
pub use super::settings::{KktError, SolveSettings};
use super::sparse::Sparse;
use super::summary::IslandSummary;
use super::work::{end_energy, external_work, load_energy, start_energy};
use crate::constraint::contact::{
    Candidate, ContactKey, ContactMemory, Kinematics, PlacedPart, Scene,
};
use crate::constraint::joint::{JointGrip, JointRow};
use crate::linalg::complementarity::{RowKind, Solver, Status};
use crate::math::{HashMap, Vec2, cross};
use crate::system::{Block, FlexBlock, Grip, Point};

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
    pub(super) contacts_before: Vec<ActiveContact>,
    pub(super) slot_of: Vec<u32>,
    /// Contacts that pressed in the last step.
    pub(super) parted: Vec<ActiveContact>,
    /// Contacts that are new in the last list of near pairs.
    pub(super) fresh: Vec<usize>,
    /// Contacts of the last list that have taken over the force of another one.
    pub(super) handed_over: Vec<usize>,
    /// The first impact of a step, the best place that the whole of the step has reached, and the best with contacts that slid off.
    pub(super) impact: Stage,
    pub(super) arrival: Stage,
    pub(super) departure: Stage,
    /// Forces before the solve at hand.
    pub(super) before_solve: Stage,
    /// Share of its own mobility that every contact gives way by to the change of its force (-).
    pub(super) softness: f64,
    /// Share of its own mobility that every row gives way by to its impulse, and to the forces that accelerations follow from (-).
    pub(super) impulse_give: f64,
    /// What the laws may miss at the very most: the least margin of the ways (m).
    pub(super) margin: f64,
    /// How fine the laws are to hold at the least, by what the step began with (m).
    pub(super) finest: f64,
    /// Ways that a contact has slid off from.
    pub(super) left: Vec<usize>,
    /// The working set after a solve.
    pub contacts: Vec<ActiveContact>,
    /// Rows of joints.
    pub joints: Vec<JointRow>,
    /// What they hold on to.
    pub joint_grips: Vec<JointGrip>,
    /// The joint rows after a solve.
    pub ties: Vec<ActiveJoint>,
    /// The grips when the last iterate was found, and at the end of the step.
    pub(super) applied_grips: Vec<JointGrip>,
    pub(super) end_grips: Vec<JointGrip>,
    /// Blocks that move and the joint rows that hold them, ascending.
    pub(super) holders: Vec<(usize, usize)>,
    /// Joint rows of the problem at hand, after those of contacts, and their places in it.
    pub(super) joint_rows: Vec<usize>,
    pub(super) joint_slot: Vec<usize>,
    pub(super) joint_answer: Vec<f64>,
    pub(super) twists: Twists,
    pub(super) is_working: Vec<bool>,
    pub(super) rows: Vec<RowDirection>,
    pub(super) kinds: Vec<RowKind>,
    pub(super) free: Vec<f64>,
    pub(super) delassus: Vec<f64>,
    /// What the multipliers move every row by, and its own share of that per unit.
    pub(super) responses: Vec<f64>,
    pub(super) diagonals: Vec<f64>,
    pub(super) joined: Joined,
    /// How far every joint row of the problem gives way by itself.
    pub(super) joint_gives: Vec<f64>,
    pub(super) sparse: Sparse,
    pub(super) multipliers: Vec<f64>,
    /// What has acted already of the rows' multipliers.
    pub(super) acted: Vec<f64>,
    pub(super) statuses: Vec<Status>,
    pub(super) wrenches: Vec<[f64; 3]>,
    pub(super) groups: Vec<usize>,
    /// Blocks with contacts of their own surface.
    pub(super) touch_themselves: Vec<bool>,
    /// Blocks of the contacts that pressed in the last step: their forces still act from the stored accelerations.
    pub(super) pressed_before: Vec<[usize; 2]>,
    pub(super) solver: Solver,
    /// Pivots and factorizations of contact problems since the solve began.
    pub(super) n_pivots: usize,
    pub(super) newton: Newton,
    pub(super) parting: Parting,
}

impl Island {
    /// Empties the island, keeping its buffers.
    pub fn clear(&mut self) {
        self.blocks.clear();
        self.flex_index.clear();
        self.parts.clear();
        self.segments.clear();
        self.candidates.clear();
        self.near_candidates.clear();
        self.path.clear();
        self.contacts.clear();
        self.joints.clear();
        self.joint_grips.clear();
        self.ties.clear();
    }

    /// Solves the step for predicted blocks: positions, velocities and contact forces at its end.
    ///
    /// `reserve` is the energy that contact has taken from this island and may give back (J).
    ///
    /// # Errors
    /// If a number is not finite.
    pub fn solve(
        &mut self,
        settings: &SolveSettings,
        memory: &ContactMemory,
        reserve: &mut f64,
    ) -> Result<IslandSummary, KktError> {
        self.n_pivots = 0;
        self.impulse_give = 0.0;
        let summary = self.solve_stages(settings, memory, reserve)?;
        Ok(IslandSummary {
            n_pivots: self.n_pivots,
            is_jammed: self.impulse_give > 0.0,
            ..summary
        })
    }

    fn solve_stages(
        &mut self,
        settings: &SolveSettings,
        memory: &ContactMemory,
        reserve: &mut f64,
    ) -> Result<IslandSummary, KktError> {
        let mut summary = IslandSummary::default();
        self.solver.set_first(settings.solver);
        if self.gives_up(settings) {
            summary.is_stopped = true;
            return Ok(summary);
        }
        self.solve_positions(settings, memory, &mut summary);
        if settings.may_be_cut && summary.is_unsolved() {
            return Ok(summary);
        }
        let before = start_energy(&self.blocks);
        let loads = external_work(&self.blocks, &self.contacts);
        let treatment = settings.treatment();
        summary.start_energy = before;
        let mut contacts = self.contacts.iter();
        summary.load_energy = load_energy(&self.blocks);
        summary.is_parting = contacts.any(|contact| contact.allowance < 0.0) || self.closes();
        let finished = treatment.finish(self, settings, &mut summary);
        let is_unsolved = summary.is_unsolved();
        if finished.is_err() && is_unsolved && !self.path.is_empty() {
            // Forces that are no numbers count no more than those that are too large.
            self.end_gently(settings, memory, &mut summary)?;
        } else {
            finished?;
        }
        self.settle_damping(settings);
        let joint_work = self.joint_work(settings);
        summary.end_energy = end_energy(&self.blocks);
        let stretched = self.stretched_by_closing(&summary);
        summary.work = self.actual_work(settings) + joint_work.all + stretched;
        let allowance = loads + joint_work.all + stretched;
        let joints_feed = joint_work.idle > GAINED * summary.brought();
        let is_thrown = self.is_flung() || !summary.is_unsolved() && self.is_thrown(&summary);
        if (is_thrown || joints_feed) && settings.may_be_cut {
            summary.is_stopped = true;
            return Ok(summary);
        }
        let has_path = !self.path.is_empty();
        if has_path && (is_thrown || self.has_gained(settings, &summary)) {
            self.end_gently(settings, memory, &mut summary)?;
        }
        if is_thrown && !has_path || self.has_gained(settings, &summary) {
            self.end_together(settings.dt, &mut summary);
            self.measure_ended(settings, &mut summary);
        }
        if treatment.limits_energy() {
            let stored = reserve.max(0.0);
            let is_unsolved = summary.is_unsolved();
            let allowance = if is_unsolved { summary.work } else { allowance };
            self.limit_energy(settings, allowance, reserve, &mut summary);
            if is_unsolved {
                // What such a step has lost is lost.
                *reserve = reserve.min(stored);
            }
        }
        self.count_late_forces(settings);
        self.publish_forces(settings.dt);
        Ok(summary)
    }

    /// Whether the step is too long for one of its blocks, and may be cut.
    fn gives_up(&mut self, settings: &SolveSettings) -> bool {
        let mut is_ambiguous = false;
        for block in &mut self.blocks {
            if let Block::Flex(block) = block {
                block.let_give_up(settings.may_be_cut);
                is_ambiguous |= block.is_ambiguous();
            }
        }
        settings.may_be_cut && is_ambiguous
    }

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

    /// Accumulates `Gᵀ f` on the blocks: node forces through `on_node`, wrenches of rigid blocks in `wrenches`.
    pub(super) fn spread(
        blocks: &mut [Block],
        kinematics: &Kinematics,
        force: [f64; 2],
        mut wrenches: Option<&mut [[f64; 3]]>,
        mut on_node: impl FnMut(&mut FlexBlock, usize, Vec2, Vec2),
    ) {
        let total = force[0] * kinematics.normal + force[1] * kinematics.tangent();
        for attachment in kinematics.attachments() {
            let share = attachment.weight * total;
            let Grip { point, lever } = attachment.grip;
            match (&mut blocks[attachment.block], point) {
                (Block::Flex(block), Point::Node(node)) => on_node(block, node, share, lever),
                (Block::Rigid(_), Point::Arm(_)) => {
                    if let Some(wrenches) = &mut wrenches {
                        let wrench = [share.x, share.y, cross(lever, share)];
                        for (sum, value) in wrenches[attachment.block].iter_mut().zip(wrench) {
                            *sum += value;
                        }
                    }
                }
                _ => {}
            }
        }
    }
}
