//! Joint rows in the position stage: their laws at this step length, their gaps and their forces.
//!
//! *Hard* rows, between rigid blocks only, follow RATTLE (Andersen 1983): the force `λ` of the position stage acts along the rows
//! of the step's beginning and gives the velocity `dt/2 M⁻¹G₀ᵀλ`; the velocity stage adds `dt/2 M⁻¹G'ᵀμ` along those of the end,
//! with `G'v' = 0`. That is second order, symmetric, keeps momentum and angular momentum exactly and energy within a band, and
//! leaves no force in the stored accelerations. As the position stage moves by `b0 M⁻¹G₀ᵀp`, `λ = 2 b0 p / dt²`. Those that nothing bounds yield a little to it, see
//! `yielding`.
//!
//! *Soft* rows, with a flexible block, act as (C.5) says, along rows that follow the iterates as those of contacts do.

use super::held::JointHold;
use super::law::resolve;
use super::mobility::own_mobility;
use super::stretch::tell_stretch;
use super::{ActiveJoint, Finish, Joints};
use crate::constraint::contact::Kinematics;
use crate::constraint::joint::{JointGrip, JointRow, When, unit_wrench};
use crate::kkt::active_contact::ActiveContact;
use crate::kkt::problem::RowProblem;
use crate::kkt::settings::SolveSettings;
use crate::linalg::complementarity::{RowKind, Status};
use crate::math::{perp, rounding};
use crate::system::{Block, Point, Response};

/// Mobility of a row, relative to that across it, up to which nothing moves it (-): the square of a lever's rounding. Forces of any size would
/// answer a row that points at the axis of what can only turn.
const SINGULAR: f64 = rounding::SQUARE;

impl Joints {
    /// Forgets all of them.
    pub(in crate::kkt) fn clear(&mut self) {
        self.rows.clear();
        self.grips.clear();
        self.ties.clear();
    }

    /// Puts every joint row to work, with the multipliers of the last step.
    pub(in crate::kkt) fn open(&mut self, blocks: &mut [Block], settings: &SolveSettings) {
        if !self.ties.is_empty() {
            self.twists.relax(blocks);
        }
        self.ties.clear();
        self.acting = if settings.is_within {
            When::Halfway
        } else {
            When::Now
        };
        self.joined.list(&[], &[]);
        if self.rows.is_empty() {
            return;
        }
        // What bodies of small strain are given late drives the turns of a hub where its spring acts as if it carried them: light ones stay damped.
        let rows = if settings.is_within {
            &self.rows[..]
        } else {
            &[]
        };
        self.laden.find(rows, &self.grips, blocks);
        self.yielding.find(&self.rows, &self.grips, blocks);
        for slot in 0..self.rows.len() {
            let row = self.rows[slot];
            let is_hard = self.prepare_row(blocks, &row);
            let when = if is_hard { When::Start } else { When::Now };
            let grips = &mut self.grips[row.grips.0..row.grips.1];
            let direction = row.sign * row.measure.aim(blocks, grips, when);
            let grips = &self.grips[row.grips.0..row.grips.1];
            let is_massless = |grip: &JointGrip| blocks[grip.block].is_massless(grip.point);
            let has_mass = !grips.iter().any(is_massless);
            let start = row.sign * row.measure.value(blocks, grips, When::Start);
            let view = (grips, direction, row.measure.is_turn());
            let mobility = own_mobility(blocks, view);
            let across = own_mobility(blocks, (grips, perp(direction), view.2));
            let swinging = self.laden.row_mobility(blocks, view).unwrap_or(mobility);
            let yielding = match is_hard {
                true => self.yielding.of(&row, blocks, (grips, mobility), settings),
                false => 0.0,
            };
            let places = [start, -yielding * row.last_multiplier()];
            let resolved = resolve(&row, is_hard, (places, mobility, swinging), settings);
            let status = match resolved.kind {
                RowKind::Unilateral if row.last_multiplier() <= 0.0 => Status::Open,
                _ => Status::Stick,
            };
            self.ties.push(ActiveJoint {
                row,
                is_hard,
                has_mass,
                share: 1.0,
                finish: resolved.finish,
                start,
                goal: resolved.goal,
                target: resolved.target,
                give: resolved.give,
                yielding,
                kind: resolved.kind,
                gap: start - resolved.goal,
                direction,
                applied: direction,
                end: direction,
                multiplier: row.last_multiplier(),
                status,
                closing: resolved.closing,
                closer: 0.0,
                answer: 0.0,
                asked: [resolved.goal, resolved.closing],
                kick: 0.0,
                impulse: 0.0,
                settled: 0.0,
                began: 0.0,
                driven: 0.0,
                is_movable: mobility > SINGULAR * across,
                seen: f64::INFINITY,
                n_same: 0,
                is_left: false,
                is_out_of_reach: false,
            });
        }
        self.applied_grips.clear();
        self.applied_grips.extend_from_slice(&self.grips);
        self.list_holders(blocks);
        self.joined.list(&self.ties, &self.grips);
        let joints = (&self.ties[..], &self.grips[..]);
        let last = |tie: &ActiveJoint| tie.row.last_multiplier();
        self.twists.stiffen(blocks, joints, settings, last);
    }

    /// Gives the blocks the stiffness of the forces of this iterate, where those of the last step were far off, as in an impact.
    pub(in crate::kkt) fn restiffen_turns(
        &mut self,
        blocks: &mut [Block],
        settings: &SolveSettings,
    ) {
        self.twists.relax(blocks);
        let joints = (&self.ties[..], &self.grips[..]);
        let now = |tie: &ActiveJoint| tie.multiplier;
        self.twists.stiffen(blocks, joints, settings, now);
    }

    /// Takes the stiffness against turning back from the blocks.
    pub(in crate::kkt) fn relax_turns(&mut self, blocks: &mut [Block]) {
        self.twists.relax(blocks);
    }

    /// Leaves blocks the share of their torque against turning that goes with forces that velocities feel; returns whether that takes anything.
    pub(in crate::kkt) fn leave_felt_torques(&mut self) -> bool {
        self.twists.leave_felt((&self.ties, &self.grips))
    }

    /// Torques against turning that velocities do not feel, by block (N m).
    pub(in crate::kkt) fn unfelt_torques(&self) -> &[f64] {
        self.twists.unfelt()
    }

    fn hold<'a>(&'a self, blocks: &'a [Block]) -> JointHold<'a> {
        JointHold {
            blocks,
            ties: &self.ties,
            grips: &self.grips,
        }
    }

    /// Whether joints leave the two rigid bodies of a contact no motion against each other.
    pub(in crate::kkt) fn holds_fast(&self, blocks: &[Block], row: &Kinematics) -> bool {
        self.hold(blocks).holds(row)
    }

    /// Whether a contact is between blocks that a joint holds.
    pub(in crate::kkt) fn joins(&self, contact: &ActiveContact) -> bool {
        self.joined.has(contact)
    }

    /// Makes the compliances of all rows' nodes known again, which bodies of large strain forget with their factors.
    pub(in crate::kkt) fn prepare(&self, blocks: &mut [Block]) {
        for slot in 0..self.ties.len() {
            let row = self.ties[slot].row;
            self.prepare_row(blocks, &row);
        }
    }

    /// Makes the compliances of a row's nodes known; returns whether there are none.
    fn prepare_row(&self, blocks: &mut [Block], row: &JointRow) -> bool {
        let mut is_hard = true;
        for grip in &self.grips[row.grips.0..row.grips.1] {
            if let (Block::Flex(block), Point::Node(node)) = (&mut blocks[grip.block], grip.point) {
                block.prepare_compliance(node);
                block.prepare_inertia(node);
                is_hard = false;
            }
        }
        is_hard
    }

    /// Lists the rows of a problem, after those of contacts.
    ///
    /// - `law`: what a row that takes part is without forces, its law, and by how much a unit multiplier lets it give way.
    pub(in crate::kkt) fn list(
        &mut self,
        problem: &mut RowProblem,
        law: impl Fn(&Self, &ActiveJoint) -> Option<(f64, RowKind, f64)>,
    ) {
        self.listed.clear();
        self.gives.clear();
        for index in 0..self.ties.len() {
            if let Some((free, kind, give)) = law(self, &self.ties[index]) {
                self.listed.push(index);
                self.gives.push(give);
                problem.free.push(free);
                problem.kinds.push(kind);
            }
        }
    }

    /// Lists which rows hold which block, so that only rows that couple are ever combined.
    pub(in crate::kkt) fn list_holders(&mut self, blocks: &[Block]) {
        self.holders.clear();
        for (index, tie) in self.ties.iter().enumerate() {
            for grip in &self.grips[tie.row.grips.0..tie.row.grips.1] {
                let moves =
                    !matches!(&blocks[grip.block], Block::Rigid(block) if block.is_prescribed());
                if moves && tie.is_movable {
                    self.holders.push((grip.block, index));
                }
            }
        }
        self.holders.sort_unstable();
        self.holders.dedup();
    }

    /// Adds the forces of the joints to the stage forces and wrenches.
    pub(in crate::kkt) fn spread(&self, blocks: &mut [Block], wrenches: &mut [[f64; 3]]) {
        for tie in &self.ties {
            let p = tie.multiplier;
            if p == 0.0 {
                continue;
            }
            let is_turn = tie.row.measure.is_turn();
            for grip in &self.grips[tie.row.grips.0..tie.row.grips.1] {
                match (&mut blocks[grip.block], grip.point) {
                    (Block::Flex(block), Point::Node(node)) => {
                        let force = p * grip.weight * tie.direction;
                        block.add_stage_force(node, force, grip.lever, false);
                    }
                    _ => add_wrench(
                        &mut wrenches[grip.block],
                        p,
                        unit_wrench(grip, tie.direction, is_turn),
                    ),
                }
            }
        }
        tell_stretch(&self.ties, &self.grips, blocks);
    }

    /// Gathers the joints' part of a solution as impulses on flexible blocks and wrenches on rigid ones; of accelerations only
    /// that of soft rows, as hard ones leave none.
    pub(in crate::kkt) fn gather(
        &self,
        problem: &RowProblem,
        (blocks, wrenches): (&mut [Block], &mut [[f64; 3]]),
        of: Response,
    ) {
        for (&index, &value) in self.listed.iter().zip(problem.of_joints()) {
            let tie = self.ties[index];
            if value == 0.0 || (of == Response::Acceleration && tie.is_hard) {
                continue;
            }
            let is_turn = tie.row.measure.is_turn();
            for grip in &self.end_grips[tie.row.grips.0..tie.row.grips.1] {
                match (&mut blocks[grip.block], grip.point) {
                    (Block::Flex(block), Point::Node(node)) => {
                        let impulse = value * grip.weight * tie.end;
                        block.gather_impulse(of, node, impulse, grip.lever);
                    }
                    _ => add_wrench(
                        &mut wrenches[grip.block],
                        value,
                        unit_wrench(grip, tie.end, is_turn),
                    ),
                }
            }
        }
    }

    /// Adds the forces of soft joints to the wrenches of rigid blocks.
    pub(in crate::kkt) fn add_soft_forces(&self, blocks: &[Block], wrenches: &mut [[f64; 3]]) {
        for tie in self.ties.iter().filter(|tie| !tie.is_hard) {
            for grip in &self.grips[tie.row.grips.0..tie.row.grips.1] {
                if let Block::Rigid(_) = &blocks[grip.block] {
                    let wrench = unit_wrench(grip, tie.direction, tie.row.measure.is_turn());
                    add_wrench(&mut wrenches[grip.block], tie.multiplier, wrench);
                }
            }
        }
    }

    /// Adds the mean forces of hard springs to the wrenches: in the acceleration problem they are known.
    pub(in crate::kkt) fn add_spring_forces(&self, wrenches: &mut [[f64; 3]], dt: f64) {
        for tie in self.ties.iter().filter(|tie| tie.is_hard) {
            if !matches!(tie.finish, Finish::Spring | Finish::Stiff(_)) {
                continue;
            }
            let force = (tie.kick + tie.impulse) / dt;
            for grip in &self.end_grips[tie.row.grips.0..tie.row.grips.1] {
                let wrench = unit_wrench(grip, tie.end, tie.row.measure.is_turn());
                add_wrench(&mut wrenches[grip.block], force, wrench);
            }
        }
    }

    /// Measures all joint rows where the blocks are now; returns how far the laws are from holding (m or rad).
    pub(in crate::kkt) fn measure(&mut self, blocks: &[Block]) -> f64 {
        let mut error = 0.0f64;
        for tie in &mut self.ties {
            let grips = &self.grips[tie.row.grips.0..tie.row.grips.1];
            let value = tie.row.measure.value(blocks, grips, When::Now);
            tie.gap = tie.row.sign * value - tie.goal;
            error = error.max(tie.error());
        }
        error
    }

    /// Extrapolates all joint rows from the beginning of the step, along the rows that they have; returns how far the laws are from holding
    /// there (m or rad).
    pub(in crate::kkt) fn extrapolate(&mut self, blocks: &[Block]) -> f64 {
        let mut error = 0.0f64;
        for tie in &mut self.ties {
            tie.gap = tie.start + tie.moved(blocks, &self.grips) - tie.goal;
            error = error.max(tie.error());
        }
        error
    }

    /// How far the ends of joints are at most from where the rows of the beginning would have them (m): by how much bodies that turn make
    /// rows mean other things within the step.
    pub(in crate::kkt) fn bend(&self, blocks: &[Block]) -> f64 {
        let stiff = self.ties.iter().filter(|tie| tie.give == 0.0);
        let bends = stiff.map(|tie| {
            let grips = &self.grips[tie.row.grips.0..tie.row.grips.1];
            let value = tie.row.sign * tie.row.measure.value(blocks, grips, When::Now);
            (value - tie.start - tie.moved(blocks, &self.grips)).abs()
        });
        bends.fold(0.0, f64::max)
    }

    /// Notes that the forces of soft joints acted along the rows that they have.
    pub(in crate::kkt) fn keep_rows(&mut self) {
        self.applied_grips.clear();
        self.applied_grips.extend_from_slice(&self.grips);
        for tie in &mut self.ties {
            tie.applied = tie.direction;
        }
    }

    /// Makes the present geometry the rows that the forces of soft joints act along.
    pub(in crate::kkt) fn turn_rows(&mut self, blocks: &[Block]) {
        for tie in &mut self.ties {
            if tie.is_hard {
                continue;
            }
            let (first, last) = tie.row.grips;
            self.applied_grips[first..last].copy_from_slice(&self.grips[first..last]);
            tie.applied = tie.direction;
            let grips = &mut self.grips[first..last];
            tie.direction = tie.row.sign * tie.row.measure.aim(blocks, grips, self.acting);
        }
    }
}

/// Adds a multiple of a wrench.
pub(in crate::kkt) fn add_wrench(sum: &mut [f64; 3], factor: f64, wrench: [f64; 3]) {
    for (sum, value) in sum.iter_mut().zip(wrench) {
        *sum += factor * value;
    }
}
