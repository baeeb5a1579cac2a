//! An island: blocks that touch, with the candidates between them, solved as one system.

use super::constraint_function::{ContactMethod, Newton};
use super::delassus::RowDirection;
use super::feasible::FeasiblePath;
use super::follow::Stage;
use super::impact::ImpactTreatment;
use super::joint_rows::ActiveJoint;
use super::sparse::Sparse;
use super::summary::IslandSummary;
use crate::constraint::contact::{
    Candidate, ContactKey, ContactMemory, Kinematics, PlacedPart, Remembered, Scene,
};
use crate::constraint::joint::{JointGrip, JointRow};
use crate::linalg::complementarity::{ComplementarityError, Method, RowKind, Solver, Status};
use crate::linalg::cone::ConeError;
use crate::math::{Vec2, cross};
use crate::path::NearPair;
use crate::system::{Block, FlexBlock, Grip, Point};
use std::collections::HashMap;
use thiserror::Error;

/// Why an island cannot be solved.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum KktError {
    /// A rigid body is too light for the springs that an explicit body meets it with.
    #[error(
        "rigid block {block} is so light that on the surface of an explicit flexible body it vibrates faster than the step of {dt} s resolves: shorten the step below {critical} s, make the body heavier, keep the inertia of the surface (`ContactInertia::Kept`), or choose beta0 > 0"
    )]
    LightPartner {
        /// Its index among the blocks of the island; whoever gathered the island knows its handle.
        block: usize,
        /// The step asked for (s).
        dt: f64,
        /// The longest stable step (s).
        critical: f64,
    },
    /// The contact problem holds numbers that are not finite.
    #[error(transparent)]
    Contact(#[from] ComplementarityError),
    /// The sparse contact problem holds numbers that are not finite.
    #[error(transparent)]
    Cone(#[from] ConeError),
}

/// Settings of a solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolveSettings {
    /// Step length (s), of the part that is solved.
    pub dt: f64,
    /// Length of the whole step (s).
    pub whole: f64,
    /// What a multiplier moves, over `A⁻¹` (s²): the Beta-2 weight `b0`, or `dt²` for the forward increment.
    pub b0: f64,
    /// Beta-2 weight `b1` (s).
    pub b1: f64,
    /// Whether multipliers act wholly within the step, so that none goes on.
    pub is_within: bool,
    /// Whether `β0 = 0`, so that multipliers act at the forward increment.
    pub is_explicit: bool,
    /// Whether steps that are too long for a partner are taken all the same.
    pub insists: bool,
    /// What is done on impact.
    pub impact: ImpactTreatment,
    /// How the laws of contact are enforced.
    pub contact: ContactMethod,
    /// The solver that contact problems are given to first.
    pub solver: Method,
    /// Approach velocity below which restitution is ignored (m/s).
    pub restitution_threshold: f64,
    /// Most Newton iterations.
    pub max_newton: usize,
    /// Whether what is not solved is cut into halves, so that where it ends does not matter.
    pub may_be_cut: bool,
    /// What counts as one unit of length in the scene (m).
    pub length_unit: f64,
}

/// A contact of the working set: its kinematics, multipliers and state.
#[derive(Clone, Copy, Debug)]
pub struct ActiveContact {
    /// Index of the candidate.
    pub candidate: usize,
    /// The row that the forces act along, with the gap beyond the allowance at the last iterate.
    pub kinematics: Kinematics,
    /// Geometry at the last iterate.
    pub(super) measured: Kinematics,
    /// The row that the multipliers acted along when the last iterate was found.
    pub(super) applied: Kinematics,
    /// Multipliers of the position stage, normal and tangential (N).
    pub multiplier: [f64; 2],
    /// Impulse of the velocity stage, normal and tangential (N s).
    pub impulse: [f64; 2],
    /// What the lasting force counts beyond its time (N s).
    pub(super) late: [f64; 2],
    /// Force of the acceleration stage (N).
    pub(super) settled: [f64; 2],
    /// Relative velocity along the normal and the tangent after the velocity stage (m/s).
    pub(super) parting: [f64; 2],
    /// Status of the normal and of the friction row.
    pub status: [Status; 2],
    /// Whether it is one of rigid bodies only.
    pub is_hard: bool,
    /// Whether some grip carries no inertia.
    pub is_massless: bool,
    /// Whether its multiplier alone decides its velocity: no impulse of the velocity stage follows.
    pub is_settled: bool,
    /// Gap and relative motion `Σ w u` at the last measurement, from which gaps are extrapolated where the
    /// geometry has no answer or keeps changing.
    pub(super) known: Option<(f64, Vec2)>,
    /// How far apart the bodies are where geometry has no gap but a force acts, 0 elsewhere (m).
    pub(super) apart: f64,
    /// Whether geometry has no gap, so that no force may act.
    pub(super) is_lost: bool,
    /// How often it has been let go for that within the step.
    pub(super) losses: u8,
    /// Tangential motion since the beginning of the step (m).
    pub slip: f64,
    /// The part of it that was gone on rows that this one has taken the force over from, less what its own row tells of that (m).
    pub(super) slip_before: f64,
    /// Share of the contact that is shorter than the step, 0 to 1 (-): the springs of the surface do not give way within it.
    pub unresolved: f64,
    /// Share of the contact in which the bodies meet as rigid ones within the step, 0 to 1 (-).
    pub rigid: f64,
    /// How far the row gives way to its own force in the problem solved, along its normal and its tangent (m/N).
    pub(super) yielding: [f64; 2],
    /// How far a force of its own moves it within the step, along its normal and its tangent, where that is known (m/N).
    pub(super) mobility: Option<[f64; 2]>,
    /// Approach velocity at the beginning of the step, `n·v` (m/s).
    pub approach: f64,
    /// Gap that is left of an overlap the step began with, zero or negative (m): what was put into each other parts by and
    /// by. The solver's gap counts from here.
    pub allowance: f64,
    /// What the contact was in the last step.
    pub remembered: Remembered,
    /// Where the contact was at the base of the path; `None` for signed rows, which know no path.
    pub(super) base: Option<AtBase>,
}

/// A contact at the base of the feasible path.
#[derive(Clone, Copy, Debug)]
pub(super) struct AtBase {
    /// Distance beyond the one at which the contact closes (m).
    pub gap: f64,
    /// Motion of the material points against each other since the beginning of the step (m); of vertices that are held together, from
    /// where they are.
    pub moved: Vec2,
    /// The near pair.
    pub near: NearPair,
    /// Whether it stands for two vertices that are held together.
    pub is_meeting: bool,
}

impl ActiveContact {
    /// Force over the step: the multiplier, or for contacts of rigid bodies the impulse over the step length (N).
    pub fn force(&self, dt: f64) -> [f64; 2] {
        if self.is_hard {
            self.impulse.map(|impulse| impulse / dt)
        } else {
            let sum = |axis| self.multiplier[axis] + (self.impulse[axis] + self.late[axis]) / dt;
            [sum(0), sum(1)]
        }
    }

    /// The force that is left in the stored accelerations (N).
    pub fn lasting(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.multiplier[axis] + self.settled[axis])
    }

    /// How far the velocity stage holds the contact's relative velocity, 0 to 1 (-): masses that meet would ring at every
    /// mesh's highest frequency; a massless surface only where the step is longer than the impact.
    pub(super) fn holds_velocity(&self) -> f64 {
        if self.is_settled {
            0.0
        } else if self.is_massless {
            self.unresolved
        } else {
            1.0
        }
    }

    /// The gap (m).
    pub fn gap(&self) -> f64 {
        self.kinematics.gap + self.allowance
    }

    /// Whether the contact carries or would carry a force.
    pub fn is_closed(&self) -> bool {
        self.multiplier[0] > 0.0
    }
}

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
    /// What the laws may miss at the very most: the least margin of the ways (m).
    pub(super) margin: f64,
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
    /// Stiffness against turning by the joints' forces, by block (N m/rad), then the torque that it made (N m).
    pub(super) twists: Vec<f64>,
    pub(super) is_working: Vec<bool>,
    pub(super) rows: Vec<RowDirection>,
    pub(super) kinds: Vec<RowKind>,
    pub(super) free: Vec<f64>,
    pub(super) delassus: Vec<f64>,
    /// What the multipliers move every row by, and its own share of that per unit.
    pub(super) responses: Vec<f64>,
    pub(super) diagonals: Vec<f64>,
    /// Pairs of blocks that joints hold, in order.
    pub(super) joined: Vec<[usize; 2]>,
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
        let summary = self.solve_stages(settings, memory, reserve)?;
        Ok(IslandSummary {
            n_pivots: self.n_pivots,
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
        let before = self.start_energy();
        let loads = self.external_work();
        let treatment = settings.treatment();
        summary.start_energy = before;
        let mut contacts = self.contacts.iter();
        summary.load_energy = self.load_energy();
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
        summary.end_energy = self.end_energy();
        let stretched = self.stretched_by_closing(&summary);
        let allowance = loads + joint_work + stretched;
        summary.work = self.actual_work(settings) + joint_work + stretched;
        let is_thrown = self.is_flung() || !summary.is_unsolved() && self.is_thrown(&summary);
        if is_thrown && settings.may_be_cut {
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
